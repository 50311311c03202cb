// Boxes, quads and turned bodies. In: corners, rings. Out: triangles in one mesh.

#include "tools/content/builder.hpp"

#include <cmath>

#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {

using glm::vec3;

void Builder::quad(vec3 a, vec3 b, vec3 c, vec3 d, Paint paint, float bright) {
    const vec3 n = glm::normalize(glm::cross(c - a, d - b));
    const uint32_t first = uint32_t(mesh.positions.size());
    for (vec3 p : {a, b, c, d}) {
        mesh.positions.push_back(p);
        mesh.normals.push_back(n);
        mesh.uvs.push_back(paletteUv(paint, bright));
    }
    for (uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + k);
}

void Builder::triangle(vec3 a, vec3 b, vec3 c, Paint paint, float bright) {
    const vec3 n = glm::normalize(glm::cross(b - a, c - a));
    for (vec3 p : {a, b, c}) {
        mesh.indices.push_back(uint32_t(mesh.positions.size()));
        mesh.positions.push_back(p);
        mesh.normals.push_back(n);
        mesh.uvs.push_back(paletteUv(paint, bright));
    }
}

void Builder::box(vec3 low, vec3 high, Paint paint, float bright, float taper) {
    const auto at = [&](int x, int y, int z) {
        const float in = y ? taper : 0;
        return vec3(x ? high.x - in : low.x + in, y ? high.y : low.y, z ? high.z - in : low.z + in);
    };
    quad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1), paint, bright);
    quad(at(1, 0, 0), at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), paint, bright);
    quad(at(1, 0, 1), at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), paint, bright);
    quad(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0), paint, bright);
    quad(at(0, 1, 1), at(1, 1, 1), at(1, 1, 0), at(0, 1, 0), paint, bright * 1.04f);
}

void Builder::turn(const Axis& axis, std::span<const Ring> rings, int sides, Paint paint, float bright, float uneven) {
    const vec3 across = glm::cross(axis.side, axis.along);
    const auto out = [&](int s) {
        const float a = 2 * kPi * float(s) / float(sides);
        return axis.side * std::cos(a) + across * std::sin(a);
    };
    for (size_t r = 0; r + 1 < rings.size(); ++r) {
        const Ring low = rings[r], high = rings[r + 1];
        const glm::vec2 slope = glm::normalize(glm::vec2(high.height - low.height, low.radius - high.radius));
        for (int s = 0; s < sides; ++s) {
            const float shade = bright * (1 + uneven * (random01(uint32_t(s), uint32_t(sides), 77) - 0.5f));
            const uint32_t first = uint32_t(mesh.positions.size());
            const auto corner = [&](int side, Ring ring) {
                mesh.positions.push_back(axis.foot + axis.along * ring.height + out(side) * ring.radius);
                mesh.normals.push_back(glm::normalize(out(side) * slope.x + axis.along * slope.y));
                mesh.uvs.push_back(paletteUv(paint, shade));
            };
            corner(s + 1, low);
            corner(s, low);
            corner(s, high);
            corner(s + 1, high);
            if (low.radius > 0)
                for (uint32_t k : {0u, 1u, 2u}) mesh.indices.push_back(first + k);
            if (high.radius > 0)
                for (uint32_t k : {0u, 2u, 3u}) mesh.indices.push_back(first + k);
        }
    }
}

void Builder::pole(vec3 from, vec3 to, float radius, int sides, Paint paint, float bright) {
    const float length = glm::distance(from, to);
    const vec3 along = (to - from) / length;
    const vec3 side = glm::normalize(glm::cross(along, std::abs(along.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0)));
    turn({from, along, side}, {{radius, 0}, {radius, length}, {0, length}}, sides, paint, bright);
}

}  // namespace espalier::content
