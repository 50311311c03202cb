// The march as kernels run it, by lanes in subgroups: its text as C++, on emulated lanes.
#include "runtime/expand/cpu_growth.hpp"
#include "shaders/expand/lane_words.h"
#include "shaders/shared/expand_grow.h"
#include "shaders/shared/refill.h"
#include "tests/expand/growing.hpp"
#include "tests/support/emulated_lanes.hpp"

using namespace espalier;
using namespace espalier::growthtest;
using espalier::test::EmulatedDispatch;
using espalier::test::EmulatedLane;
using espalier::test::LaneOrder;

namespace {

// A lane of march.comp. Its memory holds the staged samples too, as a kernel's does.
struct MarchLane : EmulatedLane {
    explicit MarchLane(const ExpandEnv& of) : env(of) { env.scratch = {&words[kLaneStage]}; }
    void main() override { growWave(); }

    ExpandEnv env;
    Machine machine;
    uint32_t words[kLaneWords] = {};
#define LANE_WORD(i) words[i]
#define THIS_LANE *this,
#include "shaders/expand/march.glsl"
#undef THIS_LANE
#undef LANE_WORD
};

std::string wrongInLanes;

// By emulated lanes.
uint32_t marchInLanes(ExpandEnv env, const ItemQueues& queues, uint32_t most, const LaneOrder& order) {
    uint32_t w = env.wave;
    for (; w < most && env.waves.v[w].count > 0 && wrongInLanes.empty(); ++w) {
        env.wave = w;
        env.items = queues[w & 1];
        env.nextItems = queues[(w + 1) & 1];
        wrongInLanes = EmulatedDispatch::run(env.waves.v[w].groups[0], kExpandGroup, order,
                                             [&] { return std::make_unique<MarchLane>(env); });
    }
    return w;
}

struct Summing : EmulatedLane {
    std::vector<uint32_t>* sums;
    void main() override {
        const uint32_t all = sumOfLanes(index);
        const uint32_t odd = countLanes(index % 2 == 1);
        const bool one = anyLane(index == 5);
        if (index % 3 == 0) return;  // some end before the others ask again
        const uint32_t rest = sumOfLanes(1);
        if (isFirstLane()) sums->insert(sums->end(), {all, odd, one ? 1u : 0u, rest});
    }
};
struct Straying : EmulatedLane {
    void main() override {
        if (index % 2 == 0)
            anyLane(true);
        else
            sumOfLanes(1);
    }
};

}  // namespace

TEST_CASE("emulated lanes ask together and tell where they don't") {
    for (const uint32_t seed : {0u, 1u, 2u}) {
        std::vector<uint32_t> sums;
        const std::string wrong = EmulatedDispatch::run(1, 8, {4, seed}, [&] {
            auto lane = std::make_unique<Summing>();
            lane->sums = &sums;
            return lane;
        });
        CHECK(wrong.empty());
        if (seed == 0) CHECK(sums == std::vector<uint32_t>{6, 2, 0, 2, 22, 2, 1, 3});
        CHECK(sums.size() == 8);
    }
    CHECK(!EmulatedDispatch::run(1, 8, {4, 0}, [] { return std::make_unique<Straying>(); }).empty());
}

TEST_CASE("a growth is the same for subgroups of any size, in lockstep and in any order") {
    Scene scene = Scene::baked(ball());
    scene.addGrammar(kBranching);
    scene.addGrammar(kMasked);
    scene.paint(0, 64, [](glm::vec2 uv) { return uv.x + uv.y > 1.1f ? 0.0f : 1.0f; });
    scene.plantMany(120);
    scene.plantMany(20, 1, 1000);
    Result<CpuGrowth> right = scene.growOnCpu();
    REQUIRE(right);
    REQUIRE(right->stats.nodes > 5000);
    for (const uint32_t size : {4u, 8u, 32u, 64u})
        for (const uint32_t seed : {0u, 1u, 2u}) {
            CAPTURE(size);
            CAPTURE(seed);
            wrongInLanes.clear();
            Result<CpuGrowth> grown = scene.growOnCpu([&](ExpandEnv env, const ItemQueues& queues, uint32_t most) {
                return marchInLanes(env, queues, most, {size, seed});
            });
            CHECK(wrongInLanes == "");
            REQUIRE(grown);
            CHECK(grown->stats.hash == right->stats.hash);
            CHECK(grown->stats.nodes == right->stats.nodes);
            CHECK(grown->stats.steps == right->stats.steps);
        }
}
