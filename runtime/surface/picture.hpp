#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "runtime/core/result.hpp"
#include "runtime/surface/surface.hpp"
#include "runtime/surface/uv_picture.hpp"

namespace espalier {

// How many texels decodePicture would make of it, by its first bytes alone; else why it would make none.
Result<uint64_t> texelsOf(std::span<const std::byte> bytes, std::string_view file);

// Whether it begins as PNG or JPEG does. The library that decodes reads further formats, by code that nobody hardens.
bool isPicture(std::span<const std::byte> bytes);

// Decodes a PNG or JPEG of 1 to 16384 texels a side; `encoded` stays empty. A failure names `file` and the cause: other
// formats, damage, more than maxTexels. Throws std::bad_alloc alone, for want of memory; may be called from any thread.
Result<Picture> decodePicture(std::span<const std::byte> bytes, std::string_view file,
                              uint64_t maxTexels = uint64_t(1) << 28);
// Likewise its grey, of 8 or 16 bits, as 0 to 1, of up to maxSide texels a side.
Result<UvPicture> decodeGrey(std::span<const std::byte> bytes, std::string_view file, uint32_t maxSide);

}  // namespace espalier
