// What is typed into a panel, or was clicked at in one, when the next click or key changes what the panel is about.
#include "tests/editor/over_town.hpp"
#include "tests/editor/user.hpp"

using namespace espalier::document;
using sample::Tool;

namespace {

// The wall of the small scene.
struct Planter : User {
    explicit Planter(const Folder& folder) : User(folder, smallScene(folder), Tool::seeds) {
        faceWall(*this, 1.4f);
        panel = [this] { sample::seedsPanel(work); };
        rest();
    }
    glm::vec2 onWall(float x, float y) const { return at({x, y, .36f}); }
    uint32_t plant(glm::vec2 place) {
        tap(place);
        REQUIRE(work.selected.size() == 1);
        return *work.selected.begin();
    }
    const espalier::scene::Seed& seed(uint32_t key) const {
        const auto* found = work.document->seed(key);
        REQUIRE(found);
        return *found;
    }
    glm::vec2 marker(uint32_t key) const { return at(sample::vec(seed(key).position)); }
};

// A town from above.
struct Builder : OverTown<User> {
    explicit Builder(const Folder& folder) : OverTown(folder, content("town.json")) {
        panel = [this] { sample::housesPanel(work); };
        rest();
    }
    float walls(uint32_t house) const { return espalier::scene::houseNow(work.context.get(), house).eaveHeight; }
    // Chooses the house, and leaves a height half typed.
    void typeWalls(uint32_t house, const char* height) {
        tap(middle(house));
        REQUIRE(work.house == house);
        tapTwice(placeOf({int(house), "Walls", "##value"}));
        type(height);
    }
};

}  // namespace

TEST_CASE("what stands in a seed's field stays that seed's, whichever seed is clicked next") {
    const Folder folder;
    Planter gardener(folder);
    const uint32_t a = gardener.plant(gardener.onWall(-1.1f, 1)), b = gardener.plant(gardener.onWall(-.8f, 1.4f));
    const uint32_t numberA = gardener.seed(a).number, numberB = gardener.seed(b).number;
    REQUIRE(numberA != numberB);
    gardener.tap(gardener.marker(a));
    REQUIRE(gardener.work.selected == std::set<uint32_t>{a});
    gardener.tap(gardener.placeOf({int(a), "##number"}));
    REQUIRE(ImGui::IsAnyItemActive());
    gardener.tap(gardener.marker(b));
    CHECK(gardener.work.selected == std::set<uint32_t>{b});
    CHECK(gardener.seed(a).number == numberA);
    CHECK(gardener.seed(b).number == numberB);

    gardener.tap(gardener.placeOf({int(b), "##number"}));
    gardener.type("9");
    gardener.tap(gardener.marker(a));
    CHECK(gardener.seed(a).number == numberA);
    CHECK(gardener.seed(b).number == 9);
}

TEST_CASE("a random number that is typed stays within what there is") {
    const Folder folder;
    Planter gardener(folder);
    const uint32_t a = gardener.plant(gardener.onWall(-1.1f, 1));
    for (const auto& [typed, number] :
         {std::pair{"-5", 0u}, {"99999999999", 4294967295u}, {"4294967295", 4294967295u}}) {
        gardener.tap(gardener.placeOf({int(a), "##number"}));
        gardener.type(typed);
        gardener.tap(gardener.marker(a));
        CHECK(gardener.seed(a).number == number);
    }
}

