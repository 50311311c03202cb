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

#include "sample_game/panels.hpp"

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

bool overPanel(float x, float y) {
    const ImGuiContext& gui = *ImGui::GetCurrentContext();
    if (!gui.OpenPopupStack.empty()) return true;
    for (const ImGuiWindow* window : gui.Windows)
        if (window->WasActive && !window->Hidden && !(window->Flags & ImGuiWindowFlags_NoMouseInputs) &&
            window->OuterRectClipped.Contains({x, y}))
            return true;
    return false;
}

void GuiEvents::key(GLFWwindow* window, int key, int scancode, int action, int mods) {
    keys_.push_back({window, false, key, scancode, action, mods});
}

void GuiEvents::letter(GLFWwindow* window, unsigned code) {
    keys_.push_back({window, true, int(code), 0, 0, 0});
}

void GuiEvents::move(float x, float y) {
    if (!mouse_.empty() && mouse_.back().button < 0) mouse_.pop_back();
    mouse_.push_back({-1, false, x, y});
}

void GuiEvents::button(int button, bool down) {
    if (button >= 0 && button < int(std::size(buttons_))) mouse_.push_back({button, down, 0, 0});
}

// True: a button changed that a panel is to see, or is about to. Clicks beside them needn't be told apart, so that none
// of them waits.
bool GuiEvents::feedMouse() {
    bool changed = false, moved = false;
    for (; !mouse_.empty() && !changed; mouse_.pop_front()) {
        const Mouse& e = mouse_.front();
        if (e.button < 0) {
            x_ = e.x;
            y_ = e.y;
            placed_ = moved = true;
            continue;
        }
        // A slider looks where the mouse is only while its button is down: the end of a fast drag is a frame of its
        // own.
        if (moved && !e.down && ofPanel_[e.button]) return true;
        buttons_[e.button] = e.down;
        if (e.down) ofPanel_[e.button] = overPanel(x_, y_);
        changed = ofPanel_[e.button];
    }
    return changed;
}

void GuiEvents::feedKeys(bool typing, std::vector<KeyEvent>& pressed) {
    if (awaitsText()) return;
    bool keyed = false, wrote = false;
    for (bool asked = false; !keys_.empty() && !asked; keys_.pop_front()) {
        const Key& e = keys_.front();
        if (e.letter) {
            if (keyed) break;
            ImGui_ImplGlfw_CharCallback(e.window, unsigned(e.code));
            wrote = true;
            continue;
        }
        const bool shifts = e.code >= GLFW_KEY_LEFT_SHIFT && e.code <= GLFW_KEY_RIGHT_SUPER;
        const bool told = typing && !writes(e.code, e.mods) && !(shifts && e.action == GLFW_PRESS);
        if (told && (keyed || wrote)) break;
        ImGui_ImplGlfw_KeyCallback(e.window, e.code, e.scancode, e.action, e.mods);
        keyed = keyed || told;
        if (e.action == GLFW_RELEASE) continue;
        pressed.push_back({e.code, e.mods});
        asked = asks(e.code, e.mods);
    }
}

void GuiEvents::feed(std::vector<KeyEvent>& pressed) {
    ImGuiIO& io = ImGui::GetIO();
    const bool typing = io.WantTextInput || !ImGui::GetCurrentContext()->OpenPopupStack.empty();
    const bool changed = feedMouse();
    // A click may end the typing, or begin it elsewhere.
    if (!changed || !typing) feedKeys(typing, pressed);
    // The backend has put in how things are by now, which is later than what ImGui is told.
    if (placed_ && (changed || !mouse_.empty()) && ImGui::IsMousePosValid()) io.MousePos = {x_, y_};
    std::copy(std::begin(buttons_), std::end(buttons_), io.MouseDown);
}

}  // namespace sample
