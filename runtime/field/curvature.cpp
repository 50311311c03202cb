// The second fundamental form of each triangle, from how the vertices' normals change along its edges; summed up at
// vertices in their own measure of angles.
#include <Eigen/Dense>
#include <cmath>

#include "runtime/field/field.hpp"

namespace espalier {
namespace {

// Symmetric 2 x 2 in the frame of the triangle's first edge: (xx, xy, yy).
Eigen::Vector3d formOf(const FieldMesh& mesh, uint32_t triangle, const glm::dvec3& x, const glm::dvec3& y) {
    Eigen::Matrix<double, 6, 3> left;
    Eigen::Matrix<double, 6, 1> right;
    for (uint32_t k = 0; k < 3; ++k) {
        const uint32_t a = mesh.triangles[triangle][k], b = mesh.triangles[triangle][(k + 1) % 3];
        const glm::dvec3 edge = mesh.positions[b] - mesh.positions[a], turn = mesh.normals[b] - mesh.normals[a];
        const double u = glm::dot(edge, x), v = glm::dot(edge, y);
        left.row(2 * k) << u, v, 0;
        left.row(2 * k + 1) << 0, u, v;
        right.segment<2>(2 * k) << glm::dot(turn, x), glm::dot(turn, y);
    }
    return (left.transpose() * left).ldlt().solve(left.transpose() * right);
}

}  // namespace

Field curvatureField(const FieldMesh& mesh) {
    const size_t count = mesh.positions.size();
    std::vector<std::complex<double>> deviator(count, 0);
    std::vector<double> mean(count, 0), weight(count, 0);
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::dvec3 p = mesh.positions[mesh.triangles[t][0]];
        const glm::dvec3 e = mesh.positions[mesh.triangles[t][1]] - p, f = mesh.positions[mesh.triangles[t][2]] - p;
        const glm::dvec3 across = glm::cross(e, f);
        const double area = glm::length(across) / 2;
        if (!(area > 0)) continue;
        const glm::dvec3 x = glm::normalize(e), y = glm::cross(across / (2 * area), x);
        const Eigen::Vector3d form = formOf(mesh, t, x, y);
        if (!form.allFinite()) continue;
        const std::complex<double> own((form[0] - form[2]) / 2, form[1]);
        // The frame's first axis is the half-edge 3 t; the other corners see it turned by what leads there.
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t v = mesh.triangles[t][k];
            const double turn = mesh.angleOf(v, x);
            deviator[v] += area * own * std::polar(1.0, 2 * turn);
            mean[v] += area * (form[0] + form[2]) / 2;
            weight[v] += area;
        }
    }
    Field field;
    field.symmetry = 2;
    field.power.resize(count);
    field.mean.resize(count);
    field.deviator.resize(count);
    for (size_t v = 0; v < count; ++v) {
        const double w = std::max(weight[v], 1e-300), length = std::abs(deviator[v]);
        field.power[v] = length > 0 ? deviator[v] / length : std::complex<double>(1);
        field.mean[v] = float(mean[v] / w);
        field.deviator[v] = float(length / w);
    }
    return field;
}

}  // namespace espalier
