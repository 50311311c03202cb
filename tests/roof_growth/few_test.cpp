// A few houses grow on the CPU, more on the GPU: records are those of all houses grown anew, to the bit.
#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <set>

#include "runtime/roof_growth/house_tables.hpp"
#include "tests/roof_growth/grow_support.hpp"

using namespace roof_test;

namespace {

// Balconies, whose floors and walls stand on regions that Join makes, and mansards, which go on above a break.
const std::string kBalconies =
    "House -> Extrude(wallHeight) {NULL, TopWall}\n"
    "TopWall -> Join(roofHeight, roofPos1, roofPos2) {Section, NULL, TopWall}\n"
    "Section -> Split(X, 2, 1, ~) {Tiles, Balcony, Tiles}\n"
    "Balcony -> Project(localTangent(), cross(localTangent(), globalNormal())) {Explode() {Floor, NULL, Right}}\n"
    "Right -> Join(projectHeight(), currentPos1(), currentPos1()) {Floor, NULL, NULL}\n"
    "Floor -> Shape(\"panel\")\n"
    "Tiles -> Repeat(XY, vec2(0.9, 0.75), clip) {Shape(\"slate\")}\n";

// All that a grid says, wherever its records stand.
std::vector<uint8_t> contents(const RoofRecords& r, RoofGrid g) {
    std::vector<uint8_t> bytes;
    auto add = [&](const auto& value) {
        const auto* from = reinterpret_cast<const uint8_t*>(&value);
        bytes.insert(bytes.end(), from, from + sizeof(value));
    };
    for (uint32_t row = 0; g.firstRow != kNoIndex && row < g.cells >> 16; ++row) add(r.runs.at(g.firstRow + row));
    if (g.region != kNoIndex) {
        RoofRegion region = r.regions.at(g.region);
        for (uint32_t i = 0; i < region.partCount; ++i) {
            RoofPart part = r.parts.at(region.firstPart + i);
            for (uint32_t k = 0; k < (part.counts & 255u); ++k) add(r.planes.at(part.firstPlane + k));
            part.firstPlane = 0;
            add(part);
        }
        region.firstPart = region.spare[0] = region.spare[1] = 0;
        add(region);
    }
    g.house &= 0xFFFFFFu;
    g.firstRow = g.firstRow == kNoIndex ? 0 : 1;
    g.region = g.region == kNoIndex ? 0 : 1;
    std::memset(g.spare, 0, sizeof(g.spare));
    add(g);
    return bytes;
}

using Contents = std::multiset<std::pair<uint64_t, std::vector<uint8_t>>>;
// Of the grids that are drawn. generations: [house], as houses were grown.
Contents drawn(const RoofRecords& r, const std::vector<uint32_t>& generations) {
    Contents all;
    for (const RoofGrid& g : r.grids)
        if (g.house >> 24 == generations.at(g.house & 0xFFFFFFu)) all.emplace(g.key, contents(r, g));
    return all;
}

}  // namespace

TEST_CASE("houses grown on the CPU or the GPU leave the records of a town grown anew") {
    Result<std::unique_ptr<Device>> device = Device::create({});
    REQUIRE(device);
    auto made = RoofGrowth::create(**device);
    REQUIRE(made);
    RoofGrowth& growth = **made;
    constexpr uint32_t kHouses = 90;
    std::vector<Footprint> all;
    for (uint32_t i = 0; i < kHouses; ++i) {
        std::vector<glm::dvec2> plan = i % 2 ? kEll : kRectangle;
        for (glm::dvec2& p : plan) p.x += 20 * i;
        all.push_back(footprint(plan, i % 3 ? RoofShape::hip : RoofShape::mansard));
        all.back().id = "house " + std::to_string(i);
    }
    Roofs r = roofs(all, kBalconies);
    RoofInputs inputs = r.inputs();
    inputs.townRevision = 1;
    REQUIRE(growth.grow(inputs));
    std::vector<uint32_t> generations(kHouses, 0);
    Result<RoofRecords> whole = growth.read();
    REQUIRE(whole);
    const Contents before = drawn(*whole, generations);
    CHECK(before.size() == growth.stats().grids);
    const auto counts = [&] {
        const RoofStats stats = growth.stats();
        return std::array{stats.tiles, stats.clipped, uint64_t(stats.terminals), stats.hash};
    };
    const auto planned = counts();
    // One house, several, and so many that the GPU grows them.
    for (uint32_t count : {1u, 7u, 40u}) {
        std::vector<uint32_t> houses;
        for (uint32_t i = 0; i < count; ++i) houses.push_back((i * 2 + count) % kHouses);
        for (uint32_t house : houses) generations[house] += 1;
        REQUIRE(growth.growHouses(inputs, houses));
        Result<RoofRecords> patched = growth.read();
        REQUIRE(patched);
        INFO(count << " houses");
        const Contents now = drawn(*patched, generations);
        CHECK(now.size() == before.size());
        CHECK(now == before);
        CHECK(counts() == planned);  // what is drawn, not what has been replaced
    }
    CHECK(growth.stats().expansions == 4);
    // A house of another shape, by either way.
    for (bool alone : {true, false}) {
        all[6].shape = alone ? RoofShape::gable : RoofShape::pyramid;
        replaceAtoms(r.tables, 6, structureOf({all[6]}));
        std::vector<uint32_t> houses{6};
        for (uint32_t h = 10; !alone && h < 45; ++h) houses.push_back(h);
        for (uint32_t house : houses) generations[house] += 1;
        REQUIRE(growth.growHouses(inputs, houses));
        Result<RoofRecords> patched = growth.read();
        REQUIRE(patched);
        const Contents now = drawn(*patched, generations);
        CHECK(now != before);
        const auto patchedCounts = counts();
        CHECK(patchedCounts != planned);
        REQUIRE(growth.grow(inputs));  // the town's tables stay where they are, what was added is sent
        std::fill(generations.begin(), generations.end(), 0u);
        Result<RoofRecords> anew = growth.read();
        REQUIRE(anew);
        CHECK(drawn(*anew, generations) == now);
        CHECK(counts() == patchedCounts);
    }
}

