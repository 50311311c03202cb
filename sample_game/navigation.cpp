#define GLFW_INCLUDE_NONE
#include "sample_game/navigation.hpp"

#include <GLFW/glfw3.h>

namespace sample {

bool Navigation::take(Workspace& work, const PointerEvent& event) {
    const glm::vec2 at{event.x, event.y};
    const glm::vec2 moved = known_ ? (at - last_) / work.window.y : glm::vec2(0);
    last_ = at;
    known_ = true;
    using Kind = PointerEvent::Kind;
    if (event.kind == Kind::press && drag_ == Drag::none && !caught) {
        const bool left = event.button == GLFW_MOUSE_BUTTON_LEFT;
        const bool turns = event.button == GLFW_MOUSE_BUTTON_MIDDLE || (left && (event.mods & GLFW_MOD_ALT)) ||
                           (left && (work.tool == Tool::look || !work.editing));
        if (turns)
            drag_ = event.mods & GLFW_MOD_SHIFT ? Drag::pan : work.editing ? Drag::orbit : Drag::look;
        else if (event.button == GLFW_MOUSE_BUTTON_RIGHT)
            drag_ = Drag::look;
        button_ = event.button;
        return drag_ != Drag::none;
    }
    if (event.kind == Kind::release) {
        if (drag_ == Drag::none || event.button != button_) return false;
        drag_ = Drag::none;
        return true;
    }
    if (event.kind != Kind::move || (drag_ == Drag::none && !caught)) return false;
    if (caught || drag_ == Drag::look)
        work.camera.look(moved.x, moved.y);
    else if (drag_ == Drag::pan)
        work.camera.pan(moved.x, moved.y);
    else
        work.camera.orbit(moved.x, moved.y);
    moved_ = true;
    return true;
}

void Navigation::wheel(Workspace& work, float steps) {
    if (steps == 0) return;
    work.camera.zoom(steps);
    moved_ = true;
}

bool Navigation::step(Workspace& work, const Input& input, float seconds, bool typing) {
    const auto axis = [&](int more, int less) { return float(input.down(more)) - float(input.down(less)); };
    // In the editor letters are tools' keys; they fly only while the right button looks around.
    const bool keys = !typing && !(input.mods() & GLFW_MOD_CONTROL) && (!work.editing || drag_ == Drag::look);
    const bool fast = input.mods() & GLFW_MOD_SHIFT;
    glm::vec3 steps{0};
    if (keys) steps = {axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S)};
    const glm::vec3 before = work.camera.eye();
    if (work.editing || flying_) {
        if (steps != glm::vec3(0)) work.camera.fly(steps, seconds, fast);
    } else if (steps != glm::vec3(0) || jump_ || work.camera.falling()) {
        // Small steps, so that a slow frame doesn't walk through a wall.
        constexpr float kStep = .05f;
        const auto meets = [&](glm::vec3 from, glm::vec3 along, float reach, EspHit& hit) {
            return work.meets({from, along}, reach, hit);
        };
        for (float left = seconds; left > 0; left -= kStep, jump_ = false)
            work.camera.walk(meets, {steps.x, steps.z}, std::min(left, kStep), fast, jump_);
    }
    jump_ = false;
    const bool moved = moved_ || before != work.camera.eye();
    moved_ = false;
    return moved;
}

}  // namespace sample
