// Growth on small analytic surfaces: what grows, what doesn't, and that GPU and CPU agree.
#include <algorithm>
#include <cmath>
#include <set>

#include "runtime/expand/growth_plan.hpp"
#include "shaders/shared/expand_tables.h"
#include "tests/expand/growing.hpp"

using namespace espalier;
using namespace espalier::growthtest;

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
    CHECK(cpu->nodes[0].radius == doctest::Approx(0.005f));
    CHECK((cpu->nodes[20].flags & kNodeTip) != 0);
    mustGrow(scene, gpu, *growth);
    checkAlike(scene, *growth);
    CHECK(growth->stats().nodes == 21);
}

TEST_CASE("any number of seeds branches, and the hash is one over runs, room and CPU") {
    TestDevice gpu;
    Scene scene = Scene::baked(ball());
    scene.addGrammar(kBranching);
    auto growth = gpu.growth();
    GrowthRoom tiny{16, 64, 16, 16, 4};
    auto cramped = gpu.growth(tiny);
    for (uint32_t seeds : {0u, 1u, 63u, 65u}) {
        CAPTURE(seeds);
        scene.clearSeeds();
        scene.plantMany(seeds);
        mustGrow(scene, gpu, *growth);
        uint64_t hash = growth->stats().hash;
        CHECK((seeds == 0) == (growth->stats().nodes == 0));
        checkAlike(scene, *growth);
        Result<GrowthRecords> records = growth->read();
        REQUIRE(records);
        checkSound(*records);
        for (int i = 0; i < 2; ++i) {
            mustGrow(scene, gpu, *growth);
            CHECK(growth->stats().hash == hash);
            CHECK(growth->stats().overflow == 0);
        }
        mustGrow(scene, gpu, *cramped);
        CHECK(cramped->stats().hash == hash);
        CHECK(cramped->stats().overflow == 0);
        if (seeds == 63) CHECK(cramped->stats().enlarged > 0);
    }
    GrowthStats s = growth->stats();
    CHECK(s.branches > 1000);
    CHECK(s.leaves > s.nodes / 4);
    CHECK(double(s.leafBytes) / s.leaves <= 32);
    std::printf("%u nodes, %u chunks, %u branches: %.1f bytes a node\n", s.nodes, s.chunks, s.branches,
                double(s.nodeBytes + s.chunkBytes) / s.nodes);
}

TEST_CASE("several grammars grow in one scene, each seed by its own") {
    TestDevice gpu;
    auto growth = gpu.growth();
    Scene scene = Scene::baked(cube());
    scene.addGrammar(kStraight);
    scene.addGrammar(kBranching);
    scene.widths = {0.05f, 0.0f};
    scene.plantMany(5, 0);
    scene.plantMany(5, 1, 2);
    mustGrow(scene, gpu, *growth);
    checkAlike(scene, *growth);
    Result<GrowthRecords> records = growth->read();
    REQUIRE(records);
    checkSound(*records);
    std::set<uint32_t> grammars;
    for (const Chunk& c : records->chunks) grammars.insert(c.symbol >> 16);
    CHECK(grammars.size() == 2);
}

TEST_CASE("a wave of more shapes than one dispatch grows is grown whole") {
    TestDevice gpu(false);
    auto growth = gpu.growth();
    Scene scene = Scene::baked(ball());
    scene.addGrammar(R"(
Stem -> Marching(0.01, rand(-1, 1), true) {NULL, Bark}
Bark -> S(0.001) Shape("bark", C1)
)");
    constexpr uint32_t kSeeds = kDispatchItems + 1000;
    for (uint32_t number = 1; scene.seeds().size() < kSeeds; ++number) scene.plantMany(kSeeds / 4, 0, number);
    GrowthStats stats[2];
    for (const bool native : {true, false}) {
        scene.native = native;
        mustGrow(scene, gpu, *growth);
        stats[native] = growth->stats();
        CHECK(stats[native].native == native);
    }
    CHECK(stats[0].chunks == scene.seeds().size());
    CHECK(stats[0].chunks == stats[1].chunks);
    CHECK(stats[0].hash == stats[1].hash);
}

