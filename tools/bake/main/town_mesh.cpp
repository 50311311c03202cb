// In: roof structures. Out: triangles.
#include "tools/bake/main/town_mesh.hpp"

#include <algorithm>
#include <array>

namespace espalier {
namespace {

constexpr uint32_t kRoofColour = 0xFF2A3F70;

glm::vec3 unitOf(glm::vec3 v) {
    const float l = glm::length(v);
    return l > 1e-12f ? v / l : glm::vec3(0, 1, 0);
}

// Newell's normal, twice the area long.
glm::vec3 newell(const std::vector<glm::vec3>& p) {
    glm::vec3 n(0);
    for (size_t i = 0; i < p.size(); ++i) n += glm::cross(p[i] - p[0], p[(i + 1) % p.size()] - p[0]);
    return n;
}

// Ears of a simple planar polygon.
void appendPolygon(std::vector<glm::vec3> p, uint32_t colour, RoofTriangles& out) {
    const glm::vec3 n = unitOf(newell(p));
    auto convex = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c) { return glm::dot(glm::cross(b - a, c - b), n); };
    auto add = [&](std::array<glm::vec3, 3> t) {
        for (glm::vec3 v : t) {
            out.indices.push_back(uint32_t(out.positions.size()));
            out.positions.push_back(v);
            out.normals.push_back(n);
            out.colours.push_back(colour);
        }
    };
    while (p.size() > 3) {
        size_t ear = p.size();
        for (size_t i = 0; i < p.size() && ear == p.size(); ++i) {
            const glm::vec3 a = p[(i + p.size() - 1) % p.size()], b = p[i], c = p[(i + 1) % p.size()];
            if (convex(a, b, c) <= 0) continue;
            bool empty = true;
            for (glm::vec3 q : p)
                empty = empty && (q == a || q == b || q == c || convex(a, b, q) < 0 || convex(b, c, q) < 0 ||
                                  convex(c, a, q) < 0);
            if (empty) ear = i;
        }
        if (ear == p.size()) {  // only needles are left
            p.erase(p.begin());
            continue;
        }
        add({p[(ear + p.size() - 1) % p.size()], p[ear], p[(ear + 1) % p.size()]});
        p.erase(p.begin() + std::ptrdiff_t(ear));
    }
    if (p.size() == 3) add({p[0], p[1], p[2]});
}

}  // namespace

void appendMassing(const RoofStructure& structure, uint32_t index, RoofTriangles& out) {
    const RoofHouse& house = structure.houses[index];
    for (const auto& ring : house.rings)
        for (size_t i = 0; i < ring.size() && !house.open; ++i) {
            const glm::vec2 a = ring[i], b = ring[(i + 1) % ring.size()];
            auto at = [&](glm::vec2 p, float y) { return glm::vec3(p.x, y, -p.y); };
            appendPolygon(
                {at(a, house.baseHeight), at(b, house.baseHeight), at(b, house.eaveHeight), at(a, house.eaveHeight)},
                kWallColour, out);
        }
    for (uint32_t f = house.firstFace; f < house.firstFace + house.faceCount; ++f) {
        const RoofFace& face = structure.faces[f];
        std::vector<glm::vec3> outline;
        auto add = [&](glm::vec3 p) {
            if (outline.empty() || outline.back() != p) outline.push_back(p);
        };
        if (!face.detached) add(face.eave[0]), add(face.eave[1]);
        for (uint32_t i = 0; i < face.segmentCount; ++i) add(structure.segments[face.firstSegment + i].to);
        while (outline.size() > 1 && outline.back() == outline.front()) outline.pop_back();
        appendPolygon(std::move(outline), face.kind == FaceKind::gable ? kWallColour : kRoofColour, out);
    }
}

}  // namespace espalier
