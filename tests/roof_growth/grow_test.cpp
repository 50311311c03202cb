#include <algorithm>
#include <set>

#include "runtime/roof_growth/plan_layers.hpp"
#include "shaders/shared/roof_layers.h"
#include "shaders/shared/roof_tables.h"
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
    for (bool native : {false, true, false}) {
        RoofInputs inputs = r.inputs();
        inputs.native = native;
        REQUIRE((*growth)->grow(inputs));
        const RoofStats stats = (*growth)->stats();
        CHECK(stats.hash == (uint64_t(cpu.status.hash[1]) << 32 | cpu.status.hash[0]));
        CHECK(stats.grids == cpu.status.grids);
        CHECK(stats.tiles == cpu.status.touched);
        CHECK(stats.tiles - stats.clipped == cpu.status.whole);
    }
}

TEST_CASE("more waves than the last expansion took are gone through") {
    Result<std::unique_ptr<Device>> device = Device::create({});
    REQUIRE(device);
    auto growth = RoofGrowth::create(**device);
    REQUIRE(growth);
    const char* stairs =
        "House -> Extrude(wallHeight) {Step(20), NULL}\n"
        "Step(n) : n > 0 -> Tile Step(n - 1)\n"  // the second is for another wave
        "Step(n) -> NULL\n"
        "Tile -> Shape(\"slate\")\n";
    Roofs flat = roofs({footprint(kRectangle)}, kSlates), deep = roofs({footprint(kRectangle)}, stairs);
    REQUIRE((*growth)->grow(flat.inputs()));
    CHECK((*growth)->stats().waves <= 2);
    RoofInputs inputs = deep.inputs();
    inputs.grammarRevision = 2;
    REQUIRE((*growth)->grow(inputs));
    CpuRoofs cpu = growRoofsOnCpu(inputs);
    CHECK((*growth)->stats().waves == 21);
    CHECK((*growth)->stats().grids == 80);
    CHECK((*growth)->stats().hash == (uint64_t(cpu.status.hash[1]) << 32 | cpu.status.hash[0]));
}

TEST_CASE("a grammar that a uniform buffer can't hold grows the same") {
    Result<std::unique_ptr<Device>> device = Device::create({});
    REQUIRE(device);
    auto growth = RoofGrowth::create(**device);
    REQUIRE(growth);
    // A hundred kilobytes of rules: each tile of a 16 by 16 board has its own.
    std::string board =
        "House -> Extrude(wallHeight) {NULL, TopWall}\n"
        "TopWall -> Join(roofHeight, roofPos1, roofPos2) {Face, NULL, TopWall}\nFace ->";
    std::string rules;
    for (int i = 0; i < 16; ++i) {
        const std::string row = "Row" + std::to_string(i);
        board += " " + row;
        rules += row + " ->";
        for (int k = 0; k < 16; ++k) rules += " " + row + "Cell" + std::to_string(k);
        rules += "\n";
        for (int k = 0; k < 16; ++k)
            rules += row + "Cell" + std::to_string(k) + " -> T(sizeX * " + std::to_string(i / 16.) + ", sizeY * " +
                     std::to_string(k / 16.) + ") S(sizeX / 16, sizeY / 16) Tint(rand()) Shape(\"slate\")\n";
    }
    Roofs r = roofs({footprint(kRectangle)}, board + "\n" + rules);
    REQUIRE(r.map.words().size() > kUniformMapWords);
    CpuRoofs cpu = growRoofsOnCpu(r.inputs());
    REQUIRE((*growth)->grow(r.inputs()));
    const RoofStats stats = (*growth)->stats();
    CHECK(stats.grids == 4 * 256);
    CHECK(stats.hash == (uint64_t(cpu.status.hash[1]) << 32 | cpu.status.hash[0]));
    // Back to a small one, which is of other kinds: the kernel follows.
    Roofs small = roofs({footprint(kEll, RoofShape::gable)}, kSlates);
    RoofInputs next = small.inputs();
    next.grammarRevision = 2;
    REQUIRE((*growth)->grow(next));
    cpu = growRoofsOnCpu(next);
    CHECK((*growth)->stats().hash == (uint64_t(cpu.status.hash[1]) << 32 | cpu.status.hash[0]));
}

