#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>

namespace espalier::test {

// A fresh empty folder, removed at the end.
struct ScratchFolder {
    std::filesystem::path path;
    ScratchFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "espalier-test-XXXXXX").string();
        if (const char* made = mkdtemp(name.data())) path = made;
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    std::string file(const std::string& name) const { return (path / name).string(); }
};

}  // namespace espalier::test
