// Bark and pebbles. In: level of detail or texture size. Out: tubes to be bent along spans, rounded stones, and
// textures that tile.

#include <algorithm>
#include <cmath>

#include "runtime/core/srgb.hpp"
#include "tools/content/leaf.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

struct Texel {
    float height;  // in units of the tile's side
    glm::vec3 color;
};

template <class At>
Tile paintTile(int size, const At& at) {
    Tile tile{Picture(size, size), Picture(size, size)};
    float step = 1.0f / static_cast<float>(size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            glm::vec2 p = (glm::vec2(x, y) + 0.5f) * step;
            Texel t = at(p);
            float dx = (at(p + glm::vec2(step, 0)).height - at(p - glm::vec2(step, 0)).height) / (2 * step);
            float dy = (at(p + glm::vec2(0, step)).height - at(p - glm::vec2(0, step)).height) / (2 * step);
            glm::vec3 n = glm::normalize(glm::vec3(-dx, dy, 1));
            for (int k = 0; k < 3; ++k) {
                tile.color.at(x, y)[k] = toByte(srgbOfLinear(t.color[k]));
                tile.normal.at(x, y)[k] = toByte(n[k] * 0.5f + 0.5f);
            }
            tile.color.at(x, y)[3] = tile.normal.at(x, y)[3] = 255;
        }
    return tile;
}

// Furrows along v, rings of former leaf scars, and the brown fringe of rootlets in two strips.
Texel barkAt(glm::vec2 p) {
    glm::vec2 bent = p + glm::vec2(0.035f * tilingFractal(p * 5.0f, {5, 5}, 911, 3), 0);
    float furrow = tilingFractal(bent * glm::vec2(14, 3), {14, 3}, 913, 4);
    float ridge = 1 - std::abs(furrow) * 1.6f;
    float fine = tilingFractal(bent * glm::vec2(46, 16), {46, 16}, 921, 3);
    float scar = ramp(0.45f, 0.75f, tilingFractal(p * glm::vec2(3, 11), {3, 11}, 927, 2));
    float strip = std::max(ramp(0.13f, 0.03f, std::abs(p.x - 0.27f)), ramp(0.11f, 0.02f, std::abs(p.x - 0.79f)));
    float fringe = strip * saturate(0.4f + 1.1f * tilingFractal(bent * glm::vec2(60, 22), {60, 22}, 931, 2));
    float height = 0.020f * ridge + 0.006f * fine + 0.008f * scar + 0.016f * fringe;
    glm::vec3 color =
        glm::mix(glm::vec3(0.075f, 0.056f, 0.040f), glm::vec3(0.215f, 0.180f, 0.140f), saturate(ridge * 0.85f));
    float grey = saturate(0.5f + 0.9f * tilingFractal(p * 3.0f, {3, 3}, 937, 3));
    color = glm::mix(color, glm::vec3(0.175f, 0.165f, 0.150f) * (0.6f + 0.5f * ridge), 0.6f * grey);
    color *= 1 + 0.35f * fine;
    color = glm::mix(color, glm::vec3(0.105f, 0.062f, 0.036f) * (1 + 0.6f * fine), 0.75f * fringe);
    color = glm::mix(color, glm::vec3(0.10f, 0.115f, 0.055f),
                     0.35f * ramp(0.25f, 0.7f, tilingFractal(p * 4.0f, {4, 4}, 941, 3)));
    return {height, glm::clamp(color, 0.01f, 0.6f)};
}

Texel pebbleAt(glm::vec2 p) {
    float cloud = tilingFractal(p * 4.0f, {4, 4}, 951, 4), grain = tilingFractal(p * 40.0f, {40, 40}, 957, 3);
    glm::vec3 color =
        glm::mix(glm::vec3(0.19f, 0.175f, 0.15f), glm::vec3(0.34f, 0.31f, 0.26f), saturate(0.5f + 0.7f * cloud));
    color *= 1 + 0.3f * grain;
    color = glm::mix(color, glm::vec3(0.10f, 0.12f, 0.05f),
                     0.5f * ramp(0.3f, 0.7f, tilingFractal(p * 3.0f, {3, 3}, 961, 3)));
    return {0.01f * cloud + 0.003f * grain, glm::clamp(color, 0.01f, 0.7f)};
}

}  // namespace

Mesh makeBark(int lod) {
    static const uint32_t kSides[] = {12, 6, 4}, kRows[] = {9, 4, 1};
    uint32_t sides = kSides[lod], rows = kRows[lod];
    Mesh mesh;
    for (uint32_t r = 0; r <= rows; ++r)
        for (uint32_t s = 0; s <= sides; ++s) {
            float u = static_cast<float>(s) / static_cast<float>(sides),
                  v = static_cast<float>(r) / static_cast<float>(rows);
            float angle = 2 * kPi * static_cast<float>(s % sides) / static_cast<float>(sides);
            glm::vec3 n(std::cos(angle), std::sin(angle), 0);
            mesh.positions.push_back(n + glm::vec3(0, 0, v));
            mesh.normals.push_back(n);
            mesh.uvs.push_back({u, 1 - v});
        }
    for (uint32_t r = 0; r < rows; ++r)
        for (uint32_t s = 0; s < sides; ++s) {
            uint32_t a = r * (sides + 1) + s, b = a + 1, c = a + sides + 1, d = c + 1;
            for (uint32_t v : {a, b, d, a, d, c}) mesh.indices.push_back(v);
        }
    return mesh;
}

Tile paintBark(int size) {
    return paintTile(size, barkAt);
}
Tile paintPebble(int size) {
    return paintTile(size, pebbleAt);
}

Mesh makePebble(int variant, int lod) {
    uint32_t sides = lod == 0 ? 10 : 5, rows = lod == 0 ? 6 : 3;
    glm::vec3 size = variant == 0 ? glm::vec3(0.50f, 0.40f, 0.26f) : glm::vec3(0.42f, 0.36f, 0.33f);
    Mesh mesh;
    for (uint32_t r = 0; r <= rows; ++r)
        for (uint32_t s = 0; s <= sides; ++s) {
            float u = static_cast<float>(s) / static_cast<float>(sides),
                  v = static_cast<float>(r) / static_cast<float>(rows);
            float turn = 2 * kPi * static_cast<float>(s % sides) / static_cast<float>(sides), tilt = kPi * v;
            bool pole = r == 0 || r == rows;
            glm::vec3 d =
                pole ? glm::vec3(0, 0, r == 0 ? -1 : 1)
                     : glm::vec3(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), -std::cos(tilt));
            float bump = 1 + 0.16f * fractal(d * 1.6f + static_cast<float>(variant) * 5.0f, 971, 2);
            glm::vec3 p = d * size * bump;
            mesh.positions.push_back(p + glm::vec3(0, 0, size.z * 0.75f));
            mesh.normals.push_back(glm::normalize(d / size));
            mesh.uvs.push_back({u * 2, 1 - v});
        }
    for (uint32_t r = 0; r < rows; ++r)
        for (uint32_t s = 0; s < sides; ++s) {
            uint32_t a = r * (sides + 1) + s, b = a + 1, c = a + sides + 1, d = c + 1;
            if (r > 0)
                for (uint32_t v : {a, b, d}) mesh.indices.push_back(v);
            if (r + 1 < rows)
                for (uint32_t v : {a, d, c}) mesh.indices.push_back(v);
        }
    return mesh;
}

}  // namespace espalier::content
