#pragma once

// The content tool as a library: everything that espalier-content writes. Deterministic: equal options give equal
// bytes.

#include <string>

#include "runtime/core/result.hpp"

namespace espalier::content {

struct Options {
    std::string directory;         // of ruin.glb, mask.png, terminals.glb; made if missing
    std::string previewDirectory;  // empty: no pictures
    std::string only;              // "ruin", "roofs" or "terminals"; empty: all
    int textureSize = 2048;        // of the ruin, a power of two
};

Status generate(const Options& options);

}  // namespace espalier::content
