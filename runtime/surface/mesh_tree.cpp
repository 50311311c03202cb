// A mesh's triangles in -> first hit of a ray, nearest point of a place.
// Built top down by the middle of the longest axis of the centres; leaves hold up to four triangles. The depth is
// at most log2(triangles), since each split halves, so that a small fixed stack does for the search.
#include "runtime/surface/mesh_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace espalier {
namespace {

constexpr uint32_t kLeafTriangles = 4;
constexpr uint32_t kStack = 64;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Where the ray enters the box, or infinity. A NaN from 0 * inf loses every comparison below, as it should.
float enterBox(glm::vec3 low, glm::vec3 high, glm::vec3 origin, glm::vec3 inverse, float limit) {
    float from = 0, to = limit;
    for (int i = 0; i < 3; ++i) {
        float t0 = (low[i] - origin[i]) * inverse[i];
        float t1 = (high[i] - origin[i]) * inverse[i];
        if (t0 > t1) std::swap(t0, t1);
        from = t0 > from ? t0 : from;
        to = t1 < to ? t1 : to;
    }
    return from <= to * 1.000001f ? from : kInfinity;
}

float distanceSquared(glm::vec3 low, glm::vec3 high, glm::vec3 point) {
    const glm::vec3 d = glm::max(glm::max(low - point, point - high), glm::vec3(0));
    return glm::dot(d, d);
}

// Weights of the point of triangle (0, ab, ac) nearest to `p`, by the region of the plane that p lies in.
glm::vec2 nearestWeights(glm::vec3 ab, glm::vec3 ac, glm::vec3 p) {
    const float d1 = glm::dot(ab, p), d2 = glm::dot(ac, p);
    if (d1 <= 0 && d2 <= 0) return {0, 0};
    const glm::vec3 bp = p - ab;
    const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return {1, 0};
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
    const glm::vec3 cp = p - ac;
    const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return {0, 1};
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {1 - w, w};
    }
    const float sum = va + vb + vc;
    if (!(sum > 0)) return {0, 0};
    return {vb / sum, vc / sum};
}

}  // namespace

MeshTree::MeshTree(std::span<const glm::vec3> positions, std::span<const uint32_t> indices) {
    const uint32_t count = uint32_t(indices.size() / 3);
    if (count == 0) return;
    struct Item {
        glm::vec3 centre;
        uint32_t triangle;
    };
    std::vector<Item> order(count);
    for (uint32_t i = 0; i < count; ++i)
        order[i] = {(positions[indices[3 * i]] + positions[indices[3 * i + 1]] + positions[indices[3 * i + 2]]) / 3.f,
                    i};

    nodes_.reserve(count);
    nodes_.push_back({});
    struct Piece {
        uint32_t node, begin, end;
    };
    std::vector<Piece> open{{0, 0, count}};
    while (!open.empty()) {
        const Piece piece = open.back();
        open.pop_back();
        Node& node = nodes_[piece.node];
        node = {glm::vec3(kInfinity), glm::vec3(-kInfinity), piece.begin, piece.end - piece.begin};
        if (node.count <= kLeafTriangles) {
            for (uint32_t i = piece.begin; i < piece.end; ++i)
                for (uint32_t k = 0; k < 3; ++k) {
                    const glm::vec3 p = positions[indices[3 * order[i].triangle + k]];
                    node.low = glm::min(node.low, p);
                    node.high = glm::max(node.high, p);
                }
            continue;
        }
        glm::vec3 low(kInfinity), high(-kInfinity);
        for (uint32_t i = piece.begin; i < piece.end; ++i) {
            low = glm::min(low, order[i].centre);
            high = glm::max(high, order[i].centre);
        }
        const glm::vec3 size = high - low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const uint32_t middle = (piece.begin + piece.end) / 2;
        std::nth_element(order.begin() + piece.begin, order.begin() + middle, order.begin() + piece.end,
                         [&](const Item& a, const Item& b) { return a.centre[axis] < b.centre[axis]; });
        const uint32_t first = uint32_t(nodes_.size());
        node.first = first;
        node.count = 0;
        nodes_.resize(nodes_.size() + 2);
        open.push_back({first, piece.begin, middle});
        open.push_back({first + 1, middle, piece.end});
    }
    // Children come after their parents.
    for (size_t i = nodes_.size(); i-- > 0;) {
        Node& node = nodes_[i];
        if (node.count > 0) continue;
        const Node &a = nodes_[node.first], &b = nodes_[node.first + 1];
        node.low = glm::min(a.low, b.low);
        node.high = glm::max(a.high, b.high);
    }

    triangles_.reserve(count);
    for (const Item& item : order) {
        const uint32_t i = item.triangle;
        const glm::vec3 a = positions[indices[3 * i]];
        triangles_.push_back({a, positions[indices[3 * i + 1]] - a, positions[indices[3 * i + 2]] - a, i});
    }
}

