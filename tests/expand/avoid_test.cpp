// Stems that keep a distance (the statement `avoid`): measured over all pairs of spans, in double precision.
#include <doctest/doctest.h>

#include <map>

#include "runtime/core/file.hpp"
#include "tests/expand/growing.hpp"
#include "tests/expand/nearness.hpp"
#include "tests/expand/session.hpp"
#include "tests/support/data.hpp"

using namespace espalier;
using namespace espalier::growthtest;

namespace {

std::map<uint64_t, uint32_t> chunksOf(const GrowthRecords& records) {
    std::map<uint64_t, uint32_t> out;
    for (const Chunk& c : records.chunks) out[c.key] = chunkNodes(c.marks);
    return out;
}

constexpr double kFar = std::numeric_limits<double>::infinity();

Scene crowdedScene(const Model& model, uint32_t seeds) {
    Scene scene = Scene::baked(model);
    scene.addGrammar(kBranching);
    scene.plantMany(seeds);
    return scene;
}

void checkAlike(const GrowthStats& a, const GrowthStats& b) {
    CHECK(a.hash == b.hash);
    CHECK(a.nodes == b.nodes);
    CHECK(a.branches == b.branches);
    CHECK(a.leaves == b.leaves);
    CHECK(a.steps == b.steps);
    CHECK(a.inserted == b.inserted);
}

// Ivy as it is shipped, 3 cm apart on a wall of 3 m; lengths are those of a model so high.
void checkIvyOn(Scene& scene, float height) {
    const float scale = height / 3, apart = 0.03f;
    Result<std::string> text = readTextFile(std::string(ESPALIER_GRAMMARS) + "/ivy_free.grammar");
    REQUIRE(text);
    RuleMap& ivy = scene.grammar(scene.addGrammar(*text));
    ivy.setParam(*ivy.findParam("scale"), {&scale, 1});
    ivy.setParam(*ivy.findParam("apart"), {&apart, 1});
    CHECK(ivy.avoid() == doctest::Approx(scale * apart));
    scene.widths = {ivy.width()};
    scene.plantMany(12);
    scene.avoid = {ivy.avoid()};
    Result<CpuGrowth> kept = scene.growOnCpu();
    REQUIRE(kept);
    CHECK(kept->stats.nodes > 2000);
    CHECK(nearestOf(*kept, double(ivy.avoid()) * 0.99999) == kFar);
    MESSAGE(kept->stats.nodes << " nodes, " << kept->stats.branches << " branches");
}

}  // namespace

TEST_CASE("no two branches are nearer than their distance, but at joints, and most still grow") {
    for (const Model& model : {flatSquare(), ball(), cube()})
        for (const float distance : {0.005f, 0.02f, 0.06f}) {
            CAPTURE(distance);
            Scene scene = crowdedScene(model, 12);
            Result<CpuGrowth> free = scene.growOnCpu();
            scene.avoid = {distance};
            Result<CpuGrowth> kept = scene.growOnCpu();
            REQUIRE(free);
            REQUIRE(kept);
            CHECK(nearestOf(*kept, double(distance) * 0.99999) == kFar);
            CHECK(nearestOf(*free, double(distance)) < double(distance));
            CHECK(kept->stats.nodes == kept->nodes.size());
            CHECK(kept->stats.branches == kept->branches.size());
            CHECK(kept->stats.chunks == kept->chunks.size());
            MESSAGE(distance << " m: " << kept->stats.nodes << " of " << free->stats.nodes << " nodes");
        }
}

TEST_CASE("branches end in bark and leaves as if they were as long as what stands of them") {
    Scene scene = crowdedScene(ball(), 20);
    scene.avoid = {0.03f};
    Result<CpuGrowth> kept = scene.growOnCpu();
    REQUIRE(kept);
    uint32_t tips = 0;
    for (const BranchRecord& branch : kept->branches) {
        uint32_t last = kNoIndex;
        for (uint32_t c = branch.firstChunk; c != kNoIndex; c = kept->chunks[c].next)
            if (chunkNodes(kept->chunks[c].marks) > 0)
                last = kept->chunks[c].firstNode + chunkNodes(kept->chunks[c].marks) - 1;
        REQUIRE(last != kNoIndex);
        const Node& node = kept->nodes[last];
        CHECK(node.arc == branch.extent);
        CHECK((node.flags & kNodeTip) != 0);
        CHECK((node.flags & kNodeInserted) == 0);
        CHECK(node.radius <= 0.0021f);  // of kBranching's bark at its tip
        ++tips;
    }
    CHECK(tips == kept->stats.branches);
    for (const Leaf& leaf : kept->leaves) CHECK(leaf.node < kept->nodes.size());
}