TEST_CASE("tables read by address grow what those in a uniform buffer do") {
    TestDevice gpu;
    auto growth = gpu.growth();
    uint64_t first = 0;
    for (uint32_t grammars : {1u, 400u, 1u}) {  // 400: so many that their words exceed kUniformTableWords
        CAPTURE(grammars);
        Scene scene = Scene::baked(ball());
        for (uint32_t i = 0; i < grammars; ++i) scene.addGrammar(kBranching);
        std::vector<RuleMapRef> refs;
        for (uint32_t i = 0; i < grammars; ++i) refs.push_back(scene.grammar(i).ref());
        GrowthInputs inputs;
        inputs.grammars = refs;
        uint64_t words = 0;
        placeTables(inputs, words);
        REQUIRE((words > kUniformTableWords) == (grammars > 1));
        scene.plantMany(7);
        mustGrow(scene, gpu, *growth);
        checkAlike(scene, *growth);
        if (first == 0) first = growth->stats().hash;
        CHECK(growth->stats().hash == first);
        scene.plantMany(3, grammars - 1, 2);  // by the last of them
        mustGrow(scene, gpu, *growth);
        checkAlike(scene, *growth);
    }
}

TEST_CASE("kernels follow when grammars ask for more than before, and for less again") {
    TestDevice gpu;
    auto growth = gpu.growth();
    Scene scene = Scene::baked(flatSquare());
    scene.paint(0, 64, [](glm::vec2 uv) { return uv.x < 0.6f ? 1.0f : 0.0f; });
    const uint32_t plain = scene.addGrammar(kStraight);
    CHECK(scene.grammar(plain).ref().features == kFeatureKnown);
    scene.plantMany(6, plain);
    mustGrow(scene, gpu, *growth);
    checkAlike(scene, *growth);
    const uint64_t hash = growth->stats().hash;

    const uint32_t masked = scene.addGrammar(kMasked);
    CHECK((scene.grammar(masked).ref().features & kFeatureSurface) != 0);
    scene.plantMany(6, masked, 2);
    mustGrow(scene, gpu, *growth);
    checkAlike(scene, *growth);
    CHECK(growth->stats().hash != hash);

    scene.clearSeeds();
    scene.plantMany(6, plain);
    mustGrow(scene, gpu, *growth);
    CHECK(growth->stats().hash == hash);
}

TEST_CASE("a forbidden area is never entered and dead ends are counted") {
    TestDevice gpu;
    auto growth = gpu.growth();
    Scene scene = Scene::baked(flatSquare());
    scene.addGrammar(kMasked);
    auto allowed = [](glm::vec2 uv) { return uv.x < 0.5f ? 1.0f : 0.0f; };
    scene.paint(0, 256, allowed);
    for (int i = 0; i < 12; ++i) scene.plant({-0.5f, 0, -0.6f + 0.1f * float(i)}, {1, 0, 0}, 0, uint64_t(i));
    mustGrow(scene, gpu, *growth);
    checkAlike(scene, *growth);
    Result<GrowthRecords> records = growth->read();
    REQUIRE(records);
    uint32_t beyond = 0;
    for (const Node& n : records->nodes) beyond += unpackUv(n.uv).x > 0.5f + 1.0f / 256 ? 1 : 0;
    CHECK(beyond == 0);
    CHECK(records->nodes.size() > 12 * 40);  // they turn along the border rather than stop
    for (const Chunk& c : records->chunks) CHECK((c.marks >> 16) == 1u);

    // All round a small island there is no way on.
    scene.paint(0, 256, [](glm::vec2 uv) { return glm::length(uv - 0.5f) < 0.03f ? 1.0f : 0.0f; });
    scene.clearSeeds();
    scene.plant({0, 0, 0}, {1, 0, 0});
    mustGrow(scene, gpu, *growth);
    CHECK(growth->stats().deadEnds == 1);
    CHECK(growth->stats().nodes < 20);
    checkAlike(scene, *growth);
}