TEST_CASE("Esc takes back a random number that is typed, of several seeds each its own, and leaves no step behind") {
    const Folder folder;
    Planter gardener(folder);
#if IMGUI_VERSION_NUM < 18700
    ImGui::GetIO().KeyMap[ImGuiKey_Escape] = GLFW_KEY_ESCAPE;
#endif
    const uint32_t a = gardener.plant(gardener.onWall(-1.1f, 1)), b = gardener.plant(gardener.onWall(-.8f, 1.4f));
    const uint32_t numberA = gardener.seed(a).number, numberB = gardener.seed(b).number;
    const size_t steps = gardener.work.document->undoSteps();
    for (const std::set<uint32_t>& chosen : {std::set{a}, std::set{a, b}}) {
        gardener.work.selected = chosen;
        gardener.tap(gardener.placeOf({int(a), "##number"}));
        gardener.type("77");
        REQUIRE(gardener.seed(a).number == 77);
        REQUIRE(gardener.seed(b).number == (chosen.size() == 2 ? 78 : numberB));
        gardener.strike(GLFW_KEY_ESCAPE);
        gardener.rest();
        CHECK(!ImGui::IsAnyItemActive());
        CHECK(gardener.seed(a).number == numberA);
        CHECK(gardener.seed(b).number == numberB);
        CHECK(gardener.work.document->undoSteps() == steps);
        CHECK(gardener.work.selected == chosen);
    }
}

TEST_CASE("any button that is pressed beside panels leaves the field that is typed into") {
    const Folder folder;
    Planter gardener(folder);
    const uint32_t a = gardener.plant(gardener.onWall(-1.1f, 1));
    for (const auto& [button, number] : {std::pair(GLFW_MOUSE_BUTTON_RIGHT, "12"), {GLFW_MOUSE_BUTTON_MIDDLE, "34"}}) {
        CAPTURE(button);
        gardener.tap(gardener.placeOf({int(a), "##number"}));
        gardener.type(number);
        REQUIRE(ImGui::IsAnyItemActive());
        const glm::vec2 at = gardener.onWall(-.8f, 1.4f);
        gardener.point(at);
        gardener.events.pointer({sample::PointerEvent::Kind::press, button, 0, at.x, at.y});
        gardener.rest();
        CHECK(!ImGui::IsAnyItemActive());
        gardener.type("5");
        CHECK(!ImGui::GetIO().WantTextInput);
        gardener.events.pointer({sample::PointerEvent::Kind::release, button, 0, at.x, at.y});
        gardener.rest();
        CHECK(gardener.seed(a).number == uint32_t(std::stoi(number)));
    }
}

TEST_CASE("any button that is pressed beside a grammar's text gives letters back to the tools") {
    const Folder folder;
    Planter gardener(folder);
    gardener.work.window = {1280, 720};
    gardener.work.layout.grammar = true;
    gardener.panel = [&] { sample::showGrammarWindow(gardener.work); };
    gardener.rest();
    for (const int button : {GLFW_MOUSE_BUTTON_LEFT, GLFW_MOUSE_BUTTON_RIGHT, GLFW_MOUSE_BUTTON_MIDDLE})
        for (const bool slow : {false, true}) {  // it goes down and up within a frame
            CAPTURE(button);
            CAPTURE(slow);
            gardener.tap({1000, 300});
            REQUIRE(sample::grammarFocused());
            const glm::vec2 at(500, 400);  // between the panel and the window
            REQUIRE(sample::inScene(at.x, at.y));
            gardener.point(at);
            gardener.events.pointer({sample::PointerEvent::Kind::press, button, 0, at.x, at.y});
            if (!slow) gardener.rest();
            CHECK(sample::grammarFocused() == slow);
            gardener.events.pointer({sample::PointerEvent::Kind::release, button, 0, at.x, at.y});
            gardener.rest();
            CHECK(!sample::grammarFocused());
        }
    sample::leaveGrammar();
}