TEST_CASE("shaders, native code and the reference keep the same distances, however little room there is") {
    TestDevice gpu;
    auto growth = gpu.growth(), cramped = gpu.growth({16, 64, 16, 16, 4});
    for (const uint32_t seeds : {1u, 40u, 200u}) {
        Scene scene = crowdedScene(cube(), seeds);
        scene.avoid = {0.02f};
        Result<CpuGrowth> reference = scene.growOnCpu();
        REQUIRE(reference);
        for (const bool native : {false, true}) {
            scene.native = native && gpu.device().info().cpu;
            CAPTURE(native);
            for (Growth* one : {growth.get(), cramped.get()}) {
                const Status grown = scene.grow(gpu.device(), *one);
                REQUIRE_MESSAGE(grown, (grown ? "" : grown.failure().text()));
                checkAlike(reference->stats, one->stats());
                Result<GrowthRecords> records = one->read();
                REQUIRE(records);
                CHECK(chunksOf(*records) == chunksOf(*reference));
            }
        }
    }
}

TEST_CASE("a distance of 0 is none, and a grammar without one takes no part") {
    Scene scene = Scene::baked(ball());
    scene.addGrammar(kBranching);
    scene.addGrammar(kStraight);
    scene.plantMany(10, 0, 1);
    scene.plantMany(10, 1, 2);
    Result<CpuGrowth> free = scene.growOnCpu();
    scene.avoid = {0, 0};
    Result<CpuGrowth> none = scene.growOnCpu();
    REQUIRE(free);
    REQUIRE(none);
    CHECK(free->stats.hash == none->stats.hash);
    scene.avoid = {0.02f, 0};
    Result<CpuGrowth> one = scene.growOnCpu();
    REQUIRE(one);
    std::map<uint64_t, uint32_t> whole = chunksOf(*free), now = chunksOf(*one);
    uint32_t straight = 0;
    for (const Chunk& c : free->chunks)
        if (c.symbol >> 16 == 1) {
            CHECK(now[c.key] == chunkNodes(c.marks));
            ++straight;
        }
    CHECK(straight >= 10);
    CHECK(one->stats.nodes < free->stats.nodes);
    scene.avoid = {-1, 0};
    CHECK(!scene.growOnCpu());
    scene.avoid = {0.1f};
    CHECK(!scene.growOnCpu());
}

TEST_CASE("distances of no sense end in plants, or in none") {
    Scene scene = crowdedScene(ball(), 12);
    Result<CpuGrowth> free = scene.growOnCpu();
    REQUIRE(free);
    for (const float distance : {1e-38f, 1e-30f, 1e-6f}) {
        scene.avoid = {distance};
        Result<CpuGrowth> kept = scene.growOnCpu();
        REQUIRE_MESSAGE(kept, (kept ? "" : kept.failure().text()));
        CHECK(kept->stats.nodes > free->stats.nodes / 3);
    }
    scene.avoid = {1e30f};  // one plant is left, whose branches all meet at joints
    Result<CpuGrowth> kept = scene.growOnCpu();
    REQUIRE_MESSAGE(kept, (kept ? "" : kept.failure().text()));
    CHECK(kept->stats.nodes < free->stats.nodes);
}

TEST_CASE("shapes that a device loses are noticed wave by wave, where stems keep distances, too") {
    GrowStatus status{};
    status.limitWave = 10;
    const auto grew = [&](std::vector<std::array<uint32_t, 2>> waves) {
        std::vector<Wave> all(waves.size());
        status.chunks = status.nodes = 0;
        for (size_t i = 0; i < waves.size(); ++i) {
            all[i].count = waves[i][0];
            all[i].chunks = all[i].nodes = waves[i][1];
            status.chunks += waves[i][1];
            status.nodes += waves[i][1];
        }
        return everyShapeGrew(status, all);
    };
    CHECK(grew({{3, 3}, {5, 5}, {0, 0}}));
    CHECK(!grew({{3, 3}, {5, 4}, {0, 0}}));
    CHECK(!grew({{3, 4}, {5, 4}, {0, 0}}));  // in sum there are as many
    status.dropped = 1;
    CHECK(!grew({{3, 3}, {5, 4}, {0, 0}}));  // nobody drops any
    status.avoidReach = 1;
    CHECK(grew({{3, 3}, {5, 4}, {0, 0}}));
    CHECK(!grew({{3, 3}, {5, 3}, {0, 0}}));
    CHECK(!grew({{3, 4}, {5, 3}, {0, 0}}));
    status.waveUndecided = 1;
    CHECK(!grew({{3, 3}, {5, 4}, {0, 0}}));
    status.waveUndecided = 0;
    status.limitWave = 1;  // of the second wave nobody knows
    CHECK(grew({{3, 3}, {5, 2}, {0, 0}}));
    CHECK(!grew({{5, 3}, {5, 5}, {0, 0}}));
}

