// Events as they come -> ImGui's state: at most one change of a button a frame, and of a key while something is typed
// into.
#define GLFW_INCLUDE_NONE
#include "sample_game/gui_events.hpp"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <iterator>

namespace sample {
namespace {

// Keys that only write needn't be seen going down: their letter comes by itself.
bool writes(int key, int mods) {
    return key >= GLFW_KEY_SPACE && key < GLFW_KEY_ESCAPE && !(mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT));
}

// Opens a dialogue, into which the next keys are typed.
bool asks(int key, int mods) {
    return (mods & GLFW_MOD_CONTROL) && (key == GLFW_KEY_S || key == GLFW_KEY_O || key == GLFW_KEY_E);
}

}  // namespace

void GuiEvents::key(GLFWwindow* window, int key, int scancode, int action, int mods) {
    events_.push_back({Event::Kind::key, window, key, scancode, action, mods});
}

void GuiEvents::letter(GLFWwindow* window, unsigned code) {
    events_.push_back({Event::Kind::letter, window, int(code)});
}

void GuiEvents::move(float x, float y) {
    if (!events_.empty() && events_.back().kind == Event::Kind::move) events_.pop_back();
    events_.push_back({.kind = Event::Kind::move, .x = x, .y = y});
}

void GuiEvents::button(int button, bool down) {
    if (button >= 0 && button < int(std::size(buttons_)))
        events_.push_back({.kind = Event::Kind::button, .code = button, .action = down});
}

void GuiEvents::feed(std::vector<KeyEvent>& keys) {
    ImGuiIO& io = ImGui::GetIO();
    const bool typing = io.WantTextInput || !ImGui::GetCurrentContext()->OpenPopupStack.empty();
    bool keyed = false, wrote = false, pressed = false;
    for (bool asked = false; !events_.empty() && !asked; events_.pop_front()) {
        const Event& e = events_.front();
        if (e.kind == Event::Kind::move) {
            if (pressed) break;
            x_ = e.x;
            y_ = e.y;
            placed_ = true;
        } else if (e.kind == Event::Kind::button) {
            if (pressed || keyed || wrote) break;
            buttons_[e.code] = e.action;
            pressed = true;
        } else if (e.kind == Event::Kind::letter) {
            if (keyed || pressed) break;
            ImGui_ImplGlfw_CharCallback(e.window, unsigned(e.code));
            wrote = true;
        } else {
            const bool shifts = e.code >= GLFW_KEY_LEFT_SHIFT && e.code <= GLFW_KEY_RIGHT_SUPER;
            const bool told = typing && !writes(e.code, e.mods) && !(shifts && e.action == GLFW_PRESS);
            if (told && (keyed || wrote || pressed)) break;
            ImGui_ImplGlfw_KeyCallback(e.window, e.code, e.scancode, e.action, e.mods);
            keyed = keyed || told;
            if (e.action == GLFW_RELEASE) continue;
            keys.push_back({e.code, e.mods});
            asked = asks(e.code, e.mods);
        }
    }
    // The backend has put in how things are by now, which is later than what ImGui is told.
    if (placed_ && (pressed || waiting()) && ImGui::IsMousePosValid()) io.MousePos = {x_, y_};
    std::copy(std::begin(buttons_), std::end(buttons_), io.MouseDown);
}

}  // namespace sample
