#pragma once

// The content tool as a library: everything that espalier-content writes. Deterministic: equal options give equal
// bytes.

#include <string>

#include "runtime/core/result.hpp"

namespace espalier::content {

struct Options {
    std::string directory;         // of all files; made if missing
    std::string previewDirectory;  // empty: no pictures
    int textureSize = 2048;        // of the ruin, a power of two
    std::string only = "";         // "ruin", "roofs", "pieces", "forms", "terminals" or "props"; empty: all
    std::string town = "";         // houses that the site is laid out around; empty: no site.json and site.png
    std::string grammar = "";      // of these houses: where their doors are
};

Status generate(const Options& options);

}  // namespace espalier::content
