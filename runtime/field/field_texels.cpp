// Each texel lies on a triangle (of a gutter texel, on its plane carried on). The directions at the triangle's corners
// are laid into its plane and mixed as N-th powers.
#include "runtime/field/field_texels.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "runtime/core/jobs.hpp"

namespace espalier {
namespace {

using glm::dvec3;
using Complex = std::complex<double>;

// Weights of the corners uv0, uv1, uv2 of a triangle; beyond it they are cut to what lies half a triangle outside.
std::array<double, 3> weightsAt(const TrianglePlane& plane, glm::dvec2 uv) {
    const glm::dvec2 a(plane.uv0), b = glm::dvec2(plane.uv1) - a, c = glm::dvec2(plane.uv2) - a, p = uv - a;
    const double area = b.x * c.y - b.y * c.x;
    if (area == 0) return {1, 0, 0};
    const double v = std::clamp((p.x * c.y - p.y * c.x) / area, -.5, 1.5);
    const double w = std::clamp((b.x * p.y - b.y * p.x) / area, -.5, 1.5);
    return {1 - v - w, v, w};
}

class Resampling {
  public:
    Resampling(const SurfaceData& surface, const FieldMesh& mesh, const Field& field)
        : surface_(surface), level_(surface.levels[0]), mesh_(mesh), field_(field) {}

    std::vector<FieldTexel> run() const {
        std::vector<FieldTexel> all(size_t(level_.size) * level_.size);
        parallelFor(level_.size, 16, [&](size_t begin, size_t end) {
            for (uint32_t y = uint32_t(begin); y < end; ++y)
                for (uint32_t x = 0; x < level_.size; ++x) all[texelIndex(level_.size, x, y)] = texel(x, y);
        });
        return all;
    }

  private:
    FieldTexel texel(uint32_t x, uint32_t y) const {
        const uint32_t at = texelIndex(level_.size, x, y);
        const uint32_t triangle = level_.aux[at].triangle;
        if (triangle == kNoIndex || mesh_.triangleOf[triangle] == kNoIndex) return {0, 0};
        const TrianglePlane& plane = surface_.triangles[triangle];
        const dvec3 normal = glm::normalize(dvec3(glm::cross(plane.du, plane.dv))) *
                             double(surface_.charts[plane.chart].orientation);
        const dvec3 axis = glm::normalize(dvec3(plane.du)), left = glm::cross(normal, axis);

        const uint32_t t = mesh_.triangleOf[triangle];
        const std::array<double, 3> weights =
            weightsAt(plane, (glm::dvec2(x, y) + .5) / double(level_.size));
        Complex power(0);
        double mean = 0, deviator = 0;
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t v = mesh_.triangles[t][k];
            const double w = weights[mesh_.cornerOf[t][k]];
            const dvec3 direction = laid(mesh_.direction(v, std::arg(field_.power[v]) / field_.symmetry),
                                         mesh_.normals[v], normal);
            const double turn = std::atan2(glm::dot(direction, left), glm::dot(direction, axis));
            power += w * std::polar(1.0, turn * field_.symmetry);
            mean += w * double(field_.mean[v]);
            deviator += w * double(field_.deviator[v]);
        }
        const double angle = std::arg(power) / field_.symmetry;
        return {packOct(glm::vec3(axis * std::cos(angle) + left * std::sin(angle))),
                glm::packHalf1x16(half(mean)) | uint32_t(glm::packHalf1x16(half(deviator))) << 16};
    }
    static float half(double x) { return float(std::clamp(x, -60000.0, 60000.0)); }

    // A tangent under one normal, turned by the least rotation to lie under another.
    static dvec3 laid(const dvec3& direction, const dvec3& from, const dvec3& to) {
        const double k = glm::dot(to, direction) / std::max(1 + glm::dot(from, to), 1e-3);
        return direction - (from + to) * k;
    }

    const SurfaceData& surface_;
    const SurfaceLevelData& level_;
    const FieldMesh& mesh_;
    const Field& field_;
};

}  // namespace

std::vector<FieldTexel> fieldTexels(const SurfaceData& surface, const FieldMesh& mesh, const Field& field) {
    return Resampling(surface, mesh, field).run();
}

}  // namespace espalier
