#pragma once

#include <string>

#include "tools/document/document.hpp"

namespace espalier::document {

// The file of a surface's picture: of several surfaces each has its own, mask.exr, mask-1.exr ...
std::string pictureOf(const Document& document, const std::string& path, size_t surface);
// Writes a layer over the walk UVs of every surface: .exr to the bit, .png with 16 bits. False: `error` tells why.
bool exportLayer(const Document& document, const std::string& layer, const std::string& path, std::string& error);
// Over an old file only when the new one is whole. Likewise a layer over the town's site, north up.
bool exportTownLayer(const Document& document, const std::string& layer, const std::string& path, std::string& error);
// Reads what exportLayer writes, or any picture over the walk UVs, as actions of one gesture (not 0). A surface but the
// first whose picture isn't there keeps its layer. `note`: what was left out or made to fit, a line each. False:
// `error` tells why, and the layer is as it was.
bool importLayer(Document& document, const std::string& layer, const std::string& path, uint32_t gesture,
                 std::string& note, std::string& error);

}  // namespace espalier::document
