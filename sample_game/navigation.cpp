#define GLFW_INCLUDE_NONE
#include "sample_game/navigation.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace sample {

bool Navigation::take(Workspace& work, const PointerEvent& event) {
    const glm::vec2 at{event.x, event.y};
    const glm::vec2 moved = known_ ? (at - last_) / work.viewSize().y : glm::vec2(0);
    last_ = at;
    known_ = true;
    using Kind = PointerEvent::Kind;
    if (event.kind == Kind::press && drag_ != Drag::none) return true;
    if (event.kind == Kind::press && !caught) {
        const bool left = event.button == GLFW_MOUSE_BUTTON_LEFT;
        const bool turns = event.button == GLFW_MOUSE_BUTTON_MIDDLE || (left && (event.mods & GLFW_MOD_ALT)) ||
                           (left && (work.tool == Tool::look || !work.editing));
        if (turns)
            drag_ = event.mods & GLFW_MOD_SHIFT ? Drag::pan : work.editing ? Drag::orbit : Drag::look;
        else if (event.button == GLFW_MOUSE_BUTTON_RIGHT)
            drag_ = Drag::look;
        if (drag_ == Drag::orbit) aim(work);
        if (drag_ == Drag::pan) aimAt(work, at);
        button_ = event.button;
        return drag_ != Drag::none;
    }
    if (event.kind == Kind::release) {
        const bool dragged = drag_ != Drag::none;
        if (event.button == button_) drag_ = Drag::none;
        return dragged;
    }
    if (event.kind != Kind::move || (drag_ == Drag::none && !caught)) return false;
    if (caught || drag_ == Drag::look)
        work.camera.look(moved.x, moved.y);
    else if (drag_ == Drag::pan)
        work.camera.pan(moved.x, moved.y);
    else
        work.camera.orbit(moved.x, moved.y);
    if (caught || drag_ != Drag::orbit) strayed_ = true;
    wheeled_.reset();
    moved_ = true;
    return true;
}

namespace {

bool within(const Workspace& work, glm::vec2 mouse) {
    return glm::clamp(mouse, glm::vec2(0), work.window) == mouse;
}

// How far ahead what lies there stands; nothing: the sky does, or it is so far away that nobody means it.
std::optional<float> depthOf(const Workspace& work, const Ray& ray) {
    EspHit hit;
    const std::optional<EspTownInfo> town = work.town();
    const float most = 2 * std::max({work.reach(), town ? town->layerSide : 0, work.camera.distance()});
    float distance = work.meets(ray, most, hit) ? hit.distance : most;
    EspPlantHit plant;  // leaves are seen where no ground is
    if (espPickPlant(work.context.get(), &ray.origin.x, &ray.direction.x, &plant) == ESP_OK)
        distance = std::min(distance, plant.distance);
    if (distance >= most) return {};
    return distance * glm::dot(ray.direction, work.camera.ahead());
}

}  // namespace

// After looking elsewhere or flying the distance is of what was there before. Nothing there: as far as usual.
void Navigation::aim(Workspace& work) {
    wheeled_.reset();
    if (!std::exchange(strayed_, false)) return;
    const auto middle = depthOf(work, {work.camera.eye(), work.camera.ahead()});
    work.camera.focus(middle.value_or(std::max(work.camera.distance(), .1f * work.reach())));
}

bool Navigation::aimAt(Workspace& work, glm::vec2 mouse) {
    // ImGui tells nothing of the mouse outside the window, or while the game has caught it.
    const auto under = within(work, mouse) ? depthOf(work, work.rayThrough(mouse)) : std::nullopt;
    const auto depth = under ? under : depthOf(work, {work.camera.eye(), work.camera.ahead()});
    if (depth)
        work.camera.focus(*depth);
    else
        aim(work);
    strayed_ = true;
    return under.has_value();
}

void Navigation::wheel(Workspace& work, float steps, glm::vec2 mouse) {
    if (steps == 0) return;
    if (work.editing && drag_ == Drag::look) {
        char text[48];
        const float speed = work.camera.hurry(steps);
        std::snprintf(text, sizeof text, "Flying at %.*f m/s", speed < 1 ? 2 : speed < 10 ? 1 : 0, speed);
        work.message = text;
        return;
    }
    const glm::vec3 way = within(work, mouse) ? work.rayThrough(mouse).direction : work.camera.ahead();
    // There and back again ends where it began: what is aimed at at first is, but for what comes near in the open.
    const bool anew = wheeled_ != mouse;
    if (anew || (open_ && steps > 0)) {
        open_ = !aimAt(work, mouse);
        metAt_ = work.camera.distance();
    }
    if (anew) stride_ = open_ ? metAt_ : 0;
    if (open_)
        work.camera.advance(steps, way, stride_);
    else
        approach(work, steps, way);
    wheeled_ = mouse;
    moved_ = true;
}

// Nearer to what is aimed at, or away from it. Where that came near in the open, the way back goes on by the steps that
// led there.
void Navigation::approach(Workspace& work, float steps, glm::vec3 way) {
    const float back = -work.camera.stepsFrom(metAt_), beyond = std::min(0.f, steps - back);
    open_ = stride_ > 0 && beyond < 0;
    work.camera.zoom(open_ ? back : steps, way);
    if (open_) work.camera.advance(beyond, way, stride_);
}

void Navigation::go(Workspace& work, glm::vec3 steps, float seconds, bool fast) {
    if (work.editing || flying_) {
        if (steps != glm::vec3(0)) work.camera.fly(steps, seconds, fast);
    } else if (steps != glm::vec3(0) || jump_ || work.camera.inAir()) {
        // Small steps, so that a slow frame doesn't walk through a wall.
        constexpr float kStep = .05f;
        const auto meets = [&](glm::vec3 from, glm::vec3 along, float reach, EspHit& hit) {
            return work.meets({from, along}, reach, hit);
        };
        if (work.camera.eye() != walked_) work.camera.stand(meets);  // the editor or a flight has led here
        for (float left = seconds; left > 0; left -= kStep, jump_ = false)
            work.camera.walk(meets, {steps.x, steps.z}, std::min(left, kStep), fast, jump_);
        walked_ = work.camera.eye();
    }
    jump_ = false;
}

bool Navigation::step(Workspace& work, const Input& input, float seconds, bool typing) {
    const auto axis = [&](int more, int less) { return float(input.down(more)) - float(input.down(less)); };
    // In the editor letters are tools' keys; they fly only while the right button looks around.
    const bool keys = !typing && !(input.mods() & GLFW_MOD_CONTROL) && (!work.editing || drag_ == Drag::look);
    glm::vec3 steps{0};
    if (keys) steps = {axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S)};
    const glm::vec3 before = work.camera.eye();
    go(work, steps, seconds, input.mods() & GLFW_MOD_SHIFT);
    if (before != work.camera.eye()) strayed_ = true, wheeled_.reset();
    const bool moved = moved_ || before != work.camera.eye();
    moved_ = false;
    return moved;
}

}  // namespace sample
