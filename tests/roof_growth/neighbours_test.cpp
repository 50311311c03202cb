// What the town's grammar makes of neighbours, of roofs on posts, and of houses far away.
#include <cstring>

#include "runtime/roof/shapes.hpp"
#include "tests/roof_growth/library.hpp"

using namespace espalier;
using namespace roof_test;

namespace {

struct Grown {
    RoofStructure structure;
    CpuRoofs roofs;
    Meshes meshes;

    // Calls each(grid, low, high): bounds of all its cells in the world.
    template <class Each>
    void eachGrid(const Each& each) const {
        for (const RoofGrid& g : roofs.records.grids) {
            const glm::vec2 cells(float(g.cells & 0xFFFFu), float(g.cells >> 16));
            const glm::vec2 size = glm::vec2(g.step) * (cells - 1.f) + glm::vec2(g.size);
            const glm::vec2 plot = roofs.records.plots[g.house & 0xFFFFFFu].at;
            glm::vec3 low(1e9f), high(-1e9f);
            for (int i = 0; i < 4; ++i) {
                const glm::vec3 p = glm::vec3(plot.x, 0, plot.y) + glm::vec3(g.origin) +
                                    glm::vec3(g.axisX) * (i & 1 ? size.x : 0.f) +
                                    glm::vec3(g.axisY) * (i & 2 ? size.y : 0.f);
                low = glm::min(low, p), high = glm::max(high, p);
            }
            each(g, low, high);
        }
    }
    bool is(const RoofGrid& g, std::initializer_list<const char*> names) const {
        const std::string& name = meshes.names[g.mesh & 255u].name;
        return std::find(names.begin(), names.end(), name) != names.end();
    }
};

Grown grown(const std::string& buildings) {
    Result<Town> town = parseFootprints("{\"buildings\":[" + buildings + "]}", "plan");
    REQUIRE(town);
    Grown g;
    std::vector<Diagnostic> said;
    g.structure = roofsOf(town->footprints, said);
    const RoofTables tables = makeAtoms(g.structure);
    Result<RuleMap> map = compiled(kGrammars / "town.grammar", g.meshes);
    if (!map) FAIL(map.failure().text());
    RoofInputs inputs;
    inputs.town = &tables;
    inputs.grammar = &*map;
    inputs.meshes = g.meshes.bounds;
    g.roofs = growRoofsOnCpu(inputs, 2);
    REQUIRE(bool(g.roofs.complete));
    return g;
}

std::string box(const std::string& id, double x, double y, double width, double depth, const std::string& tags) {
    char text[300];
    std::snprintf(text, sizeof text, R"({"id":"%s","outer":[[%.3f,%.3f],[%.3f,%.3f],[%.3f,%.3f],[%.3f,%.3f]],)",
                  id.c_str(), x, y, x + width, y, x + width, y + depth, x, y + depth);
    return text + tags + "}";
}

}  // namespace

TEST_CASE("in a row no window, dormer or skylight looks into a neighbour, and no eave reaches over him") {
    for (const char* shape : {"gabled", "hipped", "gambrel", "mansard", "skillion", "pyramidal"}) {
        INFO(shape);
        std::string row;
        for (int i = 0; i < 5; ++i)
            row += (i ? "," : "") + box("house" + std::to_string(i), 9 * i, 0, 9, 12,
                                        "\"building:levels\":3,\"roof:shape\":\"" + std::string(shape) + '"');
        const Grown g = grown(row);
        size_t windows = 0;
        g.eachGrid([&](const RoofGrid& grid, glm::vec3 low, glm::vec3 high) {
            const float west = 9.f * float(grid.house & 0xFFFFFFu), east = west + 9;
            const bool first = west == 0, last = east == 45;
            // Boards and copings of fire walls stand out, and so does half of a cap on a hip.
            const float room = g.is(grid, {"ridge"}) ? 0.25f : 0.06f;
            INFO(g.meshes.names[grid.mesh & 255u].name);
            const bool clipped = grid.region != kNoIndex;  // by its face's outline
            if (!first && !clipped) CHECK(low.x > west - room);
            if (!last && !clipped) CHECK(high.x < east + room);
            if (!g.is(grid, {"casement", "shutter", "door", "dormer", "skylight", "glass", "frame"})) return;
            ++windows;
            const glm::vec3 out = glm::cross(glm::vec3(grid.axisX), glm::vec3(grid.axisY));
            if (std::abs(out.x) < 0.5f) return;
            // What looks along the row does so at its ends.
            CHECK((out.x < 0 ? first : last));
        });
        CHECK(windows > 20);
    }
}

