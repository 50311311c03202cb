#pragma once

// Painted layers' pictures, carried from an earlier surface of a model to its new one.

#include <string>
#include <vector>

#include "runtime/surface/surface.hpp"
#include "runtime/surface/uv_picture.hpp"

namespace espalier {

// A picture's grey, at most 8192 texels a side.
Result<UvPicture> readLayer(const std::string& path);

struct CarryArguments {
    std::string from;                 // a surface; empty: nothing is carried
    std::vector<std::string> layers;  // PNG files over its walk UVs
    std::string seeds;                // a scene or project whose seeds are looked after; empty: none
};

// Each layer's picture as it has to lie over `to`, as 16-bit PNG in `files`, to be written beside `output` under the
// layer's own name. What is lost or has no layer yet, and each seed without ground, is told in `notes`. Refuses to
// write over what it reads.
struct CarriedFile {
    std::string path;
    std::vector<std::byte> bytes;
};
Result<std::vector<CarriedFile>> carryLayers(const CarryArguments& arguments, const SurfaceData& to,
                                             const std::string& output, std::vector<Diagnostic>& notes);

}  // namespace espalier
