#pragma once

// Deterministic noise for the content tool: integer hashes, value noise, fractal sums. Pure functions.

#include <cstdint>
#include <glm/glm.hpp>

namespace espalier::content {

// A well mixed 32-bit hash of up to three integers.
uint32_t hash32(uint32_t a, uint32_t b = 0, uint32_t c = 0);

// Uniform in [0, 1) from the same arguments.
float random01(uint32_t a, uint32_t b = 0, uint32_t c = 0);

// Smooth value noise in [-1, 1]; lattice spacing 1; `salt` picks an independent field.
float noise(glm::vec3 p, uint32_t salt);
float noise(glm::vec2 p, uint32_t salt);

// Sum of `octaves` of noise, each of half the amplitude and twice the frequency; about [-1, 1].
float fractal(glm::vec3 p, uint32_t salt, int octaves);
float fractal(glm::vec2 p, uint32_t salt, int octaves);

// Noise on a torus: p counts cells, and the field repeats after `period` cells in both directions.
float tilingNoise(glm::vec2 p, glm::ivec2 period, uint32_t salt);
float tilingFractal(glm::vec2 p, glm::ivec2 period, uint32_t salt, int octaves);

// Distances to the nearest and second nearest of one jittered point a cell; id of the nearest.
struct Cells {
    float nearest, second;
    uint32_t id;
};
Cells cells(glm::vec2 p, uint32_t salt);

}  // namespace espalier::content
