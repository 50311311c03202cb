// What a tool has in hand when something else comes between: a key that saves, a file that another program writes,
// work that ends beside the frames; and keys that have nothing to act on.
#include <algorithm>

#include "sample_game/dialogue.hpp"
#include "sample_game/panels.hpp"
#include "tests/editor/imgui_keys.hpp"
#include "tests/editor/window.hpp"

using namespace espalier::document;
using sample::Tool;

namespace {

// The small scene with a grammar of the test's own, which others may write, and one seed on its bare wall.
struct Hands : Editor {
    std::string grammar;

    explicit Hands(const Folder& folder)
        : Editor(folder, sceneOfItsOwn(folder), Tool::seeds), grammar(folder.file("own.grammar")) {
        faceWall(*this, 3);
        click(on(-1.1f, 1));
        REQUIRE(work.selected.size() == 1);
    }
    ~Hands() { sample::closeDialogues(); }
    glm::vec2 on(float x, float y) const { return at({x, y, .36f}); }
    std::array<float, 3> place() const { return work.document->seed(*work.selected.begin())->position; }
    size_t steps() const { return work.document->undoSteps(); }
    void look() {
        now += 1;
        (void)session.step(work, now);
    }
};

// A town seen from above, and one of its houses chosen.
struct Planner : Editor {
    uint32_t house = 0;

    explicit Planner(const Folder& folder) : Editor(folder, content("town.json"), Tool::houses) {
        work.frameAll();
        work.camera.turnTo(0, -1.5f);
        work.house = house;
    }
    espalier::scene::House now() const { return espalier::scene::houseNow(work.context.get(), house); }
    glm::vec2 corner(size_t i) const {
        EspHouseInfo info;
        REQUIRE(espHouseInfo(work.context.get(), house, &info) == ESP_OK);
        const auto corner = now().corners.at(i);
        return at({corner[0], info.eaveHeight, corner[1]});
    }
};

}  // namespace

TEST_CASE("a click on a house's corner moves nothing, and a drag moves the corner by as much as the mouse") {
    const Folder folder;
    Planner planner(folder);
    const auto before = planner.now();
    const glm::vec2 corner = planner.corner(1), grip = corner + glm::vec2(6, -5);
    planner.click(grip);
    CHECK(planner.work.houseEdge == 1u);
    planner.drag(grip, grip + glm::vec2(2, 3), 0, 2);  // a hand that trembles
    CHECK(planner.now() == before);
    CHECK(planner.work.document->undoSteps() == 0);
    planner.press(grip);
    planner.moveTo(grip + glm::vec2(12, 0), 3);
    CHECK(glm::distance(planner.corner(1), corner + glm::vec2(12, 0)) < .5f);
    planner.release(planner.mouse);
    CHECK(planner.work.document->undoSteps() == 1);
    planner.undo();
    CHECK(planner.now() == before);
}

TEST_CASE("a key that saves, opens, exports or quits ends what a tool is about, as it is") {
    const Folder folder;
    Hands hands(folder);
    for (const int key : {GLFW_KEY_S, GLFW_KEY_O, GLFW_KEY_E, GLFW_KEY_Q}) {
        CAPTURE(key);
        const size_t steps = hands.steps();
        hands.move(hands.on(-1.1f, 1));
        hands.key(GLFW_KEY_G);
        CHECK(hands.work.busy);
        hands.moveTo(hands.on(-.8f, 1.3f), 4);
        const auto moved = hands.place();
        hands.key(key, GLFW_MOD_CONTROL);
        CHECK(!hands.work.busy);
        CHECK(!hands.work.underWay);
        CHECK(sample::dialogueAsked());
        sample::closeDialogues();
        hands.moveTo(hands.on(-1, .8f), 4);
        CHECK(hands.place() == moved);
        CHECK(hands.steps() == steps + 1);
        hands.undo();
    }
    // A drag by a button, too, which is let go over the dialogue.
    hands.press(hands.at(sample::vec(hands.place())));
    hands.moveTo(hands.on(-.8f, 1.3f), 4);
    const auto moved = hands.place();
    hands.key(GLFW_KEY_S, GLFW_MOD_CONTROL);
    sample::closeDialogues();
    hands.moveTo(hands.on(-1, .8f), 4);
    hands.release(hands.mouse);
    CHECK(hands.place() == moved);
}

TEST_CASE("a house's corner that is dragged stays where it is when a key saves") {
    const Folder folder;
    Planner planner(folder);
    planner.press(planner.corner(1));
    planner.moveTo(planner.mouse + glm::vec2(15, 0), 3);
    const auto dragged = planner.now();
    planner.key(GLFW_KEY_S, GLFW_MOD_CONTROL);
    sample::closeDialogues();
    planner.moveTo(planner.mouse + glm::vec2(15, 0), 3);
    planner.release(planner.mouse);
    CHECK(planner.now() == dragged);
    CHECK(planner.work.document->undoSteps() == 1);
}

TEST_CASE(
    "what another program saves while a tool is in use is taken over when that is done, and Esc undoes the tool's") {
    const Folder folder;
    Hands hands(folder);
    const auto before = hands.place();
    const size_t steps = hands.steps();
    hands.wait();
    hands.move(hands.on(-1.1f, 1));
    hands.key(GLFW_KEY_G);
    hands.moveTo(hands.on(-.8f, 1.3f), 4);
    std::ofstream(hands.grammar, std::ios::app) << "// saved elsewhere\n";
    for (int i = 0; i < 3; ++i) hands.look();
    hands.moveTo(hands.on(-.9f, 1.2f), 2);
    CHECK(hands.all<SetText>().empty());
    hands.key(GLFW_KEY_ESCAPE);
    CHECK(hands.place() == before);
    CHECK(hands.steps() == steps);
    hands.look();
    CHECK(hands.all<SetText>().size() == 1);
    CHECK(hands.place() == before);
}

