#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace espalier::scene {

// Files whole, in and out, of any bytes. `error` names file and cause.

// Written beside `path` first and renamed (Unfinished), so that a failure leaves what was there. What a link leads to
// is replaced, not the link; devices and pipes are written to as they are.
bool writeText(const std::string& path, std::string_view text, std::string& error);

inline std::string_view asText(const std::vector<uint8_t>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// With the current folder before it, unless that is gone.
std::filesystem::path absolutePath(const std::string& path);

// What a link leads to, or else the path itself.
std::filesystem::path behindLinks(const std::filesystem::path& path);

// Folders, devices and pipes, which may never end, are refused, and files of more bytes than `most`.
bool readText(const std::string& path, std::string& text, std::string& error, uint64_t most = uint64_t(1) << 30);

// Whether it is one of these; `error` says so.
bool refused(const std::string& path, std::string& error);

}  // namespace espalier::scene
