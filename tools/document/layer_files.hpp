#pragma once

#include <string>

#include "tools/document/document.hpp"

namespace espalier::document {

// The file of a surface's picture: of several surfaces each has its own, mask.exr, mask-1.exr ...
std::string pictureOf(const Document& document, const std::string& path, size_t surface);
// Writes a layer over the walk UVs of every surface: .exr to the bit, .png with 16 bits. False: `error` tells why.
bool exportLayer(const Document& document, const std::string& layer, const std::string& path, std::string& error);
// Likewise a layer over the town's site, north up.
bool exportTownLayer(const Document& document, const std::string& layer, const std::string& path, std::string& error);

}  // namespace espalier::document
