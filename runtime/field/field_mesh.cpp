// In: a surface's triangles, each with corners of its own. Out: a manifold mesh with half-edges and angles.
#include "runtime/field/field_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "shaders/shared/random.h"

namespace espalier {
namespace {

using glm::dvec3;

constexpr double kWeld = 1e-6;  // of the radius
constexpr double kTwoPi = 2 * std::numbers::pi;

double radiusOf(const std::vector<dvec3>& corners) {
    dvec3 low(1e300), high(-1e300);
    for (const dvec3& p : corners) low = glm::min(low, p), high = glm::max(high, p);
    return corners.empty() ? 0 : glm::length(high - low) / 2;
}

// [corner]: a number that corners at one place share. Each place is looked up in the eight cells that may hold it.
std::vector<uint32_t> weld(const std::vector<dvec3>& corners, double distance, std::vector<dvec3>& places) {
    const double cell = 4 * std::max(distance, 1e-300);
    std::unordered_multimap<uint64_t, uint32_t> cells;
    const auto keyOf = [](glm::i64vec3 c) {
        return mix64(uint64_t(c.x) + mix64(uint64_t(c.y) + mix64(uint64_t(c.z))));
    };
    std::vector<uint32_t> of;
    of.reserve(corners.size());
    for (const dvec3& p : corners) {
        const glm::i64vec3 low(glm::floor((p - distance) / cell)), high(glm::floor((p + distance) / cell));
        uint32_t found = kNoIndex;
        for (int64_t x = low.x; x <= high.x; ++x)
            for (int64_t y = low.y; y <= high.y; ++y)
                for (int64_t z = low.z; z <= high.z; ++z) {
                    const auto [begin, end] = cells.equal_range(keyOf({x, y, z}));
                    for (auto it = begin; it != end; ++it)
                        if (glm::length(places[it->second] - p) <= distance) found = std::min(found, it->second);
                }
        if (found == kNoIndex) {
            found = uint32_t(places.size());
            places.push_back(p);
            cells.emplace(keyOf(glm::i64vec3(glm::floor(p / cell))), found);
        }
        of.push_back(found);
    }
    return of;
}

// Half-edges that run against each other. A third triangle at an edge gets a border there.
void pairEdges(FieldMesh& mesh) {
    mesh.twin.assign(mesh.triangles.size() * 3, kNoIndex);
    std::unordered_map<uint64_t, uint32_t> open;
    const auto keyOf = [](uint32_t a, uint32_t b) { return uint64_t(a) << 32 | b; };
    for (uint32_t h = 0; h < mesh.twin.size(); ++h) {
        const uint32_t a = mesh.from(h), b = mesh.to(h);
        if (const auto other = open.find(keyOf(b, a)); other != open.end()) {
            mesh.twin[h] = other->second;
            mesh.twin[other->second] = h;
            open.erase(other);
        } else {
            open.emplace(keyOf(a, b), h);
        }
    }
}

// The half-edge that leaves the same vertex one corner further counterclockwise; kNoIndex at a border.
uint32_t nextAround(const FieldMesh& mesh, uint32_t halfEdge) {
    return mesh.twin[FieldMesh::previous(halfEdge)];
}
uint32_t previousAround(const FieldMesh& mesh, uint32_t halfEdge) {
    const uint32_t twin = mesh.twin[halfEdge];
    return twin == kNoIndex ? kNoIndex : FieldMesh::next(twin);
}

// Gives each fan of corners a vertex of its own.
void separateFans(FieldMesh& mesh) {
    const std::vector<dvec3> places = std::move(mesh.positions);
    mesh.positions.clear();
    std::vector<bool> seen(mesh.twin.size());
    for (uint32_t h = 0; h < mesh.twin.size(); ++h) {
        if (seen[h]) continue;
        const dvec3 place = places[mesh.from(h)];
        uint32_t begin = h;
        for (uint32_t before = previousAround(mesh, begin); before != kNoIndex && before != h;
             before = previousAround(mesh, begin))
            begin = before;
        const uint32_t vertex = uint32_t(mesh.positions.size());
        mesh.positions.push_back(place);
        mesh.first.push_back(begin);
        uint32_t last = kNoIndex;
        for (uint32_t around = begin; around != kNoIndex && !seen[around]; around = nextAround(mesh, around)) {
            seen[around] = true;
            last = around;
        }
        mesh.border.push_back(nextAround(mesh, last) == kNoIndex);
        for (uint32_t around = begin;; around = nextAround(mesh, around)) {
            mesh.triangles[around / 3][around % 3] = vertex;
            if (around == last) break;
        }
    }
}

double cornerAngle(const FieldMesh& mesh, uint32_t halfEdge) {
    const dvec3 at = mesh.positions[mesh.from(halfEdge)];
    const dvec3 a = mesh.positions[mesh.to(halfEdge)] - at;
    const dvec3 b = mesh.positions[mesh.from(FieldMesh::previous(halfEdge))] - at;
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// Of the angle that lies opposite to a half-edge.
double cotangent(const FieldMesh& mesh, uint32_t halfEdge) {
    const dvec3 at = mesh.positions[mesh.from(FieldMesh::previous(halfEdge))];
    const dvec3 a = mesh.positions[mesh.from(halfEdge)] - at, b = mesh.positions[mesh.to(halfEdge)] - at;
    const double sine = glm::length(glm::cross(a, b));
    return sine > 0 ? std::clamp(glm::dot(a, b) / sine, -20.0, 20.0) : 0;
}

void measureVertices(FieldMesh& mesh) {
    const size_t count = mesh.positions.size();
    mesh.normals.assign(count, dvec3(0));
    mesh.axes.assign(count, dvec3(0));
    mesh.areas.assign(count, 0);
    mesh.angle.assign(mesh.twin.size(), 0);
    for (uint32_t v = 0; v < count; ++v) {
        double sum = 0;
        uint32_t h = mesh.first[v];
        do {
            const dvec3 at = mesh.positions[v];
            const dvec3 across =
                glm::cross(mesh.positions[mesh.to(h)] - at, mesh.positions[mesh.from(FieldMesh::previous(h))] - at);
            const double tip = cornerAngle(mesh, h), area = glm::length(across) / 2;
            mesh.angle[h] = sum;
            sum += tip;
            mesh.areas[v] += area / 3;
            if (area > 0) mesh.normals[v] += across * (tip / (2 * area));
            h = nextAround(mesh, h);
        } while (h != kNoIndex && h != mesh.first[v]);
        const double length = glm::length(mesh.normals[v]);
        mesh.normals[v] = length > 0 ? mesh.normals[v] / length : dvec3(0, 1, 0);
        const double scale = !mesh.border[v] && sum > 0 ? kTwoPi / sum : 1;
        h = mesh.first[v];
        do {
            mesh.angle[h] *= scale;
            h = nextAround(mesh, h);
        } while (h != kNoIndex && h != mesh.first[v]);
        dvec3 axis = mesh.positions[mesh.to(mesh.first[v])] - mesh.positions[v];
        axis -= mesh.normals[v] * glm::dot(axis, mesh.normals[v]);
        if (!(glm::length(axis) > 1e-12 * mesh.radius)) {
            const dvec3 n = mesh.normals[v];
            axis = glm::cross(n, std::abs(n.x) < .5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0));
        }
        mesh.axes[v] = glm::normalize(axis);
    }
}

// corners: three a triangle, without degenerate ones.
void finish(FieldMesh& mesh, const std::vector<dvec3>& corners) {
    mesh.radius = radiusOf(corners);
    const std::vector<uint32_t> of = weld(corners, kWeld * mesh.radius, mesh.positions);
    std::vector<std::array<uint8_t, 3>> cornerOf;
    std::vector<uint32_t> kept(corners.size() / 3, kNoIndex);
    for (uint32_t t = 0; t < kept.size(); ++t) {
        const std::array<uint32_t, 3> triangle{of[3 * t], of[3 * t + 1], of[3 * t + 2]};
        if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
        kept[t] = uint32_t(mesh.triangles.size());
        mesh.triangles.push_back(triangle);
        if (!mesh.cornerOf.empty()) cornerOf.push_back(mesh.cornerOf[t]);
    }
    mesh.cornerOf = std::move(cornerOf);
    for (uint32_t& t : mesh.triangleOf)
        if (t != kNoIndex) t = kept[t];
    pairEdges(mesh);
    separateFans(mesh);
    measureVertices(mesh);
}

}  // namespace

double FieldMesh::transport(uint32_t halfEdge) const {
    const uint32_t other = twin[halfEdge];
    if (other != kNoIndex) return angle[other] + std::numbers::pi - angle[halfEdge];
    // Of a border: the edge arrives one corner further around than the next half-edge leaves.
    const uint32_t leaving = next(halfEdge);
    return angle[leaving] + cornerAngle(*this, leaving) + std::numbers::pi - angle[halfEdge];
}

double FieldMesh::tip(uint32_t halfEdge) const {
    const uint32_t after = nextAround(*this, halfEdge);
    if (after == kNoIndex) return cornerAngle(*this, halfEdge);
    return angle[after] - angle[halfEdge] + (after == first[from(halfEdge)] ? kTwoPi : 0);
}

double FieldMesh::curvature(uint32_t triangle) const {
    return tip(3 * triangle) + tip(3 * triangle + 1) + tip(3 * triangle + 2) - std::numbers::pi;
}

double FieldMesh::edgeWeight(uint32_t halfEdge) const {
    const double both =
        cotangent(*this, halfEdge) + (twin[halfEdge] != kNoIndex ? cotangent(*this, twin[halfEdge]) : 0);
    return std::max(both / 2, .02);
}

glm::dvec3 FieldMesh::direction(uint32_t vertex, double of) const {
    return axes[vertex] * std::cos(of) + glm::cross(normals[vertex], axes[vertex]) * std::sin(of);
}

double FieldMesh::angleOf(uint32_t vertex, const glm::dvec3& direction) const {
    return std::atan2(glm::dot(direction, glm::cross(normals[vertex], axes[vertex])),
                      glm::dot(direction, axes[vertex]));
}

int FieldMesh::eulerCharacteristic() const {
    size_t edges = 0;
    for (uint32_t h = 0; h < twin.size(); ++h) edges += ownsEdge(h);
    return int(positions.size()) - int(edges) + int(triangles.size());
}

FieldMesh makeFieldMesh(std::vector<glm::dvec3> corners) {
    FieldMesh mesh;
    finish(mesh, corners);
    return mesh;
}

FieldMesh makeFieldMesh(const SurfaceData& surface) {
    FieldMesh mesh;
    std::vector<dvec3> corners;
    mesh.triangleOf.assign(surface.triangles.size(), kNoIndex);
    for (size_t t = 0; t < surface.triangles.size(); ++t) {
        const TrianglePlane& plane = surface.triangles[t];
        const float orientation = surface.charts[plane.chart].orientation;
        const dvec3 outside = dvec3(glm::cross(plane.du, plane.dv)) * double(orientation);
        std::array<dvec3, 3> p{dvec3(placeOn(plane, plane.uv0)), dvec3(placeOn(plane, plane.uv1)),
                               dvec3(placeOn(plane, plane.uv2))};
        const dvec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
        if (!(glm::length(across) > 0) || !std::isfinite(glm::length(across))) continue;
        const bool turned = glm::dot(across, outside) < 0;
        if (turned) std::swap(p[1], p[2]);
        mesh.triangleOf[t] = uint32_t(corners.size() / 3);
        mesh.cornerOf.push_back(turned ? std::array<uint8_t, 3>{0, 2, 1} : std::array<uint8_t, 3>{0, 1, 2});
        corners.insert(corners.end(), p.begin(), p.end());
    }
    finish(mesh, corners);
    return mesh;
}

}  // namespace espalier