// Buron 2013 §4 as printed, but for ASCII, behind the prelude that it leaves open.
static const std::string kBalcony =
    "let sizeTiles = vec2(0.3, 0.25)\n"
    "House -> Extrude(wallHeight) {WallBalcShape, TopWall}\n"
    "TopWall     -> Join(3, roofPos1, roofPos2) {RoofSection, NULL, MansardTop}\n"
    "RoofSection -> Split(X, 2, 1, ~) {RoofCov, Balcony, RoofCov}\n"
    "Balcony     -> Split(Y, 0.5, 2, ~) {RoofCov, BalconyPart, RoofCov}\n"
    "BalconyPart -> Project(localTangent(), cross(localTangent(), globalNormal())) {BalconyFlat}\n"
    "BalconyFlat -> Explode() {FloorShape, NULL, RightBalc, BackBalc, LeftBalc}\n"
    "RightBalc   -> Join(projectHeight(), currentPos1(), currentPos1()) {WallBalcShape, NULL, NULL}\n"
    "LeftBalc    -> Join(projectHeight(), currentPos0(), currentPos0()) {WallBalcShape, NULL, NULL}\n"
    "BackBalc    -> Join(projectHeight(), currentPos0(), currentPos1()) {NULL, WindowShape, NULL}\n"
    "RoofCov     -> Repeat(XY, sizeTiles) {TilesShape}\n"
    "MansardTop  -> NULL\n"
    "TilesShape -> Shape(\"slate\")\n"
    "FloorShape -> Shape(\"panel\")\n"
    "WallBalcShape -> Shape(\"panel\")\n"
    "WindowShape -> Tint(1) Shape(\"ridge\")\n";

TEST_CASE("the paper's balcony closes its hole") {
    // A gable's rectangle, 3 m high over 3 m of plan: 45 degrees, so that what is projected is known.
    Roofs r = roofs({footprint(kRectangle, RoofShape::hip, 1)}, kBalcony);
    CpuRoofs cpu = growRoofsOnCpu(r.inputs());
    // Of the face over the first edge: floor, two side walls clipped to triangles, a window.
    const RoofGrid* floor = nullptr;
    const RoofGrid* window = nullptr;
    std::vector<const RoofGrid*> sides;
    for (const RoofGrid& g : cpu.records.grids) {
        if (g.atom != 0 || g.cells != 0x10001u) continue;
        const float up = glm::cross(g.axisX, g.axisY).y;
        if ((g.mesh & 255u) == 1)
            window = &g;
        else if (std::abs(up) > 0.9f)
            floor = &g;
        else if (g.region != kNoIndex)
            sides.push_back(&g);
    }
    REQUIRE(floor);
    REQUIRE(window);
    REQUIRE(sides.size() == 2);
    const float depth = 2 / std::sqrt(2.0f);
    CHECK(floor->size.x == doctest::Approx(1));
    CHECK(floor->size.y == doctest::Approx(depth));
    CHECK(floor->origin.y == doctest::Approx(r.structure.houses[0].eaveHeight + 0.5f / std::sqrt(2.0f)));
    CHECK(window->size.x == doctest::Approx(1));
    CHECK(window->size.y == doctest::Approx(depth));  // as high as the roof has risen
    for (const RoofGrid* g : sides) {
        CHECK(g->size.x == doctest::Approx(depth));
        CHECK(g->size.y == doctest::Approx(depth));
    }
}

