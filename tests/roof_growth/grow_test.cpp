#include "tests/roof_growth/grow_support.hpp"

using namespace roof_test;

TEST_CASE("a hip's slates cover its faces") {
    Roofs r = roofs({footprint(kRectangle)}, kSlates);
    CHECK(r.map.roofs());
    CHECK(r.tables.atoms.size() == 4);
    CpuRoofs cpu = growRoofsOnCpu(r.inputs());
    CHECK(cpu.records.grids.size() == 4);
    // Whole cells can't cover more than the roof's area, touched ones no less.
    const double area = 60 * std::sqrt(2.0), cell = 0.25 * 0.2;
    MESSAGE(cpu.status.touched << " cells, " << cpu.status.whole << " whole");
    CHECK(cpu.status.whole * cell < area);
    CHECK(cpu.status.touched * cell > area);
    CHECK(cpu.status.touched * cell < area * 1.25);
    CHECK(cpu.status.stopped == 0);
}

TEST_CASE("the GPU grows what the CPU grows") {
    Result<std::unique_ptr<Device>> device = Device::create({});
    REQUIRE(device);
    auto growth = RoofGrowth::create(**device);
    REQUIRE(growth);
    std::vector<Footprint> all;
    for (RoofShape shape :
         {RoofShape::hip, RoofShape::gable, RoofShape::halfHip, RoofShape::mansard, RoofShape::flat}) {
        all.push_back(footprint(kRectangle, shape));
        all.push_back(footprint(kEll, shape));
        all.back().id += std::to_string(all.size());
    }
    Roofs r = roofs(all, kSlates);
    CpuRoofs cpu = growRoofsOnCpu(r.inputs(), 2);
    REQUIRE((*growth)->grow(r.inputs()));
    const RoofStats stats = (*growth)->stats();
    CHECK(stats.hash == (uint64_t(cpu.status.hash[1]) << 32 | cpu.status.hash[0]));
    CHECK(stats.grids == cpu.status.grids);
    CHECK(stats.tiles == cpu.status.touched);
    CHECK(stats.tiles - stats.clipped == cpu.status.whole);
}
