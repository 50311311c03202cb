// Growth on small analytic surfaces: what grows, what doesn't, limits, and that GPU and CPU agree.
#include <doctest/doctest.h>

#include <cstdio>

#include "tests/expand/scene.hpp"

using namespace espalier;
using namespace espalier::growthtest;

namespace {

const char* kStraight = R"(
param reach = 20 [0 .. 1000] "steps" "Steps"
Stem(n) -> Marching(0.05, 0, n < reach) {Stem(n + 1), Bark}
Bark -> S(0.01) Shape("bark", C1)
)";

}  // namespace

TEST_CASE("straight stems grow alike on GPU and CPU") {
    TestDevice gpu;
    auto growth = gpu.growth();
    Scene scene = Scene::baked(flatSquare());
    scene.addGrammar(kStraight);
    scene.plant({-0.5f, 0, 0.1f}, {1, 0, 0.2f});
    Result<CpuGrowth> cpu = scene.growOnCpu();
    REQUIRE(cpu);
    CHECK(cpu->stats.nodes == 21);
    CHECK(cpu->branches.size() == 1);
    CHECK(glm::length(cpu->nodes[20].position - cpu->nodes[0].position) == doctest::Approx(1.0).epsilon(1e-4));
    Status grown = scene.grow(gpu.device(), *growth);
    if (!grown) FAIL(grown.failure().text());
    Result<GrowthRecords> records = growth->read();
    REQUIRE(records);
    GrowthDifference d = compareGrowth(*cpu, *records);
    for (const std::string& note : d.notes) std::printf("%s\n", note.c_str());
    CHECK(d.alike == d.branches);
    CHECK(growth->stats().hash == cpu->stats.hash);
    CHECK(growth->stats().nodes == 21);
}
