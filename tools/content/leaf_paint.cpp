// The leaves' atlas. In: shapes. Out: colour with a distance ramp as alpha, so that mip levels keep the cut-out's
// area, colour carried on beyond the edge, and normals of blade and veins.

#include <algorithm>
#include <cmath>

#include "runtime/core/srgb.hpp"
#include "tools/content/leaf.hpp"
#include "tools/content/leaf_shape.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

float lineDistance(const std::vector<glm::vec2>& line, glm::vec2 p, float& along) {
    float best = 1e9f;
    for (size_t i = 0; i + 1 < line.size(); ++i) {
        glm::vec2 d = line[i + 1] - line[i];
        float t = saturate(glm::dot(p - line[i], d) / std::max(glm::dot(d, d), 1e-12f));
        float distance = glm::distance(p, line[i] + d * t);
        if (distance < best) {
            best = distance;
            along = (static_cast<float>(i) + t) / static_cast<float>(line.size() - 1);
        }
    }
    return best;
}

struct Veins {
    float main = 0, side = 0;  // strength, [0, 1]
    float nearMain = 1;        // distance
};

Veins veinsAt(const LeafShape& shape, glm::vec2 p) {
    Veins out;
    for (auto& vein : shape.veins) {
        float along = 0, d = lineDistance(vein, p, along);
        float width = 0.0085f * (1.05f - 0.8f * along);
        out.main = std::max(out.main, ramp(width * 1.5f, width * 0.35f, d));
        out.nearMain = std::min(out.nearMain, d);
    }
    for (auto& rib : shape.ribs) {
        float along = 0, d = lineDistance(rib, p, along);
        float width = 0.0048f * (1.1f - 0.9f * along);
        out.side = std::max(out.side, ramp(width * 1.8f, width * 0.3f, d) * (1 - 0.6f * along));
    }
    return out;
}

// Violet, paler along the veins and towards the rim, a yellow middle.
glm::vec3 petalColor(const LeafShape& shape, glm::vec2 p, float edge, const Veins& veins, bool back) {
    const float out = glm::distance(p, {0, 0.5f * (1 + shape.base)});
    glm::vec3 color = glm::mix(glm::vec3(0.17f, 0.04f, 0.30f), glm::vec3(0.30f, 0.12f, 0.45f), ramp(0.07f, 0.0f, edge));
    color = glm::mix(color, glm::vec3(0.40f, 0.18f, 0.50f), 0.6f * veins.main);
    color *= 1 + 0.14f * fractal(p * 22.0f, 1001, 3);
    color =
        glm::mix(color, glm::vec3(0.72f, 0.58f, 0.16f) * (1 + 0.4f * noise(p * 60.0f, 1007)), ramp(0.095f, 0.06f, out));
    return back ? glm::mix(color, glm::vec3(0.46f, 0.38f, 0.50f), 0.5f) : color;
}

// Grass: dark at the foot.
glm::vec3 tuftColor(glm::vec2 p) {
    const glm::vec3 color =
        glm::mix(glm::vec3(0.022f, 0.042f, 0.012f), glm::vec3(0.115f, 0.175f, 0.040f), saturate(1.2f * p.y));
    return color * (1 + 0.35f * noise(glm::vec2(p.x * 38.0f, p.y * 5.0f), 1011));
}

glm::vec3 bladeColor(int variant, glm::vec2 p, float edge, const Veins& veins, bool back) {
    static const glm::vec3 kDark[] = {{0.022f, 0.058f, 0.014f},
                                      {0.034f, 0.080f, 0.017f},
                                      {0.017f, 0.046f, 0.016f},
                                      {0.030f, 0.074f, 0.020f},
                                      {0.026f, 0.062f, 0.020f}};
    static const glm::vec3 kLight[] = {{0.060f, 0.120f, 0.026f},
                                       {0.098f, 0.165f, 0.030f},
                                       {0.045f, 0.092f, 0.028f},
                                       {0.082f, 0.150f, 0.038f},
                                       {0.070f, 0.130f, 0.036f}};
    uint32_t salt = 840u + static_cast<uint32_t>(variant) * 16u;
    float cloud = saturate(0.5f + 0.75f * fractal(p * 4.2f, salt, 3));
    glm::vec3 color = glm::mix(kDark[variant], kLight[variant], cloud);
    // Between the veins the blade darkens; towards the rim it is yellower.
    color *= 1 - 0.20f * ramp(0.02f, 0.09f, veins.nearMain);
    color = glm::mix(color, glm::vec3(0.16f, 0.17f, 0.032f),
                     0.34f * ramp(0.05f, 0.0f, edge) * saturate(0.6f + fractal(p * 6.0f, salt + 5, 2)));
    color =
        glm::mix(color, glm::vec3(0.13f, 0.105f, 0.03f), 0.55f * ramp(0.42f, 0.75f, fractal(p * 8.0f, salt + 8, 3)));
    color *= 1 + 0.16f * fractal(p * 60.0f, salt + 11, 2);
    color = glm::mix(color, glm::vec3(0.135f, 0.185f, 0.075f), 0.42f * veins.side);
    color = glm::mix(color, glm::vec3(0.205f, 0.255f, 0.110f), 0.72f * veins.main);
    if (back) color = glm::mix(color, glm::vec3(0.135f, 0.185f, 0.080f), 0.62f) * 1.12f;
    return color;
}

