// Keys on their way from the keyboard to the tools: by the user's layout, and once however long they are held.
#include <cstddef>

#include "sample_game/panels.hpp"
#include "tests/editor/imgui_keys.hpp"
#include "tests/editor/window.hpp"

using namespace espalier::document;
using sample::GuiEvents, sample::KeyEvent, sample::keyNamed, sample::Tool;

namespace {

// What GLFW tells of the keyboard -> what the tools get, in one frame.
struct Keyboard {
    Gui gui;
    GuiEvents events{nullptr};
    std::vector<std::byte> backend = std::vector<std::byte>(size_t(1) << 16);  // ImGui's, of no window

    Keyboard() { ImGui::GetIO().BackendPlatformUserData = backend.data(); }
    ~Keyboard() { ImGui::GetIO().BackendPlatformUserData = nullptr; }
    std::vector<KeyEvent> taken() {
        std::vector<sample::InputEvent> all;
        events.feed(all);
        std::vector<KeyEvent> keys;
        for (const auto& event : all) keys.push_back(std::get<KeyEvent>(event));
        return keys;
    }
};

struct Typist : Editor {
    using Editor::Editor;
    void hold(int code, int mods = 0, int repeats = 6) {
        key(code, mods);
        for (int i = 0; i < repeats; ++i) frame({KeyEvent{code, mods, mouse.x, mouse.y, true}}, mods);
    }
};

}  // namespace

TEST_CASE("letters and brackets are where the user's layout has them, and digits where they always are") {
    // QWERTZ, by the key of a keyboard of the US and what GLFW calls it
    CHECK(keyNamed(GLFW_KEY_Y, "z") == GLFW_KEY_Z);
    CHECK(keyNamed(GLFW_KEY_Z, "y") == GLFW_KEY_Y);
    CHECK(keyNamed(GLFW_KEY_LEFT_BRACKET, "\u00fc") == GLFW_KEY_LEFT_BRACKET);
    CHECK(keyNamed(GLFW_KEY_RIGHT_BRACKET, "+") == GLFW_KEY_RIGHT_BRACKET);
    // AZERTY
    CHECK(keyNamed(GLFW_KEY_Q, "a") == GLFW_KEY_A);
    CHECK(keyNamed(GLFW_KEY_A, "q") == GLFW_KEY_Q);
    CHECK(keyNamed(GLFW_KEY_SEMICOLON, "m") == GLFW_KEY_M);
    CHECK(keyNamed(GLFW_KEY_M, ",") == GLFW_KEY_COMMA);
    CHECK(keyNamed(GLFW_KEY_6, "-") == GLFW_KEY_6);
    CHECK(keyNamed(GLFW_KEY_1, "&") == GLFW_KEY_1);
    // Dvorak
    CHECK(keyNamed(GLFW_KEY_MINUS, "[") == GLFW_KEY_LEFT_BRACKET);
    CHECK(keyNamed(GLFW_KEY_EQUAL, "]") == GLFW_KEY_RIGHT_BRACKET);
    CHECK(keyNamed(GLFW_KEY_E, ".") == GLFW_KEY_PERIOD);
    // Cyrillic, and what has no name
    CHECK(keyNamed(GLFW_KEY_A, "\u0444") == GLFW_KEY_A);
    CHECK(keyNamed(GLFW_KEY_Z, nullptr) == GLFW_KEY_Z);
    CHECK(keyNamed(GLFW_KEY_F1, "") == GLFW_KEY_F1);
}

TEST_CASE("a bracket that AltGr and another key write is that bracket to tools, and ImGui's keys go up again") {
    Keyboard keyboard;
    for (const auto& [letter, meant] : {std::pair('[', GLFW_KEY_LEFT_BRACKET), std::pair(']', GLFW_KEY_RIGHT_BRACKET)})
        for (const int mods : {0, GLFW_MOD_CONTROL | GLFW_MOD_ALT}) {
            CAPTURE(letter);
            keyboard.events.key({GLFW_KEY_5, mods, 3, 4}, 0, GLFW_PRESS);
            keyboard.events.letter(unsigned(letter));
            keyboard.events.key({GLFW_KEY_5, mods, 3, 4}, 0, GLFW_RELEASE);
            const auto keys = keyboard.taken();
            REQUIRE(keys.size() == 1);
            CHECK(keys[0].key == meant);
            CHECK(keys[0].mods == 0);
            CHECK(keys[0].x == 3);
            CHECK(!isAnyKeyDown());
        }
    keyboard.events.key({GLFW_KEY_5, 0, 0, 0}, 0, GLFW_PRESS);
    keyboard.events.letter('5');
    CHECK(keyboard.taken().at(0).key == GLFW_KEY_5);
}

TEST_CASE("a key that is held tells that it is, and asks for a dialogue once") {
    Keyboard keyboard;
    keyboard.events.key({GLFW_KEY_S, GLFW_MOD_CONTROL, 0, 0}, 0, GLFW_PRESS);
    CHECK(keyboard.taken().size() == 1);
    for (int i = 0; i < 3; ++i) keyboard.events.key({GLFW_KEY_S, GLFW_MOD_CONTROL, 0, 0}, 0, GLFW_REPEAT);
    const auto keys = keyboard.taken();
    REQUIRE(keys.size() == 3);
    for (const KeyEvent& key : keys) CHECK(key.repeated);
}

