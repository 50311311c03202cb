// Events as they come -> ImGui's state: at most one change of a button a frame, and of a key while something is typed
// into.
#define GLFW_INCLUDE_NONE
#include "sample_game/gui_events.hpp"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cfloat>
#include <iterator>
#include <utility>

#include "sample_game/graph_editor.hpp"
#include "sample_game/panels.hpp"

namespace sample {
namespace {

constexpr double kDoubleClick = .3;  // seconds

// Keys that only write needn't be seen going down: their letter comes by itself.
bool writes(int key, int mods) {
    return key >= GLFW_KEY_SPACE && key < GLFW_KEY_ESCAPE && !(mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT));
}

// Opens a dialogue, into which the next keys are typed.
bool asks(int key, int mods) {
    return (mods & GLFW_MOD_CONTROL) && (key == GLFW_KEY_S || key == GLFW_KEY_O || key == GLFW_KEY_E);
}

// What is done by it is done to what is open as it stands.
bool keeps(int key, int mods) {
    return asks(key, mods) || ((mods & GLFW_MOD_CONTROL) && key == GLFW_KEY_Q);
}

// What was done last is taken back, or done again: a click that waits has been done before it.
bool steps(int key, int mods) {
    return (mods & GLFW_MOD_CONTROL) && (key == GLFW_KEY_Z || key == GLFW_KEY_Y);
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

bool inScene(float x, float y) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    return x >= 0 && y >= 0 && x <= window.x && y <= window.y && !overPanel(x, y);
}

void GuiEvents::key(const KeyEvent& event, int scancode, int action) {
    events_.push_back(Key{event, event.key, scancode, action});
    std::get<Key>(events_.back()).event.repeated = action == GLFW_REPEAT;
}

// Brackets have no key of their own on many keyboards: what writes one together with AltGr is that bracket to tools.
void GuiEvents::letter(unsigned code) {
    Key* key = events_.empty() ? nullptr : std::get_if<Key>(&events_.back());
    if (key && key->action != GLFW_RELEASE && (code == '[' || code == ']')) {
        key->event.key = code == '[' ? GLFW_KEY_LEFT_BRACKET : GLFW_KEY_RIGHT_BRACKET;
        key->event.mods &= ~(GLFW_MOD_CONTROL | GLFW_MOD_ALT);  // some systems' AltGr
    }
    events_.push_back(Letter{code});
}

// Of two presses it is known between which times each has happened: they are one double click if they can be.
void GuiEvents::pointer(const PointerEvent& event) {
    if (event.button < 0 || event.button >= int(std::size(buttons_))) return;
    bool again = false;
    if (event.kind == PointerEvent::Kind::press) {
        again = pressed_ && pressed_->first == event.button && polled_ - pressed_->second < kDoubleClick;
        pressed_ = {event.button, glfwGetTime()};
    }
    events_.push_back(Pointer{event, again});
}

bool GuiEvents::waitsForPanels(const Told& told) {
    if (told.waited) return false;
    if (told.keyed || told.wrote || told.handed) return true;  // which comes first
    leaveFields();
    return waited_ = true;
}

bool GuiEvents::tell(const Pointer& pointer, Told& told, std::vector<InputEvent>& taken) {
    if (told.clicked) return false;
    const PointerEvent& e = pointer.event;
    const bool press = e.kind == PointerEvent::Kind::press;
    if (e.kind != PointerEvent::Kind::move) {
        const bool panels = press ? overPanel(e.x, e.y) : ofPanel_[e.button];
        // What is typed is about what is chosen before the click. Over panels ImGui itself ends it.
        // Beside them any button does: what it begins takes letters as keys.
        const bool left = e.button == GLFW_MOUSE_BUTTON_LEFT;
        const bool leaves = press && ((told.typing && !panels) || (left && sliderWaits(e.x, e.y)));
        if (leaves && waitsForPanels(told)) return false;
        if (press && !panels) leaveGrammar();              // ImGui knows of the left one alone, if a frame sees it down
        if (press && panels && told.handed) return false;  // the tools may have begun what this ends
        // A slider looks where the mouse is only while its button is down: the end of a fast drag is a frame of its
        // own.
        if (panels && ((told.moved && !press) || (told.typing && (told.keyed || told.wrote)))) return false;
        // Clicks beside panels needn't be told apart, so that none of them waits.
        buttons_[e.button] = press;
        ofPanel_[e.button] = told.clicked = panels;
        if (press) ImGui::GetIO().MouseDoubleClickTime = pointer.again ? FLT_MAX : 0;
    }
    told.moved = told.moved || x_ != e.x || y_ != e.y;
    x_ = e.x;
    y_ = e.y;
    placed_ = true;
    taken.push_back(e);
    return true;
}

bool GuiEvents::tell(const Letter& letter, Told& told, std::vector<InputEvent>&) {
    if (told.awaited || told.clicked || told.keyed || told.asks) return false;
    ImGui_ImplGlfw_CharCallback(window_, letter.code);
    return told.wrote = true;
}

bool GuiEvents::tell(const Key& key, Told& told, std::vector<InputEvent>& taken) {
    const int code = key.event.key, mods = key.event.mods;
    const bool cancels = code == GLFW_KEY_ESCAPE && dialogueWaits();
    const bool ends = key.action == GLFW_RELEASE && !told.held;  // it has gone down before anything was held back
    if ((told.awaited && !cancels && !ends) || told.clicked || told.asks) return false;
    const bool shifts = code >= GLFW_KEY_LEFT_SHIFT && code <= GLFW_KEY_RIGHT_SUPER;
    const bool apart = told.typing && !writes(code, mods) && !(shifts && key.action == GLFW_PRESS);
    if (apart && (told.keyed || told.wrote)) return false;
    const bool panelsFirst =
        (keeps(code, mods) && sliderWaits()) || (steps(code, mods) && clickWaits() && !told.typing);
    if (key.action != GLFW_RELEASE && panelsFirst && waitsForPanels(told)) return false;
    ImGui_ImplGlfw_KeyCallback(window_, key.code, key.scancode, key.action, mods);
    told.keyed = told.keyed || apart;
    if (key.action == GLFW_RELEASE) return true;
    taken.push_back(key.event);
    told.handed = true;
    told.asks = !key.event.repeated &&
                (asks(code, mods) ||
                 asksForNode(code, mods & GLFW_MOD_CONTROL, mods & GLFW_MOD_SHIFT, key.event.x, key.event.y));
    return true;
}

bool GuiEvents::takeEscape(size_t behind) {
    const auto from = events_.begin() + std::ptrdiff_t(std::min(behind, events_.size()));
    const auto escapes = std::remove_if(from, events_.end(), [](const Event& event) {
        const Key* key = std::get_if<Key>(&event);
        return key && key->event.key == GLFW_KEY_ESCAPE && key->action == GLFW_PRESS;
    });
    const bool any = escapes != events_.end();
    events_.erase(escapes, events_.end());
    return any;
}

void GuiEvents::dropPresses(size_t behind) {
    bool dropped[std::size(buttons_)] = {};
    const auto from = events_.begin() + std::ptrdiff_t(std::min(behind, events_.size()));
    const auto gone = std::remove_if(from, events_.end(), [&](const Event& event) {
        const Pointer* pointer = std::get_if<Pointer>(&event);
        if (!pointer || pointer->event.kind == PointerEvent::Kind::move) return false;
        const bool press = pointer->event.kind == PointerEvent::Kind::press;
        return std::exchange(dropped[pointer->event.button], press) || press;
    });
    events_.erase(gone, events_.end());
}

void GuiEvents::feed(std::vector<InputEvent>& taken) {
    ImGuiIO& io = ImGui::GetIO();
    const ImGuiContext& gui = *ImGui::GetCurrentContext();
    Told told{.typing = gui.WantTextInputNextFrame > 0 || !gui.OpenPopupStack.empty(),
              .awaited = awaitsText() || nodeListAwaits()};
    // A dialogue whose list is held takes no text before it is let go, which may come behind a key.
    if (std::ranges::count(buttons_, true) > 0) told.awaited = false;
    told.waited = std::exchange(waited_, false);
    const auto next = [&](const auto& event) { return tell(event, told, taken); };
    for (auto event = events_.begin(); event != events_.end();) {
        const bool took = std::visit(next, *event);
        told.waited = false;
        if (took) {
            event = events_.erase(event);
        } else if (dialogueWaits() && told.awaited && !std::holds_alternative<Pointer>(*event)) {
            told.held = true;  // for when it has closed: its Cancel is clicked now
            ++event;
        } else {
            break;
        }
    }
    // The backend has put in how things are by now, which is later than what ImGui is told.
    if (placed_ && (told.clicked || waiting()) && ImGui::IsMousePosValid()) io.MousePos = {x_, y_};
    std::copy(std::begin(buttons_), std::end(buttons_), io.MouseDown);
}

}  // namespace sample
