// In: triangles of a region. Out: the patch that they make when glued along shared edges, its borders and Euler
// characteristic, and two halves of it where one chart isn't enough.
#include <algorithm>
#include <cmath>
#include <queue>

#include "tools/bake/atlas.hpp"

namespace espalier::bakery {
namespace {

constexpr double kMostCutOut = 0.15;  // of a patch's triangles, to be rid of what is tangled
constexpr double kTurnCost = 4;       // how much longer a way over a right angle is than one over flat ground

uint32_t nextOf(uint32_t h) {
    return BakeMesh::next(h);
}

// Ways over the patch from triangle to triangle, longer where it bends.
class Ways {
  public:
    Ways(const BakeMesh& mesh, const Facets& facets, const Patch& patch) : facets_(facets), patch_(patch) {
        centre_.reserve(patch.triangles.size());
        for (uint32_t t : patch.triangles) {
            const auto& p = mesh.triangles[t].point;
            centre_.push_back((mesh.points[p[0]] + mesh.points[p[1]] + mesh.points[p[2]]) / 3.0);
        }
    }

    // Distances from the nearest seed, and which seed that is.
    void spread(std::span<const uint32_t> seeds, std::vector<double>& distance, std::vector<uint8_t>& nearest) const {
        size_t count = patch_.triangles.size();
        distance.assign(count, 1e300);
        nearest.assign(count, 0);
        using Entry = std::pair<double, uint32_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        for (uint8_t i = 0; i < seeds.size(); ++i) {
            distance[seeds[i]] = 0;
            nearest[seeds[i]] = i;
            queue.push({0, seeds[i]});
        }
        while (!queue.empty()) {
            auto [d, t] = queue.top();
            queue.pop();
            if (d > distance[t]) continue;
            for (uint32_t h = t * 3; h < t * 3 + 3; ++h) {
                if (patch_.twin[h] == kNone) continue;
                uint32_t other = patch_.twin[h] / 3;
                double bend =
                    1 - glm::dot(facets_.normal[patch_.triangles[t]], facets_.normal[patch_.triangles[other]]);
                double far = d + glm::length(centre_[other] - centre_[t]) * (1 + kTurnCost * bend);
                if (far >= distance[other]) continue;
                distance[other] = far;
                nearest[other] = nearest[t];
                queue.push({far, other});
            }
        }
    }

    uint32_t farthestFrom(uint32_t seed) const {
        std::vector<double> distance;
        std::vector<uint8_t> nearest;
        spread({&seed, 1}, distance, nearest);
        return uint32_t(std::max_element(distance.begin(), distance.end()) - distance.begin());
    }