TEST_CASE("Esc leaves alone what has been done since by somebody else") {
    const Folder folder;
    Hands hands(folder);
    hands.move(hands.on(-1.1f, 1));
    hands.key(GLFW_KEY_G);
    hands.moveTo(hands.on(-.8f, 1.3f), 4);
    hands.fill(.25f);  // as an import that ends
    hands.key(GLFW_KEY_ESCAPE);
    CHECK(hands.all<Undo>().empty());
    CHECK(std::string(hands.work.document->undoName()).find("ill") != std::string::npos);
}

TEST_CASE("the first click after a panel's press whose end nobody was told of plants, once that is forgotten") {
    const Folder folder;
    Hands hands(folder);
    hands.panels = [] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({100, 100});
        ImGui::Begin("panel");
        ImGui::End();
    };
    for (int i = 0; i < 3; ++i) hands.frame({});
    const size_t seeds = hands.work.scene().seeds.size();
    hands.press({50, 50});
    hands.controls.forgetButtons();
    hands.click(hands.on(-.8f, 1.2f));
    CHECK(hands.work.scene().seeds.size() == seeds + 1);
}

TEST_CASE("keys that have nothing to act on leave no step behind") {
    const Folder folder;
    Hands hands(folder);
    hands.key(GLFW_KEY_A);
    hands.key(GLFW_KEY_DELETE);
    REQUIRE(hands.work.scene().seeds.empty());
    const size_t steps = hands.steps();
    hands.key(GLFW_KEY_R, GLFW_MOD_SHIFT);
    hands.key(GLFW_KEY_DELETE);
    CHECK(hands.steps() == steps);
    // A branch that was picked, and whose plant is gone.
    hands.work.choose(Tool::branch);
    hands.work.branch = 1234567;
    hands.work.readPath();
    hands.key(GLFW_KEY_DELETE);
    CHECK(hands.steps() == steps);
    CHECK(espPrunedCount(hands.work.context.get()) == 0);
}

TEST_CASE("a colour that is typed is one step of undo, however many of its letters already make one") {
    const Folder folder;
    Gui gui;
    Window window(folder, smallScene(folder));
    auto& work = window.work;
    const EspGrammar grammar = work.scene().grammars[0].id;
    const auto colour = [&] {
        EspParamInfo info{};
        for (uint32_t i = 0; i < espParamCount(work.context.get(), grammar); ++i)
            if (espParamInfo(work.context.get(), grammar, i, &info) == ESP_OK && info.kind == ESP_PARAM_COLOUR) break;
        REQUIRE(info.kind == ESP_PARAM_COLOUR);
        return info;
    };
    const auto frame = [&](bool focus = false) {
        ImGui::GetIO().DisplaySize = {640, 360};
        ImGui::NewFrame();
        sample::beginGesture(work);
        ImGui::Begin("panel");
        if (focus) ImGui::SetKeyboardFocusHere();
        const EspParamInfo info = colour();
        float value[3];
        std::copy(info.value, info.value + 3, value);
        if (sample::editParam(info, value))
            REQUIRE(work.perform(SetParam{0, {info.name, {value, value + 3}}}, sample::widgetGesture(work)));
        ImGui::End();
        ImGui::Render();
    };
    const auto type = [&](const char* text) {
        frame(true);
        frame(), frame();
        for (; *text; ++text) ImGui::GetIO().AddInputCharacter(unsigned(*text)), frame();
        for (bool down : {true, false}) setKey(ImGuiKey_Enter, down), frame();
        frame();
    };
    const size_t before = work.document->undoSteps();
    const float red = colour().value[0];
    type("#20d0ff");
    CHECK(colour().value[2] == doctest::Approx(1));
    CHECK(work.document->undoSteps() == before + 1);
    REQUIRE(work.perform(Undo{}));
    CHECK(colour().value[0] == red);
}

TEST_CASE("a house is chosen by a wall that is ground to ivy, and nothing is planted through a house") {
    const Folder folder;
    Editor editor(folder, content("hamlet.json"), Tool::houses);
    const auto& surfaces = editor.work.scene().surfaces;
    size_t walls = 0, hidden = 0;
    for (int row = 1; row < 36; ++row)
        for (int column = 1; column < 64; ++column) {
            const glm::vec2 at = editor.work.window * glm::vec2(column / 64.f, row / 36.f);
            const auto hit = editor.work.pick(at);
            if (!hit) continue;
            const auto surface = std::ranges::find(surfaces, hit->surface.id, [](const auto& s) { return s.id.id; });
            REQUIRE(surface != surfaces.end());
            const auto house = editor.work.meetHouse(editor.work.rayThrough(at), 1e4f, false);
            const bool before = house && house->distance < hit->distance - .3f;
            const bool wall = !surface->drawn && house && std::abs(house->distance - hit->distance) < .1f;
            if (wall) CHECK(editor.work.pickHouse(at) == house->house);
            CHECK(editor.work.pickGround(at).has_value() == !before);
            walls += wall;
            hidden += before;
        }
    CHECK(walls > 50);
    CHECK(hidden > 0);
}
