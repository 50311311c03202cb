// In: places on a finished surface. Out: whether a straight way leads from them out of the model.
#include "tools/bake/reach_sight.hpp"

#include <algorithm>
#include <cmath>

namespace espalier::bakery {
namespace {

constexpr float kOff = 0.1f;  // texels off the surface that rays begin

}  // namespace

// Rays are evenly spread over the sphere.
Sight::Sight(const BakeMesh& mesh, const MeshTree& drawn, const SurfaceData& surface)
    : mesh_(mesh), drawn_(drawn), surface_(surface) {
    for (int i = 0; i < kRays; ++i) {
        const double z = 1 - (2 * i + 1.0) / kRays, r = std::sqrt(1 - z * z), turn = 2.399963229728653 * i;
        rays_[size_t(i)] = {r * std::cos(turn), r * std::sin(turn), z};
    }
}

// Does a ray that the model doesn't stop meet the ground below its foot?
bool Sight::endsBelow(glm::dvec3 from, glm::dvec3 ray) const {
    if (ray.y >= 0) return false;
    const glm::dvec3 end = from + ray * ((mesh_.boundsMin.y - from.y) / ray.y);
    return end.x > mesh_.boundsMin.x && end.x < mesh_.boundsMax.x && end.z > mesh_.boundsMin.z &&
           end.z < mesh_.boundsMax.z;
}

bool Sight::sees(uint32_t cell) const {
    const SurfaceLevelData& level = surface_.levels[0];
    const TrianglePlane& plane = surface_.triangles[level.aux[cell].triangle];
    const glm::vec3 n = glm::normalize(glm::cross(plane.du, plane.dv)) * surface_.charts[plane.chart].orientation;
    const float texel = surface_.charts[plane.chart].metresPerUv / float(level.size);
    const glm::vec3 from = level.texels[cell].position + n * (kOff * texel);
    return std::ranges::any_of(rays_, [&](const glm::dvec3& ray) {
        return glm::dot(glm::vec3(ray), n) > 0.05f && !endsBelow(from, ray) && !drawn_.pick(from, glm::vec3(ray));
    });
}

}  // namespace espalier::bakery
