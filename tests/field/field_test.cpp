// Fields against what topology and formulas say.
#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "runtime/field/field.hpp"
#include "runtime/field/polar_map.hpp"
#include "tests/field/shapes.hpp"

using namespace espalier;

namespace {

int turnsOf(const FieldMesh& mesh, const Field& field) {
    int sum = 0;
    for (const Singularity& s : singularitiesOf(mesh, field)) sum += s.turns;
    return sum;
}

}  // namespace

TEST_CASE("welding makes closed meshes of the known Euler characteristic") {
    CHECK(makeFieldMesh(sphereCorners(1)).eulerCharacteristic() == 2);
    CHECK(makeFieldMesh(torusCorners(2, .7)).eulerCharacteristic() == 0);
    CHECK(makeFieldMesh(planeCorners(2)).eulerCharacteristic() == 1);
}

TEST_CASE("the turns of a field's singularities add up to its symmetry times the Euler characteristic") {
    for (const auto& corners : {sphereCorners(1), torusCorners(2, .7)}) {
        const FieldMesh mesh = makeFieldMesh(corners);
        for (const uint32_t symmetry : {1u, 2u, 4u, 6u}) {
            FieldDesign design;
            design.symmetry = symmetry;
            design.drift = {.3, -1, .2};
            const Result<Field> field = designField(mesh, design);
            REQUIRE(field);
            CHECK(turnsOf(mesh, field.value()) == int(symmetry) * mesh.eulerCharacteristic());
        }
    }
}

TEST_CASE("a singular element puts the singularity that it names beside its place") {
    const FieldMesh mesh = makeFieldMesh(planeCorners(4, 60));
    const struct {
        ElementKind kind;
        int turns;
    } rows[] = {{ElementKind::wedge, 1},  {ElementKind::trisector, -1}, {ElementKind::node, 2},
                {ElementKind::centre, 2}, {ElementKind::saddle, -2},    {ElementKind::regular, 0}};
    for (const auto& row : rows) {
        FieldDesign design;
        design.lean = 0;
        design.elements.push_back({row.kind, {.3, 0, .2}, {1, 0, 0}, .8});
        const Result<Field> field = designField(mesh, design);
        REQUIRE(field);
        int near = 0;
        for (const Singularity& s : singularitiesOf(mesh, field.value()))
            if (glm::length(mesh.positions[mesh.triangles[s.triangle][0]] - glm::dvec3(.3, 0, .2)) < .4)
                near += s.turns;
        CHECK(near == row.turns);
    }
}

TEST_CASE("a regular element turns the field to its direction") {
    const FieldMesh mesh = makeFieldMesh(planeCorners(4, 40));
    FieldDesign design;
    design.lean = 0;
    design.elements.push_back({ElementKind::regular, {0, 0, 0}, {1, 0, 1}, 1});
    const Result<Field> field = designField(mesh, design);
    REQUIRE(field);
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3 d = mesh.direction(v, std::arg(field.value().power[v]) / 2);
        CHECK(std::abs(glm::dot(d, glm::normalize(glm::dvec3(1, 0, 1)))) > .999);
    }
}

TEST_CASE(
    "a summed field has the elements' directions, more singularities than a solved one, and fewer after smoothing") {
    const FieldMesh mesh = makeFieldMesh(sphereCorners(1, 20));
    FieldDesign design;
    design.lean = 0;
    for (int i = 0; i < 8; ++i)
        design.elements.push_back({i % 2 ? ElementKind::wedge : ElementKind::trisector,
                                   mesh.positions[mesh.positions.size() * size_t(2 * i + 1) / 16],
                                   {1, .2, .1},
                                   .2});
    design.elements.push_back({ElementKind::regular, {0, 1, 0}, {1, 0, 0}, .2});
    const auto countOf = [&](bool summed, uint32_t passes) {
        design.summed = summed;
        design.passes = passes;
        const Result<Field> field = designField(mesh, design);
        REQUIRE(field);
        CHECK(turnsOf(mesh, field.value()) == 4);
        return singularitiesOf(mesh, field.value()).size();
    };
    const size_t rough = countOf(true, 0), smooth = countOf(true, 100), solved = countOf(false, 0);
    CHECK(rough > smooth);
    CHECK(smooth >= solved);
    design.summed = true;
    design.passes = 0;
    const Result<Field> field = designField(mesh, design);
    const auto top = std::ranges::max_element(mesh.positions, {}, &glm::dvec3::y) - mesh.positions.begin();
    const double turned = std::arg(field.value().power[size_t(top)]) / 2;
    CHECK(std::abs(glm::dot(mesh.direction(uint32_t(top), turned), glm::dvec3(1, 0, 0))) > .999);
}

