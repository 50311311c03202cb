// Enters: meshes of cells. Leaves: their cross-sections as seen from outside.
#include "runtime/render/roof_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "shaders/shared/exact.h"

namespace espalier {
namespace {

constexpr int kAcross = int(kProfileSteps), kUp = 20;  // samples of a cell
constexpr float kSteepest = 0.12f;                     // the least that a normal leans towards the eye

struct Sample {
    float height = -1e9f, slope = 0, shade = 1;
};
using Cell = std::array<Sample, size_t(kAcross) * kUp>;

glm::vec2 placeOf(int x, int y) {
    return {(float(x) + 0.5f) / float(kAcross), (float(y) + 0.5f) / float(kUp)};
}

float cross2(glm::vec2 a, glm::vec2 b) {
    return a.x * b.y - a.y * b.x;
}

struct Corner {
    glm::vec3 position, normal;
    float shade;
};
using Triangle = std::array<Corner, 3>;

// Of a triangle in a neighbouring cell what lies in this one and above what was there.
void cover(Cell& cell, const Triangle& t, glm::vec2 shift) {
    const auto& [a, b, c] = t;
    const glm::vec2 o = glm::vec2(a.position) + shift, p = glm::vec2(b.position - a.position),
                    q = glm::vec2(c.position - a.position);
    const glm::vec2 low = o + glm::min(glm::min(p, q), glm::vec2(0)), high = o + glm::max(glm::max(p, q), glm::vec2(0));
    const float area = cross2(p, q);
    const bool beside = high.x < 0 || high.y < 0 || low.x > 1 || low.y > 1;
    if (beside || !(area > 1e-9f)) return;  // or seen from inside, or edge-on
    for (int y = 0; y < kUp; ++y) {
        for (int x = 0; x < kAcross; ++x) {
            const glm::vec2 d = placeOf(x, y) - o;
            const float u = cross2(d, q) / area, v = cross2(p, d) / area, w = 1 - u - v;
            if (std::min({u, v, w}) < 0) continue;
            const float height = w * a.position.z + u * b.position.z + v * c.position.z;
            Sample& out = cell[size_t(y * kAcross + x)];
            if (height <= out.height) continue;
            const glm::vec3 n = w * a.normal + u * b.normal + v * c.normal;
            const float least = std::max(kSteepest * glm::length(n), 1e-6f);
            out = {height, -n.x / std::max(n.z, least), w * a.shade + u * b.shade + v * c.shade};
        }
    }
}

// A course lies on the one below, and the right neighbour may lie on this cell.
Cell openOf(const TerminalData& meshes, const TerminalLod& lod) {
    Cell cell;
    for (uint32_t i = 0; i + 2 < lod.indexCount; i += 3) {
        Triangle triangle;
        for (uint32_t k = 0; k < 3; ++k) {
            const TerminalVertex& v = meshes.vertices[lod.firstVertex + meshes.indices[lod.firstIndex + i + k]];
            triangle[k] = {v.position, unpackOct(v.normal), v.uv.x};
        }
        for (float x : {-1.f, 0.f, 1.f})
            for (float y : {-1.f, 0.f, 1.f}) cover(cell, triangle, {x, y});
    }
    return cell;
}

}  // namespace

std::vector<RoofProfile> roofProfiles(const TerminalData& meshes) {
    std::vector<RoofProfile> out(meshes.kinds.size() * kProfileSteps, RoofProfile{0, 1, 0, 1});
    for (const TerminalVariant& v : meshes.variants) {
        const Cell cell = openOf(meshes, v.lods.front());
        RoofProfile mean{0, 0, 0, 0};
        const std::span<RoofProfile> steps(&out[v.kind * kProfileSteps], kProfileSteps);
        for (int x = 0; x < kAcross; ++x) {
            RoofProfile& step = steps[size_t(x)] = mean;
            for (int y = 0; y < kUp; ++y) {
                const Sample& s = cell[size_t(y * kAcross + x)];
                step.slope += s.slope / kUp;
                step.shade += s.shade / kUp;
                step.steepness += std::abs(s.slope) / kUp;
            }
        }
        for (const RoofProfile& s : steps) {
            mean.steepness += s.steepness / kAcross;
            mean.meanShade += s.shade / kAcross;
        }
        for (RoofProfile& s : steps) {
            s.steepness = mean.steepness;
            s.meanShade = mean.meanShade;
        }
    }
    return out;
}

}  // namespace espalier
