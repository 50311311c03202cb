// Where walks end, against analytic, integrated and mesh-traced geodesics; the paper's walk in the next column.
#include <cstdio>

#include <doctest/doctest.h>

#include "tests/support/data.hpp"
#include "tests/walk/mesh_tracer.hpp"

using namespace espalier;
using namespace espalier::walktest;

namespace {

constexpr int kWalks = 600;
constexpr float kStep = 0.01f;  // of the radius

void printHead() {
    std::printf("%-30s %6s %5s | %8s %8s %4s %6s | %8s %8s %4s\n", "drift, % of the length walked", "texels", "walks",
                "median", "p95", "lost", "ns", "paper's", "p95", "lost");
}

void printRow(const std::string& name, uint size, const Drift& ours, const Drift* paper) {
    std::printf("%-30s %6u %5d | %8.4f %8.4f %4d %6.0f |", name.c_str(), size, ours.walks, ours.median, ours.p95,
                ours.lost, ours.nanoseconds);
    if (paper) std::printf(" %8.3f %8.3f %4d", paper->median, paper->p95, paper->lost);
    std::printf("\n");
}

// Without contacts: the oracles follow one connected surface.
Result<Baked> baked(const Model& model, bool keepLayout) {
    return bake(model, {.resolution = 1024, .keepLayout = keepLayout, .contacts = false});
}

// All levels of a shape; the paper's walk on the same shape without mirrored charts, which it has to exclude.
void judgeShape(const Shape& shape, const Shape& unmirrored) {
    auto surface = baked(toModel(shape), true);
    auto other = baked(toModel(unmirrored), true);
    REQUIRE(surface);
    REQUIRE(other);
    double length = 3 * shape.radius;
    float step = kStep * float(shape.radius);
    auto trials = shapeTrials(shape, surface->surface, kWalks, length, 7);
    auto paperTrials = shapeTrials(unmirrored, other->surface, kWalks, length, 7);
    REQUIRE(trials.size() >= 500);
    CHECK(surface->surface.charts.size() == shape.charts.size());
    for (uint level = 0; level < surface->surface.levels.size(); ++level) {
        Drift ours = judge(surface->surface, trials, level, step, Scheme::intrinsic);
        Drift paper = judge(other->surface, paperTrials, level, step, Scheme::paper);
        printRow(shape.name, surface->surface.levels[level].size, ours, &paper);
        CHECK(ours.lost == 0);
        if (level > 0) continue;
        CHECK(ours.median <= 0.1);
        CHECK(ours.p95 <= 1);
        CHECK(paper.median > 2 * ours.median);
    }
}

// Walks of a quarter radius and of one radius on a model; with `bounds`, the project's are checked.
void judgeModel(const char* name, const char* file, bool bounds) {
    auto path = test::dataFile(file);
    if (!path) return;
    auto model = importModel(*path);
    REQUIRE(model);
    auto surface = baked(*model, false);
    REQUIRE(surface);
    const SurfaceData& data = surface->surface;
    MeshTracer tracer(data.vertices, data.indices);
    double radius = glm::length(Vec3(data.boundsMax - data.boundsMin)) / 2;
    for (double radii : {0.25, 1.0}) {
        auto trials = tracer.trials(data, kWalks, radii * radius, 3);
        REQUIRE(trials.size() >= 500);
        for (uint level = 0; level < data.levels.size(); ++level) {
            Drift ours = judge(data, trials, level, kStep * float(radius), Scheme::intrinsic);
            Drift paper = judge(data, trials, level, kStep * float(radius), Scheme::paper);
            printRow(std::string(name) + (radii < 1 ? ", .25 R" : ", 1 R"), data.levels[level].size, ours, &paper);
            if (level > 0 || !bounds) continue;
            CHECK(ours.median <= (radii < 1 ? 0.3 : 0.7));
            if (radii < 1) CHECK(ours.p95 <= 2.5);
            CHECK(ours.median < paper.median);
        }
    }
}

}  // namespace

TEST_CASE("walks of three radii end where the true geodesics end") {
    printHead();
    judgeShape(sphere(192), sphere(192, false));
    judgeShape(torus(128), torus(128, false));
    judgeShape(cylinder(128), cylinder(128, false));
    judgeShape(cone(128), cone(128, false));
    judgeShape(cubeOfSixCharts(), cubeOfSixCharts(false));
    judgeShape(cubeWithStrip(), cubeWithStrip(false));
}

TEST_CASE("walks on real models end where straightest geodesics over their triangles end") {
    printHead();
    judgeModel("cat statue", "models/polyhaven_concrete_cat_statue/concrete_cat_statue_1k.gltf", true);
    judgeModel("gabled house", "models/quaternius/1Story_GableRoof_Mat.glb", true);
    judgeModel("library", "models/pmndrs/library-large.gltf", true);
    // Decimated scans: every step crosses triangles at angles of 10 degrees and more, and the geodesics of the
    // triangles are as erratic. For comparison, without bounds.
    judgeModel("Plato", "models/threedscans/Plato.glb", false);
    judgeModel("column", "models/threedscans/Column03.glb", false);
    judgeModel("bunny, unwrapped", "derived/bunny_unwrap.glb", false);
}
