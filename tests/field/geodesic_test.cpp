// The polar map against CGAL's exact geodesics (Xin and Wang 2009).
#ifdef ESPALIER_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "runtime/field/polar_map.hpp"
#include "tests/field/shapes.hpp"
#include "tests/support/data.hpp"
#include "tools/bake/bake.hpp"

using namespace espalier;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Exact = CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<Kernel, Mesh>>;

Mesh meshOf(const FieldMesh& from) {
    Mesh mesh;
    for (const glm::dvec3& p : from.positions) mesh.add_vertex({p.x, p.y, p.z});
    for (const auto& t : from.triangles)
        mesh.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2]));
    return mesh;
}

double between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// In the centre's measure: within the corner that the way leaves through.
double angleOfWay(const FieldMesh& mesh, uint32_t centre, const glm::dvec3& to) {
    const glm::dvec3 at = mesh.positions[centre], way = to - at;
    double best = 1e300, angle = 0;
    uint32_t h = mesh.first[centre];
    do {
        const glm::dvec3 a = mesh.positions[mesh.to(h)] - at,
                         b = mesh.positions[mesh.from(FieldMesh::previous(h))] - at;
        const double off = between(a, way) + between(way, b) - between(a, b);
        if (off < best) best = off, angle = mesh.angle[h] + mesh.tip(h) * between(a, way) / between(a, b);
        h = mesh.twin[FieldMesh::previous(h)];
    } while (h != kNoIndex && h != mesh.first[centre]);
    return angle;
}

}  // namespace

TEST_CASE("distances and angles of the polar map are those of exact geodesics") {
    const auto file = test::dataFile("scans/spot.obj");
    if (!file) return;
    Result<Model> model = importModel(*file);
    REQUIRE(model);
    std::vector<glm::dvec3> corners;
    for (const uint32_t i : model->indices) corners.emplace_back(model->positions[i]);
    const FieldMesh mesh = makeFieldMesh(corners);
    const Mesh exactMesh = meshOf(mesh);
    std::vector<double> distances, angles;
    for (uint32_t i = 0; i < 5; ++i) {
        const uint32_t source = uint32_t(mesh.positions.size() * (2 * i + 1) / 10);
        Exact exact(exactMesh);
        exact.add_source_point(Mesh::Vertex_index(source));
        const PolarMap map = polarMap(mesh, source, 1e9);
        CHECK(map.reached.size() == mesh.positions.size());
        for (uint32_t v = 0; v < mesh.positions.size(); v += 7) {
            if (v == source) continue;
            std::vector<Kernel::Point_3> way;
            const double length =
                exact.shortest_path_points_to_source_points(Mesh::Vertex_index(v), std::back_inserter(way)).first;
            REQUIRE(way.size() >= 2);
            const Kernel::Point_3 last = way[way.size() - 2];
            distances.push_back(std::abs(map.distance[v] / length - 1));
            const double angle = angleOfWay(mesh, source, {last.x(), last.y(), last.z()});
            angles.push_back(std::abs(std::remainder(map.angle[v] - angle, 2 * std::numbers::pi)));
        }
    }
    MESSAGE("medians: distance " << 100 * medianOf(distances) << " %, angle "
                                 << medianOf(angles) * 180 / std::numbers::pi << " degrees");
    CHECK(medianOf(distances) < .005);
    CHECK(medianOf(angles) * 180 / std::numbers::pi < 1.6);
}
#endif
