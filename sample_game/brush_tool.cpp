// Moves of the mouse -> dabs: its way is walked in steps of a few pixels, whatever events it comes in, each is picked,
// and a dab is laid wherever the last one is further away than the spacing, measured in the scene. So the paint doesn't
// depend on how fast the mouse or the frames are.
#define GLFW_INCLUDE_NONE
#include "sample_game/brush_tool.hpp"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "sample_game/brush_ring.hpp"
#include "sample_game/widgets.hpp"
#include "tools/scene/layers.hpp"

namespace sample {
namespace {

using namespace espalier::document;

constexpr float kPixelsBetweenPicks = 3;

// Ctrl turns painting into erasing, and the other way round.
std::string modeOf(const Brush& brush, int mods) {
    if (mods & GLFW_MOD_CONTROL) return brush.mode == "erase" ? "paint" : "erase";
    return mods & GLFW_MOD_SHIFT ? "smooth" : brush.mode;
}

StrokeBegin strokeOf(const Workspace& work, int mods) {
    constexpr float kDegree = 3.14159265f / 180;
    const Brush& b = work.brush;
    StrokeBegin action;
    action.layer = b.layer;
    action.mode = modeOf(b, mods);
    action.radius = work.brushRadius();
    action.strength = b.strength;
    action.hardness = b.hardness;
    action.value = b.value;
    if (isColour(work.scene(), b.layer)) action.colour.assign(std::begin(b.colour), std::end(b.colour));
    if (work.brushLimited()) {
        action.slope = {b.slope[0] * kDegree, b.slope[1] * kDegree};
        action.height = {b.height[0], b.height[1]};
        action.softness = b.softness;
    }
    action.frontOnly = b.frontOnly;
    return action;
}

}  // namespace

std::optional<StrokeBegin> limitingStroke(const Workspace& work) {
    const bool seen = work.editing && work.tool == Tool::paint && work.scene().look.view == ESP_VIEW_LAYER;
    const StrokeBegin stroke = strokeOf(work, 0), open;
    const bool limits = stroke.slope != open.slope || stroke.height != open.height;
    return seen && limits ? std::optional(stroke) : std::nullopt;
}

void BrushTool::begin(Workspace& work, int mods) {
    if (work.brush.layer.empty()) {
        work.error = "No grammar here reads a layer, so there is nothing to paint.";
        return;
    }
    gesture_ = work.newGesture();
    stroke_ = strokeOf(work, mods);
    stateBefore_ = work.document->state();
    painting_ = work.perform(stroke_, gesture_);
    lastDab_.reset();
    dabs_.dabs.clear();
}

void BrushTool::end(Workspace& work) {
    flush(work);
    if (painting_) work.perform(StrokeEnd{}, gesture_);
    if (!std::exchange(painting_, false)) return;
    if (!lastDab_)
        work.message = work.townLayer(work.brush.layer) ? "No roof there" : kNoGround;
    else if (work.error.empty() && work.document->state() == stateBefore_)
        work.message = work.brushLimited() ? "Nothing changed: it is so already, or the brush's limits keep paint off"
                       : !stroke_.colour.empty() || stroke_.mode == "smooth" ? "Nothing changed: it is so already"
                       : stroke_.mode == "erase" ? "Nothing changed: it is as it comes already; X: the opposite"
                                                 : "Nothing changed: it is so already; X: the opposite";
}

void BrushTool::flush(Workspace& work) {
    if (!painting_ || dabs_.dabs.empty()) return;
    work.perform(dabs_, gesture_);
    dabs_.dabs.clear();
}

void BrushTool::cancel(Workspace& work) {
    if (sizing()) (sizing_ == Sizing::radius ? work.brushRadius() : work.brush.strength) = before_;
    endSizing(work);
    end(work);
}

void BrushTool::takeBack(Workspace& work) {
    end(work);
    if (!lastDab_) return;
    work.takeBack(gesture_);  // one that couldn't be ended is taken back already
    work.message = "The stroke is taken back";
}

// Nothing is painted that isn't seen: beneath a panel or outside the window.
void BrushTool::layDab(const Workspace& work, glm::vec2 place) {
    if (!inScene(place.x, place.y)) return;
    const std::optional<EspHit> hit = work.aim(place);
    if (!hit) return;
    const glm::vec3 at = vec(hit->position);
    if (lastDab_ && glm::distance(at, *lastDab_) < work.brush.spacing * work.brushRadius()) return;
    lastDab_ = at;
    dabs_.dabs.push_back({at.x, at.y, at.z, hit->normal[0], hit->normal[1], hit->normal[2], 1});
}

// In whole steps: what is left of the way is walked with the next event.
void BrushTool::moveTo(Workspace& work, glm::vec2 at) {
    const float length = glm::distance(at, last_);
    const int steps = int(std::min(length / kPixelsBetweenPicks, 1e4f));
    const glm::vec2 step = (at - last_) * (kPixelsBetweenPicks / std::max(length, 1e-6f));
    for (int i = 0; i < steps; ++i) layDab(work, last_ += step);
}

bool BrushTool::take(Workspace& work, const PointerEvent& event) {
    using Kind = PointerEvent::Kind;
    const glm::vec2 at{event.x, event.y};
    if (sizing_ != Sizing::none) {
        if (event.kind == Kind::move) {
            const float moved = (at.x - sizingFrom_.x) / work.scale;
            if (sizing_ == Sizing::radius)
                work.brushRadius() = std::clamp(before_ * std::exp(moved / 150), kSmallestBrush, kLargestBrush);
            else
                work.brush.strength = std::clamp(before_ + moved / 300, .01f, 1.f);
        } else if (event.kind == Kind::press) {
            endSizing(work);
        }
        return true;
    }
    if (event.kind == Kind::press && event.button == GLFW_MOUSE_BUTTON_LEFT) {
        begin(work, event.mods);
        last_ = at;
        if (painting_) layDab(work, at);
        return true;
    }
    if (!painting_) return false;
    if (event.kind == Kind::move) moveTo(work, at);
    if (event.kind == Kind::release && event.button == GLFW_MOUSE_BUTTON_LEFT) end(work);
    return true;
}

void BrushTool::startSizing(Workspace& work, glm::vec2 at, bool strength) {
    if (painting_ || sizing()) return;
    sizing_ = strength ? Sizing::strength : Sizing::radius;
    before_ = strength ? work.brush.strength : work.brushRadius();
    sizingFrom_ = at;
    sizingAt_ = work.hit;
    work.underWay = strength ? "Move the mouse: strength   click: keep it   Esc: as it was"
                             : "Move the mouse: radius   click: keep it   Esc: as it was";
}

void BrushTool::endSizing(Workspace& work) {
    if (sizing()) work.underWay = nullptr;
    sizing_ = Sizing::none;
}

void BrushTool::drawCircle(const Workspace& work, int mods, const EspHit& hit) const {
    const StrokeBegin stroke = painting_ ? stroke_ : strokeOf(work, mods);
    const ImU32 colour = stroke.mode == "erase"    ? IM_COL32(255, 120, 90, 255)
                         : stroke.mode == "smooth" ? kSmoothRing
                                                   : IM_COL32(160, 240, 120, 255);
    drawBrushRing(work, hit, {stroke.radius, stroke.hardness, work.townLayer(stroke.layer)}, colour);
}

void BrushTool::draw(const Workspace& work, int mods) const {
    const bool sizing = sizing_ != Sizing::none;
    const auto& hit = sizing ? sizingAt_ : work.hit;
    if (hit) drawCircle(work, mods, *hit);
    const std::optional<glm::vec2> middle = hit ? work.place(vec(hit->position)) : std::nullopt;
    char text[64] = "";
    if (sizing_ == Sizing::radius) std::snprintf(text, sizeof text, "radius %.2f m", work.brushRadius());
    if (sizing_ == Sizing::strength) std::snprintf(text, sizeof text, "strength %.2f", work.brush.strength);
    if (!sizing && !painting_ && hit && work.brushLimited()) {
        const glm::vec3 normal = glm::normalize(vec(hit->normal));
        std::snprintf(text, sizeof text, "slope %.0f\u00b0, height %.1f m",
                      std::acos(std::clamp(normal.y, -1.f, 1.f)) * 180 / 3.14159265f, hit->position[1]);
    }
    if (text[0] && (sizing || middle)) noteAt(work, middle.value_or(sizingFrom_), text);
}

}  // namespace sample
