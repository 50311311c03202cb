// In: a triangle list. Out: signed distances to it. Triangles lie in a tree of boxes that is split at the median of the
// longest side; a query goes into the nearer child first and leaves out boxes that are farther than what it has.
#include "tests/fidelity/signed_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace espalier::fidelitytest {
namespace {

using Vec3 = glm::dvec3;

constexpr uint32_t kLeafTriangles = 4;

// Nearest point of a triangle, and on what it lies: 0 the face, 1 to 3 edges, 4 to 6 corners.
struct Nearest {
    Vec3 point;
    int feature;
};

Nearest onEdge(Vec3 p, Vec3 a, Vec3 b, int edge) {
    const double t = glm::dot(p - a, b - a) / glm::dot(b - a, b - a);
    if (t <= 0) return {a, 4 + edge};
    if (t >= 1) return {b, 4 + (edge + 1) % 3};
    return {a + (b - a) * t, 1 + edge};
}

Nearest onTriangle(Vec3 p, const std::array<Vec3, 3>& corner, Vec3 face) {
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
        const Vec3 a = corner[size_t(k)], b = corner[size_t(k + 1) % 3];
        inside = inside && glm::dot(glm::cross(face, b - a), p - a) >= 0;
    }
    if (inside) return {p - face * glm::dot(face, p - corner[0]), 0};
    Nearest best{};
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const Nearest n = onEdge(p, corner[size_t(k)], corner[size_t(k + 1) % 3], k);
        const double d = glm::dot(p - n.point, p - n.point);
        if (d < least) {
            least = d;
            best = n;
        }
    }
    return best;
}

}  // namespace

SignedDistance::SignedDistance(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices) {
    std::map<std::array<float, 3>, uint32_t> welds;
    std::map<std::pair<uint32_t, uint32_t>, Vec3> edges;
    std::vector<std::array<uint32_t, 3>> welded;
    std::vector<Vec3> vertices;
    auto edgeOf = [](uint32_t a, uint32_t b) { return std::pair(std::min(a, b), std::max(a, b)); };
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        Triangle t;
        std::array<uint32_t, 3> id;
        for (size_t k = 0; k < 3; ++k) {
            const glm::vec3 p = positions[indices[i + k]];
            id[k] = welds.try_emplace({p.x, p.y, p.z}, uint32_t(welds.size())).first->second;
            t.corner[k] = Vec3(p);
        }
        const Vec3 cross = glm::cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
        if (!(glm::length(cross) > 0)) continue;
        t.face = glm::normalize(cross);
        vertices.resize(welds.size(), Vec3(0));
        for (size_t k = 0; k < 3; ++k) {
            const Vec3 a = glm::normalize(t.corner[(k + 1) % 3] - t.corner[k]);
            const Vec3 b = glm::normalize(t.corner[(k + 2) % 3] - t.corner[k]);
            vertices[id[k]] += t.face * std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
            edges.try_emplace(edgeOf(id[k], id[(k + 1) % 3]), Vec3(0)).first->second += t.face;
        }
        triangles_.push_back(t);
        welded.push_back(id);
    }
    for (size_t i = 0; i < triangles_.size(); ++i)
        for (size_t k = 0; k < 3; ++k) {
            triangles_[i].edge[k] = edges.at(edgeOf(welded[i][k], welded[i][(k + 1) % 3]));
            triangles_[i].vertex[k] = vertices[welded[i][k]];
        }
    if (!triangles_.empty()) build(0, uint32_t(triangles_.size()));
}

uint32_t SignedDistance::build(uint32_t first, uint32_t count) {
    const uint32_t at = uint32_t(boxes_.size());
    Box box{Vec3(1e300), Vec3(-1e300), first, count};
    for (uint32_t i = first; i < first + count; ++i)
        for (const Vec3& p : triangles_[i].corner) {
            box.low = glm::min(box.low, p);
            box.high = glm::max(box.high, p);
        }
    boxes_.push_back(box);
    if (count <= kLeafTriangles) return at;
    const Vec3 size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t half = count / 2;
    auto middle = [axis](const Triangle& t) { return t.corner[0][axis] + t.corner[1][axis] + t.corner[2][axis]; };
    std::nth_element(triangles_.begin() + first, triangles_.begin() + first + half, triangles_.begin() + first + count,
                     [&](const Triangle& a, const Triangle& b) { return middle(a) < middle(b); });
    build(first, half);  // lies directly behind its parent
    boxes_[at].first = build(first + half, count - half);
    boxes_[at].count = 0;
    return at;
}

double SignedDistance::square(const Box& box, Vec3 point) const {
    const Vec3 d = glm::max(glm::max(box.low - point, point - box.high), Vec3(0));
    return glm::dot(d, d);
}

double SignedDistance::at(Vec3 point) const {
    double least = std::numeric_limits<double>::infinity();
    double sign = 1;
    std::array<uint32_t, 128> stack;
    size_t depth = 0;
    if (!boxes_.empty()) stack[depth++] = 0;
    while (depth > 0) {
        const uint32_t i = stack[--depth];
        const Box& box = boxes_[i];
        if (square(box, point) >= least) continue;
        if (box.count == 0) {
            uint32_t near = i + 1, far = box.first;
            if (square(boxes_[far], point) < square(boxes_[near], point)) std::swap(near, far);
            stack[depth++] = far;
            stack[depth++] = near;
            continue;
        }
        for (uint32_t k = box.first; k < box.first + box.count; ++k) {
            const Triangle& t = triangles_[k];
            const Nearest n = onTriangle(point, t.corner, t.face);
            const double d = glm::dot(point - n.point, point - n.point);
            if (d >= least) continue;
            least = d;
            const Vec3 outward = n.feature == 0  ? t.face
                                 : n.feature < 4 ? t.edge[size_t(n.feature - 1)]
                                                 : t.vertex[size_t(n.feature - 4)];
            sign = glm::dot(point - n.point, outward) < 0 ? -1 : 1;
        }
    }
    return sign * std::sqrt(least);
}

}  // namespace espalier::fidelitytest
