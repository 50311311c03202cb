// How one house's roof is dressed: covering, colour, overhang, chimneys, judged by the triangles that come of it.
#include <algorithm>
#include <set>

#include "tests/editor/editing.hpp"
#include "tools/document/project.hpp"

using namespace espalier::document;
using espalier::scene::House;
using espalier::scene::HouseLook;
using espalier::scene::houseNow;

namespace {

// A house of 10 x 8 metres with its ridge along x, and a neighbour far away.
std::string plan(const Folder& folder) {
    return folder.write("plan.json", R"({"buildings": [
 {"id": "one", "outer": [[0,0],[10,0],[10,8],[0,8]], "roof:shape": "gabled", "roof:material": "slate", "roof:angle": 40, "building:levels": 1},
 {"id": "two", "outer": [[100,0],[110,0],[110,8],[100,8]], "roof:shape": "gabled", "roof:angle": 40, "building:levels": 1}]})");
}

struct Built {
    float reach = 0;                  // of the eaves beyond the walls, metres
    float above = 0;                  // of what stands highest over the ridge
    size_t triangles = 0, other = 0;  // of the house, of its neighbour
};

Built built(Editing& editing) {
    EspContext* context = editing.context.get();
    REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
    EspTriangles triangles;
    REQUIRE_MESSAGE(espMaterialise(context, &triangles) == ESP_OK, espLastError(context));
    EspHouseInfo info;
    REQUIRE(espHouseInfo(context, 0, &info) == ESP_OK);
    Built out;
    for (uint64_t i = 0; i < triangles.indexCount; ++i) {
        const auto* at = reinterpret_cast<const float*>(static_cast<const char*>(triangles.vertices) +
                                                        16 * uint64_t(triangles.indices[i]));
        const bool ours = at[0] < 50;
        (ours ? out.triangles : out.other) += i % 3 == 0;
        if (!ours) continue;
        out.reach = std::max({out.reach, at[2] - info.boundsMax[2], info.boundsMin[2] - at[2]});
        out.above = std::max(out.above, at[1] - info.ridgeHeight);
    }
    return out;
}

void dress(Editing& editing, const HouseLook& look) {
    House house = houseNow(editing.context.get(), 0);
    house.look = look;
    REQUIRE_MESSAGE(editing.perform(SetHouse{house}), editing.error);
}

uint64_t roofs(Editing& editing) {
    EspRoofStats stats;
    REQUIRE(espUpdate(editing.context.get()) == ESP_OK);
    REQUIRE(espReadRoofStats(editing.context.get(), &stats) == ESP_OK);
    return stats.hash;
}

}  // namespace

TEST_CASE("a house's covering, overhang and chimneys are its own, and its neighbour's stay") {
    const Folder folder;
    Editing editing(plan(folder));
    const House planned = houseNow(editing.context.get(), 0);
    REQUIRE(planned.look);
    CHECK(planned.look->covering == "slate");
    CHECK(planned.look->colour.empty());
    const Built before = built(editing);
    HouseLook look = *planned.look;
    for (const float overhang : {.2f, .8f}) {
        look.overhang = overhang;
        dress(editing, look);
        const float gutter = .13f;
        CHECK(built(editing).reach == doctest::Approx(overhang + gutter).epsilon(.1));
    }
    look.chimneys = "none";
    dress(editing, look);
    CHECK(built(editing).above < .3f);
    look.chimneys = "all";
    dress(editing, look);
    CHECK(built(editing).above > .7f);
    std::set<size_t> counts;
    for (const char* covering : {"plain_tiles", "pan_tiles", "barrel_tiles", "slate", "metal"}) {
        look.covering = covering;
        dress(editing, look);
        counts.insert(built(editing).triangles);
    }
    CHECK(counts.size() == 5);
    CHECK(built(editing).other == before.other);
    for (int i = 0; i < 9; ++i) REQUIRE(editing.perform(Undo{}));
    CHECK(houseNow(editing.context.get(), 0) == planned);
    CHECK(built(editing).triangles == before.triangles);
}

