// What undo says that it takes back: what was changed, and of which house, grammar or seeds.
#include "tests/editor/editing.hpp"

using namespace espalier::document;
using espalier::scene::House;

TEST_CASE("each step of undo is called by what it changed, and of what") {
    const Folder folder;
    Editing editing(wallScene(folder, true));
    Document& document = *editing.document;
    const auto& scene = document.scene();
    uint32_t gesture = 0;
    const auto named = [&](const Action& action) {
        REQUIRE_MESSAGE(editing.perform(action, ++gesture), editing.error);
        return std::string(document.undoName());
    };
    House house = espalier::scene::houseNow(editing.context.get(), 0);
    const auto change = [&](auto&& by) {
        by(house);
        const std::string name = named(SetHouse{house});
        house = espalier::scene::houseNow(editing.context.get(), 0);
        return name;
    };
    CHECK(change([](House& h) { h.shape = "mansard"; }) == "Roof kind of house a");
    CHECK(change([](House& h) { h.slope = 1; }) == "Pitch of house a");
    CHECK(change([](House& h) { h.eaveHeight += 1; }) == "Walls of house a");
    CHECK(change([](House& h) { h.corners[1][0] += 1; }) == "Corner of house a");
    CHECK(change([](House& h) { h.edges = {{1, "gable", 0}}; }) == "Edge of house a");
    CHECK(change([](House& h) { h.look->covering = "slate"; }) == "Covering of house a");
    CHECK(change([](House& h) { h.look->colour = {.1f, .2f, .3f}; }) == "Colour of house a");
    CHECK(change([](House& h) { h.look->overhang = .3f; }) == "Overhang of house a");
    CHECK(change([](House& h) { h.look->chimneys = "none"; }) == "Chimneys of house a");
    CHECK(named(ResetHouse{0}) == "As planned: house a");
    house = espalier::scene::houseNow(editing.context.get(), 1);
    house.corners.erase(house.corners.begin() + 4);
    house.rings[0] -= 1;
    CHECK(named(SetHouse{house}) == "Corner removed of house b");

    CHECK(named(SetParam{0, {"leafSize", {.1f}}}) == "Leaf size (ivy_guided)");
    CHECK(named(SetParam{1, {"reach", {1}}}) == "Length (creeper)");
    REQUIRE(editing.perform(SetParam{1, {"bend", {.2f}}}, gesture));  // as a preset does
    CHECK(document.undoName() == std::string("Values of creeper"));
    document.callStep(gesture, "Preset Long of creeper");
    document.callStep(gesture + 1, "of another gesture");
    document.callStep(0, "of none");
    CHECK(document.undoName() == std::string("Preset Long of creeper"));
    REQUIRE(editing.perform(Undo{}));
    CHECK(document.redoName() == std::string("Preset Long of creeper"));
    REQUIRE(editing.perform(Redo{}));
    CHECK(document.undoName() == std::string("Preset Long of creeper"));
    CHECK(named(document.withText(1, scene.grammars[1].text + "\n")) == "Edit the text of creeper");

    SeedRecord seed = document.recordOf(scene.seeds[0]);
    const auto changeSeed = [&](auto&& by) { return by(seed), named(ChangeSeeds{{seed}}); };
    CHECK(changeSeed([](SeedRecord& s) { s.position[0] += .1f; }) == "Move a seed");
    CHECK(changeSeed([](SeedRecord& s) { s.direction = {1, 0, 0}; }) == "Turn a seed");
    CHECK(changeSeed([](SeedRecord& s) { s.number = 77; }) == "Random number of a seed");
    CHECK(changeSeed([](SeedRecord& s) { s.params = {{"reach", {1}}}; }) == "Values of a seed");
    CHECK(changeSeed([](SeedRecord& s) { s.grammar = 1; }) == "Grammar of a seed");

    CHECK(named(SetField{0, {"flow", {0, -1, 0}, 1, {{"node", {0, 1, 0}}}}}) == "New element of flow");
    CHECK(named(SetField{0, {"flow", {0, -1, 0}, 1, {}}}) == "Remove elements of flow");
    CHECK(named(BrushField{0, "flow", {"comb", .1f, .5f, {{0, 1, 0}, {0, 1.1f, 0}}}}) == "Comb flow");
    CHECK(named(BrushField{0, "flow", {"smooth", .1f, .5f, {{0, 1, 0}}}}) == "Smooth flow");
    CHECK(named(TrimField{0, "flow", 0, 0}) == "Remove strokes of flow");
    CHECK(named(SetLight{14, 0, true}) == "Time of the day");
    CHECK(named(SetLight{14, 1, true}) == "Exposure");
    CHECK(named(SetLight{14, 1, false}) == "Shadows");
    CHECK(named(SetLight{-1, 1, false}) == "The scene's own light");
    REQUIRE(editing.perform(Undo{}));
    CHECK(document.redoName() == std::string("The scene's own light"));
    CHECK(document.undoName() == std::string("Shadows"));
}
