// Drags over surfaces -> lines that ivy follows, and changes of these.
#define GLFW_INCLUDE_NONE
#include "sample_game/path_tool.hpp"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "sample_game/gui_events.hpp"
#include "sample_game/segment.hpp"

namespace sample {
namespace {

using espalier::scene::Seed;

constexpr float kPixelsBetweenPicks = 3;
constexpr float kPointReach = 9, kLineReach = 6;  // pixels of a display of 96 dpi

glm::vec3 pointPlace(const LinePoint& point) {
    return {point[0], point[1], point[2]};
}

// The only chosen seed, if its plant follows a line.
const Seed* chosenLine(const Workspace& work) {
    const Seed* seed = work.selected.size() == 1 ? work.document->seed(*work.selected.begin()) : nullptr;
    return seed && !seed->line.empty() && !seed->hidden ? seed : nullptr;
}

std::optional<size_t> pointAt(const Workspace& work, const std::vector<LinePoint>& line, glm::vec2 at) {
    std::optional<size_t> nearest;
    float reach = kPointReach * work.scale;
    for (size_t i = 0; i < line.size(); ++i) {
        const auto seen = work.place(pointPlace(line[i]));
        if (!seen || glm::distance(*seen, at) > reach || !work.visible(pointPlace(line[i]))) continue;
        reach = glm::distance(*seen, at);
        nearest = i;
    }
    return nearest;
}

// The part of the line that is there, by the point that it begins at.
std::optional<size_t> partAt(const Workspace& work, const std::vector<LinePoint>& line, glm::vec2 at) {
    for (size_t i = 0; i + 1 < line.size(); ++i) {
        const auto a = work.place(pointPlace(line[i])), b = work.place(pointPlace(line[i + 1]));
        if (a && b && nearestOn(*a, *b, at).second <= kLineReach * work.scale) return i;
    }
    return std::nullopt;
}

}  // namespace

void PathTool::cancel() {
    line_.clear();
    points_.clear();
    held_ = false;
}

// In whole steps: what is left of the way is walked with the next event. What isn't seen, beneath a panel or behind a
// house, is passed over.
void PathTool::moveTo(const Workspace& work, glm::vec2 at) {
    const float length = glm::distance(at, last_);
    const int steps = int(std::min(length / kPixelsBetweenPicks, 1e4f));
    const glm::vec2 step = (at - last_) * (kPixelsBetweenPicks / std::max(length, 1e-6f));
    for (int i = 0; i < steps; ++i) {
        last_ += step;
        if (!inScene(last_.x, last_.y)) continue;
        if (const auto hit = work.pickGround(last_)) line_.push_back(*hit);
    }
}

// A point of the chosen line, or one more on it; else another line that is there. False: there is none.
bool PathTool::takeUp(Workspace& work, glm::vec2 at) {
    if (const Seed* chosen = chosenLine(work)) {
        const auto hit = work.pickGround(at);
        point_ = pointAt(work, chosen->line, at);
        const auto part = point_ || !hit ? std::nullopt : partAt(work, chosen->line, at);
        points_ = chosen->line;
        if (part) {
            point_ = *part + 1;
            points_.insert(
                points_.begin() + std::ptrdiff_t(*point_),
                {hit->position[0], hit->position[1], hit->position[2], hit->normal[0], hit->normal[1], hit->normal[2]});
        }
        of_ = chosen->key;
        held_ = point_.has_value();
        moved_ = part.has_value();
        if (held_) return true;
    }
    for (const Seed& seed : work.scene().seeds) {
        if (seed.hidden || (!pointAt(work, seed.line, at) && !partAt(work, seed.line, at))) continue;
        work.selected = {seed.key};
        point_.reset();
        work.say("The line is chosen: drag its points, or the line between them");
        return true;
    }
    return false;
}

void PathTool::follow(const Workspace& work, glm::vec2 at) {
    const auto hit = inScene(at.x, at.y) ? work.pickGround(at) : std::nullopt;
    if (!hit || !point_ || *point_ >= points_.size()) return;
    if (!moved_ && glm::distance(at, last_) < kPixelsBetweenPicks) return;  // a click
    moved_ = true;
    points_[*point_] = {hit->position[0], hit->position[1], hit->position[2],
                        hit->normal[0],   hit->normal[1],   hit->normal[2]};
}

void PathTool::letGo(Workspace& work) {
    if (moved_) relay(work, of_, points_);
    held_ = false;
    points_.clear();
}

bool PathTool::take(Workspace& work, const PointerEvent& event) {
    using Kind = PointerEvent::Kind;
    const glm::vec2 at{event.x, event.y};
    const bool left = event.button == GLFW_MOUSE_BUTTON_LEFT;
    if (event.kind == Kind::press && left && !dragging()) {
        last_ = at;
        if (!(event.mods & GLFW_MOD_SHIFT) && takeUp(work, at)) return true;
        point_.reset();
        if (const auto hit = work.pickGround(at))
            line_ = {*hit};
        else
            work.say(kNoGround);
        return true;
    }
    if (!dragging()) return false;
    if (event.kind == Kind::move) held_ ? follow(work, at) : moveTo(work, at);
    if (event.kind != Kind::release || !left) return true;
    if (held_) {
        letGo(work);
    } else {
        moveTo(work, at);
        growAlong(work, line_);
        line_.clear();
    }
    return true;
}

void PathTool::removePoint(Workspace& work) {
    const Seed* chosen = chosenLine(work);
    if (!chosen || dragging()) return;
    std::vector<LinePoint> points = chosen->line;
    if (point_ && *point_ < points.size() && points.size() > 2)
        points.erase(points.begin() + std::ptrdiff_t(*point_));
    else
        points.clear();
    point_.reset();
    relay(work, chosen->key, points);
}

void PathTool::draw(const Workspace& work) const {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float s = work.scale;
    const auto polyline = [&](const std::vector<glm::vec3>& points, ImU32 colour, float width) {
        std::vector<ImVec2> places;
        for (const glm::vec3& point : points)
            if (const auto at = work.place(point)) places.push_back({at->x, at->y});
        list.AddPolyline(places.data(), int(places.size()), IM_COL32(0, 0, 0, 160), 0, 2 * width * s);
        list.AddPolyline(places.data(), int(places.size()), colour, 0, width * s);
    };
    const auto pointsOf = [](const auto& from, auto&& place) {
        std::vector<glm::vec3> points;
        for (const auto& point : from) points.push_back(place(point));
        return points;
    };
    const Seed* chosen = chosenLine(work);
    for (const Seed& seed : work.scene().seeds)
        if (&seed != chosen && !seed.hidden && !seed.line.empty())
            polyline(pointsOf(seed.line, pointPlace), IM_COL32(160, 240, 120, 110), 1.5f);
    if (chosen) {
        const std::vector<LinePoint>& line = held_ ? points_ : chosen->line;
        polyline(pointsOf(line, pointPlace), IM_COL32(255, 190, 60, 255), 2);
        for (size_t i = 0; i < line.size(); ++i) {
            const auto at = work.place(pointPlace(line[i]));
            if (!at) continue;
            list.AddCircleFilled({at->x, at->y}, 6.5f * s, IM_COL32(0, 0, 0, 160));
            list.AddCircleFilled({at->x, at->y}, 4.5f * s,
                                 point_ == i ? IM_COL32(255, 255, 255, 255) : IM_COL32(255, 190, 60, 255));
        }
    }
    polyline(pointsOf(line_, [](const EspHit& hit) { return vec(hit.position); }), IM_COL32(160, 240, 120, 255), 3);
}

}  // namespace sample
