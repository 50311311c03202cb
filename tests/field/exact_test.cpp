// Exact fields against topology: how many singularities there are, of which index, and where.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "runtime/field/field_solver.hpp"
#include "runtime/field/mesh_topology.hpp"
#include "tests/field/shapes.hpp"
#include "tests/support/data.hpp"
#include "tools/bake/bake.hpp"

using namespace espalier;

namespace {

// Places on a mesh that are far from each other.
std::vector<glm::dvec3> scattered(const FieldMesh& mesh, size_t count) {
    std::vector<glm::dvec3> places{mesh.positions[mesh.positions.size() / 3]};
    std::vector<double> away(mesh.positions.size(), 1e300);
    while (places.size() < count) {
        for (size_t v = 0; v < away.size(); ++v)
            away[v] = mesh.border[v] ? 0 : std::min(away[v], glm::length(mesh.positions[v] - places.back()));
        places.push_back(mesh.positions[size_t(std::ranges::max_element(away) - away.begin())]);
    }
    return places;
}

// Wedges and trisectors whose turns add up to what a closed mesh needs.
FieldDesign balanced(const FieldMesh& mesh, size_t count) {
    FieldDesign design;
    design.exact = true;
    const int needed = 2 * mesh.eulerCharacteristic();
    const std::vector<glm::dvec3> places = scattered(mesh, count);
    const size_t positive = size_t(int(count) + needed) / 2;
    for (size_t i = 0; i < count; ++i)
        design.elements.push_back({i < positive ? ElementKind::wedge : ElementKind::trisector, places[i], {1, .3, .2}});
    return design;
}

// Each element has its singularity at a vertex near it, and there are no others.
void checkExact(const FieldMesh& mesh, const FieldDesign& design, const Field& field) {
    std::vector<Singularity> found = singularitiesOf(mesh, field);
    CHECK(field.unasked == 0);
    CHECK(found.size() == design.elements.size());
    for (const FieldElement& element : design.elements) {
        const int turns = int(std::lround(indexOf(element.kind) * design.symmetry));
        const auto near = std::ranges::find_if(found, [&](const Singularity& s) {
            return s.turns == turns && s.vertex != kNoIndex &&
                   glm::length(mesh.positions[s.vertex] - element.position) < .1 * mesh.radius;
        });
        REQUIRE(near != found.end());
        found.erase(near);
    }
}

std::vector<glm::dvec3> cornersOf(const Model& model) {
    std::vector<glm::dvec3> corners;
    for (const uint32_t i : model.indices) corners.emplace_back(model.positions[i]);
    return corners;
}

}  // namespace

TEST_CASE("an exact field has the twelve singularities asked for and no others, on meshes of genus 0, 1 and 3") {
    for (const auto& corners : {sphereCorners(1), torusCorners(2, .7), plateCorners(3)}) {
        const FieldMesh mesh = makeFieldMesh(corners);
        const FieldDesign design = balanced(mesh, 12);
        Result<Field> field = designField(mesh, design);
        REQUIRE(field);
        checkExact(mesh, design, *field);
    }
}

TEST_CASE("a torus needs no singularity and an exact field makes none") {
    const FieldMesh mesh = makeFieldMesh(torusCorners(2, .7));
    for (const uint32_t symmetry : {1u, 2u, 4u, 6u}) {
        FieldDesign design;
        design.symmetry = symmetry;
        design.exact = true;
        Result<Field> field = designField(mesh, design);
        REQUIRE(field);
        CHECK(singularitiesOf(mesh, *field).empty());
    }
}

TEST_CASE("whole turns lie at one vertex, quarter turns of a cross share some") {
    const FieldMesh mesh = makeFieldMesh(sphereCorners(1));
    FieldDesign design;
    design.exact = true;
    design.elements = {{ElementKind::node, {0, 1, 0}, {1, 0, 0}}, {ElementKind::centre, {0, -1, 0}, {1, 0, 0}}};
    Result<Field> field = designField(mesh, design);
    REQUIRE(field);
    checkExact(mesh, design, *field);
    design.symmetry = 4;
    field = designField(mesh, design);
    REQUIRE(field);
    int above = 0, all = 0;
    for (const Singularity& s : singularitiesOf(mesh, *field)) {
        REQUIRE(s.vertex != kNoIndex);
        all += s.turns;
        if (mesh.positions[s.vertex].y > .9) above += s.turns;
    }
    CHECK(above == 4);
    CHECK(all == 8);
}