TEST_CASE("clicks behind so many events are dropped, but for what lets go of a button that was down, and keys stay") {
    Keyboard keyboard;
    using sample::PointerEvent;
    using Kind = PointerEvent::Kind;
    auto& events = keyboard.events;
    events.pointer({Kind::press, GLFW_MOUSE_BUTTON_LEFT, 0, 1, 1});
    const size_t before = events.count();
    events.pointer({Kind::release, GLFW_MOUSE_BUTTON_LEFT, 0, 2, 2});
    for (const int button : {GLFW_MOUSE_BUTTON_LEFT, GLFW_MOUSE_BUTTON_RIGHT}) {
        events.pointer({Kind::press, button, 0, 3, 3});
        events.key({GLFW_KEY_F2, 0, 3, 3}, 0, GLFW_PRESS);
        events.pointer({Kind::move, 0, 0, 4, 4});
        events.pointer({Kind::release, button, 0, 4, 4});
    }
    events.pointer({Kind::press, GLFW_MOUSE_BUTTON_LEFT, 0, 5, 5});
    events.dropPresses(before);
    std::vector<sample::InputEvent> all;
    for (int i = 0; i < 9 && events.waiting(); ++i) events.feed(all);
    std::vector<Kind> kinds;
    size_t keys = 0;
    for (const auto& event : all)
        if (const auto* pointer = std::get_if<PointerEvent>(&event))
            kinds.push_back(pointer->kind);
        else
            ++keys;
    CHECK(kinds == std::vector{Kind::press, Kind::release, Kind::move, Kind::move});
    CHECK(keys == 2);
}

TEST_CASE("V shows the brush's layer, on surfaces and on roofs") {
    const Folder folder;
    Typist typist(folder, content("hamlet.json"), Tool::paint);
    const auto& scene = typist.work.scene();
    const auto shows = [&](const std::string& layer) {
        return scene.look.view == ESP_VIEW_LAYER && scene.viewLayer == layer;
    };
    typist.work.chooseLayer("mask");
    CHECK(shows("mask"));
    // What paint does to roofs is seen; the layer where it is asked for, until another kind of layer is taken.
    typist.work.chooseLayer("moss");
    REQUIRE(typist.work.townLayer("moss"));
    CHECK(scene.look.view == ESP_VIEW_SHADED);
    typist.key(GLFW_KEY_V);
    CHECK(shows("moss"));
    typist.work.chooseLayer("decay");
    CHECK(shows("decay"));
    typist.key(GLFW_KEY_V);
    CHECK(scene.look.view == ESP_VIEW_SHADED);
    typist.key(GLFW_KEY_V);
    typist.work.choose(Tool::seeds);
    CHECK(scene.look.view == ESP_VIEW_SHADED);
}

TEST_CASE("who walks sees the finished picture, and who comes back to the brush what is painted") {
    const Folder folder;
    Typist typist(folder, smallScene(folder), Tool::paint);
    const auto& scene = typist.work.scene();
    typist.work.showLayer(true);
    typist.key(GLFW_KEY_TAB);
    CHECK(!typist.work.editing);
    CHECK(scene.look.view == ESP_VIEW_SHADED);
    typist.key(GLFW_KEY_TAB);
    CHECK(typist.work.editing);
    CHECK(scene.look.view == ESP_VIEW_LAYER);
    // What another tool shows is meant.
    typist.work.choose(Tool::seeds);
    typist.work.perform(espalier::document::SetView{"lod", ""});
    typist.key(GLFW_KEY_TAB);
    typist.key(GLFW_KEY_TAB);
    CHECK(scene.look.view == ESP_VIEW_LOD);
}

TEST_CASE("a key that is held acts once, but for undo, the brush's size and the numpad") {
    const Folder folder;
    Typist typist(folder, smallScene(folder), Tool::paint);
    const bool shown = typist.work.scene().look.view == ESP_VIEW_LAYER;
    typist.hold(GLFW_KEY_V);
    CHECK((typist.work.scene().look.view == ESP_VIEW_LAYER) != shown);
    typist.hold(GLFW_KEY_F1);
    CHECK(typist.work.layout.help);
    typist.key(GLFW_KEY_F1);
    typist.work.brush.radius = .1f;
    typist.hold(GLFW_KEY_RIGHT_BRACKET);
    CHECK(typist.work.brush.radius > .2f);
    // The radius follows the mouse from where it was when F went down.
    typist.work.brush.radius = .1f;
    typist.move({600, 300});
    typist.key(GLFW_KEY_F);
    typist.move({700, 300});
    const float sized = typist.work.brush.radius;
    CHECK(sized > .15f);
    typist.frame({KeyEvent{GLFW_KEY_F, 0, 700, 300, true}});
    typist.move({701, 300});
    CHECK(typist.work.brush.radius == doctest::Approx(sized).epsilon(.02));
    typist.click({701, 300});

    for (const float value : {.2f, .4f, .6f}) typist.fill(value);
    typist.hold(GLFW_KEY_Z, GLFW_MOD_CONTROL, 2);
    CHECK(typist.work.document->undoSteps() == 0);
    typist.hold(GLFW_KEY_Y, GLFW_MOD_CONTROL, 2);
    CHECK(typist.work.document->undoSteps() == 3);
    const glm::vec3 ahead = typist.work.camera.ahead();
    typist.key(GLFW_KEY_KP_4);
    const float one = glm::distance(typist.work.camera.ahead(), ahead);
    typist.frame({KeyEvent{GLFW_KEY_KP_4, 0, 0, 0, true}});
    CHECK(glm::distance(typist.work.camera.ahead(), ahead) > 1.5f * one);
}
