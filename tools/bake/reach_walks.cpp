// In: the finished surface, and where walks begin. Out: how many of them end where the model goes on. Each goes
// straight on for two radii, as bark does that nothing stops.
#include "tools/bake/reach_walks.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "runtime/core/disjoint_sets.hpp"
#include "runtime/core/jobs.hpp"
#include "runtime/surface/box_tree.hpp"
#include "runtime/surface/triangle_distance.hpp"
#include "shaders/shared/random.h"
#include "shaders/shared/walk.h"
#include "tools/bake/sort_buckets.hpp"

namespace espalier::bakery {
namespace {

constexpr double kForgiven = 3;     // texels from a border of the model
constexpr double kTouching = 1e-4;  // of the radius: what is as near goes on
constexpr int kSteps = 100;
constexpr double kStep = 0.02;  // of the radius
constexpr double kBeside[] = {0.0, -0.15, 0.15, -0.4,
                              0.4, -0.8,  0.8};  // of what is forgiven: where a border is looked at

// The model's own borders.
class Borders {
  public:
    Borders(const BakeMesh& mesh, double within) : mesh_(mesh), within_(within), piece_(mesh.triangles.size()) {
        struct Half {
            uint64_t key;
            uint32_t half;
        };
        std::vector<Half> halves(mesh.twin.size());
        for (uint32_t h = 0; h < halves.size(); ++h) {
            const auto [a, b] =
                std::minmax(mesh.triangles[h / 3].point[h % 3], mesh.triangles[h / 3].point[(h + 1) % 3]);
            halves[h] = {uint64_t(a) << 32 | b, h};
        }
        sortBuckets(
            halves, mesh.points.size(), [](const Half& h) { return h.key >> 32; },
            [](const Half& x, const Half& y) { return std::tie(x.key, x.half) < std::tie(y.key, y.half); });
        DisjointSets pieces(mesh.triangles.size());
        std::vector<Box> boxes;
        for (size_t i = 0, j = 0; i < halves.size(); i = j) {
            for (; j < halves.size() && halves[j].key == halves[i].key; ++j)
                pieces.join(halves[j].half / 3, halves[i].half / 3);
            if (j - i > 1) continue;
            borders_.push_back(halves[i].half);
            boxes.emplace_back();
            for (glm::dvec3 p : {mesh.pointAt(halves[i].half), mesh.pointAt(BakeMesh::next(halves[i].half))})
                boxes.back().add(p);
        }
        borderTree_ = BoxTree(std::move(boxes), {});
        pieces.number(piece_);
        std::vector<Box> triangles(mesh.triangles.size());
        for (size_t t = 0; t < triangles.size(); ++t)
            for (uint32_t p : mesh.triangles[t].point) triangles[t].add(mesh.points[p]);
        triangleTree_ = BoxTree(std::move(triangles), {});
    }

    // Is one of them near, or bare ground, which is one? Where another piece touches, the model goes on; beside that it
    // may not.
    bool near(glm::dvec3 p) const {
        Box around;
        around.add(p);
        const Box within = around.grown(within_);
        bool found = false;
        borderTree_.near(within, [&](uint32_t i) { found = found || endsNear(borders_[i], p); });
        triangleTree_.near(
            within, [&](uint32_t t) { found = found || (mesh_.triangles[t].bare && distance(p, t) <= within_); });
        return found;
    }

  private:
    bool endsNear(uint32_t half, glm::dvec3 p) const {
        const glm::dvec3 a = mesh_.pointAt(half), d = mesh_.pointAt(BakeMesh::next(half)) - a;
        const double length = glm::length(d), foot = glm::dot(p - a, d) / length;
        for (double beside : kBeside) {
            const glm::dvec3 at = a + d * (std::clamp(foot + beside * within_, 0.0, length) / length);
            if (glm::length(p - at) <= within_ && !goesOn(at, piece_[half / 3])) return true;
        }
        return false;
    }

    bool goesOn(glm::dvec3 at, uint32_t piece) const {
        const double touching = kTouching * mesh_.radius;
        Box around;
        around.add(at);
        bool found = false;
        triangleTree_.near(around.grown(touching), [&](uint32_t t) {
            found = found || (piece_[t] != piece && !mesh_.triangles[t].bare && distance(at, t) <= touching);
        });
        return found;
    }

    double distance(glm::dvec3 p, uint32_t t) const {
        const auto& point = mesh_.triangles[t].point;
        return distanceToTriangle(p, {mesh_.points[point[0]], mesh_.points[point[1]], mesh_.points[point[2]]});
    }

    const BakeMesh& mesh_;
    double within_;
    std::vector<uint32_t> piece_;    // of each triangle: what edges join
    std::vector<uint32_t> borders_;  // half-edges
    BoxTree borderTree_, triangleTree_;
};

// Any direction, the same for the same number on every machine.
glm::vec3 directionOf(uint32_t number) {
    glm::vec3 d;
    for (int k = 0; k < 3; ++k)
        d[k] = float(int(mix64(uint64_t(number) * 3 + uint64_t(k)) >> 40) - (1 << 23)) / float(1 << 23);
    return d;
}

}  // namespace

std::vector<WalkEnds> walkAbout(const BakeMesh& mesh, const SurfaceData& surface, std::span<const WalkStart> starts,
                                uint32_t pieces) {
    double area = 0, uv = 0;
    for (const Chart& c : surface.charts) area += c.area, uv += c.area / (double(c.metresPerUv) * c.metresPerUv);
    const Borders borders(mesh, kForgiven * std::sqrt(area / uv) / surface.levels[0].size);
    const SurfaceRef ref = surfaceRef(surface);
    const float stride = float(kStep * mesh.radius);
    std::vector<uint8_t> walked(starts.size(), 0), ended(starts.size(), 0);
    parallelFor(starts.size(), 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const SurfaceBuf surfaces{const_cast<SurfaceRef*>(&ref)};
            WalkState w{};
            walked[i] = startWalk(surfaces, 0, starts[i].chart, starts[i].uv, directionOf(uint32_t(i)), w);
            uint event = kWalkDone;
            for (int s = 0; walked[i] && s < kSteps && event == kWalkDone; ++s)
                event = walkStep(surfaces, 0, w, stride);
            ended[i] = event == kWalkOpen && !borders.near(glm::dvec3(w.position));
        }
    });
    std::vector<WalkEnds> ends(pieces);
    for (size_t i = 0; i < starts.size(); ++i)
        ends[starts[i].piece].walks += walked[i], ends[starts[i].piece].ended += ended[i];
    return ends;
}

}  // namespace espalier::bakery
