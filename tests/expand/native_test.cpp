// Growth as native code against growth by shaders: the same plants, whatever the number of threads and whatever edits.
#include <doctest/doctest.h>

#include "shaders/shared/random.h"
#include "tests/expand/session.hpp"

using namespace espalier;
using namespace espalier::growthtest;

namespace {

void mustGrow(Scene& scene, TestDevice& gpu, Growth& growth) {
    Status grown = scene.grow(gpu.device(), growth);
    if (!grown) FAIL(grown.failure().text());
}

}  // namespace

TEST_CASE("native code grows what shaders grow") {
    TestDevice gpu;
    if (!gpu.device().info().cpu) {
        MESSAGE("only software devices run growth as native code");
        return;
    }
    Scene scene = Scene::baked(cube());
    scene.addGrammar(kGuided);
    scene.paint(0, 256, [](glm::vec2 uv) { return uv.x + uv.y < 1.2f ? 1.0f : 0.0f; });
    auto shaders = gpu.growth(), native = gpu.growth(), cramped = gpu.growth({16, 64, 16, 16, 4});
    struct Mode {
        uint32_t seeds;
        TangentMode tangents;
        WalkMode walk;
        float cap;
        uint32_t most;
    };
    const Mode modes[] = {{1, TangentMode::stem, WalkMode::intrinsic, 0, 4'000'000},
                          {65, TangentMode::stem, WalkMode::intrinsic, 0, 4'000'000},
                          {65, TangentMode::stem, WalkMode::intrinsic, 0, 3000},
                          {33, TangentMode::paper, WalkMode::paper, 0, 4'000'000},
                          {33, TangentMode::stem, WalkMode::intrinsic, 40, 4'000'000}};
    for (const Mode& mode : modes) {
        CAPTURE(&mode - modes);
        scene.clearSeeds();
        scene.plantMany(mode.seeds);
        scene.limits.tangents = mode.tangents;
        scene.limits.walk = mode.walk;
        scene.limits.leafDensityCap = mode.cap;
        scene.limits.maxNodes = mode.most;
        scene.native = false;
        mustGrow(scene, gpu, *shaders);
        CHECK(!shaders->stats().native);
        scene.native = true;
        for (Growth* growth : {native.get(), cramped.get()}) {
            mustGrow(scene, gpu, *growth);
            const GrowthStats a = shaders->stats(), b = growth->stats();
            CHECK(b.native);
            CHECK(b.nodes >= mode.seeds);
            CHECK(a.hash == b.hash);
            CHECK(a.nodes == b.nodes);
            CHECK(a.chunks == b.chunks);
            CHECK(a.branches == b.branches);
            CHECK(a.leaves == b.leaves);
            CHECK(a.stopped == b.stopped);
            CHECK(a.waves == b.waves);
        }
    }
}

TEST_CASE("edits of what native code has grown") {
    Session s(ball());
    s.scene.native = true;
    s.scene.plantMany(40, 0);
    s.scene.plantMany(20, 1, 2);  // with keys of their own, by which growths are compared
    s.upload(0);
    s.upload(1);
    s.check();
    const uint32_t before = s.growth->stats().regrowths;
    uint64_t key = 7;
    for (int i = 0; i < 6; ++i) {
        CAPTURE(i);
        key = mix64(key);
        const glm::vec2 at(uniformRandom(key, 1), uniformRandom(key, 2));
        s.dab(uint32_t(i & 1), at, 0.02f + 0.1f * uniformRandom(key, 3), i % 3 == 0 ? 0.0f : uniformRandom(key, 4));
        s.check();
    }
    s.set(0, "leafSize", 0.05f);
    s.check();
    s.set(1, "reach", 18);
    s.check();
    s.scene.seeds().pop_back();
    s.check();
    CHECK(s.growth->stats().regrowths > before);
}
