// Growth that comes to its limits: of nodes, leaves, room and density; and inputs that can't be grown.
#include <limits>
#include <string>

#include "runtime/expand/growth_plan.hpp"
#include "tests/expand/growing.hpp"

using namespace espalier;
using namespace espalier::growthtest;

TEST_CASE("endless recursion ends at the limits, reported") {
    TestDevice gpu;
    auto growth = gpu.growth();
    Scene scene = Scene::baked(ball());
    scene.addGrammar("Stem -> Marching(0.05, rand(-1, 1), true) {Stem, Bark}\nBark -> S(0.01) Shape(\"bark\", C1)\n");
    scene.plantMany(3);
    scene.limits.maxDepth = 70;
    mustGrow(scene, gpu, *growth);
    CHECK(growth->stats().stopped == 3);
    CHECK(growth->stats().waves == 70);
    CHECK(growth->stats().nodes > 3 * 70 * 20);
    CHECK(growth->stats().nodes <= 3 * 70 * 32);
    checkAlike(scene, *growth);

    // Everything branches without end: the limit of nodes holds, and alike in every run.
    scene.grammar(0) = std::move(
        *compileGrammar("Stem -> Marching(0.05, rand(-1, 1), true) {Fork, Bark}\nFork -> Branch(2) {Stem, Stem}\n"
                        "Bark -> S(0.01) Shape(\"bark\", C1)\n"));
    scene.limits.maxNodes = 20000;
    mustGrow(scene, gpu, *growth);
    GrowthStats s = growth->stats();
    CHECK(s.nodes <= 20000);
    CHECK(s.nodes > 1000);
    CHECK(s.overflow > 0);
    CHECK(s.stopped > 0);
    auto again = gpu.growth(GrowthRoom{64, 64, 64, 64, 64});
    mustGrow(scene, gpu, *again);
    CHECK(again->stats().hash == s.hash);
    Result<GrowthRecords> records = growth->read();
    REQUIRE(records);
    checkSound(*records);
}

TEST_CASE("as many leaves as the limit grow, one more is refused by name, and what grew before stands") {
    TestDevice gpu;
    Scene scene = Scene::baked(ball());
    scene.addGrammar(kBranching);
    scene.plantMany(6);
    for (const bool native : {false, true}) {
        CAPTURE(native);
        scene.native = native;
        scene.limits.maxLeaves = GrowthLimits().maxLeaves;
        auto growth = gpu.growth(GrowthRoom{64, 64, 64, 64, 64});
        mustGrow(scene, gpu, *growth);
        const GrowthStats s = growth->stats();
        REQUIRE(s.leaves > 100);
        scene.limits.maxLeaves = s.leaves;
        mustGrow(scene, gpu, *growth);
        CHECK(growth->stats().hash == s.hash);
        for (uint32_t most : {s.leaves - 1, 10u, 0u}) {
            scene.limits.maxLeaves = most;
            const Status refused = scene.grow(gpu.device(), *growth);
            REQUIRE_FALSE(refused);
            const std::string why = "would have more than " + std::to_string(most) + " leaves";
            CHECK(refused.failure().text().find(why) != std::string::npos);
            CHECK(growth->stats().hash == s.hash);
            const Result<CpuGrowth> onCpu = scene.growOnCpu();
            REQUIRE_FALSE(onCpu);
            CHECK(onCpu.failure().text().find(why) != std::string::npos);
        }
    }
}

TEST_CASE("the density cap thins leaves, alike in every run") {
    TestDevice gpu;
    auto growth = gpu.growth();
    Scene scene = Scene::baked(ball());
    scene.addGrammar(kBranching);
    scene.plantMany(8);
    mustGrow(scene, gpu, *growth);
    uint32_t all = growth->stats().leaves;
    scene.limits.leafDensityCap = 40;
    mustGrow(scene, gpu, *growth);
    uint32_t capped = growth->stats().leaves;
    CHECK(capped < all);
    CHECK(capped > 0);
    checkAlike(scene, *growth);
}

