// The ruin keeps what its documentation promises: one manifold, an atlas without overlaps, low stretch.

#include <doctest/doctest.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "tools/content/masonry.hpp"
#include "tools/content/ruin.hpp"

using namespace espalier::content;

namespace {

const Ruin& ruin() {
    static const Ruin made = makeRuin(256);
    return made;
}

// Vertices told apart by their exact position, as a reader of the file sees them.
std::vector<uint32_t> byPosition(const Mesh& mesh) {
    std::map<std::array<float, 3>, uint32_t> ids;
    std::vector<uint32_t> out;
    for (glm::vec3 p : mesh.positions)
        out.push_back(ids.emplace(std::array{p.x, p.y, p.z}, static_cast<uint32_t>(ids.size())).first->second);
    return out;
}

using Edges = std::map<std::pair<uint32_t, uint32_t>, int>;
Edges directedEdges(const Mesh& mesh, const std::vector<uint32_t>& ids) {
    Edges edges;
    for (size_t i = 0; i < mesh.indices.size(); i += 3)
        for (size_t k = 0; k < 3; ++k) ++edges[{ids[mesh.indices[i + k]], ids[mesh.indices[i + (k + 1) % 3]]}];
    return edges;
}

// A layer's value, 0 to 255, at a point of a chart.
int layerAt(const Picture& layer, const std::string& chart, glm::vec2 st) {
    const Ruin& r = ruin();
    for (size_t c = 0; c < r.charts.size(); ++c)
        if (r.charts[c].name == chart) {
            glm::vec2 uv = r.assembly.toUv(c, st) * static_cast<float>(layer.width);
            return static_cast<int>(layer.at(static_cast<int>(uv.x), static_cast<int>(uv.y))[0]);
        }
    FAIL("no such chart");
    return 0;
}

}  // namespace

