// The library's grammars: every one compiles with the meshes that the content tool makes and covers houses of all
// shapes.
#include <doctest/doctest.h>
#include <filesystem>
#include <map>

#include "runtime/core/file.hpp"
#include "runtime/roof/shapes.hpp"
#include "tests/roof_growth/library.hpp"

using namespace espalier;
using namespace roof_test;

namespace {

RoofStructure townStructure() {
    Result<Town> town = readFootprints("content/town.json");
    REQUIRE(town);
    CHECK(town->diagnostics.empty());
    std::vector<Diagnostic> diagnostics;
    RoofStructure s = roofsOf(town->footprints, diagnostics);
    CHECK(s.houses.size() == town->footprints.size());
    return s;
}

// Area of the cells of a mesh, each by what lies within its grid.
double areaOf(const CpuRoofs& roofs, uint32_t mesh, bool whole) {
    double sum = 0;
    for (const RoofGrid& g : roofs.records.grids) {
        if ((g.mesh & 255u) != mesh || g.firstRow == kNoIndex) continue;
        for (uint32_t r = 0; r < g.cells >> 16; ++r) {
            const RoofRun run = roofs.records.runs[g.firstRow + r];
            sum += double((whole ? run.whole : run.touched) >> 16) * g.step.x * g.step.y;
        }
    }
    return sum;
}

}  // namespace

TEST_CASE("every roof grammar of the library covers the sample town's roofs") {
    const Meshes meshes;
    const RoofStructure structure = townStructure();
    const RoofTables tables = makeAtoms(structure);
    double slopes = 0;  // square metres, from the faces' areas in the plan (shoelace) and their pitch
    for (const RoofFace& face : structure.faces) {
        if (face.kind != FaceKind::slope) continue;
        double twice = 0;
        glm::dvec3 from =
            face.detached ? structure.segments[face.firstSegment + face.segmentCount - 1].to : face.eave[1];
        for (uint32_t i = 0; i < face.segmentCount; ++i) {
            const glm::dvec3 to = structure.segments[face.firstSegment + i].to;
            twice += to.x * from.z - from.x * to.z;
            from = to;
        }
        if (!face.detached) twice += double(face.eave[1].x) * face.eave[0].z - double(face.eave[0].x) * face.eave[1].z;
        slopes += std::abs(twice) / 2 * std::sqrt(1 + double(face.slope) * face.slope);
    }
    int grammars = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kGrammars)) {
        const std::string name = entry.path().stem().string();
        std::string covering;
        for (const char* known : {"slate", "plain", "pan"})
            if (name.starts_with("roof_") && name.ends_with(std::string("_") + known)) covering = known;
        if (covering.empty()) continue;
        CAPTURE(name);
        Result<RuleMap> map = compiled(entry.path(), meshes);
        if (!map) {
            FAIL_CHECK(map.failure().text());
            continue;
        }
        RoofInputs inputs;
        inputs.town = &tables;
        inputs.grammar = &*map;
        inputs.meshes = meshes.bounds;
        const CpuRoofs roofs = growRoofsOnCpu(inputs, 2);
        CHECK(roofs.status.stopped == 0);
        const uint32_t mesh = meshes.number(covering);
        CHECK(areaOf(roofs, mesh, false) > slopes);
        CHECK(areaOf(roofs, mesh, true) < slopes * 1.35);  // eaves and verges reach over the walls
        CHECK(areaOf(roofs, mesh, true) > slopes * 0.75);
        grammars += 1;
    }
    CHECK(grammars >= 18);
}

TEST_CASE("the town's grammar gives each house gutters, windows and a covering") {
    const Meshes meshes;
    const RoofStructure structure = townStructure();
    const RoofTables tables = makeAtoms(structure);
    Result<RuleMap> map = compiled(kGrammars / "town.grammar", meshes);
    if (!map) FAIL(map.failure().text());
    RoofInputs inputs;
    inputs.town = &tables;
    inputs.grammar = &*map;
    inputs.meshes = meshes.bounds;
    const CpuRoofs roofs = growRoofsOnCpu(inputs, 2);
    CHECK(roofs.status.stopped == 0);
    for (uint32_t h = 0; h < structure.houses.size(); ++h) {
        CAPTURE(structure.houses[h].id);
        std::map<std::string, int> count;
        for (const RoofGrid& g : roofs.records.grids)
            if ((g.house & 0xFFFFFFu) == h) count[meshes.names[g.mesh & 255u].name] += 1;
        CHECK(count["casement"] > 0);
        const bool flat = structure.houses[h].shape == RoofShape::flat;
        CHECK((count["gutter"] > 0) == !flat);
        CHECK((count["slate"] + count["plain"] + count["pan"] + count["barrel"] + count["seam"] > 0) == !flat);
        if (structure.houses[h].shape == RoofShape::mansard) CHECK(count["railing"] > 0);
    }
}

TEST_CASE("overhanging eaves meet at corners of any angle") {
    // A square's corners turn by 90 degrees; an L's reflex corner by -90.
    Footprint f;
    f.id = "l";
    f.rings = {{{0, 0}, {12, 0}, {12, 5}, {5, 5}, {5, 12}, {0, 12}}};
    f.slope = 1;
    f.levels = 1;
    std::vector<Diagnostic> diagnostics;
    const RoofTables tables = makeAtoms(roofOf(f, diagnostics));
    int convex = 0, reflex = 0;
    for (const RoofAtom& a : tables.atoms)
        for (float c : {a.corners.x, a.corners.y}) {
            convex += std::abs(c - 1) < 1e-4f;
            reflex += std::abs(c + 1) < 1e-4f;
        }
    CHECK(convex == 10);
    CHECK(reflex == 2);
}