TEST_CASE("what the elements leave over is told and lies far from them") {
    const FieldMesh mesh = makeFieldMesh(sphereCorners(1));
    FieldDesign design;
    design.exact = true;
    design.elements = {{ElementKind::wedge, {0, 1, 0}, {1, 0, 0}}};
    Result<Field> field = designField(mesh, design);
    REQUIRE(field);
    CHECK(field->unasked == 3);
    const std::vector<Singularity> found = singularitiesOf(mesh, *field);
    CHECK(found.size() == 4);
    for (const Singularity& s : found) {
        CHECK(s.turns == 1);
        REQUIRE(s.vertex != kNoIndex);
        const double away = glm::length(mesh.positions[s.vertex] - glm::dvec3(0, 1, 0));
        CHECK((away < .1 || away > .5));
    }
}

TEST_CASE("an exact field goes along its elements") {
    const FieldMesh mesh = makeFieldMesh(torusCorners(2, .7));
    FieldDesign design = balanced(mesh, 4);
    for (const double y : {.7, -.7}) design.elements.push_back({ElementKind::regular, {2, y, 0}, {1, 0, 1}, .5});
    Result<Field> field = designField(mesh, design);
    REQUIRE(field);
    CHECK(singularitiesOf(mesh, *field).size() == 4);
    for (uint32_t v = 0; v < mesh.positions.size(); ++v)
        for (const double y : {.7, -.7})
            if (glm::length(mesh.positions[v] - glm::dvec3(2, y, 0)) < .1) {
                const glm::dvec3 d = mesh.direction(v, std::arg(field->power[v]) / 2);
                CHECK(std::abs(glm::dot(d, glm::normalize(glm::dvec3(1, 0, 1)))) > .97);
            }
}

TEST_CASE("a solver that is used again gives the bits of a new one") {
    const FieldMesh mesh = makeFieldMesh(torusCorners(2, .7));
    FieldSolver solver(mesh);
    FieldDesign design = balanced(mesh, 6);
    for (int step = 0; step < 6; ++step) {
        if (step == 2) design.elements[0].position.y += .2;
        if (step == 4) design.exact = false;
        design.elements[1].direction = {1, .2 * step, .4};
        Result<Field> kept = solver.design(design), anew = designField(mesh, design);
        REQUIRE(kept);
        REQUIRE(anew);
        CHECK(kept->power == anew->power);
    }
}

TEST_CASE("on every closed model the turns add up to the Euler characteristic, and twelve asked are twelve got") {
    if (!test::dataFile("models")) return;
    size_t closed = 0, exactly = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(test::dataFolder())) {
        const std::string ending = entry.path().extension().string();
        if (entry.path().string().find("validator_cases") != std::string::npos) continue;
        if (ending != ".glb" && ending != ".gltf" && ending != ".obj" && ending != ".ply" && ending != ".stl") continue;
        Result<Model> model = importModel(entry.path().string());
        if (!model || model->indices.size() / 3 > 200000) continue;
        const FieldMesh mesh = makeFieldMesh(cornersOf(*model));
        if (mesh.triangles.empty() || std::ranges::any_of(mesh.border, [](bool b) { return b; })) continue;
        ++closed;
        CAPTURE(entry.path().filename().string());
        FieldDesign design;
        Result<Field> smooth = designField(mesh, design);
        REQUIRE(smooth);
        int sum = 0;
        for (const Singularity& s : singularitiesOf(mesh, *smooth)) sum += s.turns;
        CHECK(sum == 2 * mesh.eulerCharacteristic());
        // A mesh of few triangles can't show each turn, nor can the tiny handles of a careless scan.
        const size_t pieces = topologyOf(mesh).pieces.size();
        if (pieces > 1 || mesh.triangles.size() < 5000 || mesh.eulerCharacteristic() < 0) continue;
        design = balanced(mesh, 12);
        Result<Field> exact = designField(mesh, design);
        REQUIRE(exact);
        checkExact(mesh, design, *exact);
        ++exactly;
    }
    MESSAGE(closed << " closed models, twelve singularities on " << exactly);
    CHECK(closed > 0);
}