TEST_CASE("a height that is typed is the house's that was chosen, whatever is clicked next") {
    const Folder folder;
    Builder builder(folder);
    const uint32_t a = builder.named("mansard"), b = builder.named("gambrel");
    const float before = builder.walls(b);
    builder.typeWalls(a, "9");
    CHECK(builder.walls(a) != 9);  // it may go on
    builder.tap(builder.middle(b));
    CHECK(builder.work.house == b);
    CHECK(builder.walls(a) == doctest::Approx(9));
    CHECK(builder.walls(b) == before);

    builder.typeWalls(a, "7");
    const EspHouseInfo from = builder.info(a), to = builder.info(b);
    const glm::vec2 ground = builder.at(
        {(from.boundsMax[0] + to.boundsMin[0]) / 2, from.boundsMin[1], (from.boundsMin[2] + from.boundsMax[2]) / 2});
    REQUIRE(!builder.work.pickHouse(ground));
    builder.tap(ground);
    CHECK(!builder.work.house);
    builder.tap(builder.middle(b));
    CHECK(builder.walls(a) == doctest::Approx(7));
    CHECK(builder.walls(b) == before);
}

TEST_CASE("a stroke that follows what is typed into the brush paints by it") {
    const Folder folder;
    Planter painter(folder);
    painter.work.choose(Tool::paint);
    painter.panel = [&] { sample::brushPanel(painter.work); };
    painter.tapTwice(painter.placeOf({"Value", "##value"}));
    painter.type(".25");
    painter.tap(painter.onWall(-1, 1));
    REQUIRE(painter.all<StrokeBegin>().size() == 1);
    CHECK(painter.all<StrokeBegin>()[0].value == .25f);
    CHECK(painter.all<StrokeEnd>().size() == 1);
}

TEST_CASE("a number that is half typed is part of what Ctrl+S saves, and keeps Ctrl+Q from leaving unasked") {
    const Folder folder;
    Builder builder(folder);
    const uint32_t house = builder.named("mansard");
    REQUIRE(!builder.session.modified(builder.work));
    builder.typeWalls(house, "9");
    builder.strike(GLFW_KEY_Q, GLFW_MOD_CONTROL);
    builder.rest();
    CHECK(builder.walls(house) == doctest::Approx(9));
    CHECK(!builder.session.quit);
    CHECK(sample::dialogueAsked());
    sample::closeDialogues();

    const std::string garden = folder.file("garden");
    REQUIRE(builder.save(garden));
    builder.typeWalls(house, "7");
    builder.strike(GLFW_KEY_S, GLFW_MOD_CONTROL);
    builder.rest();
    builder.session.background().finish();
    CHECK(!builder.session.modified(builder.work));
    Editing saved(garden);
    CHECK(espalier::scene::houseNow(saved.context.get(), house).eaveHeight == doctest::Approx(7));
}

TEST_CASE(
    "two sliders that are clicked one right after the other both go where they were clicked, and each can be undone") {
    const Folder folder;
    Planter user(folder);
    float values[2] = {10, 20};
    size_t steps[2] = {};
    glm::vec2 places[2];
    user.panel = [&] {
        for (int i = 0; i < 2; ++i) {
            ImGui::PushID(i);
            ImGui::SetNextItemWidth(200);
            if (sample::slider("##value", &values[i], 0, 100, "%.0f")) {
                user.work.perform(SetLight{10, float(i), true}, sample::widgetGesture(user.work));
                steps[i] = user.work.document->undoSteps();
            }
            const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
            places[i] = {low.x + .75f * (high.x - low.x), (low.y + high.y) / 2};
            ImGui::PopID();
        }
    };
    for (const auto& [first, second] : {std::pair(0, 1), std::pair(1, 0)}) {
        values[0] = 10, values[1] = 20;
        user.rest();
        const size_t before = user.work.document->undoSteps();
        user.tap(places[first]);
        user.tap(places[second]);
        user.rest(30);
        for (const float value : values) CHECK(value == doctest::Approx(75).epsilon(.05));
        CHECK(steps[first] == before + 1);
        CHECK(steps[second] == before + 2);
    }
}

