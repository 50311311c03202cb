// Enters: meshes of cells. Leaves: their cross-sections as seen from outside.
#include "runtime/render/roof_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "shaders/shared/exact.h"

namespace espalier {
namespace {

constexpr int kAcross = int(kProfileSteps), kUp = 8;  // samples of a cell
constexpr float kSteepest = 0.12f;                    // the least that a normal leans towards the eye

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

// Of a triangle in a neighbouring cell what lies in this one and above what was there.
void cover(Cell& cell, const TerminalVertex& a, const TerminalVertex& b, const TerminalVertex& c, glm::vec2 shift) {
    const glm::vec2 o = glm::vec2(a.position) + shift, p = glm::vec2(b.position - a.position),
                    q = glm::vec2(c.position - a.position);
    const float area = cross2(p, q);
    if (area <= 1e-9f) return;  // seen from inside, or edge-on
    const std::array<glm::vec3, 3> normals{unpackOct(a.normal), unpackOct(b.normal), unpackOct(c.normal)};
    for (int y = 0; y < kUp; ++y) {
        for (int x = 0; x < kAcross; ++x) {
            const glm::vec2 d = placeOf(x, y) - o;
            const float s = cross2(d, q) / area, t = cross2(p, d) / area, r = 1 - s - t;
            if (std::min({r, s, t}) < 0) continue;
            const float height = r * a.position.z + s * b.position.z + t * c.position.z;
            Sample& out = cell[size_t(y * kAcross + x)];
            if (height <= out.height) continue;
            const glm::vec3 n = r * normals[0] + s * normals[1] + t * normals[2];
            out = {height, -n.x / std::max(n.z, kSteepest * glm::length(n)), r * a.uv.x + s * b.uv.x + t * c.uv.x};
        }
    }
}

// A course lies on the one below, and the right neighbour may lie on this cell.
Cell openOf(const TerminalData& meshes, const TerminalLod& lod) {
    Cell cell;
    for (uint32_t i = 0; i + 2 < lod.indexCount; i += 3) {
        auto vertex = [&](uint32_t k) -> const TerminalVertex& {
            return meshes.vertices[lod.firstVertex + meshes.indices[lod.firstIndex + i + k]];
        };
        for (float x : {-1.f, 0.f, 1.f})
            for (float y : {-1.f, 0.f, 1.f}) cover(cell, vertex(0), vertex(1), vertex(2), {x, y});
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