namespace {

// Area of what of a rectangle lies inside a polygon, without any of the code under test: the polygon (any simple one)
// clipped by the rectangle's four sides.
double overlap(std::vector<glm::dvec2> polygon, glm::dvec2 low, glm::dvec2 high) {
    for (int side = 0; side < 4; ++side) {
        auto inside = [&](glm::dvec2 p) {
            return side == 0 ? p.x - low.x : side == 1 ? high.x - p.x : side == 2 ? p.y - low.y : high.y - p.y;
        };
        std::vector<glm::dvec2> next;
        for (size_t i = 0; i < polygon.size(); ++i) {
            const glm::dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
            const double da = inside(a), db = inside(b);
            if (da >= 0) next.push_back(a);
            if ((da < 0) != (db < 0)) next.push_back(a + (b - a) * (da / (da - db)));
        }
        polygon = next;
    }
    double twice = 0;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return 0.5 * twice;
}

}  // namespace

TEST_CASE("cells are made where their face is, and whole where it covers them") {
    const std::vector<std::vector<glm::dvec2>> plans = {
        kRectangle,
        kEll,
        {{0, 0}, {16, 0}, {16, 6}, {11, 6}, {11, 13}, {5, 13}, {5, 6}, {0, 6}},
        {{0, 0}, {16, 0}, {16, 13}, {11, 13}, {11, 5}, {5, 5}, {5, 13}, {0, 13}},
        {{0, 0}, {9, -2}, {17, 1}, {12, 4}, {14, 11}, {6, 8}, {1, 12}}};
    for (const auto& plan : plans) {
        Roofs r = roofs({footprint(plan)}, kSlates);
        CpuRoofs cpu = growRoofsOnCpu(r.inputs());
        for (const RoofGrid& g : cpu.records.grids) {
            // The outline in the grid's own coordinates, from the structure; hips cut several faces of one edge apart.
            std::vector<std::vector<glm::dvec2>> outlines;
            std::set<uint32_t> edges;  // atoms of a hip are its eaves, in the order of edges
            for (const RoofFace& face : r.structure.faces) edges.insert(face.edge);
            for (const RoofFace& face : r.structure.faces) {
                if (uint32_t(std::distance(edges.begin(), edges.find(face.edge))) != g.atom) continue;
                std::vector<glm::dvec3> corners;
                if (!face.detached) corners.push_back(face.eave[0]), corners.push_back(face.eave[1]);
                for (uint32_t i = 0; i + (face.detached ? 0 : 1) < face.segmentCount; ++i)
                    corners.push_back(r.structure.segments[face.firstSegment + i].to);
                std::vector<glm::dvec2> outline;
                for (glm::dvec3 c : corners) {
                    const glm::dvec3 d = c - glm::dvec3(g.origin);
                    outline.emplace_back(glm::dot(d, glm::dvec3(g.axisX)), glm::dot(d, glm::dvec3(g.axisY)));
                }
                outlines.push_back(outline);
            }
            REQUIRE(!outlines.empty());
            const glm::dvec2 step(g.step);
            double covered = 0, area = 0;
            for (const auto& outline : outlines) area += overlap(outline, glm::dvec2(-1e6), glm::dvec2(1e6));
            for (uint32_t row = 0; row < g.cells >> 16; ++row)
                for (uint32_t column = 0; column < (g.cells & 0xFFFFu); ++column) {
                    const glm::dvec2 low(column * step.x, row * step.y);
                    double share = 0;
                    for (const auto& outline : outlines) share += overlap(outline, low, low + step);
                    const RoofRun run = cpu.records.runs[g.firstRow + row];
                    auto within = [&](uint32_t packed) {
                        return column >= (packed & 0xFFFFu) && column < (packed & 0xFFFFu) + (packed >> 16);
                    };
                    const double whole = step.x * step.y;
                    if (share > 0.02 * whole && !within(run.touched)) FAIL_CHECK("a cell is missing");
                    if (share < 0.97 * whole && within(run.whole)) FAIL_CHECK("a cell is not whole");
                    if (within(run.touched)) covered += share;
                }
            CHECK(covered > 0.999 * area);
        }
    }
}

