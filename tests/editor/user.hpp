#pragma once

#include <cstddef>

#include "sample_game/dialogue.hpp"
#include "sample_game/panels.hpp"
#include "tests/editor/widgets.hpp"

// An editor whose mouse and keys go the way that a window's do, so that panels and tools share them. One panel is open,
// at the left.
struct User : Editor {
    sample::GuiEvents events{nullptr};
    std::vector<std::byte> backend = std::vector<std::byte>(size_t(1) << 16);  // ImGui's, of no window
    std::function<void()> panel = [] {};                                       // lays out what is in it

    User(const Folder& folder, const std::string& file, sample::Tool tool) : Editor(folder, file, tool) {
        sample::dialogues() = {};
        ImGui::GetIO().BackendPlatformUserData = backend.data();
        events.polled(kLater);
        panels = [this] {
            sample::beginGesture(work);
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({work.panelUnits(), work.window.y});
            ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove);
            panel();
            ImGui::End();
        };
    }
    ~User() {
        sample::closeDialogues();
        sample::dialogues() = {};
        ImGui::GetIO().BackendPlatformUserData = nullptr;
    }

    // Until all that was done is told, and has been laid out.
    void rest(int frames = 3) {
        for (int i = 0; i < frames || events.waiting(); ++i) {
            REQUIRE(i < 100);
            std::vector<sample::InputEvent> taken;
            events.feed(taken);
            frame(taken);
        }
    }
    void point(glm::vec2 to) {
        mouse = to;
        events.pointer({sample::PointerEvent::Kind::move, 0, 0, to.x, to.y});
    }
    void hold(glm::vec2 at) {
        point(at);
        events.pointer({sample::PointerEvent::Kind::press, GLFW_MOUSE_BUTTON_LEFT, 0, at.x, at.y});
    }
    void letGo() { events.pointer({sample::PointerEvent::Kind::release, GLFW_MOUSE_BUTTON_LEFT, 0, mouse.x, mouse.y}); }
    void tap(glm::vec2 at) {
        hold(at);
        rest();
        letGo();
        rest();
    }
    void tapTwice(glm::vec2 at) {
        tap(at);
        events.polled(0);
        tap(at);
        events.polled(kLater);
    }
    void strike(int key, int mods = 0) {
        for (const int action : {GLFW_PRESS, GLFW_RELEASE}) events.key({key, mods, mouse.x, mouse.y}, 0, action);
    }
    void type(const char* text) {
        for (; *text; ++text) events.letter(unsigned(*text));
        rest();
    }
    // Where a widget of the panel is, found by what the mouse is over.
    glm::vec2 placeOf(const std::vector<Part>& path) {
        constexpr float kStep = 5;
        rest();
        const ImGuiID wanted = widget("panel", path);
        for (float y = 0; y < work.window.y; y += kStep)
            for (const float share : {.3f, .5f, .8f}) {
                mouse = {std::floor(share * work.panelUnits()), y};
                frame({});
                if (ImGui::GetCurrentContext()->HoveredId == wanted) return mouse;
            }
        FAIL("it isn't in the panel");
        return {};
    }

  private:
    static constexpr double kLater = 1;  // seconds: no second click makes a double click
};