TEST_CASE("smoothing a summed field takes each neighbour once, also along a border") {
    const FieldMesh mesh = makeFieldMesh(planeCorners(2, 6));
    std::vector<std::set<uint32_t>> neighbours(mesh.positions.size());
    for (const auto& t : mesh.triangles)
        for (size_t k = 0; k < 3; ++k) neighbours[t[k]].insert({t[(k + 1) % 3], t[(k + 2) % 3]});
    FieldDesign design;
    design.symmetry = 1;
    design.lean = 0;
    design.summed = true;
    for (const glm::dvec3& p : mesh.positions) {  // none is felt by others
        const double angle = 5 * p.x * p.x + 3 * p.z + p.x * p.z;
        design.elements.push_back({ElementKind::regular, p, {std::cos(angle), 0, -std::sin(angle)}, .01});
    }
    design.passes = 0;
    const Result<Field> rough = designField(mesh, design);
    REQUIRE(rough);
    std::vector<glm::dvec3> wanted(mesh.positions.size());
    for (uint32_t v = 0; v < wanted.size(); ++v) wanted[v] = mesh.direction(v, std::arg(rough.value().power[v]));
    for (uint32_t passes = 1; passes <= 3; ++passes) {
        const std::vector<glm::dvec3> before = wanted;
        for (uint32_t v = 0; v < wanted.size(); ++v) {
            for (const uint32_t other : neighbours[v]) wanted[v] += before[other];
            wanted[v] = glm::normalize(wanted[v]);
        }
        design.passes = passes;
        const Result<Field> field = designField(mesh, design);
        REQUIRE(field);
        for (uint32_t v = 0; v < wanted.size(); ++v)
            CHECK(glm::length(mesh.direction(v, std::arg(field.value().power[v])) - wanted[v]) < 1e-9);
    }
}

TEST_CASE("a vector field refuses elements of half a turn") {
    FieldDesign design;
    design.symmetry = 1;
    design.elements.push_back({ElementKind::wedge, {0, 0, 0}, {1, 0, 0}, 1});
    CHECK_FALSE(designField(makeFieldMesh(planeCorners(2, 4)), design));
}

TEST_CASE("a polar map agrees with straight lines on a plane and great circles on a sphere") {
    const FieldMesh plane = makeFieldMesh(planeCorners(2, 40));
    const auto centreOf = [](const FieldMesh& mesh, glm::dvec3 at) {
        return uint32_t(std::ranges::min_element(mesh.positions, {}, [&](auto p) { return glm::length(p - at); }) -
                        mesh.positions.begin());
    };
    const uint32_t middle = centreOf(plane, {0, 0, 0});
    const PolarMap map = polarMap(plane, middle, 1e9);
    REQUIRE(map.reached.size() == plane.positions.size());
    for (uint32_t v : map.reached) {
        if (v == middle) continue;
        CHECK(map.distance[v] ==
              doctest::Approx(glm::length(plane.positions[v] - plane.positions[middle])).epsilon(1e-6));
        const double off = map.angle[v] - plane.angleOf(middle, plane.positions[v] - plane.positions[middle]);
        CHECK(std::abs(std::remainder(off, 2 * std::numbers::pi)) < 1e-6);
    }
    const FieldMesh sphere = makeFieldMesh(sphereCorners(1, 32));
    const uint32_t pole = centreOf(sphere, {0, 1, 0});
    const PolarMap round = polarMap(sphere, pole, 1e9);
    std::vector<double> distances, angles;
    for (uint32_t v : round.reached) {
        const double great = std::acos(std::clamp(glm::dot(sphere.positions[v], sphere.positions[pole]), -1.0, 1.0));
        if (great < .1 || great > 3) continue;
        distances.push_back(std::abs(round.distance[v] / great - 1));
        angles.push_back(
            std::abs(std::remainder(round.angle[v] - sphere.angleOf(pole, sphere.positions[v]), 2 * std::numbers::pi)));
    }
    CHECK(medianOf(distances) < .003);
    CHECK(medianOf(angles) < .026);
}

TEST_CASE("curvature on a torus is that of the formula") {
    const double large = 2, small = .7;
    const FieldMesh mesh = makeFieldMesh(torusCorners(large, small, 128, 64));
    const Field field = curvatureField(mesh);
    std::vector<double> errors, turns;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3 p = mesh.positions[v];
        const double ring = std::hypot(p.x, p.z), across = 1 / small, along = (ring - large) / small / ring;
        const double larger = std::max(across, along), lesser = std::min(across, along);
        errors.push_back(std::abs(double(field.mean[v]) + double(field.deviator[v]) - larger) / larger);
        errors.push_back(std::abs(double(field.mean[v]) - double(field.deviator[v]) - lesser) / larger);
        const glm::dvec3 round = glm::normalize(glm::dvec3(-p.z, 0, p.x));
        const double sine = glm::dot(mesh.direction(v, std::arg(field.power[v]) / 2), round);
        turns.push_back(std::asin(std::min(std::abs(sine), 1.0)) * 180 / std::numbers::pi);
    }
    CHECK(medianOf(errors) < .02);
    CHECK(medianOf(turns) < 2);
}
