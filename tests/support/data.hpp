#pragma once

// Finds models that the repository doesn't hold. Tests that need one skip, saying so, where it isn't there.

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace espalier::test {

// The folder of further models: the environment variable ESPALIER_DATA, else ../shared/data seen from the
// project's root, where tests run. None: an empty path.
inline std::filesystem::path dataFolder() {
    std::error_code error;
    if (const char* given = std::getenv("ESPALIER_DATA"); given && *given)
        return std::filesystem::is_directory(given, error) ? given : "";
    return std::filesystem::is_directory("../shared/data", error) ? "../shared/data" : "";
}

// A file or folder below it; prints why and returns nothing where it is missing.
inline std::optional<std::string> dataFile(const std::string& name) {
    std::error_code error;
    std::filesystem::path path = dataFolder() / name;
    if (!dataFolder().empty() && std::filesystem::exists(path, error)) return path.string();
    std::printf("skipped: %s is not there (set ESPALIER_DATA to the folder that holds it)\n", name.c_str());
    return std::nullopt;
}

}  // namespace espalier::test