TEST_CASE("one house grown anew gives what all grown anew give") {
    Result<std::unique_ptr<Device>> device = Device::create({});
    REQUIRE(device);
    auto made = RoofGrowth::create(**device);
    REQUIRE(made);
    RoofGrowth& growth = **made;
    std::vector<Footprint> all;
    for (int i = 0; i < 12; ++i) {
        std::vector<glm::dvec2> plan = i % 2 ? kEll : kRectangle;
        for (glm::dvec2& p : plan) p.x += 20 * i;
        all.push_back(footprint(plan));
        all.back().id = "house " + std::to_string(i);
    }
    Roofs r = roofs(all, kBalcony);
    REQUIRE(growth.grow(r.inputs()));
    all[5].shape = RoofShape::mansard;
    replaceAtoms(r.tables, 5, structureOf({all[5]}));
    REQUIRE(growth.growHouses(r.inputs(), std::vector<uint32_t>{5}));
    CHECK(growth.stats().expansions == 2);
    auto living = [&](const RoofRecords& records) {
        std::vector<std::pair<uint64_t, uint32_t>> keys;
        for (const RoofGrid& g : records.grids)
            if ((g.house >> 24) == ((g.house & 0xFFFFFFu) == 5 ? records.grids.back().house >> 24 : 0u))
                keys.emplace_back(g.key, g.cells);
        std::sort(keys.begin(), keys.end());
        return keys;
    };
    Result<RoofRecords> after = growth.read();
    REQUIRE(after);
    auto patched = living(*after);
    Roofs fresh = roofs(all, kBalcony);
    CpuRoofs whole = growRoofsOnCpu(fresh.inputs());
    std::vector<std::pair<uint64_t, uint32_t>> expected;
    for (const RoofGrid& g : whole.records.grids) expected.emplace_back(g.key, g.cells);
    std::sort(expected.begin(), expected.end());
    CHECK(patched == expected);
}

TEST_CASE("layers are read at a shape's place and over its house, alike on both devices") {
    std::vector<Footprint> all;
    for (int i = 0; i < 4; ++i) {
        std::vector<glm::dvec2> plan = kRectangle;
        for (glm::dvec2& p : plan) p.x += 20 * i;
        all.push_back(footprint(plan));
    }
    Roofs r = roofs(all,
                    "context here = 0\ncontext mean = 0\ncontext unread = 1\n"
                    "House : mean(house) > 0.1 -> Extrude(1) {Wall(mean(house)), NULL}\n"
                    "House -> Extrude(1) {Wall(here(texCoord)), NULL}\n"
                    "Wall(v) -> S(1 + v, 1 + unread(house)) Shape(\"panel\")\n");
    // 100 m in texels of a metre: `here` rises eastwards by a hundredth a metre, `mean` covers half of house 2.
    constexpr uint32_t kSide = 100;
    std::vector<float> here(kSide * kSide), mean(kSide * kSide);
    for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) {
            here[y * kSide + x] = (float(x) + 0.5f) / 100;
            mean[y * kSide + x] = x >= 40 && x < 45 ? 1 : 0;
        }
    std::vector<float> means(4 * kRoofLayers, 0.0f);
    for (uint32_t h = 0; h < 4; ++h) means[h * kRoofLayers + 1] = h == 2 ? 0.5f : 0.0f, means[h * kRoofLayers + 2] = 1;
    RoofInputs inputs = r.inputs();
    inputs.site = {{-10, -50}, 1, kSide};
    inputs.layers[0].texels = here.data();
    inputs.layers[1].texels = mean.data();
    inputs.means = means;
    const CpuRoofs cpu = growRoofsOnCpu(inputs);
    CHECK(cpu.records.grids.size() == 16);
    for (const RoofGrid& g : cpu.records.grids) {
        CHECK(g.size.y == doctest::Approx(2));
        const uint32_t house = g.house & 0xFFFFFFu;
        // A wall stands on its eave, whose middle is where it is asked.
        const RoofAtom& atom = r.tables.atoms[g.atom];
        const float middle = cpu.records.plots[house].at.x + atom.foot.x + atom.tangent.x * atom.eaveLength / 2;
        CHECK(g.size.x == doctest::Approx(house == 2 ? 1.5f : 1.1f + middle / 100).epsilon(1e-4));
    }
    for (uint32_t h = 0; h < 4; ++h) CHECK(cpu.reads[h] == (h == 2 ? 0x600u : 0x601u));

    Result<std::unique_ptr<Device>> device = Device::create({});
    REQUIRE(device);
    auto made = RoofGrowth::create(**device);
    REQUIRE(made);
    REQUIRE((*made)->grow(inputs));
    CHECK((*made)->stats().hash == (uint64_t(cpu.status.hash[1]) << 32 | cpu.status.hash[0]));
    const auto reads = (*made)->reads();
    CHECK(std::vector<uint32_t>(reads.begin(), reads.end()) == cpu.reads);
}

