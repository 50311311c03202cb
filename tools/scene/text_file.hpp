#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace espalier::scene {

// Files whole, in and out, of any bytes. `error` names file and cause.

// Written beside `path` first and renamed, so that a failure leaves what was there. What a link leads to is replaced,
// not the link; devices and pipes are written to as they are.
bool writeText(const std::string& path, std::string_view text, std::string& error);

// With the current folder before it, unless that is gone.
std::filesystem::path absolutePath(const std::string& path);

// What a link leads to, or else the path itself.
std::filesystem::path behindLinks(const std::filesystem::path& path);

// Folders, devices and pipes, which may never end, are refused.
bool readText(const std::string& path, std::string& text, std::string& error);

// Whether it is one of these; `error` says so.
bool refused(const std::string& path, std::string& error);

}  // namespace espalier::scene