TEST_CASE("windows look out above a lower neighbour only") {
    const Grown g = grown(box("high", 0, 0, 12, 10, R"("building:levels":6,"roof:shape":"hipped")") + "," +
                          box("low", 12, 0, 12, 10, R"("height":7,"roof:shape":"hipped")"));
    size_t above = 0;
    g.eachGrid([&](const RoofGrid& grid, glm::vec3 low, glm::vec3) {
        const glm::vec3 out = glm::cross(glm::vec3(grid.axisX), glm::vec3(grid.axisY));
        if ((grid.house & 0xFFFFFFu) != 0 || !g.is(grid, {"casement", "door"}) || out.x < 0.5f) return;
        ++above;
        CHECK(low.y > 7);
    });
    CHECK(above > 0);
}

TEST_CASE("a roof on posts has posts to the ground and no walls") {
    for (const char* tags : {R"("building":"roof","height":5,"roof:shape":"gabled","roof:height":1.5)",
                             R"("building":"carport")", R"("building":"roof","height":6,"min_height":5)",
                             R"("building":"yes","wall":"no","height":5,"roof:shape":"skillion")"}) {
        INFO(tags);
        const Grown g = grown(box("roof", 0, 0, 12, 8, tags));
        const float eave = g.structure.houses[0].eaveHeight;
        size_t posts = 0;
        g.eachGrid([&](const RoofGrid& grid, glm::vec3 low, glm::vec3 high) {
            const glm::vec3 size = high - low;
            CHECK_FALSE(g.is(grid, {"casement", "door", "dormer", "skylight", "chimney", "surround"}));
            if (low.y > 0.1f) return;
            // All that stands on the ground is slim.
            CHECK(g.is(grid, {"board", "pipe"}));
            CHECK(grid.size.x < 0.3f);
            CHECK(high.y > eave - 0.5f);
            posts += std::max(grid.cells & 0xFFFFu, grid.cells >> 16);
            CHECK(size.y > 1);
        });
        CHECK(posts >= 8);
    }
}

TEST_CASE("low walls have no door that reaches into the roof, and no pipes where there are none") {
    for (const auto& [tags, eave] :
         {std::pair(R"("height":8,"roof:shape":"hipped","roof:height":6)", 2.f),
          std::pair(R"("building:part":"yes","min_height":10,"height":16,"roof:shape":"pyramidal","roof:height":6)",
                    10.f),
          std::pair(R"("height":7.3,"roof:shape":"gabled","roof:height":6)", 1.3f)}) {
        for (int i = 0; i < 8; ++i) {  // of several lots
            INFO(eave, i);
            const Grown g = grown(box("low" + std::to_string(i), 13 * i, 0, 12, 8, tags));
            g.eachGrid([&](const RoofGrid& grid, glm::vec3, glm::vec3 high) {
                if (g.is(grid, {"door", "pipe"})) CHECK(high.y < eave + 0.05f);
            });
        }
    }
}

TEST_CASE("roofs are the same to the bit kilometres away") {
    const std::string tags = R"("building:levels":2,"roof:shape":"hipped","roof:angle":41.3)";
    const auto at = [&](double x, double y) {
        char ring[300];
        std::snprintf(ring, sizeof ring,
                      R"({"id":"h","outer":[[%.3f,%.3f],[%.3f,%.3f],[%.3f,%.3f],[%.3f,%.3f],[%.3f,%.3f],[%.3f,%.3f]],)",
                      x, y, x + 15.25, y + 1.125, x + 14.75, y + 8.25, x + 7.125, y + 7.75, x + 6.625, y + 15.25,
                      x - 0.5, y + 14.875);
        return grown(ring + tags + "}");
    };
    const Grown here = at(0, 0), there = at(8000, -5000);
    const auto sorted = [](const Grown& g) {
        std::vector<RoofGrid> grids = g.roofs.records.grids;
        for (RoofGrid& grid : grids) grid.firstRow = grid.firstRow == kNoIndex ? kNoIndex : 0;
        for (RoofGrid& grid : grids) grid.region = grid.region == kNoIndex ? kNoIndex : 0;  // threads number them
        std::sort(grids.begin(), grids.end(),
                  [](const RoofGrid& a, const RoofGrid& b) { return std::memcmp(&a, &b, sizeof a) < 0; });
        return grids;
    };
    const std::vector<RoofGrid> a = sorted(here), b = sorted(there);
    REQUIRE(a.size() == b.size());
    CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
    CHECK(here.roofs.status.touched == there.roofs.status.touched);
    CHECK(here.roofs.status.whole == there.roofs.status.whole);
    CHECK(glm::vec2(there.roofs.records.plots[0].at) - glm::vec2(here.roofs.records.plots[0].at) ==
          glm::vec2(8000, 5000));
}