TEST_CASE("undo and redo right behind a click on a slider are of what it does") {
    const Folder folder;
    Planter user(folder);
    auto& document = *user.work.document;
    float value = 10;
    glm::vec2 place{0};
    user.panel = [&] {
        value = user.work.scene().hour;
        ImGui::SetNextItemWidth(200);
        if (sample::slider("##value", &value, 0, 24, "%.0f"))
            user.work.perform(SetLight{value, 0, true}, sample::widgetGesture(user.work));
        const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
        place = {low.x + .75f * (high.x - low.x), (low.y + high.y) / 2};
    };
    REQUIRE(user.work.perform(SetLight{4, 0, true}));
    REQUIRE(user.work.perform(SetLight{10, 0, true}));
    user.undo();
    user.rest();
    REQUIRE(document.redoName());
    const size_t before = document.undoSteps();
    user.tap(place);
    CHECK(sample::clickWaits());
    user.strike(GLFW_KEY_Z, GLFW_MOD_CONTROL);
    user.rest();
    CHECK(!sample::clickWaits());
    CHECK(document.undoSteps() == before);
    CHECK(user.work.scene().hour == 4);
    user.strike(GLFW_KEY_Y, GLFW_MOD_CONTROL);
    user.rest();
    CHECK(user.work.scene().hour == doctest::Approx(18).epsilon(.05));
    user.rest(30);
    CHECK(document.undoSteps() == before + 1);
}

TEST_CASE("what was typed into a panel that has been closed since isn't typed any more") {
    const Folder folder;
    Planter user(folder);
    float value = 10;
    bool shown = true;
    user.panel = [&] {
        if (shown) (void)sample::slider("##value", &value, 0, 100, "%.0f");
    };
    user.tapTwice(user.placeOf({"##value"}));
    user.type("7");
    shown = false;
    user.rest();
    shown = true;
    user.rest();
    CHECK(value == 10);
}

TEST_CASE("the click that ends what a key has begun presses nothing in the panel under it") {
    const Folder folder;
    Planter user(folder);
    int pressed = 0;
    user.panel = [&] { pressed += ImGui::Button("Press me", {200, 60}); };
    user.plant(user.onWall(-1.1f, 1));
    const glm::vec2 button = user.placeOf({"Press me"});
    for (const bool atOnce : {false, true}) {
        CAPTURE(atOnce);
        for (const int key : {GLFW_KEY_G, GLFW_KEY_R}) {
            pressed = 0;
            user.strike(key);
            if (!atOnce) user.rest();
            user.tap(button);
            CHECK(!user.work.underWay);
            CHECK(pressed == 0);
            user.tap(button);
            CHECK(pressed == 1);
        }
    }
    user.work.choose(Tool::paint);
    for (const int mods : {0, GLFW_MOD_SHIFT}) {
        pressed = 0;
        user.strike(GLFW_KEY_F, mods);
        user.rest();
        user.tap(button);
        CHECK(pressed == 0);
        user.tap(button);
        CHECK(pressed == 1);
    }
}

TEST_CASE("Esc takes back drags of the brush's slopes and heights") {
    const Folder folder;
    Planter painter(folder);
    sample::Brush& brush = painter.work.brush;
    painter.work.choose(Tool::paint);
    painter.panel = [&] { sample::brushPanel(painter.work); };
    brush.limited = true;
    const auto drag = [&](const char* range, const char* end, float way, float& value) {
        const float before = value;
        painter.hold(painter.placeOf({range, end}));
        painter.rest();
        painter.point(painter.mouse + glm::vec2(way, 0));
        painter.rest();
        CHECK(value != before);
        painter.strike(GLFW_KEY_ESCAPE);
        painter.rest();
        painter.point(painter.mouse + glm::vec2(way, 0));
        painter.rest();
        painter.letGo();
        painter.rest();
        CHECK(value == before);
    };
    drag("##slope", "##min", 40, brush.slope[0]);
    drag("##slope", "##max", -40, brush.slope[1]);
    drag("##height", "##max", -80, brush.height[1]);
    CHECK(painter.work.tool == Tool::paint);
}
