// In: nothing. Out: the skin of three rings that run through each other at right angles, by surface nets: a vertex in
// each cell of a grid that the skin passes through, and a quad across each edge of the grid that it cuts.
#include <algorithm>
#include <array>
#include <cmath>

#include "tools/content/forms.hpp"

namespace espalier::content {
namespace {

using glm::ivec3;
using glm::vec3;

constexpr float kRing = .62f, kTube = .15f;  // metres
constexpr float kFillet = .09f;              // joints are round, so that fields and pieces pass over them
constexpr int kCells = 56;                   // a side of the grid
constexpr float kHalf = 1.08f * (kRing + kTube), kStep = 2 * kHalf / kCells;

float ringDistance(vec3 p, int axis) {
    const float along = p[axis];
    p[axis] = 0;
    const float across = glm::length(p) - kRing;
    return std::sqrt(across * across + along * along) - kTube;
}
float smoothMinimum(float a, float b) {
    const float h = std::max(kFillet - std::abs(a - b), 0.0f) / kFillet;
    return std::min(a, b) - .25f * kFillet * h * h;
}
// Negative inside; near the skin about the distance to it.
float depthAt(vec3 p) {
    return smoothMinimum(smoothMinimum(ringDistance(p, 0), ringDistance(p, 1)), ringDistance(p, 2));
}
vec3 outwards(vec3 p) {
    constexpr float e = 1e-3f;
    return glm::normalize(vec3(depthAt(p + vec3(e, 0, 0)) - depthAt(p - vec3(e, 0, 0)),
                               depthAt(p + vec3(0, e, 0)) - depthAt(p - vec3(0, e, 0)),
                               depthAt(p + vec3(0, 0, e)) - depthAt(p - vec3(0, 0, e))));
}
vec3 onSkin(vec3 p) {
    for (int i = 0; i < 4; ++i) p -= depthAt(p) * outwards(p);
    return p;
}

// Points of the grid, or its cells by their lowest corner.
template <class T>
class Grid {
  public:
    explicit Grid(T value) : values_(size_t(kSide) * kSide * kSide, value) {}
    T& operator[](ivec3 p) { return values_[(size_t(p.z) * kSide + size_t(p.y)) * kSide + size_t(p.x)]; }
    static vec3 place(ivec3 p) { return vec3(p) * kStep - kHalf; }
    template <class Visit>
    static void each(int side, const Visit& visit) {
        for (int z = 0; z < side; ++z)
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x) visit(ivec3(x, y, z));
    }

  private:
    static constexpr int kSide = kCells + 1;
    std::vector<T> values_;
};

constexpr uint32_t kNone = ~0u;

Grid<uint32_t> addVertices(Grid<float>& depths, Mesh& mesh) {
    Grid<uint32_t> vertices(kNone);
    Grid<float>::each(kCells, [&](ivec3 cell) {
        int inside = 0;
        for (int k = 0; k < 8; ++k) inside += depths[cell + ivec3(k & 1, k >> 1 & 1, k >> 2)] < 0 ? 1 : 0;
        if (inside == 0 || inside == 8) return;
        vertices[cell] = uint32_t(mesh.positions.size());
        const vec3 p = onSkin(Grid<float>::place(cell) + .5f * kStep);
        mesh.positions.push_back(p + vec3(0, kRing + kTube + .25f * kFillet, 0));  // stands on a joint
        mesh.normals.push_back(outwards(p));
        mesh.uvs.emplace_back(1, 0);
        mesh.weld.push_back(vertices[cell]);
    });
    return vertices;
}

void addQuads(Grid<float>& depths, Grid<uint32_t>& vertices, Mesh& mesh) {
    Grid<float>::each(kCells, [&](ivec3 p) {
        for (int axis = 0; axis < 3; ++axis) {
            ivec3 ahead(0), b(0), c(0);
            ahead[axis] = b[(axis + 1) % 3] = c[(axis + 2) % 3] = 1;
            const bool inside = depths[p] < 0;
            if (inside == (depths[p + ahead] < 0)) continue;
            // Counterclockwise seen from where the edge leads to.
            std::array<uint32_t, 4> v{vertices[p], vertices[p - b], vertices[p - b - c], vertices[p - c]};
            if (!inside) std::swap(v[1], v[3]);
            for (size_t i : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(v[i]);
        }
    });
}

}  // namespace

Mesh makeLinkedTori() {
    Grid<float> depths(0);
    Grid<float>::each(kCells + 1, [&](ivec3 p) { depths[p] = depthAt(Grid<float>::place(p)); });
    Mesh mesh;
    Grid<uint32_t> vertices = addVertices(depths, mesh);
    addQuads(depths, vertices, mesh);
    return mesh;
}

}  // namespace espalier::content
