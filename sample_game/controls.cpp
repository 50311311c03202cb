// Keys and mouse on their way to panels, camera and tools.
#include "sample_game/controls.hpp"

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <utility>

#include "sample_game/additions.hpp"
#include "sample_game/graph_editor.hpp"
#include "sample_game/panels.hpp"
#include "tools/scene/layers.hpp"

namespace sample {

using namespace espalier::document;

void Controls::catchMouse(bool caught) {
    navigation_.caught = caught;
    if (input_) input_->catchMouse(caught);
    ImGuiIO& io = ImGui::GetIO();
    io.ConfigFlags = caught ? io.ConfigFlags | ImGuiConfigFlags_NoMouse | ImGuiConfigFlags_NoMouseCursorChange
                            : io.ConfigFlags & ~(ImGuiConfigFlags_NoMouse | ImGuiConfigFlags_NoMouseCursorChange);
}

void Controls::cancelTools() {
    brush_.cancel(work_);
    seeds_.cancel(work_);
    path_.cancel();
    houses_.cancel(work_);
    fields_.cancel(work_);
    noteTools();
}

bool Controls::takeBackDrag() {
    if (brush_.sizing())
        brush_.cancel(work_);
    else if (brush_.painting())
        brush_.takeBack(work_);
    else if (seeds_.dragging())
        seeds_.cancel(work_);
    else if (path_.dragging())
        path_.cancel();
    else if (houses_.dragging())
        houses_.cancel(work_);
    else if (fields_.dragging())
        fields_.cancel(work_);
    else
        return false;
    return true;
}

void Controls::finishTools() {
    brush_.cancel(work_);  // keeps what is painted
    seeds_.finish(work_);
    path_.cancel();
    houses_.finish(work_);
    fields_.finish();
    finishDrag();
    noteTools();
}

void Controls::noteTools() {
    work_.busy = toolBusy() || holdsControl();
    // The click that ends what follows the mouse without a button is no panel's.
    const bool own = navigation_.caught || seeds_.followsMouse() || brush_.sizing();
    ImGuiConfigFlags& flags = ImGui::GetIO().ConfigFlags;
    flags = own ? flags | ImGuiConfigFlags_NoMouse : flags & ~ImGuiConfigFlags_NoMouse;
}

void Controls::setEditing(bool editing) {
    finishTools();
    catchMouse(false);
    work_.setEditing(editing);
}

void Controls::askToQuit() {
    finishTools();
    if ((session_.modified(work_) || !session_.idle()) && !work_.editing) setEditing(true);
    askToLeave(work_, session_);
}

void Controls::chooseTool(Tool tool) {
    cancelTools();
    work_.choose(tool);
}

void Controls::takeKey(const KeyEvent& event) {
    const int key = event.key;
    const bool control = event.mods & GLFW_MOD_CONTROL, shift = event.mods & GLFW_MOD_SHIFT;
    if (key == GLFW_KEY_F1) work_.layout.help = !work_.layout.help;
    if (key == GLFW_KEY_F2) work_.layout.panel = !work_.layout.panel, work_.redraw = true;
    if (key == GLFW_KEY_F3) work_.layout.figures = !work_.layout.figures;
    if (key == GLFW_KEY_F4) work_.showGrammar(!work_.layout.grammar, work_.shownGrammar);
    if (key == GLFW_KEY_F5) work_.showAtlas(!work_.layout.atlas);
    if (key == GLFW_KEY_F12) work_.screenshot = true, work_.message.clear();  // the last one's isn't in the picture
    if (key == GLFW_KEY_F6) return showNodes(work_, !work_.graphs.nodes);
    if (takeNodeKey(work_, event) || takeTimeKey(work_, event)) return;
    if (takeBookmarkKey(event)) return;
    if (control && takeViewKey(event)) return;
    if (control) {
        // A stroke, a drag or what G has begun ends before what it has done is saved, written or left.
        const int ends[] = {GLFW_KEY_Q, GLFW_KEY_S, GLFW_KEY_O, GLFW_KEY_E, GLFW_KEY_N};
        if (std::ranges::find(ends, key) != std::end(ends)) finishTools();
        if (key == GLFW_KEY_Q) askToQuit();
        if (key == GLFW_KEY_S) askToSave(work_, session_, shift);
        if (key == GLFW_KEY_O) askToOpen();
        if (key == GLFW_KEY_N) askToLeave(work_, session_, emptyScene());
        if (key == GLFW_KEY_E && !work_.brush.layer.empty()) askForLayer(work_.brush.layer, false);
        if (key == GLFW_KEY_Z && takeBackDrag()) return;
        if (toolBusy()) return;
        if (key == GLFW_KEY_D && work_.editing && work_.tool == Tool::seeds && !navigation_.dragging())
            return seeds_.duplicate(work_, {event.x, event.y});
        const bool undoes = key == GLFW_KEY_Z && !shift, redoes = (key == GLFW_KEY_Z && shift) || key == GLFW_KEY_Y;
        if (undoes && work_.document->undoName()) return void(work_.perform(Undo{}));
        if (redoes && work_.document->redoName()) return void(work_.perform(Redo{}));
        if (undoes && session_.recording()) return work_.say("Nothing to undo since the recording began");
        if (undoes || redoes) work_.say(undoes ? "Nothing to undo" : "Nothing to redo");
        return;
    }
    if (key == GLFW_KEY_TAB) return setEditing(!work_.editing);
    if (key == GLFW_KEY_ESCAPE) {
        // Never quits: frees the mouse, closes the help, puts the tool away.
        if (navigation_.caught)
            catchMouse(false);
        else if (work_.layout.help)
            work_.layout.help = false;
        else if (!takeBackDrag())
            chooseTool(Tool::look);
    }
    if (key == GLFW_KEY_HOME) {
        work_.editing ? work_.frameAll() : work_.lookFromStart();  // who walks stays on the ground
        navigation_.moved();
    }
    if (!work_.editing) {
        if (key == GLFW_KEY_G) navigation_.toggleFlying();
        if (key == GLFW_KEY_SPACE) navigation_.jump();
        return;
    }
    if (takeViewKey(event) || navigation_.dragging()) return;  // letters fly
    if (!seeds_.dragging() && !path_.dragging() && !houses_.dragging() && !fields_.dragging()) takeToolKey(event);
}

// Digits of the row: with Ctrl they keep the view, with Shift they show what was kept.
bool Controls::takeBookmarkKey(const KeyEvent& event) {
    const int digit = event.key - GLFW_KEY_0;
    const bool control = event.mods & GLFW_MOD_CONTROL, shift = event.mods & GLFW_MOD_SHIFT;
    if (!work_.editing || control == shift || digit < 1 || digit > 9) return false;
    if (control)
        work_.keepBookmark(uint32_t(digit));
    else if (work_.lookFromBookmark(uint32_t(digit)))
        navigation_.moved();
    return true;
}

// The views of Blender's number pad.
bool Controls::takeViewKey(const KeyEvent& event) {
    constexpr float kQuarter = 1.57079633f, kStep = .26179939f;  // 15 degrees
    struct View {
        int key;
        float yaw, pitch, yawOther, pitchOther;  // the other: with Ctrl
    };
    constexpr View kViewKeys[] = {{GLFW_KEY_KP_1, 0, 0, 2 * kQuarter, 0},
                                  {GLFW_KEY_KP_3, kQuarter, 0, -kQuarter, 0},
                                  {GLFW_KEY_KP_7, 0, -kQuarter, 0, kQuarter}};
    const auto view = std::ranges::find(kViewKeys, event.key, &View::key);
    constexpr int kTurns[] = {GLFW_KEY_KP_2, GLFW_KEY_KP_4,   GLFW_KEY_KP_5,       GLFW_KEY_KP_6,
                              GLFW_KEY_KP_8, GLFW_KEY_KP_ADD, GLFW_KEY_KP_SUBTRACT};
    if (view != std::end(kViewKeys) || std::ranges::find(kTurns, event.key) != std::end(kTurns)) navigation_.aim(work_);
    const bool other = event.mods & GLFW_MOD_CONTROL;
    if (view != std::end(kViewKeys))
        work_.camera.turnTo(other ? view->yawOther : view->yaw, other ? view->pitchOther : view->pitch);
    else if (event.key == GLFW_KEY_KP_4 || event.key == GLFW_KEY_KP_6)
        work_.camera.turnBy(event.key == GLFW_KEY_KP_4 ? -kStep : kStep, 0);
    else if (event.key == GLFW_KEY_KP_8 || event.key == GLFW_KEY_KP_2)
        work_.camera.turnBy(0, event.key == GLFW_KEY_KP_8 ? -kStep : kStep);
    else if (event.key == GLFW_KEY_KP_ADD || event.key == GLFW_KEY_KP_SUBTRACT)
        work_.camera.zoom(event.key == GLFW_KEY_KP_ADD ? 1 : -1);
    else if (event.key == GLFW_KEY_KP_5)
        work_.camera.toggleFlat();
    else if (event.key == GLFW_KEY_KP_0)
        work_.lookFromStart();
    else if (event.key == GLFW_KEY_KP_DECIMAL || event.key == GLFW_KEY_PERIOD)
        work_.frameChosen();
    else
        return false;
    navigation_.moved();
    return true;
}

// H hides what is chosen as in Blender; without that it is the key of the tool for houses.
bool Controls::takeHideKey(const KeyEvent& event) {
    const bool chosen =
        (work_.tool == Tool::seeds && !work_.selected.empty()) || (work_.tool == Tool::houses && work_.house);
    if (event.mods & GLFW_MOD_ALT)
        work_.showAll();
    else if (event.mods & GLFW_MOD_SHIFT)
        work_.isolateChosen();
    else if (chosen)
        work_.hideChosen();
    else
        return false;
    return true;
}

void Controls::takeToolKey(const KeyEvent& event) {
    const int key = event.key;
    if (key == GLFW_KEY_Q) chooseTool(Tool::look);
    if (key == GLFW_KEY_B) chooseTool(Tool::paint);
    if (key == GLFW_KEY_S) chooseTool(Tool::seeds);
    if (key == GLFW_KEY_T) chooseTool(Tool::path);
    if (key == GLFW_KEY_P) chooseTool(Tool::branch);
    if (key == GLFW_KEY_H && !takeHideKey(event)) chooseTool(Tool::houses);
    if (key == GLFW_KEY_KP_DIVIDE || key == GLFW_KEY_SLASH)
        work_.chosen().empty() && work_.anyHidden() ? work_.showAll() : work_.isolateChosen();
    if (key == GLFW_KEY_E) chooseTool(Tool::fields);
    const bool paints = work_.tool == Tool::paint;
    if (paints && !brush_.painting() && !brush_.sizing()) {  // a stroke goes on as it began
        float& radius = work_.brushRadius();
        if (key == GLFW_KEY_LEFT_BRACKET) radius = std::max(radius / 1.15f, kSmallestBrush);
        if (key == GLFW_KEY_RIGHT_BRACKET) radius = std::min(radius * 1.15f, kLargestBrush);
        const bool colour = isColour(work_.scene(), work_.brush.layer);  // which has no opposite
        if (key == GLFW_KEY_X && !colour) {
            work_.brush.value = 1 - work_.brush.value;
            if (work_.brush.mode == "erase") work_.brush.mode = "paint";  // which is what has a value
        }
        if (key == GLFW_KEY_F) brush_.startSizing(work_, {event.x, event.y}, event.mods & GLFW_MOD_SHIFT);
    }
    if (!paints && key == GLFW_KEY_F) {
        work_.frameChosen();
        navigation_.moved();
    }
    const bool removes = key == GLFW_KEY_DELETE || key == GLFW_KEY_X;
    if (work_.tool == Tool::branch && removes) work_.prune();
    if (work_.tool == Tool::branch && key == GLFW_KEY_LEFT_BRACKET) work_.pickParent();
    if (work_.tool == Tool::houses && removes) houses_.removeCorner(work_);
    if (work_.tool == Tool::fields && removes) fields_.remove(work_);
    if (work_.tool == Tool::fields && brushesField(work_) &&
        (key == GLFW_KEY_LEFT_BRACKET || key == GLFW_KEY_RIGHT_BRACKET))
        work_.field.radius = std::clamp(fieldReach(work_) * (key == GLFW_KEY_LEFT_BRACKET ? 1 / 1.15f : 1.15f),
                                        kSmallestBrush, mostFieldReach(work_));
    if (work_.tool == Tool::path && removes) path_.removePoint(work_);
    if (work_.tool == Tool::seeds) {
        if (removes) seeds_.remove(work_);
        if (key == GLFW_KEY_A && (event.mods & GLFW_MOD_ALT))
            work_.selected.clear();
        else if (key == GLFW_KEY_A)
            seeds_.selectAll(work_);
        const bool turns = key == GLFW_KEY_R && !(event.mods & GLFW_MOD_SHIFT);
        if (key == GLFW_KEY_G || turns) seeds_.grab(work_, {event.x, event.y}, turns);
        if (key == GLFW_KEY_D && (event.mods & GLFW_MOD_SHIFT)) seeds_.duplicate(work_, {event.x, event.y});
    }
    if (key == GLFW_KEY_R && (event.mods & GLFW_MOD_SHIFT)) work_.renumberSeeds();
    if (key == GLFW_KEY_V && !work_.brush.layer.empty()) work_.showLayer(work_.scene().look.view != ESP_VIEW_LAYER);
    for (size_t i = 0; i < std::size(kViews); ++i)
        if (key == GLFW_KEY_1 + int(i)) work_.perform(SetView{espalier::scene::nameOf(kViews[i]), ""});
}

bool Controls::toolBusy() const {
    return brush_.painting() || brush_.sizing() || seeds_.dragging() || path_.dragging() || houses_.dragging() ||
           fields_.dragging();
}

bool Controls::panelTakes(const PointerEvent& event) {
    const uint32_t button = 1u << event.button;
    // Whatever has begun since by a key: what went down over a panel goes up there.
    if (event.kind == PointerEvent::Kind::release && (panelButtons_ & button)) {
        panelButtons_ &= ~button;
        return true;
    }
    if (navigation_.caught || navigation_.dragging() || toolBusy()) return false;
    if (event.kind != PointerEvent::Kind::press || (!panelButtons_ && !overPanel(event.x, event.y))) return false;
    panelButtons_ |= button;
    return true;
}

void Controls::takePointer(const PointerEvent& event) {
    if (panelTakes(event)) return;
    const bool pressed = event.kind == PointerEvent::Kind::press && event.button == GLFW_MOUSE_BUTTON_LEFT;
    if (!work_.editing && pressed && !navigation_.caught) return catchMouse(true);
    const bool right = event.kind == PointerEvent::Kind::press && event.button == GLFW_MOUSE_BUTTON_RIGHT;
    if (right && !brush_.painting() && !navigation_.dragging() && takeBackDrag()) return;
    // Whoever has begun goes on until his button is let go.
    const bool toolFirst = toolBusy() && !navigation_.dragging();
    if (!toolFirst && navigation_.take(work_, event)) return;
    if (!work_.editing || panelButtons_ > 0) return;
    if (work_.tool == Tool::paint) brush_.take(work_, event);
    if (work_.tool == Tool::seeds) seeds_.take(work_, event);
    if (work_.tool == Tool::path) path_.take(work_, event);
    if (work_.tool == Tool::houses) houses_.take(work_, event);
    if (work_.tool == Tool::fields) fields_.take(work_, event);
    if (work_.tool == Tool::branch && pressed) work_.pickBranch({event.x, event.y});
    if (toolFirst) navigation_.follow({event.x, event.y});
}

bool Controls::panelTakes(const KeyEvent& event) {
    const bool functionKey = event.key >= GLFW_KEY_F1 && event.key <= GLFW_KEY_F12;
    if (event.key == GLFW_KEY_ESCAPE && (cancelDrag(work_) || closeMenus())) return true;
    if (functionKey) return false;
    if (!ImGui::GetCurrentContext()->OpenPopupStack.empty()) return true;
    const bool file = (event.mods & GLFW_MOD_CONTROL) && (event.key == GLFW_KEY_S || event.key == GLFW_KEY_O ||
                                                          event.key == GLFW_KEY_E || event.key == GLFW_KEY_Q);
    const bool numpad = event.key >= GLFW_KEY_KP_0 && event.key <= GLFW_KEY_KP_EQUAL;
    if (work_.editing && grammarFocused() && !ImGui::IsAnyItemActive() && !(event.mods & GLFW_MOD_CONTROL) && !numpad) {
        if (event.key == GLFW_KEY_ESCAPE) leaveGrammar();
        return true;
    }
    // What WantTextInput says is a frame late: nothing is active any more once a dialogue has closed.
    return ImGui::GetIO().WantTextInput && ImGui::IsAnyItemActive() && !file;
}

namespace {

// A key that is held down is meant once, but where it goes on step by step.
bool heeded(const KeyEvent& event) {
    const int key = event.key;
    const bool history = (event.mods & GLFW_MOD_CONTROL) && (key == GLFW_KEY_Z || key == GLFW_KEY_Y);
    const bool numpad = key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_EQUAL;
    return !event.repeated || history || numpad || key == GLFW_KEY_LEFT || key == GLFW_KEY_RIGHT ||
           key == GLFW_KEY_LEFT_BRACKET || key == GLFW_KEY_RIGHT_BRACKET;
}

}  // namespace

void Controls::take(const std::vector<InputEvent>& events, float wheel) {
    for (const InputEvent& event : events) {
        if (const auto* key = std::get_if<KeyEvent>(&event)) {
            if (heeded(*key) && !panelTakes(*key)) takeKey(*key);
        } else {
            takePointer(std::get<PointerEvent>(event));
        }
    }
    brush_.flush(work_);
    noteTools();
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (!overPanel(mouse.x, mouse.y)) navigation_.wheel(work_, wheel, {mouse.x, mouse.y});
}

bool Controls::step(const Input& input, float seconds) {
    if (std::exchange(work_.looked, false)) navigation_.moved();
    return navigation_.step(work_, input, seconds, ImGui::GetIO().WantTextInput);
}

void Controls::hover() {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    work_.hit.reset();
    const bool seen = work_.editing && inScene(mouse.x, mouse.y);
    if (seen && work_.tool == Tool::paint) work_.hit = work_.aim({mouse.x, mouse.y});
    if (seen && work_.tool == Tool::fields && brushesField(work_)) work_.hit = work_.pick({mouse.x, mouse.y});
    const bool points = seen && work_.tool == Tool::branch && !navigation_.dragging();
    work_.pointAtBranch(points ? std::optional(glm::vec2(mouse.x, mouse.y)) : std::nullopt);
}

void Controls::showTool(int mods) {
    hover();
    if (work_.tool == Tool::paint) brush_.draw(work_, mods);
    if (work_.tool == Tool::seeds) seeds_.draw(work_);
    if (work_.tool == Tool::path) path_.draw(work_);
    if (work_.tool == Tool::houses) houses_.draw(work_);
    if (work_.tool == Tool::fields) fields_.draw(work_);
    if (work_.tool == Tool::branch) showWalk(work_);
}

}  // namespace sample
