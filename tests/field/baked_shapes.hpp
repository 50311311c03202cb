#pragma once

// Shapes of shapes.hpp as baked surfaces.

#include <doctest/doctest.h>

#include <array>
#include <map>

#include "runtime/field/field_texels.hpp"
#include "runtime/field/triangle_weights.hpp"
#include "tests/field/shapes.hpp"
#include "tools/bake/bake.hpp"

namespace espalier {

struct BakedShape {
    SurfaceData surface;
    FieldMesh mesh;
    std::vector<glm::vec3> places;  // of the model's vertices

    BakedShape(const std::vector<glm::dvec3>& corners, uint32_t resolution) {
        Model model;
        model.name = "shape";
        std::map<std::array<float, 3>, uint32_t> known;
        for (const glm::vec3 p : corners) {
            const auto [found, fresh] = known.try_emplace({p.x, p.y, p.z}, uint32_t(model.positions.size()));
            if (fresh) model.positions.push_back(p);
            model.indices.push_back(found->second);
        }
        places = model.positions;
        BakeOptions options;
        options.resolution = resolution;
        Result<Baked> baked = bake(model, options);
        REQUIRE(baked);
        surface = std::move(baked->surface);
        mesh = makeFieldMesh(surface);
    }

    // Calls fn(index, place, normal) for each texel whose middle lies on a triangle.
    template <class Fn>
    void eachTexel(Fn&& fn) const {
        const SurfaceLevelData& level = surface.levels[0];
        for (uint32_t y = 0; y < level.size; ++y)
            for (uint32_t x = 0; x < level.size; ++x) {
                const size_t index = texelIndex(level.size, x, y);
                const uint32_t triangle = level.aux[index].triangle;
                if (triangle == kNoIndex || mesh.triangleOf[triangle] == kNoIndex) continue;
                const TrianglePlane& plane = surface.triangles[triangle];
                const glm::vec2 uv = (glm::vec2(x, y) + .5f) / float(level.size);
                const std::array<double, 3> weights = weightsAt(plane, uv, 1e9);
                if (std::ranges::any_of(weights, [](double w) { return w < 0; })) continue;
                const glm::dvec3 across = glm::cross(glm::dvec3(plane.du), glm::dvec3(plane.dv));
                fn(index, glm::dvec3(placeOn(plane, uv)),
                   glm::normalize(across) * double(surface.charts[plane.chart].orientation));
            }
    }
};

// The angle in degrees between a direction and what a formula says of the place, both laid into the surface. Of a field
// of lines, directions that point apart are the same.
inline double degreesOff(const glm::dvec3& direction, const glm::dvec3& formula, const glm::dvec3& normal, bool lines) {
    const auto laid = [&](const glm::dvec3& v) { return glm::normalize(v - normal * glm::dot(v, normal)); };
    const glm::dvec3 a = laid(direction), b = laid(formula);
    const double cosine = lines ? std::abs(glm::dot(a, b)) : glm::dot(a, b);
    return std::atan2(glm::length(glm::cross(a, b)), cosine) * 180 / std::numbers::pi;
}

}  // namespace espalier
