// Joins charts into one surface. In: charts over a block-out. Out: the mesh displaced so that each border vertex
// satisfies the heights of all charts that meet there, its smooth normals, and the atlas layout.

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "tools/content/model.hpp"

namespace espalier::content {
namespace {

std::vector<uint32_t> weldCharts(const std::vector<Chart>& charts, uint32_t& count) {
    std::map<std::array<int64_t, 3>, uint32_t> ids;
    std::vector<uint32_t> weld;
    for (auto& chart : charts)
        for (glm::vec3 p : chart.block) {
            std::array<int64_t, 3> key{std::llround(p.x * 1e4), std::llround(p.y * 1e4), std::llround(p.z * 1e4)};
            weld.push_back(ids.emplace(key, static_cast<uint32_t>(ids.size())).first->second);
        }
    count = static_cast<uint32_t>(ids.size());
    return weld;
}

// The smallest displacement v with dot(normal, v) = height for every chart at a vertex, in least squares.
struct Displacement {
    glm::dmat3 a{0.03};
    glm::dvec3 b{0};
    void require(glm::dvec3 n, double height) {
        a += glm::outerProduct(n, n);
        b += n * (height * 1.03);
    }
    glm::vec3 solve() const { return glm::inverse(a) * b; }
};

// Places rectangles by the skyline's lowest spot; false where they don't fit into a square of this side.
bool pack(const std::vector<glm::vec2>& sizes, float side, float gutter, std::vector<glm::vec2>& corners,
          std::vector<bool>& turned) {
    constexpr int kColumns = 512;
    std::vector<float> sky(kColumns, 0.0f);
    std::vector<size_t> order(sizes.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
        return std::max(sizes[a].x, sizes[a].y) > std::max(sizes[b].x, sizes[b].y);
    });
    float column = side / kColumns;
    for (size_t i : order) {
        float best = 1e9f;
        int bestAt = 0;
        for (int turn = 0; turn < 2; ++turn) {
            glm::vec2 s = (turn != 0 ? glm::vec2(sizes[i].y, sizes[i].x) : sizes[i]) + gutter;
            int wide = static_cast<int>(std::ceil(s.x / column));
            for (int at = 0; at + wide <= kColumns; ++at) {
                float base = *std::max_element(sky.begin() + at, sky.begin() + at + wide);
                float waste = 0;
                for (int k = at; k < at + wide; ++k) waste += (base - sky[static_cast<size_t>(k)]) * column;
                float score = base + s.y + 0.15f * waste;
                bool fits = base + s.y + gutter <= side && static_cast<float>(at) * column + gutter + s.x <= side;
                if (!fits || score >= best) continue;
                best = score;
                bestAt = at;
                corners[i] = {static_cast<float>(at) * column + gutter, base + gutter};
                turned[i] = turn != 0;
            }
        }
        if (best > 1e8f) return false;
        glm::vec2 s = (turned[i] ? glm::vec2(sizes[i].y, sizes[i].x) : sizes[i]) + gutter;
        int wide = static_cast<int>(std::ceil(s.x / column));
        for (int k = bestAt; k < bestAt + wide; ++k) sky[static_cast<size_t>(k)] = corners[i].y + s.y - gutter;
    }
    return true;
}

void layOut(const std::vector<Chart>& charts, float gutter, Assembly& out) {
    std::vector<glm::vec2> sizes;
    float area = 0;
    for (auto& chart : charts) {
        Placement p;
        glm::vec2 high = p.low = chart.st.at(0);
        for (glm::vec2 st : chart.st) {
            p.low = glm::min(p.low, st);
            high = glm::max(high, st);
        }
        p.size = high - p.low;
        area += p.size.x * p.size.y;
        sizes.push_back(p.size);
        out.placements.push_back(p);
    }
    std::vector<glm::vec2> corners(charts.size());
    std::vector<bool> turned(charts.size());
    float side = std::sqrt(area);
    while (!pack(sizes, side, gutter * side, corners, turned)) side *= 1.01f;
    out.atlasMetres = side;
    for (size_t i = 0; i < charts.size(); ++i) {
        out.placements[i].offset = corners[i];
        out.placements[i].turned = turned[i];
    }
}

void computeNormals(Mesh& mesh, uint32_t welds) {
    std::vector<glm::dvec3> sum(welds, glm::dvec3(0));
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        std::array<uint32_t, 3> v{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
        for (size_t k = 0; k < 3; ++k) {
            glm::dvec3 p = mesh.positions[v[k]];
            glm::dvec3 a = glm::dvec3(mesh.positions[v[(k + 1) % 3]]) - p,
                       b = glm::dvec3(mesh.positions[v[(k + 2) % 3]]) - p;
            glm::dvec3 n = glm::cross(a, b);
            double length = glm::length(n);
            if (length < 1e-14) continue;
            sum[mesh.weld[v[k]]] += n / length * std::atan2(length, glm::dot(a, b));
        }
    }
    for (uint32_t w : mesh.weld) mesh.normals.push_back(glm::normalize(sum[w]));
}

}  // namespace

glm::vec2 Assembly::toUv(size_t chart, glm::vec2 st) const {
    const Placement& p = placements[chart];
    glm::vec2 local{st.x - p.low.x, p.low.y + p.size.y - st.y};
    if (p.turned) local = {p.size.y - local.y, local.x};
    return (p.offset + local) / atlasMetres;
}

glm::vec2 Assembly::toSt(size_t chart, glm::vec2 uv) const {
    const Placement& p = placements[chart];
    glm::vec2 local = uv * atlasMetres - p.offset;
    if (p.turned) local = {local.y, p.size.y - local.x};
    return {local.x + p.low.x, p.low.y + p.size.y - local.y};
}

Assembly assemble(const std::vector<Chart>& charts, const std::function<glm::vec3(glm::vec3)>& warp, float gutter) {
    Assembly out;
    uint32_t welds = 0;
    out.mesh.weld = weldCharts(charts, welds);
    layOut(charts, gutter, out);
    std::vector<Displacement> displacements(welds);
    uint32_t vertex = 0;
    for (auto& chart : charts)
        for (size_t i = 0; i < chart.st.size(); ++i, ++vertex) {
            float height = chart.detail(chart.st[i]).height;
            out.meshHeight.push_back(height);
            displacements[out.mesh.weld[vertex]].require(chart.normal[i], height);
        }
    vertex = 0;
    for (size_t c = 0; c < charts.size(); ++c) {
        out.firstVertex.push_back(vertex);
        for (auto& t : charts[c].triangles)
            for (uint32_t v : t) out.mesh.indices.push_back(vertex + v);
        for (size_t i = 0; i < charts[c].st.size(); ++i, ++vertex) {
            out.mesh.positions.push_back(warp(charts[c].block[i]) + displacements[out.mesh.weld[vertex]].solve());
            out.mesh.uvs.push_back(out.toUv(c, charts[c].st[i]));
        }
    }
    // Vertices of one place are to have one position bit for bit; equal block-out positions may differ by rounding.
    std::vector<int64_t> first(welds, -1);
    for (uint32_t v = 0; v < out.mesh.weld.size(); ++v) {
        int64_t& f = first[out.mesh.weld[v]];
        if (f < 0) f = v;
        out.mesh.positions[v] = out.mesh.positions[static_cast<size_t>(f)];
    }
    computeNormals(out.mesh, welds);
    return out;
}

}  // namespace espalier::content
