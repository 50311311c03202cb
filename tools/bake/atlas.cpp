// In: the welded mesh and the model's UVs. Out: charts: sets of triangles of one orientation in UV that are connected
// across edges on whose UVs both sides agree.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {
namespace {

constexpr double kUvTolerance = 1e-6;    // within which two corners' UVs agree
constexpr double kMinUvArea = 1e-13;     // of a triangle; below, its map has no inverse worth the name
constexpr double kFlippedShare = 0.005;  // of the area: flipped islands up to this are left out

struct UnionFind {
    std::vector<uint32_t> parent;
    explicit UnionFind(size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0u); }
    uint32_t find(uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) {
        a = find(a), b = find(b);
        if (a != b) parent[std::max(a, b)] = std::min(a, b);
    }
};

void warn(std::vector<Diagnostic>& warnings, const Model& model, std::string text) {
    warnings.push_back({model.name, 0, 0, {}, std::move(text), true});
}

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g %%", share * 100);
    return text;
}

// What is wrong with triangles that are left out.
struct LeftOut {
    size_t degenerateUv = 0, noUv = 0, flipped = 0;
    double degenerateUvArea = 0, noUvArea = 0, flippedArea = 0;
};

Status reportLeftOut(const Model& model, const LeftOut& out, double area, std::vector<Diagnostic>& warnings) {
    if (out.noUvArea > 0.005 * area)
        return Failure(model.name, percent(out.noUvArea / area) + " of the area has no UVs (" +
                                       std::to_string(out.noUv) +
                                       " triangles): an unwrapped UV set is needed to bake it");
    if (out.degenerateUvArea > 0.05 * area)
        return Failure(model.name, "the UVs of " + percent(out.degenerateUvArea / area) +
                                       " of the area collapse to points or lines (" + std::to_string(out.degenerateUv) +
                                       " triangles): an unwrapped UV set is needed to bake it");
    if (out.flippedArea > 0.02 * area)
        return Failure(model.name, "the UVs fold over themselves: " + percent(out.flippedArea / area) +
                                       " of the area is flipped (" + std::to_string(out.flipped) +
                                       " triangles): an unwrapped UV set is needed to bake it");
    if (out.degenerateUv + out.noUv > 0)
        warn(warnings, model,
             std::to_string(out.degenerateUv + out.noUv) + " triangles without area in UV left out, " +
                 percent((out.degenerateUvArea + out.noUvArea) / area) + " of the area");
    if (out.flipped > 0)
        warn(warnings, model,
             std::to_string(out.flipped) + " triangles flipped in UV left out, " + percent(out.flippedArea / area) +
                 " of the area");
    return Done{};
}

bool uvsAgree(const BakeMesh& mesh, uint32_t h, uint32_t twin) {
    glm::dvec2 d0 = mesh.uvAt(h) - mesh.uvAt(BakeMesh::next(twin));
    glm::dvec2 d1 = mesh.uvAt(BakeMesh::next(h)) - mesh.uvAt(twin);
    double most = std::max(std::max(std::abs(d0.x), std::abs(d0.y)), std::max(std::abs(d1.x), std::abs(d1.y)));
    return most <= kUvTolerance;
}

// Gives corners the model's UVs; returns which triangles have any of use.
std::vector<uint8_t> readUvs(const Model& model, BakeMesh& mesh, LeftOut& out) {
    std::vector<uint8_t> usable(mesh.triangles.size(), 0);
    for (size_t t = 0; t < usable.size(); ++t) {
        Triangle& triangle = mesh.triangles[t];
        bool finite = !model.uvs.empty();
        for (size_t k = 0; k < 3 && finite; ++k) {
            triangle.uv[k] = glm::dvec2(model.uvs[vertexAt(model, triangle, k)]);
            finite = std::abs(triangle.uv[k].x) < 1e6 && std::abs(triangle.uv[k].y) < 1e6;
        }
        if (!finite) {
            ++out.noUv;
            out.noUvArea += area3(mesh, triangle);
        } else if (std::abs(uvArea(triangle)) < kMinUvArea) {
            ++out.degenerateUv;
            out.degenerateUvArea += area3(mesh, triangle);
        } else {
            usable[t] = 1;
        }
    }
    return usable;
}

