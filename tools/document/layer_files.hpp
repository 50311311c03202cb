#pragma once

#include <string>

#include "tools/document/document.hpp"
#include "tools/document/work.hpp"

namespace espalier::document {

// The file of a surface's picture: of several surfaces each has its own, mask.exr, mask-1.exr ...
std::string pictureOf(const Document& document, const std::string& path, size_t surface);
// Writes a layer over the walk UVs of every surface, or, where it lies over the town alone, over its site, north up:
// .exr to the bit, .png with 16 bits. Old files are written over only when all new ones are whole. As saving, what is
// written is the layer as it is now (Work::settle). False: `error` tells why.
Work::Plan exporting(const Document& document, const std::string& layer, const std::string& path);
bool exportLayer(const Document& document, const std::string& layer, const std::string& path, std::string& error);
// Reads what exporting writes, or any picture, as actions of one gesture (not 0); nothing else is to edit the document
// before that is over. A surface but the first whose picture isn't there keeps its layer. The note tells what was left
// out or made to fit, with semicolons between. Failed or cancelled, the layer is as it was.
Work::Plan importing(Document& document, const std::string& layer, const std::string& path, uint32_t gesture);

}  // namespace espalier::document
