// Lists of stages: the barriers that follow from what stages touch, which no software device would miss, and how native
// code goes through a list.
#include <doctest/doctest.h>

#include "runtime/expand/growth_stages.hpp"
#include "runtime/host/kernels.hpp"
#include "runtime/pattern/pattern_stages.hpp"
#include "runtime/roof_growth/roof_stages.hpp"
#include "runtime/run/hazards.hpp"
#include "runtime/run/host_runner.hpp"

using namespace espalier;

namespace {

constexpr Things kA = 1, kB = 2, kC = 4;

bool has(Use all, Use one) {
    return (uint32_t(all) & uint32_t(one)) != 0;
}

// [stage]: whether it waits for those before it.
std::vector<bool> waitsOf(const StageList& list) {
    Hazards hazards;
    std::vector<bool> waits;
    for (const Stage& stage : list) waits.push_back(hazards.add(stage.kernel, stage.groups).any);
    return waits;
}

// A plant's lists with all passes, as shaders would run them.
struct Lists {
    Buffer buffer;
    GrowthShaders shaders{&buffer, &buffer, &buffer};
    ExpandEnv env{};
    GrowthLimits limits;
    Lists() {
        env.itemCapacity = 1;
        limits.tangents = TangentMode::paper;
        limits.leafDensityCap = 1;
    }
    std::vector<StageList> ofGrowth() const {
        return {tableStages(shaders, env, 1), growthStages(shaders, env, {}, limits, 0, 0, 2),
                growthStages(shaders, env, {}, limits, 2, 0, 2), findStages(shaders, env),
                regrowthStages(shaders, env, {}, 0, 2)};
    }
};

// Waves in which so many shapes wait, but too many for the room that there is: native code goes through each and
// derives nothing.
struct FullWaves {
    std::vector<Wave> waves;
    RoofStatus status{};
    RoofEnv env{};
    uint32_t turned = 0;
    explicit FullWaves(std::vector<uint32_t> counts) {
        for (uint32_t count : counts) waves.push_back({count, {0, 1, 1}, 0, 0, 0, 0});
        env.waves.v = waves.data();
        env.status.v = &status;
    }
    StageList list() {
        StageList stages = roofStages({}, env, 0, uint32_t(waves.size()));
        stages[0].turn = [this, turn = stages[0].turn](Stage& stage, uint32_t wave) {
            turn(stage, wave);
            ++turned;
        };
        return stages;
    }
};

}  // namespace

TEST_CASE("a stage waits for who has written what it touches, and for who has read what it writes") {
    Hazards hazards;
    CHECK(!hazards.add({"", kA, kB}, {}).any);
    CHECK(!hazards.add({"", kA, kC}, {}).any);  // both read
    CHECK(hazards.add({"", kB, 0}, {}).any);
    CHECK(!hazards.add({"", kC, 0}, {}).any);  // waited for, too
    CHECK(hazards.add({"", 0, kB}, {}).any);   // which was read
    CHECK(hazards.add({"", 0, kB}, {}).any);   // which was written
    const Hazards::Wait groups = hazards.add({"", 0, kC}, {{}, nullptr, 0, kB});
    CHECK(has(groups.before, Use::compute));  // by whom numbers of groups are written
    const Hazards::Wait after = hazards.add({"", 0, kB}, {});
    CHECK(has(after.before, Use::indirect));
    hazards.sent();
    const Hazards::Wait sent = hazards.add({"", kA, 0}, {});
    CHECK(has(sent.before, Use::transfer));
    CHECK(!has(sent.before, Use::indirect));
}

TEST_CASE("each stage of growth waits for the one before, but leaves move beside nodes") {
    const Lists lists;
    for (const StageList& list : lists.ofGrowth()) {
        const std::vector<bool> waits = waitsOf(list);
        CHECK(!waits[0]);
        for (size_t i = 1; i < waits.size(); ++i) {
            CAPTURE(list[i].kernel.shader);
            CHECK(waits[i]);
        }
    }
    CHECK(waitsOf(compactionStages(lists.shaders, {})) == std::vector<bool>{false, true, false});
    // A wave waits for the one before it.
    for (const StageList& list :
         {growthStages(lists.shaders, lists.env, {}, lists.limits, 0, 0, 2), roofStages({}, {}, 0, 2)})
        CHECK(waitsOf({list[0], list[0]}) == std::vector<bool>{false, true});
}

TEST_CASE("native code has each kernel that it may be handed") {
    const Lists lists;
    std::vector<StageList> all = lists.ofGrowth();
    all.push_back(closingStages({}));
    all.push_back(roofStages({}, {}, 0, 1));
    all.push_back(patternStages({}, {}));
    all.push_back(patternHashStages({}, {}));
    GrowthLimits paper;
    paper.walk = WalkMode::paper;
    all.push_back(growthStages(lists.shaders, lists.env, {}, paper, 0, 0, 1));
    for (const StageList& list : all)
        for (const Stage& stage : list) {
            CAPTURE(stage.kernel.shader);
            const bool known = hostKernel(stage.kernel.shader) != nullptr;
            CHECK(known);
        }
    const bool copies = hostKernel("expand/compact_places.comp") != nullptr;
    CHECK(!copies);
}

TEST_CASE("native code goes through waves until one is empty") {
    const std::pair<std::vector<uint32_t>, uint32_t> cases[] = {{{1, 1, 0, 1}, 3}, {{0, 1}, 1}, {{1, 1}, 2}};
    for (const auto& [counts, turned] : cases) {
        FullWaves waves(counts);
        StageList list = waves.list();
        CHECK(HostRunner(1).run(list));
        CHECK(waves.turned == turned);
    }
}

TEST_CASE("who watches stops stages, but none that has to be brought to its end") {
    GrowthWatch watch([](uint64_t) { return false; }, std::chrono::milliseconds(0));
    watch.begin();
    CHECK(!watch.look(0));
    FullWaves waves({1, 0});
    StageList list = waves.list();
    CHECK(!HostRunner(1).run(list, &watch));
    CHECK(waves.turned == 0);
    for (Stage& stage : list) stage.watched = false;
    PassTimes times;
    CHECK(HostRunner(1).run(list, &watch, &times));
    CHECK(waves.turned == 2);
    CHECK(times.size() == 1);
    CHECK(times["roof expand"] > 0);
}
