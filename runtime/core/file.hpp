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

// What becomes of a link in a file's place: what it leads to is replaced, as suits files that a user names, or the link
// itself, as suits folders whose files nobody but us is to name.
enum class Links { follow, replace };

// Writes under a name that nobody can foresee beside `path` first and renames, so that a reader sees the old file or
// the whole new one and a failure leaves nothing behind. Devices and pipes are written to as they are, unless links are
// replaced. Missing folders are made. Fails with the path and the system's reason.
Status writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes, Links links = Links::follow);
Status writeFile(const std::filesystem::path& path, std::string_view text, Links links = Links::follow);

// A name beside `path` that nobody can foresee.
std::string neighbourOf(const std::filesystem::path& path);

}  // namespace espalier
