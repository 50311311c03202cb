// What is hidden, isolated and locked, and views that are kept under digits.
#include "tests/editor/gardener.hpp"
#include "tests/editor/over_town.hpp"
#include "tools/document/project.hpp"

namespace showing {
namespace {

using Keys = std::set<uint32_t>;

struct Looker : Gardener {
    explicit Looker(const Folder& folder) : Gardener(folder) {}
    EspStats stats() {
        REQUIRE(espUpdate(work.context.get()) == ESP_OK);
        EspStats stats;
        REQUIRE(espReadStats(work.context.get(), &stats) == ESP_OK);
        return stats;
    }
    Keys hidden() const {
        Keys keys;
        for (const auto& seed : work.scene().seeds)
            if (seed.hidden) keys.insert(seed.key);
        return keys;
    }
    uint32_t first() const { return work.scene().seeds[0].key; }
    uint32_t second() const { return work.scene().seeds[1].key; }
};

}  // namespace

TEST_CASE(
    "H hides the chosen plants, Shift+H all others, Alt+H shows all; each is one step, and plants come back as they "
    "were") {
    const Folder folder;
    Looker looker(folder);
    const EspStats all = looker.stats();
    looker.work.selected = {looker.first()};
    looker.key(GLFW_KEY_H);
    CHECK(looker.hidden() == Keys{looker.first()});
    CHECK(looker.work.selected.empty());
    CHECK(looker.work.tool == Tool::seeds);
    CHECK(looker.steps() == 1);
    const EspStats one = looker.stats();
    CHECK(one.nodes < all.nodes);
    CHECK(one.nodes > 0);
    looker.key(GLFW_KEY_H, GLFW_MOD_ALT);
    CHECK(looker.hidden().empty());
    CHECK(looker.stats().hash == all.hash);
    looker.undo();
    CHECK(looker.hidden() == Keys{looker.first()});
    looker.undo();
    CHECK(looker.hidden().empty());
    CHECK(looker.stats().hash == all.hash);

    looker.work.selected = {looker.first()};
    looker.key(GLFW_KEY_H, GLFW_MOD_SHIFT);
    CHECK(looker.hidden() == Keys{looker.second()});
    CHECK(looker.steps() == 1);
    CHECK(std::string(looker.work.document->undoName()) == "Isolate");
    looker.key(GLFW_KEY_KP_DIVIDE);  // once more: all
    CHECK(looker.hidden().empty());
    looker.key(GLFW_KEY_H, GLFW_MOD_ALT);
    CHECK(looker.work.message == "Nothing is hidden");
    // A hidden seed can't be clicked or marked.
    looker.work.perform(ShowPlants{{looker.second()}, false});
    looker.work.selected.clear();
    looker.key(GLFW_KEY_A);
    CHECK(looker.work.selected == Keys{looker.first()});
    CHECK(!looker.work.document->scene().seeds.empty());
    std::string error;
    CHECK(!looker.work.document->perform(ShowPlants{{999}, false}, error));
}

TEST_CASE("a hidden model is gone through by clicks, a locked one stays, and a project keeps both") {
    const Folder folder;
    Looker looker(folder);
    const glm::vec2 wall = looker.onWall(-1.2f, 1);
    REQUIRE(looker.work.pick(wall));
    const EspStats all = looker.stats();
    REQUIRE(looker.work.perform(ShowSurfaces{{0}, false}));
    CHECK(!looker.work.pick(wall));
    CHECK(looker.stats().hash == all.hash);  // it stays ground
    REQUIRE(looker.work.perform(LockSurface{0, true}));
    CHECK(!looker.work.perform(PlaceSurface{0, {1, 0, 0}, 0, 1}));
    CHECK(contains(looker.work.error, "is locked"));
    REQUIRE(looker.work.perform(ShowPlants{{looker.second()}, false}));
    const EspStats one = looker.stats();
    REQUIRE(looker.save(folder.file("saved")));
    Editing again(folder.file("saved"));
    CHECK(again.document->scene().surfaces[0].hidden);
    CHECK(again.document->scene().surfaces[0].locked);
    CHECK(again.document->scene().seeds[1].hidden);
    CHECK(again.hash() == one.hash);
    looker.undo();
    looker.undo();
    looker.undo();
    CHECK(looker.work.pick(wall));
    CHECK(looker.stats().hash == all.hash);
    CHECK(!looker.work.perform(ShowSurfaces{{7}, true}));
    CHECK(!looker.work.perform(LockSurface{7, true}));
}

TEST_CASE("H hides the chosen house, which clicks go past then; a locked one stays, and a project keeps both") {
    const Folder folder;
    OverTown<Editor> planner(folder, wallScene(folder, true));
    const auto tiles = [&] {
        REQUIRE(espUpdate(planner.work.context.get()) == ESP_OK);
        EspRoofStats stats;
        REQUIRE(espReadRoofStats(planner.work.context.get(), &stats) == ESP_OK);
        return stats;
    };
    const EspRoofStats all = tiles();
    const glm::vec2 roof = planner.middle(0);
    REQUIRE(planner.work.pickHouse(roof) == 0);
    planner.work.house = 0;
    planner.key(GLFW_KEY_H);
    CHECK(planner.work.document->undoSteps() == 1);
    CHECK(!planner.work.house);
    CHECK(planner.info(0).hidden == 1);
    CHECK(planner.work.pickHouse(roof) != 0);
    CHECK(tiles().tiles < all.tiles);
    REQUIRE(planner.work.perform(LockHouse{1, true}));
    const auto house = espalier::scene::houseNow(planner.work.context.get(), 1);
    CHECK(!planner.work.perform(SetHouse{house}));
    CHECK(contains(planner.work.error, "is locked"));
    CHECK(!planner.work.perform(ResetHouse{1}));
    const uint64_t hidden = tiles().hash;
    REQUIRE(planner.save(folder.file("saved")));
    Editing again(folder.file("saved"));
    REQUIRE(again.document->scene().town);
    CHECK(again.document->scene().town->mark(0).hidden);
    CHECK(again.document->scene().town->mark(1).locked);
    REQUIRE(espUpdate(again.context.get()) == ESP_OK);
    EspRoofStats reopened;
    REQUIRE(espReadRoofStats(again.context.get(), &reopened) == ESP_OK);
    CHECK(reopened.hash == hidden);
    planner.key(GLFW_KEY_H, GLFW_MOD_ALT);
    CHECK(tiles().hash == all.hash);
    planner.work.house = 1;
    planner.key(GLFW_KEY_H, GLFW_MOD_SHIFT);
    CHECK(planner.info(0).hidden == 1);
    CHECK(planner.info(1).hidden == 0);
    planner.undo();
    planner.undo();
    planner.undo();
    planner.undo();
    CHECK(tiles().hash == all.hash);
    CHECK(!planner.work.perform(ShowHouses{{99}, false}));
    CHECK(!planner.work.perform(LockHouse{99, true}));
}

TEST_CASE("a locked layer is neither painted, filled nor loaded, until it is unlocked") {
    const Folder folder;
    Looker looker(folder);
    REQUIRE(looker.work.perform(LockLayer{"mask", true}));
    CHECK(!looker.work.perform(StrokeBegin{"mask"}));
    CHECK(contains(looker.work.error, "'mask' is locked"));
    CHECK(!looker.work.perform(FillLayer{"mask", 0}));
    CHECK(!looker.work.perform(LoadLayer{"mask", "none.png", 0}));
    REQUIRE(looker.save(folder.file("saved")));
    Editing again(folder.file("saved"));
    CHECK(again.document->scene().lockedLayers == std::vector<std::string>{"mask"});
    looker.undo();
    CHECK(looker.work.perform(FillLayer{"mask", 0}));
}

TEST_CASE("Ctrl and a digit keep the view, Shift and the digit show it again, also in the saved project") {
    const Folder folder;
    Looker looker(folder);
    looker.work.lookFromStart();
    const EspCamera start = looker.work.camera.camera();
    looker.key(GLFW_KEY_3, GLFW_MOD_CONTROL);
    REQUIRE(looker.work.scene().bookmarks.size() == 1);
    CHECK(looker.work.scene().bookmarks[0].digit == 3);
    CHECK(std::string(looker.work.document->undoName()) == "Bookmark 3");
    looker.work.camera.turnTo(1, -.5f);
    looker.key(GLFW_KEY_3, GLFW_MOD_SHIFT);
    const EspCamera back = looker.work.camera.camera();
    for (int i = 0; i < 3; ++i) CHECK(back.eye[i] == doctest::Approx(start.eye[i]));
    CHECK(back.fovY == doctest::Approx(start.fovY));
    CHECK(looker.work.scene().look.view == ESP_VIEW_SHADED);  // the digit alone is a view's key
    looker.key(GLFW_KEY_5, GLFW_MOD_SHIFT);
    CHECK(contains(looker.work.message, "no bookmark 5"));
    REQUIRE(looker.save(folder.file("saved")));
    Editing again(folder.file("saved"));
    REQUIRE(again.document->scene().bookmarks.size() == 1);
    CHECK(again.document->scene().bookmarks[0].digit == 3);
    looker.undo();
    CHECK(looker.work.scene().bookmarks.empty());
    std::string error;
    CHECK(!looker.work.document->perform(SetBookmark{10, true, {1, 1, 1}, {0, 0, 0}}, error));
    CHECK(!looker.work.document->perform(SetBookmark{1, true, {0, 0, 0}, {0, 0, 0}}, error));
    looker.work.setEditing(false);
    looker.key(GLFW_KEY_4, GLFW_MOD_CONTROL);  // who walks keeps none
    CHECK(looker.work.scene().bookmarks.empty());
}

}  // namespace showing
