// Hash and value noise for procedural content. In: coordinates and a salt. Out: the same numbers on every run;
// nothing here has state.

#include "tools/content/noise.hpp"

#include <cmath>

namespace espalier::content {

uint32_t hash32(uint32_t a, uint32_t b, uint32_t c) {
    uint32_t h = a * 0x9E3779B1u ^ (b + 0x7F4A7C15u) * 0x85EBCA77u ^ (c + 0x165667B1u) * 0xC2B2AE3Du;
    h ^= h >> 16;
    h *= 0x7FEB352Du;
    h ^= h >> 15;
    h *= 0x846CA68Bu;
    return h ^ (h >> 16);
}

float random01(uint32_t a, uint32_t b, uint32_t c) {
    return static_cast<float>(hash32(a, b, c) >> 8) / 16777216.0f;
}

namespace {

float fade(float t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}

uint32_t bits(float latticePoint) {
    return static_cast<uint32_t>(static_cast<int32_t>(latticePoint));
}

float lattice(float x, float y, float z, uint32_t salt) {
    return random01(hash32(bits(x), bits(y), salt), bits(z)) * 2 - 1;
}

}  // namespace

float noise(glm::vec3 p, uint32_t salt) {
    glm::vec3 i = glm::floor(p), f = p - i;
    float u = fade(f.x), v = fade(f.y), w = fade(f.z);
    auto layer = [&](float z) {
        float low = glm::mix(lattice(i.x, i.y, z, salt), lattice(i.x + 1, i.y, z, salt), u);
        float high = glm::mix(lattice(i.x, i.y + 1, z, salt), lattice(i.x + 1, i.y + 1, z, salt), u);
        return glm::mix(low, high, v);
    };
    return glm::mix(layer(i.z), layer(i.z + 1), w);
}

float noise(glm::vec2 p, uint32_t salt) {
    glm::vec2 i = glm::floor(p), f = p - i;
    float u = fade(f.x), v = fade(f.y);
    float low = glm::mix(lattice(i.x, i.y, 0, salt), lattice(i.x + 1, i.y, 0, salt), u);
    float high = glm::mix(lattice(i.x, i.y + 1, 0, salt), lattice(i.x + 1, i.y + 1, 0, salt), u);
    return glm::mix(low, high, v);
}

float fractal(glm::vec3 p, uint32_t salt, int octaves) {
    float sum = 0, amplitude = 0.55f;
    for (int o = 0; o < octaves; ++o, p = p * 2.03f + 17.3f, amplitude *= 0.5f)
        sum += amplitude * noise(p, salt + static_cast<uint32_t>(o));
    return sum;
}

float fractal(glm::vec2 p, uint32_t salt, int octaves) {
    float sum = 0, amplitude = 0.55f;
    for (int o = 0; o < octaves; ++o, p = p * 2.03f + 17.3f, amplitude *= 0.5f)
        sum += amplitude * noise(p, salt + static_cast<uint32_t>(o));
    return sum;
}

float tilingNoise(glm::vec2 p, glm::ivec2 period, uint32_t salt) {
    glm::vec2 i = glm::floor(p), f = p - i;
    auto wrap = [](float x, int n) { return static_cast<float>(((static_cast<int>(x) % n) + n) % n); };
    float x0 = wrap(i.x, period.x), x1 = wrap(i.x + 1, period.x);
    float y0 = wrap(i.y, period.y), y1 = wrap(i.y + 1, period.y);
    float u = fade(f.x), v = fade(f.y);
    float low = glm::mix(lattice(x0, y0, 0, salt), lattice(x1, y0, 0, salt), u);
    float high = glm::mix(lattice(x0, y1, 0, salt), lattice(x1, y1, 0, salt), u);
    return glm::mix(low, high, v);
}

float tilingFractal(glm::vec2 p, glm::ivec2 period, uint32_t salt, int octaves) {
    float sum = 0, amplitude = 0.55f;
    for (int o = 0; o < octaves; ++o, p *= 2.0f, period *= 2, amplitude *= 0.5f)
        sum += amplitude * tilingNoise(p, period, salt + static_cast<uint32_t>(o));
    return sum;
}

Cells cells(glm::vec2 p, uint32_t salt) {
    glm::vec2 base = glm::floor(p);
    Cells found{9, 9, 0};
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            glm::vec2 cell = base + glm::vec2(dx, dy);
            uint32_t id = hash32(bits(cell.x), bits(cell.y), salt);
            float d = glm::distance(p, cell + glm::vec2(random01(id, 1), random01(id, 2)));
            if (d < found.nearest) {
                found = {d, found.nearest, id};
            } else if (d < found.second) {
                found.second = d;
            }
        }
    return found;
}

}  // namespace espalier::content
