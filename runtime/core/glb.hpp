#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "runtime/core/result.hpp"

// The container of binary glTF (glTF 2.0, §4.4): a header, a JSON chunk and a binary chunk.
namespace espalier {

inline constexpr uint32_t kGlbMagic = 0x46546C67, kGlbJson = 0x4E4F534A, kGlbBinary = 0x004E4942;

// The container's bytes; both chunks are padded to four. The sizes together stay below 4 GiB.
std::vector<std::byte> glbContainer(std::string json, std::span<const std::byte> binary);

// Writes it as writeFile does; fails also where it is larger than a .glb can be.
Status writeGlb(const std::filesystem::path& path, std::string json, std::span<const std::byte> binary);

}  // namespace espalier
