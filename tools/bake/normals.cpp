// In: the welded mesh. Out: shading normals at corners (the model's, or weighted by area) and the mean curvature
// at points, by the cotangent Laplacian.
#include <cmath>

#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {
namespace {

constexpr float kSmoothCosine = 0.82f;  // 35°: the most that a rounded normal turns from its face's

}  // namespace

void addNormalsAndCurvature(const Model& model, BakeMesh& mesh) {
    size_t n = mesh.points.size();
    std::vector<glm::dvec3> normal(n, glm::dvec3(0)), laplacian(n, glm::dvec3(0));
    std::vector<double> area(n, 0);
    std::vector<uint8_t> border(n, 0);
    for (uint32_t h = 0; h < mesh.twin.size(); ++h)
        if (mesh.twin[h] == kNone)
            border[mesh.triangles[h / 3].point[h % 3]] = border[mesh.triangles[h / 3].point[(h + 1) % 3]] = 1;
    for (const Triangle& t : mesh.triangles) {
        glm::dvec3 p[3] = {mesh.points[t.point[0]], mesh.points[t.point[1]], mesh.points[t.point[2]]};
        glm::dvec3 c = glm::cross(p[1] - p[0], p[2] - p[0]);
        double twice = glm::length(c);
        for (int k = 0; k < 3; ++k) {
            uint32_t a = t.point[size_t(k)], b = t.point[size_t(k + 1) % 3];
            glm::dvec3 u = p[k] - p[(k + 2) % 3], v = p[(k + 1) % 3] - p[(k + 2) % 3];
            double cotangent = glm::dot(u, v) / twice;  // of the corner that faces edge a-b
            // Slivers would drown their neighbours.
            cotangent = std::min(std::max(cotangent, -20.0), 20.0);
            glm::dvec3 d = (p[k] - p[(k + 1) % 3]) * (cotangent / 2);
            laplacian[a] += d;
            laplacian[b] -= d;
            normal[a] += c;
            area[a] += twice / 6;
        }
    }
    for (glm::dvec3& m : normal) {
        double length = glm::length(m);
        if (length > 0) m /= length;
    }
    std::vector<float> raw(n, 0);
    for (size_t i = 0; i < n; ++i)
        if (!border[i] && area[i] > 0) raw[i] = float(glm::dot(laplacian[i], normal[i]) / (2 * area[i]));
    // One round of averaging: single vertices of a scan say little.
    std::vector<double> sum(n, 0), weight(n, 0);
    for (const Triangle& t : mesh.triangles)
        for (size_t k = 0; k < 3; ++k)
            for (size_t j = 0; j < 3; ++j) {
                if (border[t.point[j]]) continue;
                sum[t.point[k]] += raw[t.point[j]];
                weight[t.point[k]] += 1;
            }
    mesh.curvature.assign(n, 0);
    for (size_t i = 0; i < n; ++i)
        if (weight[i] > 0) mesh.curvature[i] = float(sum[i] / weight[i]);
    mesh.normals.resize(mesh.triangles.size() * 3);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& point = mesh.triangles[t].point;
        glm::dvec3 p0 = mesh.points[point[0]];
        glm::vec3 flat(glm::normalize(glm::cross(mesh.points[point[1]] - p0, mesh.points[point[2]] - p0)));
        for (size_t k = 0; k < 3; ++k) {
            glm::vec3 m(0);
            if (!model.normals.empty()) m = model.normals[vertexAt(model, mesh.triangles[t], k)];
            float length = glm::length(m);
            if (length > 1e-6f && std::isfinite(length)) {
                mesh.normals[t * 3 + k] = m / length;
                continue;
            }
            // Without normals of the model's own: rounded where faces meet gently, flat along creases.
            glm::vec3 smooth(normal[mesh.triangles[t].point[k]]);
            mesh.normals[t * 3 + k] = glm::dot(smooth, flat) > kSmoothCosine ? smooth : flat;
        }
    }
}

}  // namespace espalier::bakery