glm::vec3 stalkColor(glm::vec2 p) {
    return glm::mix(glm::vec3(0.115f, 0.062f, 0.036f), glm::vec3(0.15f, 0.155f, 0.055f), saturate(p.y * 3.4f)) *
           (1 + 0.2f * noise(p * 40.0f, 871));
}

float bladeHeight(int variant, glm::vec2 p, const Veins& veins) {
    uint32_t salt = 880u + static_cast<uint32_t>(variant) * 16u;
    float pillow = 0.012f * ramp(0.0f, 0.09f, veins.nearMain);
    return pillow - 0.004f * veins.main - 0.0018f * veins.side + 0.0035f * fractal(p * 9.0f, salt, 2);
}

}  // namespace

namespace {

glm::vec3 colorAt(int form, const LeafShape& shape, glm::vec2 p, float edge, const Veins& veins, bool back) {
    if (form == kTuft) return tuftColor(p);
    const bool stalk = p.y < shape.base && std::abs(p.x) < 0.035f && edge > -0.03f &&
                       leafDistance(shape, {p.x + 0.06f, p.y}) < 0 && leafDistance(shape, {p.x - 0.06f, p.y}) < 0;
    if (stalk) return stalkColor(p);
    return form == kBlossom ? petalColor(shape, p, edge, veins, back) : bladeColor(form, p, edge, veins, back);
}

// `count` forms from `first` on, side by side.
LeafAtlas paintForms(int size, int first, int count) {
    LeafAtlas atlas{Picture(size, size), Picture(size, size)};
    std::vector<uint8_t> filled(static_cast<size_t>(size) * static_cast<size_t>(size), 0);
    float texel = 1.0f / static_cast<float>(size);
    int half = size / 2;
    for (int column = 0; column < count; ++column) {
        const int variant = first + column;
        LeafShape shape = leafShape(variant);
        int x0 = size * column / count, x1 = size * (column + 1) / count;
        float unit = glm::distance(leafPoint(variant, {0, texel}), leafPoint(variant, {0, 0}));
        for (int y = 0; y < half; ++y)
            for (int x = x0; x < x1; ++x) {
                glm::vec2 p = leafPoint(variant, (glm::vec2(x, y) + 0.5f) * texel);
                float edge = leafDistance(shape, p);
                // The ramp is 16 texels wide: wide enough to survive three mip levels.
                float alpha = saturate(0.5f + edge / unit / 16);
                Veins veins = veinsAt(shape, p);
                float step = unit;
                float h = bladeHeight(variant, p, veins);
                float hx = bladeHeight(variant, p + glm::vec2(step, 0), veinsAt(shape, p + glm::vec2(step, 0))) - h;
                float hy = bladeHeight(variant, p + glm::vec2(0, step), veinsAt(shape, p + glm::vec2(0, step))) - h;
                glm::vec3 n = glm::normalize(glm::vec3(-hx / step, -hy / step, 1.0f));
                for (int side = 0; side < 2; ++side) {
                    const glm::vec3 color = colorAt(variant, shape, p, edge, veins, side == 1);
                    uint8_t* c = atlas.color.at(x, y + side * half);
                    uint8_t* m = atlas.normal.at(x, y + side * half);
                    for (int k = 0; k < 3; ++k) {
                        c[k] = toByte(srgbOfLinear(color[k]));
                        m[k] = toByte(n[k] * 0.5f + 0.5f);
                    }
                    c[3] = toByte(alpha);
                    m[3] = 255;
                    if (edge > 0)
                        filled[static_cast<size_t>(y + side * half) * static_cast<size_t>(size) +
                               static_cast<size_t>(x)] = 1;
                }
            }
    }
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) atlas.normal.at(x, y)[3] = 255;
    dilate(atlas.color, filled, size / 32);
    return atlas;
}

}  // namespace

LeafAtlas paintLeaves(int size) {
    return paintForms(size, 0, kLeafVariants);
}

LeafAtlas paintFlora(int size) {
    return paintForms(size, kFirstOval, kFloraForms);
}

}  // namespace espalier::content