TEST_CASE("the ruin is one oriented manifold whose only border is the rim of the ground") {
    const Mesh& mesh = ruin().assembly.mesh;
    std::vector<uint32_t> ids = byPosition(mesh);
    Edges edges = directedEdges(mesh, ids);
    std::map<uint32_t, uint32_t> next;
    size_t doubled = 0, collapsed = 0;
    for (auto& [edge, count] : edges) {
        doubled += count > 1 ? 1u : 0u;
        collapsed += edge.first == edge.second ? 1u : 0u;
        if (edges.count({edge.second, edge.first}) == 0) CHECK(next.emplace(edge.first, edge.second).second);
    }
    CHECK(doubled == 0);
    CHECK(collapsed == 0);
    // The border is one loop.
    REQUIRE(!next.empty());
    uint32_t at = next.begin()->first;
    size_t length = 0;
    do {
        at = next.at(at);
        ++length;
    } while (at != next.begin()->first && length <= next.size());
    CHECK(length == next.size());
    for (auto& [from, to] : next)
        for (size_t v = 0; v < ids.size(); ++v)
            if (ids[v] == from) CHECK(mesh.positions[v].y < 0.1f);
    // And the surface one piece.
    std::vector<uint32_t> parent(*std::max_element(ids.begin(), ids.end()) + 1);
    std::iota(parent.begin(), parent.end(), 0u);
    auto root = [&](uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (auto& [edge, count] : edges) parent[root(edge.first)] = root(edge.second);
    std::set<uint32_t> roots;
    for (uint32_t i : ids) roots.insert(root(i));
    CHECK(roots.size() == 1);
    // Every vertex has one fan: V - E + F of a sphere with one hole and the handle of the arch.
    size_t vertices = parent.size(), faces = mesh.indices.size() / 3, undirected = (edges.size() + next.size()) / 2;
    CHECK(static_cast<long>(vertices) - static_cast<long>(undirected) + static_cast<long>(faces) == 1 - 2);
}

TEST_CASE("the ruin's size is moderate") {
    size_t triangles = ruin().assembly.mesh.indices.size() / 3;
    CHECK(triangles > 30000);
    CHECK(triangles < 80000);
}

TEST_CASE("the atlas lies in the unit square, nothing overlaps or is flipped, and gutters are kept") {
    const Ruin& r = ruin();
    constexpr int kSize = 1024;
    std::vector<int> chartAt(kSize * kSize, -1);
    std::vector<uint8_t> hits(kSize * kSize, 0);
    size_t outside = 0, flipped = 0, overlaps = 0, foreign = 0;
    for (glm::vec2 uv : r.assembly.mesh.uvs) outside += uv.x >= 0 && uv.y >= 0 && uv.x <= 1 && uv.y <= 1 ? 0u : 1u;
    for (size_t c = 0; c < r.charts.size(); ++c)
        for (auto& t : r.charts[c].triangles) {
            glm::dvec2 p[3];
            for (size_t k = 0; k < 3; ++k)
                p[k] = glm::dvec2(r.assembly.mesh.uvs[r.assembly.firstVertex[c] + t[k]]) * double(kSize);
            // v points down: a triangle that faces outwards runs clockwise in (u, v).
            double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
            if (area >= 0) ++flipped;
            glm::dvec2 low = glm::min(p[0], glm::min(p[1], p[2])), high = glm::max(p[0], glm::max(p[1], p[2]));
            for (int y = static_cast<int>(low.y); y <= std::min(kSize - 1, static_cast<int>(high.y)); ++y)
                for (int x = static_cast<int>(low.x); x <= std::min(kSize - 1, static_cast<int>(high.x)); ++x) {
                    // Off the texel's centre by odd fractions, so that no shared edge is hit by both sides.
                    glm::dvec2 q(x + 0.50137, y + 0.49811);
                    double w1 = ((q.x - p[0].x) * (p[2].y - p[0].y) - (q.y - p[0].y) * (p[2].x - p[0].x)) / area;
                    double w2 = ((p[1].x - p[0].x) * (q.y - p[0].y) - (p[1].y - p[0].y) * (q.x - p[0].x)) / area;
                    if (w1 < 1e-9 || w2 < 1e-9 || w1 + w2 > 1 - 1e-9) continue;
                    size_t at = static_cast<size_t>(y) * kSize + static_cast<size_t>(x);
                    if (hits[at]++ != 0) ++overlaps;
                    chartAt[at] = static_cast<int>(c);
                }
        }
    CHECK(outside == 0);
    CHECK(flipped == 0);
    CHECK(overlaps == 0);
    // Two texels at 128² are sixteen here; the gutter is 14: no chart comes nearer than 13 to another.
    for (int y = 0; y < kSize; y += 2)
        for (int x = 0; x < kSize; ++x) {
            int own = chartAt[static_cast<size_t>(y) * kSize + static_cast<size_t>(x)];
            for (int d = 1; own >= 0 && d <= 12; ++d) {
                int right = x + d < kSize ? chartAt[static_cast<size_t>(y) * kSize + static_cast<size_t>(x + d)] : -1;
                int below = y + d < kSize ? chartAt[static_cast<size_t>(y + d) * kSize + static_cast<size_t>(x)] : -1;
                if ((right >= 0 && right != own) || (below >= 0 && below != own)) ++foreign;
            }
        }
    CHECK(foreign == 0);
}

TEST_CASE("the atlas stretches little and evenly") {
    const Ruin& r = ruin();
    const Mesh& mesh = r.assembly.mesh;
    std::vector<std::pair<double, double>> density;  // metres a unit of uv, area
    double total = 0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        glm::dvec3 p[3];
        glm::dvec2 q[3];
        for (size_t k = 0; k < 3; ++k) {
            p[k] = mesh.positions[mesh.indices[i + k]];
            q[k] = mesh.uvs[mesh.indices[i + k]];
        }
        double area = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
        double flat = std::abs((q[1].x - q[0].x) * (q[2].y - q[0].y) - (q[1].y - q[0].y) * (q[2].x - q[0].x));
        density.push_back({std::sqrt(area / flat), area});
        total += area;
    }
    std::sort(density.begin(), density.end());
    auto at = [&](double share) {
        double sum = 0;
        for (auto& [d, area] : density)
            if ((sum += area) >= share * total) return d;
        return density.back().first;
    };
    CHECK(at(0.95) / at(0.5) < 1.6);
    CHECK(at(0.5) / at(0.05) < 1.3);
}