TEST_CASE("an edit among stems that keep a distance gives what growing all anew gives") {
    Session s(ball());
    s.scene.avoid = {0.02f, 0.01f};
    s.scene.plantMany(20, 0, 1);
    s.scene.plantMany(10, 1, 2);
    s.check();
    const uint64_t before = s.growth->stats().hash;
    s.dab(0, {0.4f, 0.4f}, 0.1f, 0);
    s.check();
    CHECK(s.growth->stats().hash != before);
    s.dab(0, {0.4f, 0.4f}, 0.1f, 1);
    s.check();
    CHECK(s.growth->stats().hash == before);
    s.scene.avoid = {0, 0.01f};
    s.check();
    s.scene.avoid = {0, 0};
    s.check();
    s.dab(0, {0.3f, 0.5f}, 0.1f, 0);
    s.check();
    CHECK(s.growth->stats().regrowths == 1);  // the first that could be one
}

TEST_CASE("stems stay away from frozen plants, which stay as they are") {
    Session s(ball());
    s.scene.avoid = {0.03f, 0.03f};
    s.scene.plantMany(24, 0, 1);
    s.grow();
    Result<GrowthRecords> records = s.growth->read();
    REQUIRE(records);
    const std::vector<Seed> seeds = s.scene.seeds();
    s.scene.clearSeeds();
    for (size_t i = 0; i < seeds.size(); ++i) {
        const bool frozen = i % 3 == 0;
        if (frozen)
            s.scene.frozen.push_back({seeds[i].key, std::make_shared<PlantRecords>(plantOf(*records, uint32_t(i)))});
        else
            s.scene.seeds().push_back(seeds[i]);
    }
    // What has grown in a second try can be saved and loaded.
    for (const FrozenPlant& plant : s.scene.frozen) {
        const Result<PlantRecords> loaded = unpackPlant(packPlant(*plant.records), 1);
        CHECK_MESSAGE(loaded, (loaded ? "" : loaded.failure().text()));
    }
    s.changes.everything = true;
    for (const bool native : {false, true}) {
        s.scene.native = native;
        s.grow();
        Result<GrowthRecords> now = s.growth->read();
        REQUIRE(now);
        CHECK(nearestOf(*now, 0.03 * 0.99999) == kFar);
        uint32_t stand = 0;
        const std::map<uint64_t, uint32_t> chunks = chunksOf(*now);
        for (const FrozenPlant& plant : s.scene.frozen)
            for (const Chunk& c : plant.records->chunks) {
                CHECK(chunks.at(c.key) == chunkNodes(c.marks));
                ++stand;
            }
        CHECK(stand > 20);
        CHECK(now->chunks.size() > stand);
        s.changes.everything = true;
    }
}

TEST_CASE("ivy keeps its distance on the ruin") {
    Result<SurfaceData> ruin = readSurface(ESPALIER_RUIN);
    REQUIRE_MESSAGE(ruin, (ruin ? "" : ruin.failure().text()));
    Scene scene(std::move(*ruin));
    checkIvyOn(scene, 3);
}

TEST_CASE("ivy keeps its distance on statues") {
    if (test::dataFolder().empty()) {
        MESSAGE("skipped: it needs the data of tests");
        return;
    }
    for (const char* name : {"bunny", "armadillo", "dragon_res3"}) {
        CAPTURE(std::string(name));
        Result<Model> model = importModel((test::dataFolder() / "derived" / (std::string(name) + ".glb")).string());
        REQUIRE(model);
        Scene scene = Scene::baked(*model, 512);
        float low = 1e30f, high = -1e30f;
        for (const glm::vec3& p : model->positions) low = std::min(low, p.y), high = std::max(high, p.y);
        checkIvyOn(scene, high - low);
    }
}
