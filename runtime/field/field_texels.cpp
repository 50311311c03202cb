// Each texel lies on a triangle (of a gutter texel, on its plane carried on). The directions at the triangle's corners
// are laid into its plane, by the least rotation that takes the corner's normal to the triangle's, and mixed as N-th
// powers.
#include "runtime/field/field_texels.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/core/jobs.hpp"
#include "runtime/field/triangle_weights.hpp"

namespace espalier {
namespace {

using glm::dvec3;
using Complex = std::complex<double>;

// A tangent under one normal, turned by the least rotation to lie under another.
dvec3 laid(const dvec3& direction, const dvec3& from, const dvec3& to) {
    const double k = glm::dot(to, direction) / std::max(1 + glm::dot(from, to), 1e-3);
    return direction - (from + to) * k;
}

Complex powerOf(Complex direction, uint32_t symmetry) {
    Complex power = direction;
    for (uint32_t i = 1; i < symmetry; ++i) power *= direction;
    return power;
}

// The direction whose N-th power this is, that of the least angle. Most fields have an N whose roots need no angles.
Complex rootOf(Complex power, uint32_t symmetry) {
    const double length = std::abs(power);
    if (!(length > 0)) return 1;
    Complex root = power / length;
    for (; symmetry % 2 == 0; symmetry /= 2)
        root = {std::sqrt(std::max((1 + root.real()) / 2, 0.0)),
                std::copysign(std::sqrt(std::max((1 - root.real()) / 2, 0.0)), root.imag())};
    return symmetry == 1 ? root : std::polar(1.0, std::arg(root) / symmetry);
}

}  // namespace

FieldSampling::FieldSampling(const SurfaceData& surface, const FieldMesh& mesh)
    : surface_(surface), mesh_(mesh), planes_(surface.triangles.size()) {
    parallelFor(planes_.size(), 1024, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const TrianglePlane& plane = surface.triangles[i];
            if (mesh.triangleOf[i] == kNoIndex) continue;
            const dvec3 normal =
                glm::normalize(dvec3(glm::cross(plane.du, plane.dv))) * double(surface.charts[plane.chart].orientation);
            const dvec3 axis = glm::normalize(dvec3(plane.du)), left = glm::cross(normal, axis);
            planes_[i] = {axis, left, {}};
            for (uint32_t k = 0; k < 3; ++k) {
                const uint32_t v = mesh.triangles[mesh.triangleOf[i]][k];
                const dvec3 there = laid(mesh.axes[v], mesh.normals[v], normal);
                const Complex turn(glm::dot(there, axis), glm::dot(there, left));
                planes_[i].corners[k] = std::abs(turn) > 0 ? turn / std::abs(turn) : 1;
            }
        }
    });
}

std::vector<FieldTexel> FieldSampling::texels(const Field& field) const {
    // [triangle of the mesh][corner]: the corner's N-th power in the triangle's plane.
    std::vector<std::array<Complex, 3>> corners(mesh_.triangles.size());
    parallelFor(planes_.size(), 1024, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            if (const uint32_t t = mesh_.triangleOf[i]; t != kNoIndex)
                for (uint32_t k = 0; k < 3; ++k)
                    corners[t][k] = field.power[mesh_.triangles[t][k]] * powerOf(planes_[i].corners[k], field.symmetry);
    });
    const SurfaceLevelData& level = surface_.levels[0];
    const auto texel = [&](uint32_t x, uint32_t y) -> FieldTexel {
        const uint32_t triangle = level.aux[texelIndex(level.size, x, y)].triangle;
        if (triangle == kNoIndex || mesh_.triangleOf[triangle] == kNoIndex) return {0, 0, 0};
        const uint32_t t = mesh_.triangleOf[triangle];
        const std::array<double, 3> weights =
            weightsAt(surface_.triangles[triangle], (glm::dvec2(x, y) + .5) / double(level.size), .5);
        Complex power(0);
        double mean = 0, deviator = 0;
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t v = mesh_.triangles[t][k];
            const double w = weights[mesh_.cornerOf[t][k]];
            power += w * corners[t][k];
            mean += w * double(field.mean[v]);
            deviator += w * double(field.deviator[v]);
        }
        const Complex direction = rootOf(power, field.symmetry);
        return {packOct(planes_[triangle].axis * float(direction.real()) +
                        planes_[triangle].left * float(direction.imag())),
                float(mean), float(deviator)};
    };
    std::vector<FieldTexel> all(size_t(level.size) * level.size);
    parallelFor(level.size, 16, [&](size_t begin, size_t end) {
        for (uint32_t y = uint32_t(begin); y < end; ++y)
            for (uint32_t x = 0; x < level.size; ++x) all[texelIndex(level.size, x, y)] = texel(x, y);
    });
    return all;
}

}  // namespace espalier
