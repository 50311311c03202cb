// What grammars of roofs may ask for: rules without end are told in no time, and what a limit ends is ended alike by
// native code and by the GPU.
#include <ctime>

#include "tests/roof_growth/grow_support.hpp"

using namespace roof_test;

namespace {

struct OnGpu {
    std::unique_ptr<Device> device;
    std::unique_ptr<RoofGrowth> growth;
    OnGpu() {
        Result<std::unique_ptr<Device>> made = Device::create({});
        REQUIRE(made);
        device = std::move(*made);
        Result<std::unique_ptr<RoofGrowth>> roofs = RoofGrowth::create(*device);
        REQUIRE(roofs);
        growth = std::move(*roofs);
    }
    Status grow(RoofInputs inputs) {
        inputs.grammarRevision = ++revision;
        return growth->grow(inputs);
    }
    uint64_t revision = 0;
};

double seconds(const std::clock_t since) {
    return double(std::clock() - since) / CLOCKS_PER_SEC;
}
uint64_t hashOf(const CpuRoofs& roofs) {
    return uint64_t(roofs.status.hash[1]) << 32 | roofs.status.hash[0];
}
std::vector<Footprint> row(uint32_t houses) {
    std::vector<Footprint> all;
    for (uint32_t i = 0; i < houses; ++i) {
        std::vector<glm::dvec2> plan = kRectangle;
        for (glm::dvec2& p : plan) p.x += 20 * i;
        all.push_back(footprint(plan));
        all.back().id += std::to_string(i);
    }
    return all;
}

const char* const kWithoutEnd[] = {"House -> House House\nOther -> Explode() {NULL, NULL}\n",
                                   "House -> Extrude(1) {Box, NULL}\nBox -> Extrude(1) {Box, Box}\n",
                                   "House -> Explode() {House House Tile, NULL}\nTile -> Shape(\"panel\")\n"};

}  // namespace

TEST_CASE("a rule may ask for its number in a Repeat and for nothing else") {
    const std::string row = "House -> Extrude(wallHeight) {Row, NULL}\nRow -> Repeat(X, 0.5) {Slat}\n";
    OnGpu gpu;
    for (const char* slat : {"Slat : index == 0 -> Shape(\"panel\")\nSlat -> NULL\n",
                             "Slat : index + 1 == count -> Shape(\"panel\")\nSlat -> NULL\n"}) {
        Roofs r = roofs({footprint(kRectangle)}, row + slat);
        const CpuRoofs cpu = growRoofsOnCpu(r.inputs());
        CHECK(cpu.records.grids.size() == 4);
        RoofInputs inputs = r.inputs();
        for (const bool native : {false, true}) {
            inputs.native = native;
            REQUIRE(gpu.grow(inputs));
            CHECK(gpu.growth->stats().grids == 4);
            CHECK(gpu.growth->stats().hash == hashOf(cpu));
        }
    }
    // Each by its number, below what the slat itself asks for.
    Roofs r = roofs({footprint(kRectangle)}, row + "Slat -> T(0, 0.01 * index) S(0.1, 0.1) Shape(\"panel\")\n");
    const CpuRoofs cpu = growRoofsOnCpu(r.inputs());
    REQUIRE(gpu.grow(r.inputs()));
    CHECK(gpu.growth->stats().hash == hashOf(cpu));
    float low = 1e9f, high = -1e9f;
    for (const RoofGrid& g : cpu.records.grids) low = std::min(low, g.origin.y), high = std::max(high, g.origin.y);
    CHECK(high - low == doctest::Approx(0.01 * 19));
}

