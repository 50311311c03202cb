// How fast growth is on a real model: a printout, and the checks that keep it meaningful.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <sys/resource.h>

#include "tests/expand/scene.hpp"
#include "tests/support/data.hpp"

using namespace espalier;
using namespace espalier::growthtest;

namespace {

// Recursive branching: stems that twist, twigs that end after a few steps, leaves.
std::string branching(float step, uint32_t mainSteps, uint32_t twigSteps) {
    char text[1024];
    std::snprintf(text, sizeof text, R"(
param stride = %g [0 .. 10] "m" "Step"
param mainSteps = %u [0 .. 100000] "steps" "Stem"
param twigSteps = %u [0 .. 1000] "steps" "Twig"
Stem(n) -> Marching(stride, rand(-0.2, 0.2), n < mainSteps) {Fork(n + 1), Cover}
Fork(n) -> Branch(2) {Twig(0, rand(0, twigSteps)), Stem(n)}
Twig(n, k) -> Marching(stride, rand(-0.5, 0.5), n < k) {Twig(n + 1, k), Cover}
Cover -> Bark Leaves
Bark -> S(stride * 0.1) Shape("bark", C1)
Leaves -> Repeat(1) { T(rand(), 0) R(rand(-1, 1), 0.4) S(stride) Shape("leaf") }
)",
                  double(step), mainSteps, twigSteps);
    return text;
}

// Processor seconds of this process, all threads: on a software device the honest measure on a busy machine.
double processorSeconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_utime.tv_sec) + 1e-6 * double(usage.ru_utime.tv_usec);
}

}  // namespace

TEST_CASE("throughput on a real model") {
    std::optional<std::string> file = test::dataFile("derived/bunny_unwrap.glb");
    if (!file) return;
    Result<Model> model = importModel(*file);
    REQUIRE(model);
    TestDevice gpu(false);
    auto growth = gpu.growth();
    Scene scene = Scene::baked(*model, 1024);
    std::vector<float> scales;
    for (const Chart& chart : scene.surface().charts) scales.push_back(chart.metresPerUv);
    std::nth_element(scales.begin(), scales.begin() + scales.size() / 2, scales.end());
    float texel = scales[scales.size() / 2] / 1024;
    scene.addGrammar(branching(2.2f * texel, 1000, 24));
    const char* only = std::getenv("ESPALIER_SEEDS");
    for (uint32_t seeds : {42u, 1u, 64u, 4096u}) {
        if (only && uint32_t(std::atoi(only)) != seeds) continue;
        scene.grammar(0) = std::move(*compileGrammar(branching(2.2f * texel, 1000 * 42 / seeds, 24)));
        scene.clearSeeds();
        scene.plantMany(seeds);
        double cpu = 0;
        for (int i = 0; i < 2; ++i) {  // the first warms up
            cpu = processorSeconds();
            Status grown = scene.grow(gpu.device(), *growth);
            if (!grown) FAIL(grown.failure().text());
        }
        GrowthStats s = growth->stats();
        cpu = processorSeconds() - cpu;
        std::printf(
            "%5u seeds: %7u nodes, %6u branches, %6u chunks, %7u leaves, %4u waves, %5u inserted, %5u dead | march "
            "%6.1f "
            "terminals %6.1f fit %5.1f ms | %.2f M nodes/s | %.1f bytes a node | %.0f core ns a node\n",
            seeds, s.nodes, s.branches, s.chunks, s.leaves, s.waves, s.inserted, s.deadEnds, s.marchMs, s.terminalsMs,
            s.fitMs, double(s.nodes) / s.expandMs * 1e-3, double(s.nodeBytes + s.chunkBytes) / s.nodes,
            cpu * 1e9 / s.nodes);
        if (seeds > 1) CHECK(s.nodes > 500000);
        CHECK(double(s.nodeBytes + s.chunkBytes) / s.nodes <= 64);
    }
}