  private:
    const Facets& facets_;
    const Patch& patch_;
    std::vector<glm::dvec3> centre_;
};

// 1 for triangles at what is tangled or crossed; empty where that is too much, or everything.
std::vector<uint8_t> cutOut(const Patch& patch, const PatchVerdict& verdict) {
    if (verdict.overlapping) return {};
    std::vector<uint8_t> bad(patch.point.size(), 0), side(patch.triangles.size(), 0);
    for (const auto* list : {&verdict.tangled, &verdict.crossed})
        for (uint32_t v : *list) bad[v] = 1;
    size_t out = 0;
    for (size_t t = 0; t < side.size(); ++t) {
        const auto& c = patch.corner[t];
        out += side[t] = bad[c[0]] || bad[c[1]] || bad[c[2]];
    }
    if (out == 0 || double(out) > kMostCutOut * double(side.size())) side.clear();
    return side;
}

// Numbers the corners that twins bring together; add(corner) is called for the first of each.
template <class Add>
void glue(Patch& patch, Add&& add) {
    const uint32_t count = uint32_t(patch.twin.size());
    DisjointSets corners(count);
    for (uint32_t h = 0; h < count; ++h)
        if (uint32_t other = patch.twin[h]; other != kNone) {
            corners.join(h, nextOf(other));
            corners.join(nextOf(h), other);
        }
    patch.corner.resize(patch.triangles.size());
    std::vector<uint32_t> vertex(count, kNone);
    uint32_t vertices = 0;
    for (uint32_t h = 0; h < count; ++h) {
        uint32_t& v = vertex[corners.find(h)];
        if (v == kNone) v = vertices++, add(h);
        patch.corner[h / 3][h % 3] = v;
    }
}

// Those triangles of a patch. local: where each triangle of the patch comes to lie in its part.
Patch partOf(const Patch& patch, const std::vector<uint32_t>& triangles, const std::vector<uint32_t>& local,
             const std::vector<uint32_t>& partOfTriangle) {
    Patch part;
    part.twin.assign(triangles.size() * 3, kNone);
    for (uint32_t i = 0; i < triangles.size(); ++i) {
        part.triangles.push_back(patch.triangles[triangles[i]]);
        for (uint32_t k = 0; k < 3; ++k) {
            uint32_t twin = patch.twin[triangles[i] * 3 + k];
            if (twin != kNone && partOfTriangle[twin / 3] == partOfTriangle[triangles[i]])
                part.twin[i * 3 + k] = local[twin / 3] * 3 + twin % 3;
        }
    }
    glue(part, [&](uint32_t h) {
        uint32_t v = patch.corner[triangles[h / 3]][h % 3];
        part.point.push_back(patch.point[v]);
        if (!patch.uv.empty()) part.uv.push_back(patch.uv[v]);
    });
    return part;
}

// 0 or 1 for each triangle: what is nearer to one or the other end of the patch.
std::vector<uint8_t> halve(const BakeMesh& mesh, const Facets& facets, const Patch& patch) {
    Ways ways(mesh, facets, patch);
    uint32_t a = ways.farthestFrom(0), b = ways.farthestFrom(a);
    if (a == b) b = a == 0 ? 1 : 0;
    std::vector<double> distance;
    std::vector<uint8_t> nearest;
    uint32_t seeds[2] = {a, b};
    ways.spread(seeds, distance, nearest);
    return nearest;
}

}  // namespace

Patch makePatch(const BakeMesh& mesh, std::span<const uint32_t> triangles, const std::vector<uint32_t>& region,
                const std::vector<uint8_t>& cut, std::vector<uint32_t>& local) {
    Patch patch;
    patch.triangles.assign(triangles.begin(), triangles.end());
    size_t count = triangles.size();
    for (uint32_t i = 0; i < count; ++i) local[triangles[i]] = i;
    patch.twin.assign(count * 3, kNone);
    for (uint32_t h = 0; h < count * 3; ++h) {
        uint32_t own = triangles[h / 3] * 3 + h % 3, twin = mesh.twin[own];
        if (twin == kNone || cut[own] || twin / 3 == own / 3 || region[twin / 3] != region[own / 3]) continue;
        patch.twin[h] = local[twin / 3] * 3 + twin % 3;
    }
    glue(patch, [&](uint32_t h) { patch.point.push_back(mesh.pointAt(triangles[h / 3] * 3 + h % 3)); });
    return patch;
}

std::vector<std::vector<uint32_t>> borderLoops(const Patch& patch) {
    std::vector<std::vector<uint32_t>> loops;
    std::vector<uint8_t> seen(patch.twin.size(), 0);
    for (uint32_t start = 0; start < patch.twin.size(); ++start) {
        if (patch.twin[start] != kNone || seen[start]) continue;
        loops.emplace_back();
        uint32_t h = start;
        do {
            seen[h] = 1;
            loops.back().push_back(h);
            // Around the end vertex to the border that leaves it.
            h = nextOf(h);
            while (patch.twin[h] != kNone) h = nextOf(patch.twin[h]);
        } while (h != start);
    }
    auto length = [&](const std::vector<uint32_t>& loop) {
        double sum = 0;
        for (uint32_t h : loop)
            sum += glm::length(patch.point[patch.corner[nextOf(h) / 3][nextOf(h) % 3]] -
                               patch.point[patch.corner[h / 3][h % 3]]);
        return sum;
    };
    std::stable_sort(loops.begin(), loops.end(), [&](const auto& a, const auto& b) { return length(a) > length(b); });
    return loops;
}

bool canFlatten(const Patch& patch) {
    int edges = 0;
    for (uint32_t h = 0; h < patch.twin.size(); ++h) edges += patch.twin[h] == kNone || h < patch.twin[h];
    // Euler: with b border loops, V - E + F = 2 - b where there are no handles.
    int loops = int(borderLoops(patch).size());
    return loops > 0 && int(patch.point.size()) - edges + int(patch.triangles.size()) == 2 - loops;
}

std::vector<Patch> divide(const BakeMesh& mesh, const Facets& facets, const Patch& patch, const PatchVerdict& verdict) {
    size_t count = patch.triangles.size();
    std::vector<uint8_t> side = cutOut(patch, verdict);
    if (side.empty()) side = halve(mesh, facets, patch);
    DisjointSets sets(count);
    for (uint32_t h = 0; h < patch.twin.size(); ++h)
        if (uint32_t twin = patch.twin[h]; twin != kNone && side[h / 3] == side[twin / 3]) sets.join(h / 3, twin / 3);
    std::vector<std::vector<uint32_t>> members;
    std::vector<uint32_t> number(count, kNone), part(count), local(count);
    for (uint32_t t = 0; t < count; ++t) {
        uint32_t& n = number[sets.find(t)];
        if (n == kNone) n = uint32_t(members.size()), members.emplace_back();
        part[t] = n, local[t] = uint32_t(members[n].size());
        members[n].push_back(t);
    }
    std::vector<Patch> parts;
    for (const auto& triangles : members) parts.push_back(partOf(patch, triangles, local, part));
    return parts;
}

}  // namespace espalier::bakery
