// Growth on small analytic surfaces: what grows, what doesn't, limits, and that GPU and CPU agree.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#include "runtime/expand/growth_plan.hpp"
#include "shaders/shared/exact.h"
#include "shaders/shared/expand_tables.h"
#include "tests/expand/scene.hpp"

using namespace espalier;
using namespace espalier::growthtest;

namespace {

const char* kStraight = R"(
param reach = 20 [0 .. 100000] "steps" "Steps"
Stem(n) -> Marching(0.05, 0, n < reach) {Stem(n + 1), Bark}
Bark -> S(0.01) Shape("bark", C1)
)";

// Stems with side branches of side branches, bark that thins towards tips, leaves in random number.
const char* kBranching = R"(
param reach = 30 [0 .. 1000] "steps" "Steps"
Stem(n) -> Marching(0.04, rand(-0.3, 0.3), n < reach) {Fork(n + 1), Cover}
Fork(n) -> Branch(2) {Twig(0, rand(0, 12)), Stem(n)}
Twig(n, k) -> Marching(0.03, rand(-0.6, 0.6), n < k) {Bud(n + 1, k), Cover}
Bud(n, k) -> Branch(2) {Tip(0), Twig(n, k)} : 0.2
Bud(n, k) -> Twig(n, k) : 0.8
Tip(n) -> Marching(0.02, rand(-1, 1), n < 3) {Tip(n + 1), Cover}
Cover -> Bark Leaves
Bark -> S(0.002 + 0.01 * clamp(toTip / 0.5, 0, 1)) Shape("bark", C1)
Leaves -> Repeat(floor(rand(0, 3))) { T(rand(), 0.01) R(rand(-1, 1), 0.4) S(0.04 * rand(0.6, 1)) Tint(rand()) Shape("leaf") }
)";

const char* kMasked = R"(
context mask = 1
param reach = 200 [0 .. 1000] "steps" "Steps"
Stem(n) -> Marching(0.04, rand(-0.2, 0.2), mask(texCoord) > 0.5 and n < reach) {Stem(n + 1), Bark}
Bark -> S(0.01) Shape("bark", C1)
)";

std::string grammarText(const char* name) {
    std::ifstream file(std::string("content/grammars/") + name);
    std::stringstream all;
    all << file.rdbuf();
    return all.str();
}

void mustGrow(Scene& scene, TestDevice& gpu, Growth& growth) {
    Status grown = scene.grow(gpu.device(), growth);
    if (!grown) FAIL(grown.failure().text());
}

void checkAlike(Scene& scene, Growth& growth) {
    Result<CpuGrowth> cpu = scene.growOnCpu();
    Result<GrowthRecords> records = growth.read();
    REQUIRE(cpu);
    REQUIRE(records);
    GrowthDifference d = compareGrowth(*cpu, *records);
    for (const std::string& note : d.notes) std::printf("  differs: %s\n", note.c_str());
    CHECK(d.alike * 100ull >= d.branches * 99ull);
    CHECK(growth.stats().nodes == cpu->stats.nodes);
    CHECK(growth.stats().leaves == cpu->stats.leaves);
    CHECK(growth.stats().hash == cpu->stats.hash);
}

// What any growth must be: links that lead where they should, unit vectors, finite numbers.
void checkSound(const GrowthRecords& g) {
    bool sound = true;
    std::set<uint64_t> keys;
    for (size_t i = 0; i < g.nodes.size(); ++i) {
        const Node& n = g.nodes[i];
        REQUIRE(n.chunk < g.chunks.size());
        const Chunk& c = g.chunks[n.chunk];
        sound = sound && i >= c.firstNode && i < c.firstNode + chunkNodes(c.marks) &&
                ((n.flags >> 8) & 31) == i - c.firstNode;
        sound = sound && std::isfinite(n.position.x + n.position.y + n.position.z + n.radius + n.arc) && n.radius >= 0;
    }
    for (size_t i = 0; i < g.chunks.size(); ++i) {
        const Chunk& c = g.chunks[i];
        keys.insert(c.key);
        sound = sound && (c.marks & kChunkPublished) && chunkNodes(c.marks) <= kChunkNodes;
        if (c.next != kNoIndex) sound = sound && g.chunks[c.next].parent == i && g.chunks[c.next].branch == c.branch;
        if (c.previousNode != kNoIndex) sound = sound && c.previousNode < g.nodes.size();
    }
    CHECK(keys.size() == g.chunks.size());
    for (const BranchRecord& b : g.branches) {
        sound = sound && g.chunks[b.firstChunk].branch == uint32_t(&b - g.branches.data());
        sound = sound && b.thickness > 0 && b.thickness <= 1;
        uint32_t parent = g.chunks[b.firstChunk].previousNode;
        if (parent == kNoIndex) continue;
        const Node& joint = g.nodes[parent];
        const Node& first = g.nodes[g.chunks[b.firstChunk].firstNode];
        sound = sound && g.chunks[joint.chunk].branch != kNoIndex && first.radius <= joint.radius * 1.00001f;
    }
    for (const Leaf& l : g.leaves) sound = sound && l.node < g.nodes.size();
    CHECK(sound);
}

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

TEST_CASE("tables, surfaces and records read by address grow what those read as uniforms and texels do") {
    TestDevice gpu;
    auto growth = gpu.growth();
    uint64_t first = 0;
    for (uint32_t grammars : {1u, 400u}) {  // so many that their words exceed kUniformTableWords
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
        for (bool fetch : {true, false}) {
            CAPTURE(fetch);
            scene.fetch = fetch;
            mustGrow(scene, gpu, *growth);
            checkAlike(scene, *growth);
            if (first == 0) first = growth->stats().hash;
            CHECK(growth->stats().hash == first);
        }
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