TEST_CASE("a painted path is followed") {
    TestDevice gpu;
    auto growth = gpu.growth();
    Scene scene = Scene::baked(flatSquare());
    scene.addGrammar(kMasked);
    // A quarter of a ring of radius 0.3 (UV) around the square's middle.
    scene.paint(0, 256, [](glm::vec2 uv) {
        return std::abs(glm::length(uv - 0.5f) - 0.3f) < 0.06f && uv.x > 0.45f && uv.y > 0.45f ? 1.0f : 0.0f;
    });
    scene.plant({0.0f, 0, 0.75f}, {1, 0, 0});
    mustGrow(scene, gpu, *growth);
    Result<GrowthRecords> records = growth->read();
    REQUIRE(records);
    float farthest = -1;
    for (const Node& n : records->nodes) {
        glm::vec2 uv = unpackUv(n.uv);
        CHECK(std::abs(glm::length(uv - 0.5f) - 0.3f) < 0.065f);
        farthest = std::max(farthest, uv.x - uv.y);
    }
    CHECK(farthest > 0.2f);  // it came around
}

TEST_CASE("the paper's walk and the paper's tangents are modes") {
    TestDevice gpu;
    auto growth = gpu.growth();
    Scene scene = Scene::baked(ball());
    scene.addGrammar(kBranching);
    scene.plantMany(6);
    mustGrow(scene, gpu, *growth);
    uint64_t ours = growth->stats().hash;
    scene.limits.tangents = TangentMode::paper;
    mustGrow(scene, gpu, *growth);
    CHECK(growth->stats().hash != ours);
    checkAlike(scene, *growth);
    scene.limits.walk = WalkMode::paper;
    mustGrow(scene, gpu, *growth);
    CHECK(growth->stats().nodes > 100);
    checkAlike(scene, *growth);
    Result<GrowthRecords> records = growth->read();
    REQUIRE(records);
    checkSound(*records);
    scene.limits = {};
    mustGrow(scene, gpu, *growth);
    CHECK(growth->stats().hash == ours);
}

TEST_CASE("the hash is one over the numbers of a software device's threads") {
    Scene scene = Scene::baked(ball());
    scene.addGrammar(kBranching);
    scene.plantMany(40);
    std::set<uint64_t> hashes;
    for (const char* threads : {"0", "1", "2"}) {
        setenv("LP_NUM_THREADS", threads, 1);
        TestDevice gpu;
        auto growth = gpu.growth(GrowthRoom{512, 1024, 512, 1024, 64});
        Scene own = Scene(scene.surface());
        own.addGrammar(kBranching);
        own.seeds() = scene.seeds();
        mustGrow(own, gpu, *growth);
        hashes.insert(growth->stats().hash);
    }
    unsetenv("LP_NUM_THREADS");
    CHECK(hashes.size() == 1);
}

TEST_CASE("our own ivy grows within its bytes, alike on GPU and CPU") {
    for (const char* name : {"ivy_free.grammar", "ivy_guided.grammar"}) {
        CAPTURE(name);
        TestDevice gpu;
        auto growth = gpu.growth();
        Scene scene = Scene::baked(ball());
        scene.addGrammar(grammarText(name));
        scene.plantMany(8);
        mustGrow(scene, gpu, *growth);
        GrowthStats s = growth->stats();
        double nodeBytes = double(s.nodeBytes + s.chunkBytes) / s.nodes;
        std::printf("%s: %u nodes, %u branches, %u leaves, %.1f bytes a node\n", name, s.nodes, s.branches, s.leaves,
                    nodeBytes);
        CHECK(s.nodes > 500);
        CHECK(s.leaves > 500);
        CHECK(nodeBytes <= 64);
        checkAlike(scene, *growth);
    }
}

TEST_CASE("the paper's ivy grammar grows") {
    std::string grammar = grammarText("ivy_paper.grammar"), prelude = grammarText("ivy_prelude.grammar");
    REQUIRE(!grammar.empty());
    size_t line = grammar.find("include");
    grammar.replace(line, grammar.find('\n', line) - line, prelude);
    TestDevice gpu;
    auto growth = gpu.growth();
    Scene scene = Scene::baked(ball());
    scene.addGrammar(grammar);
    scene.plantMany(3);
    scene.limits.maxDepth = 8;  // its main branch goes on for ever
    mustGrow(scene, gpu, *growth);
    GrowthStats s = growth->stats();
    std::printf("the paper's grammar: %u nodes, %u branches, %u leaves, %u stopped, %.1f bytes a node\n", s.nodes,
                s.branches, s.leaves, s.stopped, double(s.nodeBytes + s.chunkBytes) / s.nodes);
    CHECK(s.branches > 300);
    CHECK(s.leaves > 300);
    CHECK(s.stopped >= 3);
    checkAlike(scene, *growth);
}