TEST_CASE("dabs on a site are undone bit for bit and reach no further than their radius") {
    const Roofs r = roofs({footprint(kRectangle)}, kSlates);
    PlanLayers plan(r.structure);
    PlanLayer& layer = plan.make("moss", 0.25f);
    const std::vector<float> before = layer.texels;
    BrushRecord brush{};
    brush.perRadius = 0.5f;
    brush.perSoft = 1;
    brush.target = 1;
    brush.strength = 0.7f;
    PlanRecord kept;
    std::vector<DabRecord> dabs;
    for (int i = 0; i < 20; ++i) dabs.push_back({{0.3f * float(i), 7, -3}, 1, {0, 1, 0}, 0});
    const PlanRect rect = plan.dabs(layer, brush, false, dabs, kept);
    const RoofSite site = plan.site();
    double painted = 0;
    for (uint32_t y = 0; y < site.size; ++y)
        for (uint32_t x = 0; x < site.size; ++x) {
            const float value = layer.texels[y * site.size + x];
            const glm::vec2 at = site.low + (glm::vec2(x, y) + 0.5f) / site.perMetre;
            const float away = glm::length(glm::vec2(std::max({0 - at.x, at.x - 5.7f, 0.0f}), at.y + 3));
            if (away > 2.0f) CHECK(value == 0.25f);
            if (away < 0.5f) CHECK(value > 0.9f);
            if (value != 0.25f) CHECK((x >= rect.x0 && x < rect.x1 && y >= rect.y0 && y < rect.y1));
            painted += value - 0.25;
        }
    CHECK(painted > 0);
    PlanRecord smooth;
    plan.dabs(layer, brush, true, dabs, smooth);
    plan.swap(layer, smooth);
    plan.close(layer, kept);
    CHECK(kept.blocks.size() > 3);
    plan.swap(layer, kept);
    CHECK(layer.texels == before);
}

TEST_CASE("cells go where their layer is painted, the more the stronger") {
    uint32_t gone[5] = {};
    for (uint32_t i = 0; i < 10000; ++i)
        for (uint32_t step = 0; step < 5; ++step)
            gone[step] += cellHold(0x1234567u, i % 100, i / 100) < 0.25f * float(step) ? 1 : 0;
    CHECK(gone[0] == 0);
    CHECK(gone[1] > 500);
    CHECK(gone[2] > gone[1] + 2000);
    CHECK(gone[3] > gone[2] + 2000);
    CHECK(gone[4] == 10000);
}

