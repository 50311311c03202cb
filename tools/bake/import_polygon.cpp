// In: a polygon's corners. Out: triangles that fill it, by cutting ears in its mean plane (Newell's normal).
#include "tools/bake/import.hpp"

namespace espalier::import {
namespace {

// Ears of larger polygons would be looked for too long; they are cut as fans.
constexpr size_t kMaxCorners = 1024;

double cross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Corners laid into their mean plane, counter-clockwise.
std::vector<glm::dvec2> flatten(const std::vector<glm::vec3>& positions, std::span<const uint32_t> polygon) {
    glm::dvec3 normal(0), origin(positions[polygon[0]]);
    for (size_t i = 0; i < polygon.size(); ++i) {
        glm::dvec3 a = glm::dvec3(positions[polygon[i]]) - origin;
        glm::dvec3 b = glm::dvec3(positions[polygon[(i + 1) % polygon.size()]]) - origin;
        normal += glm::cross(a, b);
    }
    glm::dvec3 size = glm::abs(normal);
    int k = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;  // the axis to drop
    int u = (k + 1) % 3, v = (k + 2) % 3;
    if (normal[k] < 0) std::swap(u, v);
    std::vector<glm::dvec2> out;
    for (uint32_t i : polygon) out.push_back({positions[i][u], positions[i][v]});
    return out;
}

bool isEar(const std::vector<glm::dvec2>& flat, const std::vector<uint32_t>& left, size_t i) {
    size_t n = left.size();
    uint32_t a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
    if (!(cross(flat[a], flat[b], flat[c]) > 0)) return false;
    for (uint32_t p : left) {
        if (p == a || p == b || p == c || flat[p] == flat[a] || flat[p] == flat[b] || flat[p] == flat[c]) continue;
        if (cross(flat[a], flat[b], flat[p]) >= 0 && cross(flat[b], flat[c], flat[p]) >= 0 &&
            cross(flat[c], flat[a], flat[p]) >= 0)
            return false;
    }
    return true;
}

}  // namespace

void triangulate(const std::vector<glm::vec3>& positions, std::span<const uint32_t> polygon,
                 std::vector<uint32_t>& triangles) {
    size_t n = polygon.size();
    auto emit = [&](uint32_t a, uint32_t b, uint32_t c) {
        triangles.insert(triangles.end(), {polygon[a], polygon[b], polygon[c]});
    };
    if (n <= 3 || n > kMaxCorners) {
        for (uint32_t i = 2; i < n; ++i) emit(0, i - 1, i);
        return;
    }
    std::vector<glm::dvec2> flat = flatten(positions, polygon);
    std::vector<uint32_t> left(n);
    for (uint32_t i = 0; i < n; ++i) left[i] = i;
    size_t at = 0;
    while (left.size() > 3) {
        // Where nothing is an ear (the outline crosses itself), some corner is cut all the same.
        size_t tries = 0;
        while (tries < left.size() && !isEar(flat, left, at % left.size())) ++at, ++tries;
        size_t i = at % left.size(), m = left.size();
        emit(left[(i + m - 1) % m], left[i], left[(i + 1) % m]);
        left.erase(left.begin() + long(i));
    }
    emit(left[0], left[1], left[2]);
}

}  // namespace espalier::import
