#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "runtime/core/result.hpp"

namespace espalier {

// The whole file. Fails with the path and the system's reason; folders and devices, which may never end, are refused.
Result<std::vector<std::byte>> readFile(const std::filesystem::path& path);
Result<std::string> readTextFile(const std::filesystem::path& path);

// Writes beside `path` first and renames, so that a reader sees the old file or the whole new one and a failure
// leaves nothing behind. What a link leads to is replaced, not the link (but one that leads nowhere is); devices and
// pipes are written to as they are. Missing folders are made. Fails with the path and the system's reason.
Status writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);
Status writeFile(const std::filesystem::path& path, std::string_view text);

}  // namespace espalier
