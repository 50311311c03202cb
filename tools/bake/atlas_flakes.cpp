// In: triangles with their welded points. Out: the same without copies: of triangles with the same corners one is kept,
// and flakes go: pairs back to back that lie on a surface which is whole without them, or stand on it as a fin of a few
// texels. The pairs of a sheet that was modelled with two sides stay, since nothing else is there.
#include <algorithm>
#include <unordered_map>

#include "tools/bake/bake_mesh.hpp"
#include "tools/bake/sort_buckets.hpp"

namespace espalier::bakery {
namespace {

struct Corners {
    std::array<uint32_t, 3> point;  // ascending
    uint32_t triangle;
    bool odd;  // whether the triangle runs through them against their order
};

std::vector<Corners> sortedCorners(const BakeMesh& mesh) {
    std::vector<Corners> out;
    out.reserve(mesh.triangles.size());
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        Corners c{mesh.triangles[t].point, t, false};
        for (auto [i, j] : {std::pair{0u, 1u}, {1u, 2u}, {0u, 1u}})
            if (c.point[i] > c.point[j]) std::swap(c.point[i], c.point[j]), c.odd = !c.odd;
        out.push_back(c);
    }
    sortBuckets(
        out, mesh.points.size(), [](const Corners& c) { return c.point[0]; },
        [](const Corners& a, const Corners& b) {
            return std::tie(a.point, a.odd, a.triangle) < std::tie(b.point, b.odd, b.triangle);
        });
    return out;
}

uint64_t edgeOf(const BakeMesh& mesh, uint32_t t, size_t k) {
    return uint64_t(mesh.triangles[t].point[k]) << 32 | mesh.triangles[t].point[(k + 1) % 3];
}

}  // namespace

size_t dropCopies(BakeMesh& mesh, double finArea) {
    std::vector<Corners> corners = sortedCorners(mesh);
    std::vector<uint8_t> drop(mesh.triangles.size(), 0);
    std::vector<uint32_t> paired;  // triangles with an opposite copy
    for (size_t i = 0, j; i < corners.size(); i = j) {
        size_t even = 0, odd = 0;
        for (j = i; j < corners.size() && corners[j].point == corners[i].point; ++j) {
            size_t& seen = corners[j].odd ? odd : even;
            if (seen++ == 0) continue;
            drop[corners[j].triangle] = 1;
            mesh.copied += area3(mesh, mesh.triangles[corners[j].triangle]);
        }
        for (size_t k = i; k < j && even > 0 && odd > 0; ++k)
            if (!drop[corners[k].triangle]) paired.push_back(corners[k].triangle);
    }
    if (!paired.empty()) {
        std::vector<uint8_t> isPaired(mesh.triangles.size(), 0);
        for (uint32_t t : paired) isPaired[t] = 1;
        struct Use {
            uint32_t rest = 0, pairs = 0;  // half-edges of the rest of the surface, and of pairs
        };
        std::unordered_map<uint64_t, Use> along;  // per direction, of edges that pairs have
        for (uint32_t t : paired)
            for (size_t k = 0; k < 3; ++k) ++along[edgeOf(mesh, t, k)].pairs;
        for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
            for (size_t k = 0; k < 3 && !isPaired[t] && !drop[t]; ++k)
                if (auto e = along.find(edgeOf(mesh, t, k)); e != along.end()) ++e->second.rest;
        for (uint32_t t : paired) {
            int whole = 0, rim = 0;
            for (size_t k = 0; k < 3; ++k) {
                uint64_t edge = edgeOf(mesh, t, k), back = edge << 32 | edge >> 32;
                const Use &here = along[edge], &there = along[back];
                whole += here.rest > 0 && there.rest > 0;
                rim += here.rest + there.rest == 0 && here.pairs + there.pairs == 2;
            }
            bool fin = whole > 0 && whole + rim == 3 && area3(mesh, mesh.triangles[t]) < finArea;
            if (whole == 3 || fin) drop[t] = 1;
        }
    }
    size_t kept = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        if (!drop[t]) mesh.triangles[kept++] = mesh.triangles[t];
    size_t dropped = mesh.triangles.size() - kept;
    mesh.triangles.resize(kept);
    return dropped;
}

}  // namespace espalier::bakery