TEST_CASE("equal vertices have equal normals of unit length, and faces agree with them") {
    const Mesh& mesh = ruin().assembly.mesh;
    std::vector<uint32_t> ids = byPosition(mesh);
    std::map<uint32_t, glm::vec3> normal;
    size_t against = 0, uneven = 0, unequal = 0;
    for (size_t v = 0; v < ids.size(); ++v) {
        uneven += std::abs(glm::length(mesh.normals[v]) - 1) < 1e-4f ? 0u : 1u;
        unequal +=
            glm::distance(normal.emplace(ids[v], mesh.normals[v]).first->second, mesh.normals[v]) < 1e-6f ? 0u : 1u;
    }
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        glm::vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                  c = mesh.positions[mesh.indices[i + 2]];
        glm::vec3 n = glm::cross(b - a, c - a);
        glm::vec3 sum =
            mesh.normals[mesh.indices[i]] + mesh.normals[mesh.indices[i + 1]] + mesh.normals[mesh.indices[i + 2]];
        if (glm::dot(n, sum) < 0) ++against;
    }
    CHECK(uneven == 0);
    CHECK(unequal == 0);
    CHECK(against * 500 < mesh.indices.size() / 3);  // folds are rare
}

TEST_CASE("the mask leads from the ground up the wall") {
    const Ruin& r = ruin();
    auto maskAt = [&](const std::string& chart, glm::vec2 st) { return layerAt(r.painted.mask, chart, st); };
    CHECK(maskAt("main front", {-1.3f, 0.3f}) > 128);
    CHECK(maskAt("main front", {0.55f, 2.66f}) > 128);
    CHECK(maskAt("main front", {-2.5f, 1.5f}) < 128);
    CHECK(maskAt("main back", {0.5f, 1.0f}) < 128);
    CHECK(maskAt("ground", {-1.35f, -0.5f}) > 128);
}

TEST_CASE("the sample's ivy keeps off the tondo, is lush over the arch and climbs the back and the end by tongues") {
    auto ivyAt = [](const std::string& chart, glm::vec2 st) { return layerAt(ruin().painted.ivy, chart, st); };
    CHECK(ivyAt("main front", {-1.62f, 2.05f}) == 0);
    CHECK(ivyAt("main front", {0.55f, 2.70f}) > 180);
    CHECK(ivyAt("main front", {-2.5f, 0.8f}) == 128);
    CHECK(ivyAt("main back", {1.85f, 1.5f}) > 140);  // s runs against x there
    CHECK(ivyAt("main back", {0, 1.9f}) == 0);
    CHECK(ivyAt("return outer", {1.4f, 0.5f}) > 140);
    CHECK(ivyAt("return outer", {-0.25f, 3.3f}) == 0);  // the corner, high up
    CHECK(ivyAt("ground", {0.5f, -2.0f}) == 128);
}

TEST_CASE("stones are rectangles without holes, a few of them two courses high") {
    const Elevation wall(0, 8, {{0, 12}, {5.1f, 9}, {6.4f, 5}}, Arch{}, 77);
    constexpr float kStep = 0.01f;
    struct Seen {
        glm::vec2 low{1e9f}, high{-1e9f};
        float area = 0;
    };
    std::map<uint32_t, Seen> stones;
    for (float x = kStep / 2; x < 8; x += kStep)
        for (float y = kStep / 2; y < wall.top(x); y += kStep) {
            Seen& stone = stones[wall.placeAt({x, y}, 0).id];
            stone.low = glm::min(stone.low, glm::vec2(x, y));
            stone.high = glm::max(stone.high, glm::vec2(x, y));
            stone.area += kStep * kStep;
        }
    int tall = 0;
    for (const auto& [id, stone] : stones) {
        const glm::vec2 size = stone.high - stone.low + kStep;
        if (size.y > 0.4f) ++tall;
        CHECK(size.y < 0.68f);
        // Its joints wander by two centimetres at each end.
        CHECK(stone.area > (size.x - 0.045f) * (size.y - 0.045f) - 0.003f);
    }
    CHECK(tall >= 5);
    CHECK(tall < int(stones.size()) / 6);
}
