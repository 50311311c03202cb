#pragma once

// Textures of colours as devices sample them best: sRGB, on software devices square roots of linear colours, whose
// filtering needs no table.

#include <span>
#include <string>
#include <string_view>

#include "runtime/gpu/upload.hpp"

namespace espalier {

// Do textures of makeColorTexture hold square roots? Shaders square them then.
bool holdsRoots(const Device& device);

// rgba: 8-bit sRGB with linear alpha, rows top to bottom, width * height * 4 bytes. With all mips. roots: holdsRoots().
size_t addColorTexture(Upload& upload, std::string name, uint32_t width, uint32_t height, std::span<const uint8_t> rgba,
                       bool roots);
// The same at once.
Result<Image> makeColorTexture(Device& device, std::string_view name, uint32_t width, uint32_t height,
                               std::span<const uint8_t> rgba);

}  // namespace espalier
