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

// Where displacement squeezes or tears a triangle, its vertices move with their neighbours instead.
void relax(const std::vector<Chart>& charts, const std::vector<glm::vec3>& rest, const std::vector<uint32_t>& weld,
           std::vector<glm::vec3>& moved) {
    constexpr float kSqueezed = 0.42f, kTorn = 2.4f;
    std::vector<std::pair<glm::vec3, float>> around(moved.size());
    for (int round = 0; round < 60; ++round) {
        std::fill(around.begin(), around.end(), std::pair(glm::vec3(0), 0.0f));
        std::vector<uint8_t> bad(moved.size(), 0);
        size_t count = 0;
        uint32_t first = 0;
        for (auto& chart : charts) {
            for (auto& t : chart.triangles) {
                glm::vec3 p[3];
                for (size_t k = 0; k < 3; ++k) {
                    uint32_t v = first + t[k], n = weld[first + t[(k + 1) % 3]];
                    p[k] = rest[v] + moved[weld[v]];
                    around[weld[v]].first += moved[n];
                    around[weld[v]].second += 1;
                }
                glm::vec2 a = chart.st[t[1]] - chart.st[t[0]], b = chart.st[t[2]] - chart.st[t[0]];
                float area = a.x * b.y - a.y * b.x;
                glm::vec3 ds = ((p[1] - p[0]) * b.y - (p[2] - p[0]) * a.y) / area;
                glm::vec3 dt = ((p[2] - p[0]) * a.x - (p[1] - p[0]) * b.x) / area;
                float e = glm::dot(ds, ds), f = glm::dot(ds, dt), g = glm::dot(dt, dt);
                float half = (e + g) / 2, root = std::sqrt((e - g) * (e - g) / 4 + f * f);
                if (half - root > kSqueezed * kSqueezed && half + root < kTorn * kTorn) continue;
                for (uint32_t v : t) bad[weld[first + v]] = 1;
                ++count;
            }
            first += static_cast<uint32_t>(chart.st.size());
        }
        if (count == 0) return;
        for (size_t w = 0; w < moved.size(); ++w)
            if (bad[w] != 0) moved[w] = glm::mix(moved[w], around[w].first / around[w].second, 0.6f);
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
    std::vector<glm::vec3> rest, moved;
    for (auto& chart : charts)
        for (glm::vec3 p : chart.block) rest.push_back(warp(p));
    for (auto& d : displacements) moved.push_back(d.solve());
    relax(charts, rest, out.mesh.weld, moved);
    vertex = 0;
    for (size_t c = 0; c < charts.size(); ++c) {
        out.firstVertex.push_back(vertex);
        for (auto& t : charts[c].triangles)
            for (uint32_t v : t) out.mesh.indices.push_back(vertex + v);
        for (size_t i = 0; i < charts[c].st.size(); ++i, ++vertex) {
            out.mesh.positions.push_back(rest[vertex] + moved[out.mesh.weld[vertex]]);
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