// Connects triangles of one orientation; returns each triangle's island, kNone where it is left out as flipped.
std::vector<uint32_t> findIslands(const Model& model, BakeMesh& mesh, LeftOut& out) {
    size_t count = mesh.triangles.size();
    std::vector<uint8_t> usable = readUvs(model, mesh, out);
    UnionFind sets(count);
    std::vector<uint8_t> positive(count);
    for (size_t t = 0; t < count; ++t) positive[t] = uvArea(mesh.triangles[t]) > 0;
    std::vector<uint32_t> against;  // half-edges across which UVs agree but the orientation turns: folds
    for (uint32_t h = 0; h < count * 3; ++h) {
        uint32_t twin = mesh.twin[h];
        if (twin == kNone || twin < h || !usable[h / 3] || !usable[twin / 3] || !uvsAgree(mesh, h, twin)) continue;
        if (positive[h / 3] == positive[twin / 3])
            sets.join(h / 3, twin / 3);
        else
            against.push_back(h);
    }
    std::vector<uint32_t> island(count), members(count, 0);
    std::vector<double> area(count, 0);
    for (uint32_t t = 0; t < count; ++t) {
        island[t] = sets.find(t);
        ++members[island[t]];
        area[island[t]] += area3(mesh, mesh.triangles[t]);
    }
    std::vector<uint8_t> flipped(count, 0);
    for (uint32_t h : against) {
        uint32_t a = island[h / 3], b = island[mesh.twin[h] / 3];
        uint32_t small = area[a] < area[b] ? a : b, large = area[a] < area[b] ? b : a;
        if (members[small] <= 4 && area[small] <= kFlippedShare * mesh.area && area[small] < area[large])
            flipped[small] = 1;
    }
    for (uint32_t t = 0; t < count; ++t) {
        if (!usable[t]) island[t] = kNone;
        if (island[t] == kNone || !flipped[island[t]]) continue;
        ++out.flipped;
        out.flippedArea += area3(mesh, mesh.triangles[t]);
        island[t] = kNone;
    }
    return island;
}

// Numbers charts by their first triangle and sorts triangles by chart.
Status sortByChart(const Model& model, const std::vector<uint32_t>& island, BakeMesh& mesh) {
    size_t count = mesh.triangles.size();
    std::vector<uint32_t> number(count, kNone), sizes;
    for (uint32_t t = 0; t < count; ++t) {
        if (island[t] == kNone) continue;
        uint32_t& n = number[island[t]];
        if (n == kNone) {
            n = uint32_t(sizes.size());
            sizes.push_back(0);
            mesh.orientation.push_back(uvArea(mesh.triangles[t]) > 0 ? 1.0f : -1.0f);
        }
        mesh.triangles[t].chart = n;
        ++sizes[n];
    }
    if (sizes.empty()) return Failure(model.name, "no triangle can be baked: all lack area");
    if (sizes.size() > 65535)
        return Failure(model.name, "the UVs fall into " + std::to_string(sizes.size()) + " charts; 65535 is the limit");
    mesh.firstTriangle.assign(sizes.size() + 1, 0);
    for (size_t c = 0; c < sizes.size(); ++c) mesh.firstTriangle[c + 1] = mesh.firstTriangle[c] + sizes[c];
    std::vector<uint32_t> at(mesh.firstTriangle.begin(), mesh.firstTriangle.end() - 1);
    std::vector<uint32_t> moved(count, kNone);
    std::vector<Triangle> sorted(mesh.firstTriangle.back());
    for (uint32_t t = 0; t < count; ++t)
        if (island[t] != kNone) sorted[moved[t] = at[mesh.triangles[t].chart]++] = mesh.triangles[t];
    std::vector<uint32_t> twin(sorted.size() * 3, kNone);
    for (uint32_t h = 0; h < count * 3; ++h) {
        uint32_t other = mesh.twin[h];
        if (moved[h / 3] == kNone || other == kNone || moved[other / 3] == kNone) continue;
        twin[moved[h / 3] * 3 + h % 3] = moved[other / 3] * 3 + other % 3;
    }
    mesh.triangles.swap(sorted);
    mesh.twin.swap(twin);
    mesh.joined.assign(mesh.twin.size(), 0);
    for (uint32_t h = 0; h < mesh.twin.size(); ++h)
        if (mesh.twin[h] != kNone && mesh.chartOf(h) == mesh.chartOf(mesh.twin[h]) && uvsAgree(mesh, h, mesh.twin[h]))
            mesh.joined[h] = 1;
    return Done{};
}

}  // namespace

Status makeAtlas(const Model& model, BakeMesh& mesh, std::vector<Diagnostic>& warnings) {
    LeftOut out;
    std::vector<uint32_t> island = findIslands(model, mesh, out);
    Status usable = reportLeftOut(model, out, mesh.area, warnings);
    if (!usable) return std::move(usable.failure());
    return sortByChart(model, island, mesh);
}

}  // namespace espalier::bakery