TEST_CASE("a house keeps its look through projects, runs and records that know of none") {
    const Folder folder;
    Editing editing(plan(folder));
    const uint64_t planned = roofs(editing);
    const HouseLook look{"copper", {.5f, .125f, 0}, .7f, "none"};
    dress(editing, look);
    const HouseLook stored = *houseNow(editing.context.get(), 0).look;
    CHECK(stored.covering == "copper");
    for (int i = 0; i < 3; ++i) CHECK(stored.colour[i] == doctest::Approx(look.colour[i]).epsilon(.02));
    const uint64_t dressed = roofs(editing);
    CHECK(dressed != planned);

    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("saved"), editing.error), editing.error);
    Editing again(folder.file("saved"));
    CHECK(roofs(again) == dressed);
    CHECK(*houseNow(again.context.get(), 0).look == stored);

    RunLine line{1, 0, SetHouse{houseNow(editing.context.get(), 0)}}, back;
    REQUIRE_MESSAGE(fromJson(toJson(line), back, editing.error), editing.error);
    CHECK(std::get<SetHouse>(back.action).house == std::get<SetHouse>(line.action).house);
    House old = houseNow(editing.context.get(), 0);
    old.look.reset();
    REQUIRE(editing.perform(SetHouse{old}));
    CHECK(roofs(editing) == dressed);

    old.look = HouseLook{"marble", {}};
    CHECK(!editing.perform(SetHouse{old}));
    CHECK(contains(editing.error, "marble"));
    old.look = HouseLook{"slate", {}, 3};
    CHECK(!editing.perform(SetHouse{old}));
    CHECK(roofs(editing) == dressed);
}

TEST_CASE("records without a look leave it as it is, and undo and projects know what it was") {
    const Folder folder;
    Editing editing(plan(folder));
    House steep = houseNow(editing.context.get(), 0);
    steep.look.reset();
    steep.slope = 1;
    REQUIRE_MESSAGE(editing.perform(SetHouse{steep}), editing.error);
    const uint64_t plain = roofs(editing);
    HouseLook look = *houseNow(editing.context.get(), 0).look;
    look.chimneys = "all";
    look.covering = "pan_tiles";
    dress(editing, look);
    const uint64_t dressed = roofs(editing);
    CHECK(dressed != plain);
    REQUIRE(editing.perform(Undo{}));
    CHECK(roofs(editing) == plain);
    REQUIRE(editing.perform(Redo{}));
    steep.slope = .9f;
    REQUIRE_MESSAGE(editing.perform(SetHouse{steep}), editing.error);
    CHECK(*houseNow(editing.context.get(), 0).look == look);
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("saved"), editing.error), editing.error);
    Editing again(folder.file("saved"));
    CHECK(*houseNow(again.context.get(), 0).look == look);
    CHECK(roofs(again) == roofs(editing));
}

TEST_CASE("a roof keeps the height that its plan gives it when only its look changes") {
    const Folder folder;
    Editing editing(folder.write("plan.json", R"({"buildings": [
 {"id": "low", "outer": [[0,0],[10,0],[10,8],[0,8]], "roof:shape": "gabled", "roof:height": 1.5, "height": 5, "building:levels": 1}]})"));
    const auto heights = [&] {
        EspHouseInfo info;
        REQUIRE(espHouseInfo(editing.context.get(), 0, &info) == ESP_OK);
        return std::pair(info.eaveHeight, info.ridgeHeight);
    };
    const auto planned = heights();
    dress(editing, {"slate", {.1f, .1f, .2f}, .3f, "none"});
    CHECK(heights() == planned);
    House wider = houseNow(editing.context.get(), 0);
    wider.corners[0][0] -= 1;
    REQUIRE_MESSAGE(editing.perform(SetHouse{wider}), editing.error);
    CHECK(houseNow(editing.context.get(), 0).look->covering == "slate");
}
