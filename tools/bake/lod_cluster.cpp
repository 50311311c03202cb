// In: a mesh as it is drawn. Out: where its vertices go when those of one cell of a grid are put into one place: that
// of the vertex which is nearest to the planes of the cell's triangles (after Lindstrom 2000). Places alone are shared:
// every triangle keeps the textures and normals of its corners, so that what is closed stays closed and keeps its
// colours, and small parts go. For kits of boxes, whose corners' seams leave no edge to collapse.
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "tools/bake/lod_cluster.hpp"

namespace espalier::bakery {
namespace {

// The sum over planes of area times squared distance.
struct Quadric {
    glm::dmat3 nn{0};
    glm::dvec3 nd{0};
    double dd = 0;

    void add(glm::dvec3 n, double d, double area) {
        nn += glm::outerProduct(n, n) * area;
        nd += n * (d * area);
        dd += d * d * area;
    }
    double at(glm::dvec3 p) const { return glm::dot(p, nn * p) + 2 * glm::dot(nd, p) + dd; }
};

// Numbers the vertices' cells in the order of their keys; returns how many there are.
uint32_t findCells(const std::vector<DrawVertex>& vertices, glm::vec3 low, float cell, std::vector<uint32_t>& cellOf) {
    std::vector<std::pair<uint64_t, uint32_t>> keys(vertices.size());
    for (uint32_t v = 0; v < keys.size(); ++v) {
        const glm::vec3 at = glm::max((vertices[v].position - low) / cell, glm::vec3(0));
        keys[v] = {uint64_t(at.x) << 42 | uint64_t(at.y) << 21 | uint64_t(at.z), v};
    }
    std::sort(keys.begin(), keys.end());
    cellOf.resize(vertices.size());
    uint32_t count = 0;
    for (size_t i = 0; i < keys.size(); ++i) {
        count += i == 0 || keys[i].first != keys[i - 1].first;
        cellOf[keys[i].second] = count - 1;
    }
    return count;
}

// Per cell the vertex whose place all take.
std::vector<uint32_t> findPlaces(const std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& indices,
                                 glm::vec3 low, const std::vector<uint32_t>& cellOf, uint32_t cells) {
    std::vector<Quadric> quadrics(cells);
    for (size_t i = 0; i < indices.size(); i += 3) {
        const glm::dvec3 a(vertices[indices[i]].position - low), b(vertices[indices[i + 1]].position - low),
            c(vertices[indices[i + 2]].position - low), n = glm::cross(b - a, c - a);
        const double twice = glm::length(n);
        if (!(twice > 0)) continue;
        for (size_t k = 0; k < 3; ++k) quadrics[cellOf[indices[i + k]]].add(n / twice, -glm::dot(n, a) / twice, twice);
    }
    std::vector<uint32_t> best(cells, kNone);
    std::vector<double> least(cells, 0);
    for (uint32_t v = 0; v < vertices.size(); ++v) {
        const uint32_t c = cellOf[v];
        const double error = quadrics[c].at(glm::dvec3(vertices[v].position - low));
        if (best[c] == kNone || error < least[c]) best[c] = v, least[c] = error;
    }
    return best;
}

auto valuesOf(const DrawVertex& v) {
    return std::pair(std::array{v.position.x, v.position.y, v.position.z, v.normal.x, v.normal.y, v.normal.z,
                                v.tangent.x, v.tangent.y, v.tangent.z, v.tangent.w, v.uv.x, v.uv.y, v.walkUv.x,
                                v.walkUv.y, v.otherUv.x, v.otherUv.y},
                     v.colour);
}

// Per vertex the first that is the same in everything.
std::vector<uint32_t> firstAlike(const std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& materialOf) {
    std::vector<uint32_t> order(vertices.size()), first(vertices.size());
    for (uint32_t v = 0; v < order.size(); ++v) order[v] = v;
    const auto key = [&](uint32_t v) { return std::pair(materialOf[v], valuesOf(vertices[v])); };
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
    for (size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
    return first;
}

}  // namespace

std::vector<uint32_t> clusterVertices(std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& indices,
                                      const std::vector<uint32_t>& materialOf, float cell) {
    glm::vec3 low(1e30f);
    for (const DrawVertex& v : vertices) low = glm::min(low, v.position);
    low -= cell / 2;  // walls along the axes are to lie within cells, not between two
    std::vector<uint32_t> cellOf;
    const uint32_t cells = findCells(vertices, low, cell, cellOf);
    const std::vector<uint32_t> places = findPlaces(vertices, indices, low, cellOf, cells);
    std::vector<glm::vec3> moved(cells);
    for (uint32_t c = 0; c < cells; ++c) moved[c] = vertices[places[c]].position;
    for (uint32_t v = 0; v < vertices.size(); ++v) vertices[v].position = moved[cellOf[v]];

    // Of triangles that have come to lie in one place, facing one way, the first stays.
    struct Place {
        std::array<uint32_t, 3> cells;  // the least first
        uint32_t triangle;
    };
    std::vector<Place> left;
    for (uint32_t t = 0; t < indices.size() / 3; ++t) {
        std::array<uint32_t, 3> c{cellOf[indices[t * 3]], cellOf[indices[t * 3 + 1]], cellOf[indices[t * 3 + 2]]};
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
        std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
        left.push_back({c, t});
    }
    const auto less = [](const Place& a, const Place& b) {
        return std::tie(a.cells, a.triangle) < std::tie(b.cells, b.triangle);
    };
    std::sort(left.begin(), left.end(), less);
    left.erase(std::unique(left.begin(), left.end(), [](const Place& a, const Place& b) { return a.cells == b.cells; }),
               left.end());
    std::sort(left.begin(), left.end(), [](const Place& a, const Place& b) { return a.triangle < b.triangle; });
    const std::vector<uint32_t> first = firstAlike(vertices, materialOf);
    std::vector<uint32_t> out;
    for (const Place& p : left)
        for (uint32_t k = 0; k < 3; ++k) out.push_back(first[indices[p.triangle * 3 + k]]);
    return out;
}

}  // namespace espalier::bakery
