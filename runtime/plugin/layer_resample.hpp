#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/surface/surface.hpp"

namespace espalier {

inline constexpr uint32_t kMaxLayerSide = 8192;  // texels, of pictures that hosts hand in

// What a layer holds of a host's value.
inline float layerValue(float value) {
    return value > 0 ? std::min(value, 1.f) : 0;  // NaN becomes 0
}

// A single-channel picture as a layer hands it in: rows from v = 0 on, at least 1 × 1. It is read bilinearly, values
// limited to [0,1] (NaN: 0).
struct LayerPicture {
    std::span<const float> texels;  // width * height
    uint32_t width = 0, height = 0;
    bool materialUv = false;  // drawn in the materials' UV set; repeats if that leaves [0,1]; else in the walk's
};

// The picture laid into the walk's UV at level 0's size, in texelIndex order. What lies outside of the charts is
// filled from the border of the chart next to it, so that a bilinear read at a border reads no foreign value.
std::vector<float> resampleLayer(const SurfaceData& surface, const LayerPicture& picture);

}  // namespace espalier