TEST_CASE("tables that houses were replaced in become those of a town made anew, and grow the same") {
    std::vector<Footprint> all;
    for (uint32_t i = 0; i < 6; ++i) {
        std::vector<glm::dvec2> plan = i % 2 ? kEll : kRectangle;
        for (glm::dvec2& p : plan) p.x += 20 * i;
        all.push_back(footprint(plan, i % 3 ? RoofShape::hip : RoofShape::mansard));
        all.back().id = "house " + std::to_string(i);
    }
    Roofs r = roofs(all, kBalconies);
    CHECK_FALSE(mostlyUnused(r.tables));
    const auto sizes = [](const RoofTables& t) {
        return std::array{t.houses.size(),  t.atoms.size(), t.pieces.size(),
                          t.regions.size(), t.parts.size(), t.planes.size()};
    };
    CHECK(sizes(withoutUnused(r.tables)) == sizes(r.tables));
    for (uint32_t edit = 0; edit < 200; ++edit) {
        const uint32_t house = edit * 5 % 6;
        all[house].shape = edit % 4 < 2 ? RoofShape::gable : RoofShape::hip;
        replaceAtoms(r.tables, house, structureOf({all[house]}), {0});
    }
    CHECK(mostlyUnused(r.tables));
    const RoofTables kept = withoutUnused(r.tables);
    const Roofs anew = roofs(all, kBalconies);
    CHECK(sizes(kept) == sizes(anew.tables));
    CHECK_FALSE(mostlyUnused(kept));
    r.tables = kept;
    const CpuRoofs grown = growRoofsOnCpu(r.inputs()), wanted = growRoofsOnCpu(anew.inputs());
    CHECK(grown.status.grids > 50);
    const std::vector<uint32_t> first(all.size(), 0);
    CHECK(drawn(grown.records, first) == drawn(wanted.records, first));
}

TEST_CASE("what only the next growth of all houses would use is given back, and they grow as before") {
    Result<std::unique_ptr<Device>> device = Device::create({});
    REQUIRE(device);
    auto made = RoofGrowth::create(**device);
    REQUIRE(made);
    RoofGrowth& growth = **made;
    std::vector<Footprint> all;
    for (uint32_t i = 0; i < 80; ++i) {
        std::vector<glm::dvec2> plan = i % 2 ? kEll : kRectangle;
        for (glm::dvec2& p : plan) p.x += 20 * i;
        all.push_back(footprint(plan));
    }
    Roofs r = roofs(all, kBalconies);
    RoofInputs inputs = r.inputs();
    inputs.townRevision = 1;
    for (int i = 0; i < 2; ++i) REQUIRE(growth.grow(inputs));  // both sets of buffers are there now
    const RoofStats kept = growth.stats();
    std::vector<uint32_t> generations(all.size(), 0);
    const auto records = [&] {
        Result<RoofRecords> read = growth.read();
        REQUIRE(read);
        return drawn(*read, generations);
    };
    const Contents before = records();
    growth.trim();
    CHECK(growth.stats().reservedBytes < kept.reservedBytes * 3 / 4);
    CHECK(growth.stats().hash == kept.hash);
    CHECK(records() == before);
    for (uint32_t count : {1u, 35u}) {  // by the CPU, by the GPU
        CAPTURE(count);
        std::vector<uint32_t> houses(count);
        std::iota(houses.begin(), houses.end(), 0u);
        for (uint32_t house : houses) generations[house] += 1;
        REQUIRE(growth.growHouses(inputs, houses));
        CHECK(growth.stats().hash == kept.hash);
        CHECK(records() == before);
        growth.trim();
    }
    REQUIRE(growth.grow(inputs));
    std::fill(generations.begin(), generations.end(), 0u);
    CHECK(growth.stats().hash == kept.hash);
    CHECK(records() == before);
}
