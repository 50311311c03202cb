// Enters: a model whose UVs are an atlas. Leaves: the count of indirection pixels, each with its link.
// Buron 2015 §4, Figure 2a.
#include "tools/bench/paper_bake.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>
#include <numeric>

namespace espalier {
namespace {

struct PositionMap {
    uint32_t size;
    std::vector<glm::vec3> position;
    std::vector<int> chart;  // -1: empty
};

// Charts as connected components over shared vertices of the index list.
std::vector<int> chartOfTriangle(const Model& model) {
    std::vector<uint32_t> parent(model.positions.size());
    std::iota(parent.begin(), parent.end(), 0u);
    auto root = [&](uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (size_t i = 0; i + 2 < model.indices.size(); i += 3) {
        parent[root(model.indices[i + 1])] = root(model.indices[i]);
        parent[root(model.indices[i + 2])] = root(model.indices[i]);
    }
    std::vector<int> chart(model.indices.size() / 3);
    for (size_t t = 0; t < chart.size(); ++t) chart[t] = int(root(model.indices[3 * t]));
    return chart;
}

void rasterTriangle(PositionMap& picture, const Model& model, size_t t, int chart) {
    std::array<glm::vec2, 3> p;
    std::array<glm::vec3, 3> q;
    for (int k = 0; k < 3; ++k) {
        p[k] = model.uvs[model.indices[3 * t + k]] * float(picture.size) - 0.5f;
        q[k] = model.positions[model.indices[3 * t + k]];
    }
    float area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
    if (std::abs(area) < 1e-12f) return;
    glm::vec2 low = glm::max(glm::min(p[0], glm::min(p[1], p[2])), glm::vec2(0));
    glm::vec2 high = glm::min(glm::max(p[0], glm::max(p[1], p[2])), glm::vec2(float(picture.size - 1)));
    for (int y = int(std::ceil(low.y)); y <= int(high.y); ++y)
        for (int x = int(std::ceil(low.x)); x <= int(high.x); ++x) {
            auto edge = [&](int i, int j) {
                return ((p[j].x - p[i].x) * (float(y) - p[i].y) - (float(x) - p[i].x) * (p[j].y - p[i].y)) / area;
            };
            float w2 = edge(0, 1), w0 = edge(1, 2), w1 = edge(2, 0);
            if (w0 < 0 || w1 < 0 || w2 < 0) continue;
            size_t texel = size_t(y) * picture.size + size_t(x);
            picture.position[texel] = q[0] * w0 + q[1] * w1 + q[2] * w2;
            picture.chart[texel] = chart;
        }
}

struct Points {
    std::vector<glm::vec3> position;
    std::vector<int> chart;
    size_t kdtree_get_point_count() const { return position.size(); }
    float kdtree_get_pt(size_t i, size_t axis) const { return position[i][int(axis)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

constexpr std::array<glm::ivec2, 4> kNeighbours{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

Points innerBorder(const PositionMap& picture) {
    Points points;
    int size = int(picture.size);
    for (int y = 1; y + 1 < size; ++y)
        for (int x = 1; x + 1 < size; ++x) {
            int chart = picture.chart[size_t(y) * picture.size + size_t(x)];
            if (chart < 0) continue;
            for (glm::ivec2 d : kNeighbours)
                if (picture.chart[size_t(y + d.y) * picture.size + size_t(x + d.x)] != chart) {
                    points.position.push_back(picture.position[size_t(y) * picture.size + size_t(x)]);
                    points.chart.push_back(chart);
                    break;
                }
        }
    return points;
}

size_t linkOuterBorder(const PositionMap& picture, const Points& border) {
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3>;
    Tree tree(3, border, nanoflann::KDTreeSingleIndexAdaptorParams(16));
    tree.buildIndex();
    size_t links = 0;
    int size = int(picture.size);
    for (int y = 1; y + 1 < size; ++y)
        for (int x = 1; x + 1 < size; ++x) {
            if (picture.chart[size_t(y) * picture.size + size_t(x)] >= 0) continue;
            glm::vec3 mean(0);
            int own = -1, count = 0;
            for (glm::ivec2 d : kNeighbours) {
                size_t texel = size_t(y + d.y) * picture.size + size_t(x + d.x);
                if (picture.chart[texel] < 0 || (own >= 0 && picture.chart[texel] != own)) continue;
                own = picture.chart[texel];
                mean += picture.position[texel];
                ++count;
            }
            if (!count) continue;
            mean /= float(count);
            std::array<uint32_t, 16> found{};
            std::array<float, 16> distance{};
            size_t n = tree.knnSearch(&mean.x, found.size(), found.data(), distance.data());
            for (size_t i = 0; i < n; ++i)
                if (border.chart[found[i]] != own) {
                    ++links;
                    break;
                }
        }
    return links;
}

}  // namespace

size_t paperBake(const Model& model, uint32_t resolution) {
    size_t texels = size_t(resolution) * resolution;
    PositionMap picture{resolution, std::vector<glm::vec3>(texels), std::vector<int>(texels, -1)};
    std::vector<int> charts = chartOfTriangle(model);
    for (size_t t = 0; t < charts.size(); ++t) rasterTriangle(picture, model, t, charts[t]);
    Points border = innerBorder(picture);
    return border.position.empty() ? 0 : linkOuterBorder(picture, border);
}

}  // namespace espalier