std::optional<MeshHit> MeshTree::pick(glm::vec3 origin, glm::vec3 direction, float limit) const {
    if (nodes_.empty()) return std::nullopt;
    const glm::vec3 inverse = 1.f / direction;
    std::optional<MeshHit> best;
    float reach = limit;
    uint32_t stack[kStack], top = 0;
    stack[top++] = 0;
    while (top) {
        const Node& node = nodes_[stack[--top]];
        if (enterBox(node.low, node.high, origin, inverse, reach) == kInfinity) continue;
        for (uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Triangle& t = triangles_[i];
            const glm::vec3 p = glm::cross(direction, t.ac);
            const float det = glm::dot(t.ab, p);
            if (det == 0) continue;
            const glm::vec3 s = origin - t.a;
            const float u = glm::dot(s, p) / det;
            const glm::vec3 q = glm::cross(s, t.ab);
            const float v = glm::dot(direction, q) / det;
            const float d = glm::dot(t.ac, q) / det;
            // Written so that NaN is no hit.
            if (!(u >= 0 && v >= 0 && u + v <= 1 && d >= 0 && d < reach)) continue;
            reach = d;
            best = MeshHit{t.index, {u, v}, t.a + u * t.ab + v * t.ac, d};
        }
        if (node.count == 0) {
            const Node& left = nodes_[node.first];
            const Node& right = nodes_[node.first + 1];
            const bool leftFirst = enterBox(left.low, left.high, origin, inverse, reach) <=
                                   enterBox(right.low, right.high, origin, inverse, reach);
            stack[top++] = node.first + (leftFirst ? 1 : 0);
            stack[top++] = node.first + (leftFirst ? 0 : 1);
        }
    }
    return best;
}

std::optional<MeshHit> MeshTree::nearest(glm::vec3 point, float limit, float enough) const {
    if (nodes_.empty()) return std::nullopt;
    std::optional<MeshHit> best;
    float reach = limit * limit;
    uint32_t stack[kStack], top = 0;
    stack[top++] = 0;
    while (top) {
        const Node& node = nodes_[stack[--top]];
        if (!(distanceSquared(node.low, node.high, point) < reach)) continue;
        for (uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Triangle& t = triangles_[i];
            const glm::vec2 w = nearestWeights(t.ab, t.ac, point - t.a);
            const glm::vec3 on = t.a + w.x * t.ab + w.y * t.ac;
            const glm::vec3 gap = point - on;
            const float d = glm::dot(gap, gap);
            if (!(d < reach)) continue;
            reach = d;
            best = MeshHit{t.index, w, on, std::sqrt(d)};
            if (best->distance <= enough) return best;
        }
        if (node.count == 0) {
            const Node& left = nodes_[node.first];
            const Node& right = nodes_[node.first + 1];
            const bool leftFirst =
                distanceSquared(left.low, left.high, point) <= distanceSquared(right.low, right.high, point);
            stack[top++] = node.first + (leftFirst ? 1 : 0);
            stack[top++] = node.first + (leftFirst ? 0 : 1);
        }
    }
    return best;
}

}  // namespace espalier