TEST_CASE("what one large growth took is given back, and what is smaller grows on in less room") {
    TestDevice gpu;
    for (bool native : {false, true}) {
        CAPTURE(native);
        auto growth = gpu.growth({64, 1024, 64, 1024, 64});
        Scene scene = Scene::baked(cube());
        scene.native = native;
        scene.addGrammar(kBranching);
        scene.plantMany(300);
        mustGrow(scene, gpu, *growth);
        mustGrow(scene, gpu, *growth);  // into the other set of buffers
        const GrowthStats large = growth->stats();
        GrowthChanges none;
        none.everything = false;
        const auto edit = [&](Growth& edited) {
            scene.changes = &none;
            scene.plantMany(1, 0, 9);
            mustGrow(scene, gpu, edited);
            CHECK(edited.stats().regrowths == 1);
            scene.changes = nullptr;
        };
        edit(*growth);
        scene.clearSeeds();
        scene.plantMany(3);
        mustGrow(scene, gpu, *growth);
        const uint64_t hash = growth->stats().hash, kept = growth->stats().reservedBytes;
        CHECK(kept >= large.reservedBytes);

        growth->trim();
        CHECK(growth->stats().hash == hash);
        CHECK(growth->stats().reservedBytes < kept);
        checkAlike(scene, *growth);
        mustGrow(scene, gpu, *growth);  // into new buffers
        growth->trim();                 // which leaves those of the large growth
        CHECK(growth->stats().hash == hash);
        CHECK(growth->stats().nodes < large.nodes / 50);
        MESSAGE("bytes of " << large.nodes << " nodes: " << kept << "; then " << growth->stats().reservedBytes);
        CHECK(growth->stats().reservedBytes < kept / 2);
        checkAlike(scene, *growth);
        // No more is left than one has that never was large.
        auto small = gpu.growth({64, 1024, 64, 1024, 64});
        mustGrow(scene, gpu, *small);
        edit(*small);
        MESSAGE("bytes of one that never was: " << small->stats().reservedBytes);
        CHECK(growth->stats().reservedBytes <= small->stats().reservedBytes);

        scene.plantMany(300);
        mustGrow(scene, gpu, *growth);
        CHECK(growth->stats().enlarged > 0);
        checkAlike(scene, *growth);
    }
}

TEST_CASE("more grammars than work items can name are refused") {
    const std::vector<RuleMapRef> maps(65537);
    GrowthInputs inputs;
    inputs.grammars = std::span(maps).first(65536);
    CHECK(checkInputs(inputs));
    inputs.grammars = maps;
    const Status refused = checkInputs(inputs);
    REQUIRE(!refused);
    CHECK(refused.failure().text().find("65537 grammars") != std::string::npos);
}

TEST_CASE("inputs that can't be grown are refused and the last growth stands") {
    TestDevice gpu;
    auto growth = gpu.growth();
    Scene scene = Scene::baked(flatSquare());
    scene.addGrammar(kStraight);
    scene.plant({0, 0, 0}, {1, 0, 0});
    mustGrow(scene, gpu, *growth);
    uint64_t revision = growth->view().revision;
    Seed good = scene.seeds()[0];
    auto refused = [&] {
        bool failed = !scene.grow(gpu.device(), *growth) && !scene.growOnCpu();
        scene.seeds()[0] = good;
        return failed;
    };
    scene.seeds()[0].grammar = 3;
    CHECK(refused());
    scene.seeds()[0].symbol = 99;
    CHECK(refused());
    scene.seeds()[0].walk.uv.x = std::numeric_limits<float>::quiet_NaN();
    CHECK(refused());
    scene.seeds()[0].walk.place = 7u << 16;
    CHECK(refused());
    scene.limits.maxDepth = 0;
    CHECK(refused());
    scene.limits.maxDepth = 4096;
    CHECK(growth->view().revision == revision);
    CHECK(growth->stats().nodes > 10);

    // A chart that isn't there, a place off the surface, a direction along the normal: dead ends, no harm.
    scene.seeds()[0].walk.place = 40000;
    mustGrow(scene, gpu, *growth);
    CHECK(growth->stats().deadEnds == 1);
    scene.seeds()[0] = good;
    scene.seeds()[0].walk.uv = {0.99f, -7};
    mustGrow(scene, gpu, *growth);
    CHECK(growth->stats().deadEnds == 1);
    scene.seeds()[0] = good;
    scene.seeds()[0].walk.direction = {0, 1, 0};
    mustGrow(scene, gpu, *growth);
    CHECK(growth->stats().nodes > 1);
}