TEST_CASE("many cells with many successors are as many on the GPU as in native code") {
    const std::vector<glm::dvec2> slim = {{0, 0}, {45, 0}, {45, 6}, {0, 6}};
    const std::string row = "House -> Extrude(wallHeight) {Row, NULL}\nRow -> Repeat(X, 0.01, clip) {";
    std::string dots;
    for (int i = 0; i < 16; ++i) dots += "Dot ";
    const struct {
        std::string text;
        uint32_t cells, stopped;  // of a long side
    } cases[] = {
        {row + "Dot}\nDot -> T(0, index * 0.0001) S(0.01, 0.01) Shape(\"panel\")\n", 4096, 0},
        {row + dots + "}\nDot -> T(0, index * 0.0001) S(0.01, 0.01) Shape(\"panel\")\n", 1024, 1},
        {row + "Dot(sin(sizeX) + cos(sizeY * sin(sizeX + 1)) * sqrt(sizeX + sizeY) - sin(sin(sin(sin(sizeX * 2)))))}\n"
               "Dot(x) -> T(index * 0.0001, x) S(0.01, 0.01) Shape(\"panel\")\n",
         0, 1},
    };
    OnGpu gpu;
    for (const auto& c : cases) {
        Roofs r = roofs({footprint(slim)}, c.text);
        const CpuRoofs cpu = growRoofsOnCpu(r.inputs(), 2);
        REQUIRE(cpu.complete);
        INFO(c.text << cpu.status.grids);
        const uint32_t successors = c.text.find(dots) != std::string::npos ? 16 : 1;
        if (c.cells) CHECK(cpu.status.grids == 2 * successors * (c.cells + std::min(c.cells, 600u)));
        CHECK(cpu.status.stopped == 2 * c.stopped);
        CHECK(cpu.status.deep == 0);
        REQUIRE(gpu.grow(r.inputs()));
        CHECK(gpu.growth->stats().grids == cpu.status.grids);
        CHECK(gpu.growth->stats().stopped == cpu.status.stopped);
        CHECK(gpu.growth->stats().hash == hashOf(cpu));
    }
}

TEST_CASE("rules that lead to themselves without end are told soon, and the last roofs stand") {
    OnGpu gpu;
    for (uint32_t houses : {1u, 40u}) {
        Roofs good = roofs(row(houses), kSlates);
        REQUIRE(gpu.grow(good.inputs()));
        const RoofStats before = gpu.growth->stats();
        for (const char* text : kWithoutEnd) {
            Roofs r = roofs(row(houses), text);
            std::clock_t begin = std::clock();
            const CpuRoofs cpu = growRoofsOnCpu(r.inputs());
            MESSAGE(houses << " houses, " << std::string(text) << seconds(begin) << " s native");
            CHECK(seconds(begin) < 20);
            REQUIRE(!cpu.complete);
            CHECK(cpu.complete.failure().text().find("leads to itself without end") != std::string::npos);
            begin = std::clock();
            const Status grown = gpu.grow(r.inputs());
            MESSAGE(houses << " houses, " << std::string(text) << seconds(begin) << " s by kernels");
            CHECK(seconds(begin) < 20);
            REQUIRE(!grown);
            CHECK(grown.failure().text().find("leads to itself without end") != std::string::npos);
            CHECK(gpu.growth->stats().hash == before.hash);
            CHECK(gpu.growth->stats().grids == before.grids);
        }
        REQUIRE(gpu.grow(good.inputs()));
        CHECK(gpu.growth->stats().hash == before.hash);
    }
}

TEST_CASE("one chain without end is cut at the limit, however many houses have one") {
    OnGpu gpu;
    Roofs r = roofs(row(90), "House -> Extrude(0.5) {Panel, House}\nPanel -> T(0, 0.1) Shape(\"panel\")\n");
    const CpuRoofs cpu = growRoofsOnCpu(r.inputs(), 2);
    REQUIRE(cpu.complete);
    CHECK(cpu.status.deep == 360);
    CHECK(cpu.status.stopped == 360);
    CHECK(cpu.status.grids == 360 * 64);
    REQUIRE(gpu.grow(r.inputs()));
    CHECK(gpu.growth->stats().stopped == 360);
    CHECK(gpu.growth->stats().hash == hashOf(cpu));
}

TEST_CASE("room is found for what one dispatch goes through, and for no more") {
    constexpr uint32_t kMost = 65'535 * kRoofGroup;
    RoofRoom room;
    const auto held = [&](RoofStatus status, uint32_t widest) { return *room.hold(status, widest, 4); };
    CHECK(!held({}, kMost - 1));
    CHECK(room.scopes == kMost);
    CHECK(held({}, kMost));
    Result<bool> more = room.hold({}, kMost + 1, 4);
    REQUIRE(!more);
    CHECK(more.failure().text().find("more shapes of these houses than memory holds") != std::string::npos);
    RoofStatus many{};
    many.grids = UINT32_MAX;
    CHECK(!held(many, 1));
    CHECK(room.grids == UINT32_MAX);
}
