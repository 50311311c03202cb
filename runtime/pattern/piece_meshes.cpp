// Triangles in runs of eight that lie near each other, each run within a sphere.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "runtime/pattern/pattern_data.hpp"
#include "runtime/surface/triangle_distance.hpp"

namespace espalier {
namespace {

using Corner = std::array<vec3, 3>;

vec3 middleOf(const Corner& t) {
    return (t[0] + t[1] + t[2]) / 3.0f;
}

// Halves along the longest side until a run is left.
void sortNear(std::span<Corner> triangles) {
    if (triangles.size() <= kClusterTriangles) return;
    vec3 low(1e30f), high(-1e30f);
    for (const Corner& t : triangles) low = glm::min(low, middleOf(t)), high = glm::max(high, middleOf(t));
    const vec3 side = high - low;
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    // Whole runs on both sides.
    const size_t runs = (triangles.size() + kClusterTriangles - 1) / kClusterTriangles;
    const size_t half = runs / 2 * kClusterTriangles;
    std::nth_element(triangles.begin(), triangles.begin() + half, triangles.end(),
                     [&](const Corner& a, const Corner& b) { return middleOf(a)[axis] < middleOf(b)[axis]; });
    sortNear(triangles.first(half));
    sortNear(triangles.subspan(half));
}

vec4 sphereAround(std::span<const Corner> triangles) {
    vec3 low(1e30f), high(-1e30f);
    for (const Corner& t : triangles)
        for (const vec3& p : t) low = glm::min(low, p), high = glm::max(high, p);
    const vec3 centre = (low + high) * .5f;
    float radius = 0;
    for (const Corner& t : triangles)
        for (const vec3& p : t) radius = std::max(radius, glm::length(p - centre));
    return {centre.x, centre.y, centre.z, radius * 1.00001f};
}

// Whether each edge between two places is run along as often in one direction as in the other.
bool isClosed(std::span<const Corner> triangles) {
    std::map<std::array<float, 6>, int> edges;
    for (const Corner& t : triangles)
        for (int k = 0; k < 3; ++k) {
            const vec3 &a = t[k], &b = t[(k + 1) % 3];
            ++edges[{a.x, a.y, a.z, b.x, b.y, b.z}];
            --edges[{b.x, b.y, b.z, a.x, a.y, a.z}];
        }
    return !triangles.empty() && std::ranges::all_of(edges, [](const auto& e) { return e.second == 0; });
}

// In the middle between a triangle and what lies behind it.
vec3 middleBehind(std::span<const Corner> triangles, const Corner& front) {
    const auto across = [](const Corner& t) { return glm::cross(t[1] - t[0], t[2] - t[0]); };
    const vec3 from = middleOf(front), inward = -glm::normalize(across(front));
    float behind = 1e30f;
    for (const Corner& t : triangles) {
        const vec3 n = across(t);
        const float towards = glm::dot(n, inward), at = glm::dot(n, t[0] - from) / towards;
        if (&t == &front || !(std::abs(towards) > 0) || !(at > 0) || at >= behind) continue;
        const vec3 p = from + inward * at;
        const auto side = [&](int i) { return glm::dot(n, glm::cross(t[(i + 1) % 3] - t[i], p - t[i])) >= 0; };
        if (side(0) && side(1) && side(2)) behind = at;
    }
    return behind < 1e30f ? from + inward * (behind / 2) : from;
}

// A ball inside of a closed mesh: the largest of those whose middle is behind one of some sixty triangles.
vec4 ballWithin(std::span<const Corner> triangles) {
    constexpr size_t kMostTries = 64;
    vec4 largest(0);
    for (size_t i = 0; i < triangles.size(); i += 1 + triangles.size() / kMostTries) {
        const vec3 middle = middleBehind(triangles, triangles[i]);
        double radius = 1e30;
        for (const Corner& t : triangles) radius = std::min(radius, distanceToTriangle(middle, {t[0], t[1], t[2]}));
        if (float(radius) > largest.w) largest = vec4(middle, float(radius));
    }
    return largest;
}

}  // namespace

void PieceMeshes::add(std::span<const glm::vec3> positions, std::span<const uint32_t> indices) {
    std::vector<Corner> triangles;
    for (size_t i = 0; i + 2 < indices.size(); i += 3)
        triangles.push_back({positions[indices[i]], positions[indices[i + 1]], positions[indices[i + 2]]});
    sortNear(triangles);
    PatternMesh mesh = {};
    mesh.firstCluster = uint32_t(clusters.size());
    mesh.firstVertex = uint32_t(corners.size());
    mesh.triangleCount = uint32_t(triangles.size());
    for (size_t first = 0; first < triangles.size(); first += kClusterTriangles)
        clusters.push_back(sphereAround(
            std::span(triangles).subspan(first, std::min<size_t>(kClusterTriangles, triangles.size() - first))));
    mesh.clusterCount = uint32_t(clusters.size()) - mesh.firstCluster;
    const vec4 ball = isClosed(triangles) ? ballWithin(triangles) : vec4(0);
    mesh.within = vec3(ball);
    mesh.inner = ball.w * .9999f;
    const vec4 all = triangles.empty() ? vec4(0) : sphereAround(triangles);
    mesh.centre = vec3(all);
    mesh.radius = all.w;
    for (const Corner& t : triangles) corners.insert(corners.end(), t.begin(), t.end());
    std::vector<vec3> places(corners.begin() + mesh.firstVertex, corners.end());
    std::ranges::sort(places, {}, [](const vec3& p) { return std::tuple(p.x, p.y, p.z); });
    const auto repeated = std::ranges::unique(places);
    places.erase(repeated.begin(), repeated.end());
    corners.insert(corners.end(), places.begin(), places.end());
    mesh.placeCount = uint32_t(places.size());
    meshes.push_back(mesh);
}

}  // namespace espalier
