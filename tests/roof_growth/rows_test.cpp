// The second kernel of roofs by lanes in subgroups of any size.
#include "shaders/shared/roof_rows.h"
#include "tests/roof_growth/grow_support.hpp"
#include "tests/support/emulated_lanes.hpp"

using namespace roof_test;
using espalier::test::EmulatedDispatch;
using espalier::test::EmulatedLane;

namespace {

struct RowsLane : EmulatedLane {
    RoofEnv env;
    uint32_t stride = 0;
    void main() override { finishGrids(*this, env, index, gridsToFinish(env), stride); }
};

}  // namespace

TEST_CASE("rows and sums of grids are the same for subgroups of any size") {
    std::vector<Footprint> all;
    for (int i = 0; i < 40; ++i) {
        all.push_back(footprint(i % 2 ? kEll : kRectangle, i % 3 ? RoofShape::hip : RoofShape::gable));
        for (glm::dvec2& p : all.back().rings[0]) p.x += 20 * i;
        all.back().id += std::to_string(i);
    }
    const Roofs r = roofs(all, kSlates);
    CpuRoofs right = growRoofsOnCpu(r.inputs());
    REQUIRE(right.records.grids.size() > 150);
    for (const uint32_t size : {4u, 8u, 32u, 64u})
        for (const uint32_t seed : {0u, 1u}) {
            CAPTURE(size);
            CAPTURE(seed);
            std::vector<RoofRun> runs(right.records.runs.size());
            RoofStatus status{};
            status.grids = right.status.grids;
            status.rows = right.status.rows;
            RoofEnv env{};
            env.grids.v = right.records.grids.data();
            env.runs.v = runs.data();
            env.regions.v = right.records.regions.data();
            env.parts.v = right.records.parts.data();
            env.planes.v = right.records.planes.data();
            env.plots.v = right.records.plots.data();
            env.meshes.v = const_cast<RoofMesh*>(kBounds.data());
            env.status.v = &status;
            env.gridRoom = status.grids;
            env.rowRoom = status.rows;
            constexpr uint32_t kGroups = 2;
            const std::string wrong = EmulatedDispatch::run(kGroups, kRoofGroup, {size, seed}, [&] {
                auto lane = std::make_unique<RowsLane>();
                lane->env = env;
                lane->stride = kGroups * kRoofGroup;
                return lane;
            });
            CHECK(wrong == "");
            CHECK(status.touched == right.status.touched);
            CHECK(status.whole == right.status.whole);
            CHECK(status.terminals == right.status.terminals);
            CHECK(status.hash[0] == right.status.hash[0]);
            CHECK(status.hash[1] == right.status.hash[1]);
            CHECK(std::memcmp(runs.data(), right.records.runs.data(), runs.size() * sizeof(RoofRun)) == 0);
        }
}
