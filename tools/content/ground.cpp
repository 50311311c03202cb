// The ground of the ruin: earth with worn paving that rises to the feet of walls and columns. In: footprints.
// Out: one chart with a hole for each, and the settling of everything that stands on it.

#include <algorithm>
#include <cmath>

#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"
#include "tools/content/ruin.hpp"

namespace espalier::content {
namespace {

constexpr glm::vec2 kMiddle{0.35f, 1.7f}, kReach{5.35f, 4.1f};  // of the ground's outline, (x, z)

float boxDistance(glm::vec2 p, glm::vec2 low, glm::vec2 high) {
    glm::vec2 d = glm::max(low - p, p - high);
    return glm::length(glm::max(d, glm::vec2(0))) + std::min(std::max(d.x, d.y), 0.0f);
}

// The outline is a rounded rectangle that frays; angle in radians.
glm::vec2 outlineAt(float angle) {
    glm::vec2 d(std::cos(angle), std::sin(angle));
    float k = std::pow(std::pow(std::abs(d.x), 5.0f) + std::pow(std::abs(d.y), 5.0f), -0.2f);
    float fray = 1 + 0.035f * fractal(d * 3.0f, 701, 3);
    return kMiddle + d * kReach * k * fray;
}

// 0 in the middle, 1 on the outline, roughly.
float outward(glm::vec2 xz) {
    glm::vec2 d = glm::abs(xz - kMiddle) / kReach;
    return std::pow(std::pow(d.x, 5.0f) + std::pow(d.y, 5.0f), 0.2f);
}

}  // namespace

float footDistance(glm::vec2 p) {
    float d =
        std::min({boxDistance(p, {-3.5f, -0.35f}, {-0.23f, 0.35f}), boxDistance(p, {1.33f, -0.35f}, {3.4f, 0.35f}),
                  boxDistance(p, {-3.5f, 0.35f}, {-2.8f, 2.7f}), boxDistance(p, {3.9f, 1.0f}, {4.6f, 4.2f})});
    for (glm::vec2 c :
         {glm::vec2(2.3f, 1.95f), glm::vec2(-1.2f, 1.95f), glm::vec2(3.2f, 3.3f), glm::vec2(-0.75f, 3.55f)})
        d = std::min(d, boxDistance(p, c - 0.44f, c + 0.44f));
    for (glm::vec3 c : {glm::vec3(3.45f, 1.0f, 0.22f), glm::vec3(-2.2f, 2.75f, 0.25f), glm::vec3(0.15f, 2.95f, 0.18f)})
        d = std::min(d, glm::distance(p, glm::vec2(c)) - c.z);
    return std::max(d, 0.0f);
}

float pavedShare(glm::vec2 xz) {
    float way = std::max(1 - std::abs(xz.x - 0.55f) / 1.5f, 0.9f - glm::distance(xz, glm::vec2(0.6f, 2.3f)) / 3.2f);
    way -= 0.9f * ramp(0.72f, 0.95f, outward(xz));  // grass has taken the rim
    return ramp(0.02f, 0.22f, way + 0.55f * fractal(xz * 0.9f, 711, 3) - 0.12f);
}

namespace {

// Earth and rubble that fell from the walls: (x, z), radius, height.
constexpr glm::vec4 kHeaps[] = {{3.75f, 0.15f, 0.55f, 0.20f}, {-3.1f, 3.05f, 0.5f, 0.16f}, {2.6f, -0.8f, 0.6f, 0.13f}};

// Shares of the ground, paving apart. rim: where it goes over into the meadow; patches: where grass has taken hold;
// grass: those, and where it has closed over the heaps because nobody treads there.
struct Turf {
    float rim, patches, grass;
};

Turf turfAt(glm::vec2 xz) {
    Turf turf{};
    turf.rim = ramp(0.62f, 0.93f, outward(xz) + 0.12f * fractal(xz * 1.3f, 763, 3));
    turf.patches =
        ramp(0.05f, 0.5f,
             fractal(xz * 1.9f, 761, 4) + 0.35f * ramp(0.7f, 0.0f, footDistance(xz)) - 0.08f + 0.55f * turf.rim);
    const float trodden = ramp(0.66f, 0.36f, outward(xz) + 0.14f * fractal(xz * 1.1f, 767, 3));
    turf.grass = std::max(turf.patches, 0.95f * (1 - trodden) * ramp(-0.45f, 0.05f, fractal(xz * 2.3f, 769, 3)));
    for (glm::vec4 heap : kHeaps)
        turf.grass = std::max(turf.grass, ramp(1.9f, 0.9f, glm::distance(xz, glm::vec2(heap)) / heap.z));
    return turf;
}

Detail groundDetail(glm::vec2 st) {
    glm::vec2 xz(st.x, -st.y);
    glm::vec2 bent = xz + 0.05f * glm::vec2(fractal(xz * 2.2f, 721, 2), fractal(xz * 2.2f, 723, 2));
    Cells flag = cells(bent / 0.62f, 725);
    float joint = (flag.second - flag.nearest) * 0.31f;
    float stone = pavedShare(xz + 0.25f * (glm::vec2(random01(flag.id, 5), random01(flag.id, 6)) - 0.5f));
    stone *= random01(flag.id, 7) < 0.86f ? 1.0f : 0.0f;
    stone *= ramp(0.012f, 0.045f, joint) * ramp(0.02f, 0.12f, footDistance(xz));
    float clods = fractal(xz * 4.5f, 731, 4), grit = fractal(xz * 26.0f, 735, 3);
    Cells pebble = cells(xz * 15.0f + 0.35f * glm::vec2(grit, clods), 741);
    float size = 0.10f + 0.22f * random01(pebble.id, 3) * random01(pebble.id, 4);
    float isPebble = random01(pebble.id, 1) < 0.15f + 0.5f * saturate(fractal(xz * 1.6f, 745, 3))
                         ? ramp(size + 0.06f, size - 0.04f, pebble.nearest)
                         : 0.0f;
    float earthHeight = 0.020f * clods + 0.004f * grit + 0.010f * isPebble;
    float stoneHeight =
        0.020f + (random01(flag.id, 1) - 0.5f) * 0.022f + 0.006f * fractal(xz * 5.0f, 743, 3) + 0.002f * grit;
    Detail out;
    out.height = glm::mix(earthHeight, stoneHeight, stone);

    float cloud = fractal(xz * 1.3f, 751, 3);
    glm::vec3 earth =
        glm::mix(glm::vec3(0.072f, 0.058f, 0.037f), glm::vec3(0.144f, 0.118f, 0.079f), saturate(0.5f + 0.6f * cloud));
    earth *= 1 + 0.35f * grit + 0.25f * clods;
    earth =
        glm::mix(earth, glm::vec3(0.165f, 0.148f, 0.122f) * (0.6f + 0.8f * random01(pebble.id, 2)), 0.8f * isPebble);
    const Turf turf = turfAt(xz);
    const float rim = turf.rim, grass = turf.grass;
    float blades = 0.5f + 0.5f * fractal(glm::vec2(xz.x * 60.0f, xz.y * 34.0f), 765, 2);
    out.height += 0.010f * turf.patches * blades * (1 - stone);
    earth = glm::mix(earth,
                     glm::mix(glm::mix(glm::vec3(0.034f, 0.044f, 0.014f), glm::vec3(0.092f, 0.106f, 0.036f), blades),
                              glm::vec3(0.088f, 0.102f, 0.038f) * (0.50f + 0.7f * blades), 0.5f + 0.4f * rim),
                     0.85f * grass);
    glm::vec3 slab =
        glm::mix(glm::vec3(0.175f, 0.165f, 0.145f), glm::vec3(0.245f, 0.215f, 0.168f), random01(flag.id, 2));
    slab *= 0.85f + 0.3f * random01(flag.id, 3);
    slab *= 1 + 0.22f * grit + 0.3f * fractal(xz * 3.3f, 771, 3);
    float moss = ramp(0.25f, 0.6f, fractal(xz * 2.6f, 775, 4) + 0.25f * ramp(0.09f, 0.02f, joint));
    slab = glm::mix(slab, glm::vec3(0.058f, 0.066f, 0.025f), 0.75f * moss);
    out.albedo = glm::mix(earth, slab, stone);
    out.albedo *= 1 - 0.35f * ramp(0.28f, 0.0f, footDistance(xz));  // shade and damp at the foot
    out.albedo = glm::clamp(out.albedo, 0.004f, 0.8f);
    return out;
}

}  // namespace

float grassShare(glm::vec2 xz) {
    return turfAt(xz).grass * (1 - pavedShare(xz));
}

float groundHeight(glm::vec2 xz) {
    float foot = footDistance(xz);
    float height = 0.05f * fractal(xz * 0.55f, 781, 2) + 0.022f * fractal(xz * 1.7f, 783, 2);
    height += 0.10f * std::exp(-foot / 0.22f) * (0.55f + 0.5f * fractal(xz * 1.4f, 785, 2));
    for (glm::vec4 heap : kHeaps) {
        float r = glm::distance(xz, glm::vec2(heap)) / heap.z;
        height += heap.w * std::exp(-r * r) * (1 + 0.5f * fractal(xz * 5.0f, 787, 2));
    }
    // The rim goes under the meadow around it, gently.
    float rim = std::max(outward(xz) - 0.70f, 0.0f);
    return height * ramp(1.05f, 0.75f, outward(xz)) - 1.9f * rim * rim;
}

glm::vec3 settle(glm::vec3 block) {
    float above = saturate(block.y / 0.9f);
    glm::vec3 p = block;
    p.y += groundHeight({block.x, block.z}) * (1 - above) * (1 - above);
    glm::vec3 q = block * 0.55f;
    float sway = saturate(block.y / 0.8f);
    p.x += sway * (0.030f * noise(q, 791) + 0.006f * block.y);
    p.z += sway * (0.045f * noise(q, 793) - 0.010f * block.y);
    p.y += sway * 0.030f * noise(q, 795);
    // Courses have sunk and shifted: a hand's breadth over a stone's length.
    p += sway * 0.018f * glm::vec3(noise(block * 1.7f, 797), noise(block * 1.7f, 798), noise(block * 1.7f, 799));
    return p;
}

void addGround(std::vector<Chart>& charts, const std::vector<Loop>& footprints) {
    Chart chart;
    chart.name = "ground";
    std::vector<std::vector<glm::vec2>> loops(1);
    constexpr int kPieces = 330;
    for (int i = 0; i < kPieces; ++i) {
        glm::vec2 xz = outlineAt(2 * kPi * static_cast<float>(i) / kPieces);
        loops[0].push_back({xz.x, -xz.y});
    }
    for (auto& footprint : footprints) {
        loops.emplace_back();
        for (glm::vec2 xz : footprint) loops.back().push_back({xz.x, -xz.y});
    }
    Candidates fine{{}, 0.088f, 0.055f}, coarse{{}, 0.16f, 0.09f};
    for (float z = -2.8f; z < 6.2f; z += 0.02f)
        for (float x = -5.4f; x < 6.1f; x += 0.02f) {
            uint32_t h = hash32(static_cast<uint32_t>(static_cast<int>(x * 1000)),
                                static_cast<uint32_t>(static_cast<int>(z * 1000)));
            glm::vec2 xz = glm::vec2(x, z) + 0.018f * glm::vec2(random01(h, 1), random01(h, 2));
            bool detailed = pavedShare(xz) > 0.3f || footDistance(xz) < 0.12f;
            (detailed ? fine : coarse).points.push_back({xz.x, -xz.y});
        }
    triangulate(chart, loops, {fine, coarse});
    for (glm::vec2 st : chart.st) {
        chart.block.push_back({st.x, 0, -st.y});
        chart.normal.push_back({0, 1, 0});
    }
    chart.detail = groundDetail;
    // The painted path begins in front of the wall.
    chart.mask = [](glm::vec2 st) {
        glm::vec2 xz(st.x, -st.y);
        float d =
            std::min(boxDistance(xz, {-1.5f, 0.3f}, {-1.15f, 0.9f}), boxDistance(xz, {1.85f, 0.3f}, {2.1f, 0.8f}));
        d = std::min(d, glm::distance(xz, glm::vec2(2.3f, 1.95f)) - 0.62f);
        return ramp(0.12f, 0.06f, d);
    };
    charts.push_back(std::move(chart));
}

}  // namespace espalier::content