TEST_CASE("mistakes in grammars of roofs are named") {
    const struct {
        const char* text;
        const char* expected;
    } cases[] = {
        {"A -> Split(Z, 1) {B}\nB -> NULL", "X or Y"},
        {"A -> Split(X, 1, ~) {B}\nB -> NULL", "2 sizes and 1 parts"},
        {"A -> Join(1, 2, 3) {NULL}", "expected a vector"},
        {"A -> Extrude(~) {NULL}", "'~' is a size of Split"},
        {"A -> Extrude(heading.x) {NULL}", "belongs to growth"},
        {"A -> Extrude(localTangent) {NULL}", "is a vector"},
        {"A -> Explode() {Shape(\"slat\")}", "there is no mesh \"slat\" (did you mean 'slate'?)"},
        {"A -> Explode() {B, C}\nB -> Marching(1, 0, true) {B}\nC -> NULL", "either marches or makes roofs"},
        {"let a = b\nlet b = a\nA -> Project(a, b) {NULL}", "defined by itself"},
        {"context m = 0\nA -> Extrude(m(uv)) {NULL}", "or over the whole house: m(house)"},
        {"param m = 1\nA -> Extrude(1) {Drop(m) Shape(\"slate\")}", "one of the first 8 context layers"},
        {"A -> Repeat(XY, 1, fitted) {Shape(\"slate\")}", "fit, clip or bond"},
        {"A -> Extrude(1) {[S(1) B, NULL}\nB -> NULL", "'[' without ']'"},
        {"A -> Extrude(1) {S(1)] B, NULL}\nB -> NULL", "']' without '['"},
        {"A -> Extrude(1) {[ S(1) ] ] B C, NULL}\nB -> NULL\nC -> NULL", "']' without '['"},
        {"A -> Extrude(1) {[ NULL, NULL}", "'[' without ']'"},
    };
    for (const auto& c : cases) {
        const std::string text = failureText(c.text);
        INFO(c.text << "\n" << text);
        CHECK(text.find(c.expected) != std::string::npos);
    }
}

TEST_CASE("brackets keep what stands before one thing, as before several") {
    const auto grids = [](const char* wall) {
        Roofs r =
            roofs({footprint(kRectangle)},
                  std::string("House -> Extrude(wallHeight) {Wall, NULL}\nTile -> Shape(\"panel\")\nWall -> ") + wall);
        return growRoofsOnCpu(r.inputs()).records.grids;
    };
    const auto plain = grids("Tile");
    REQUIRE(plain.size() == 4);
    for (const char* wall : {"[T(1, 1)] Tile", "[T(1) [S(1) T(0, 2)] R(1)] [Tile]", "[S(2, 2)] Shape(\"panel\")"}) {
        const auto kept = grids(wall);
        INFO(wall);
        REQUIRE(kept.size() == 4);
        for (size_t i = 0; i < 4; ++i) {
            CHECK(kept[i].origin == plain[i].origin);
            CHECK(kept[i].size == plain[i].size);
        }
    }
    const auto moved = grids("T(0, 1) [T(0, 2)] S(2, 0.5) [Tile]");
    REQUIRE(moved.size() == 4);
    for (size_t i = 0; i < 4; ++i) {
        CHECK(moved[i].origin.y == doctest::Approx(plain[i].origin.y + 1));
        CHECK(moved[i].size.x == 2);
    }
}

TEST_CASE("endless recursion is stopped and counted") {
    Roofs r = roofs({footprint(kRectangle)}, "House -> Explode() {House, NULL}\n");
    CpuRoofs cpu = growRoofsOnCpu(r.inputs());
    CHECK(cpu.status.stopped == 4);
    CHECK(cpu.records.grids.empty());
}

TEST_CASE("what is drawn at a ridge stays drawn where the outline leans and the ridge is no longer level") {
    const std::string grammar =
        "House -> Extrude(wallHeight) {NULL, TopWall}\n"
        "TopWall -> Join(roofHeight, roofPos1, roofPos2) {NULL, Joints, NULL}\n"
        "Joints -> Explode() {NULL, NULL, Line, Line, Line}\n"
        "Line : owner == 1 and joint == ridge and rand() < 0.5 -> S(0.5, 0.5) Shape(\"panel\")\n"
        "Line -> NULL\n";
    const auto drawn = [&](uint32_t number, double lean) {
        Footprint house = footprint({{0, 0}, {14, 0}, {14 + lean, 9 + lean}, {0, 9}}, RoofShape::hip, 0.8);
        house.id = "house " + std::to_string(number);
        return growRoofsOnCpu(roofs({house}, grammar).inputs()).records.grids.size();
    };
    size_t some = 0;
    for (uint32_t number = 0; number < 24; ++number) {
        CAPTURE(number);
        const size_t level = drawn(number, 0);
        some += level;
        for (const double lean : {0.4, -0.4, 1.5}) CHECK(drawn(number, lean) == level);
    }
    CHECK(some > 6);
    CHECK(some < 18);
}
