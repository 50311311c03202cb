#pragma once

// The noise that the meadow's look comes from, and that look at a place, for what grows there.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace espalier {

constexpr uint32_t kNoiseSide = 512;  // texels of its tile, which repeats

// Of integers, -1 to 1.
float lattice(uint32_t x, uint32_t y, uint32_t salt);
// Sum of octaves of value noise in [-1, 1] or so, at a texel of a tile; the coarsest has `cells` to the side, each next
// twice as many.
float octaves(uint32_t x, uint32_t y, uint32_t cells, int count, uint32_t salt);

// What the tile holds but for blades of grass: x: patches; z, w: slopes of a bumpy height. Of mean 0, so that they fade
// with distance as colours do.
glm::vec4 meadowNoise(uint32_t x, uint32_t y);
std::vector<glm::vec4> meadowNoiseTile();  // row by row

struct MeadowHue {
    float dry = 0;    // share of the grass
    float shade = 1;  // of its colour
};
// place: x and z, metres.
MeadowHue meadowHue(glm::vec2 place);

}  // namespace espalier
