// Places in the window to houses, edges and corners of a town; outlines are handled at the height of their eaves.
#include "sample_game/house_tool.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sample_game/segment.hpp"
#include "sample_game/widgets.hpp"

namespace sample {
namespace {

using namespace espalier::document;
using espalier::scene::House;
using espalier::scene::houseNow;
using espalier::scene::Ring;
using espalier::scene::ringOf;

constexpr float kCornerReach = 11, kEdgeReach = 8, kMergeReach = 6, kTremble = 4;  // pixels at 96 dpi
constexpr float kDepth = 4;  // metres that a pixel is at the most in depth, by what it is across
constexpr ImU32 kOutline = IM_COL32(255, 255, 255, 230), kChosen = IM_COL32(255, 170, 50, 255),
                kGable = IM_COL32(250, 220, 90, 255), kEave = IM_COL32(110, 210, 255, 255),
                kShade = IM_COL32(0, 0, 0, 140);
constexpr int kDashes = 16;  // of an edge

ImU32 dimmed(ImU32 colour) {
    return (colour & ~IM_COL32_A_MASK) | 120u << IM_COL32_A_SHIFT;
}

// The corners of the house at its eaves.
std::vector<glm::vec3> eavesOf(const Workspace& work, const House& house) {
    std::vector<glm::vec3> eaves;
    EspHouseInfo info;
    if (espHouseInfo(work.context.get(), house.index, &info) != ESP_OK) return eaves;
    for (const auto& corner : house.corners) eaves.emplace_back(corner[0], info.eaveHeight, corner[1]);
    return eaves;
}

// Those in the window; none for corners behind the camera.
using Outline = std::vector<std::optional<glm::vec2>>;
Outline outline(const Workspace& work, const House& house) {
    Outline points;
    for (const glm::vec3 corner : eavesOf(work, house)) points.push_back(work.place(corner));
    return points;
}

// Of an edge, where it is decided whether a dash of it is hidden.
glm::vec3 dashOf(glm::vec3 from, glm::vec3 to, float dash) {
    return glm::mix(from, to, dash / kDashes);
}

// What is hidden, by the flags of its dashes, has gaps and is fainter.
void drawEdge(const Workspace& work, glm::vec3 from, glm::vec3 to, ImU32 colour,
              std::vector<bool>::const_iterator hidden) {
    const float s = work.scale;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (int i = 0; i < kDashes; ++i) {
        const bool faint = hidden[i];
        const auto a = work.place(dashOf(from, to, float(i)));
        const auto b = work.place(dashOf(from, to, float(i) + (faint ? .5f : 1)));
        if (!a || !b) continue;
        if (!faint) list.AddLine({a->x, a->y}, {b->x, b->y}, kShade, 4 * s);
        list.AddLine({a->x, a->y}, {b->x, b->y}, faint ? dimmed(colour) : colour, 2 * s);
    }
}

// Where along an edge, 0 to 1, the mouse is on it; none: beside it. An edge that begins or ends behind the camera is as
// long as its dashes that don't.
std::optional<float> shareAt(const Workspace& work, glm::vec3 from, glm::vec3 to, glm::vec2 at) {
    std::optional<float> best;
    float nearest = kEdgeReach * work.scale;
    for (int i = 0; i < kDashes; ++i) {
        const auto a = work.place(dashOf(from, to, float(i))), b = work.place(dashOf(from, to, float(i) + 1));
        if (!a || !b) continue;
        const auto [share, distance] = nearestOn(*a, *b, at);
        if (distance > nearest) continue;
        nearest = distance;
        best = (float(i) + share) / kDashes;
    }
    return best;
}

// What one edge has of its own another one has, too.
void copyEdge(House& house, uint32_t from, uint32_t to) {
    const auto own = std::ranges::find(house.edges, from, &House::Edge::edge);
    if (own == house.edges.end()) return;
    House::Edge copy = *own;
    copy.edge = to;
    house.edges.push_back(copy);
}

// Edges from `first` on have another number now.
void renumber(House& house, uint32_t first, int by) {
    for (auto& edge : house.edges)
        if (edge.edge >= first) edge.edge = uint32_t(int(edge.edge) + by);
}

// The plane in which the corner is dragged, by its normal: that of the eaves. Where the eye sees it nearly from its
// edge a pixel would be many metres: it is tilted there, so that one is no more than kDepth times what it is across.
glm::vec3 dragPlane(glm::vec3 eye, glm::vec3 corner) {
    const glm::vec3 way = glm::normalize(corner - eye);
    const float tilt = std::max(0.f, std::asin(1 / kDepth) - std::asin(std::min(std::abs(way.y), 1.f)));
    const glm::vec3 level = glm::vec3(way.x, 0, way.z) / std::max(glm::length(glm::vec2(way.x, way.z)), 1e-6f);
    return std::cos(tilt) * glm::vec3(0, 1, 0) + std::copysign(std::sin(tilt), way.y) * level;
}

}  // namespace

void HouseTool::press(Workspace& work, glm::vec2 at, bool insert) {
    if (work.house) {
        House house = houseNow(work.context.get(), *work.house);
        const Outline points = outline(work, house);
        for (size_t i = 0; i < points.size() && !insert; ++i)
            if (points[i] && glm::distance(*points[i], at) < kCornerReach * work.scale) {
                work.houseEdge = uint32_t(i);
                changed_ = false;
                gesture_ = work.newGesture();
                beginDrag(work, std::move(house), i, at);
                return;
            }
        const std::vector<glm::vec3> eaves = eavesOf(work, house);
        for (size_t i = 0; i < points.size(); ++i) {
            const Ring ring = ringOf(house, i);
            const size_t next = ring.after(i);
            const std::optional<float> share = shareAt(work, eaves[i], eaves[next], at);
            if (!share) continue;
            work.houseEdge = uint32_t(i);
            if (!insert) return;
            const auto &a = house.corners[i], &b = house.corners[next];
            house.corners.insert(house.corners.begin() + std::ptrdiff_t(i) + 1,
                                 {a[0] + (b[0] - a[0]) * *share, a[1] + (b[1] - a[1]) * *share});
            house.rings.at(ring.number) += 1;
            renumber(house, uint32_t(i) + 1, 1);
            copyEdge(house, uint32_t(i), uint32_t(i) + 1);
            gesture_ = work.newGesture();
            changed_ = work.perform(SetHouse{house}, gesture_);
            if (changed_) beginDrag(work, std::move(house), i + 1, at);
            return;
        }
    }
    work.house = work.pickHouse(at);
    work.houseEdge.reset();
}

void HouseTool::beginDrag(Workspace& work, House house, size_t corner, glm::vec2 at) {
    const Outline points = outline(work, house);
    corner_ = corner;
    dragged_ = std::move(house);
    from_ = at;
    refused_ = false;
    grip_ = corner < points.size() ? points[corner].value_or(at) - at : glm::vec2(0);
    if (const std::vector<glm::vec3> eaves = eavesOf(work, dragged_); corner < eaves.size()) hold_ = eaves[corner];
    moved_ = false;
}

void HouseTool::dragTo(Workspace& work, glm::vec2 mouse) {
    moved_ = moved_ || glm::distance(mouse, from_) > kTremble * work.scale;
    if (!moved_) return;
    const glm::vec2 at = mouse + grip_;  // the corner doesn't jump to the mouse
    EspHouseInfo info;
    if (espHouseInfo(work.context.get(), dragged_.index, &info) != ESP_OK) return;
    const Ray ray = work.rayThrough(at);
    const glm::vec3 normal = dragPlane(ray.origin, hold_);
    const float along = glm::dot(hold_ - ray.origin, normal) / glm::dot(ray.direction, normal);
    // Towards the horizon a pixel is many metres: nobody means that.
    auto& corner = dragged_.corners[*corner_];
    const float now = glm::distance(ray.origin, {corner[0], info.eaveHeight, corner[1]});
    if (!(along > 0 && along < 2 * now + 2)) return;
    const glm::vec3 to = ray.origin + along * ray.direction;
    corner = {to.x, to.z};
    // So near to the next corner or the one before, seen in the window and on the plan, it is meant to be one with it.
    const Ring ring = ringOf(dragged_, *corner_);
    const float near = kMergeReach * work.scale, pixels = work.camera.pixelsPerMetre(now, work.viewSize().y);
    const auto shown = work.place({to.x, info.eaveHeight, to.z});
    for (size_t other : {ring.after(*corner_), ring.before(*corner_)}) {
        const auto& next = dragged_.corners[other];
        const auto place = work.place({next[0], info.eaveHeight, next[1]});
        const float away = pixels * glm::distance(glm::vec2(next[0], next[1]), glm::vec2(to.x, to.z));
        if (place && shown && glm::distance(*place, *shown) < near && away < kDepth * near) corner = next;
    }
    refused_ = !work.perform(SetHouse{dragged_}, gesture_);
    if (refused_) return;
    changed_ = true;
    const auto& corners = houseNow(work.context.get(), dragged_.index).corners;
    const auto away = [&](const auto& c) { return glm::distance(glm::vec2(c[0], c[1]), glm::vec2(to.x, to.z)); };
    work.houseEdge = uint32_t(std::ranges::min_element(corners, {}, away) - corners.begin());
}

bool HouseTool::take(Workspace& work, const PointerEvent& event) {
    using Kind = PointerEvent::Kind;
    const glm::vec2 at(event.x, event.y);
    if (corner_ && event.kind == Kind::move) {
        dragTo(work, at);
        return true;
    }
    if (event.kind == Kind::move || event.button != GLFW_MOUSE_BUTTON_LEFT) return corner_.has_value();
    if (event.kind == Kind::press) {
        press(work, at, event.mods & GLFW_MOD_CONTROL);
    } else if (refused_) {  // let go where no roof can be: not where the drag happened to get to
        const std::string why = work.error;
        cancel(work);
        work.error = why;
    } else {
        corner_.reset();
    }
    return true;
}

void HouseTool::cancel(Workspace& work) {
    if (corner_ && changed_) work.takeBack(gesture_);
    corner_.reset();
}

void HouseTool::finish(Workspace& work) {
    if (refused_) return cancel(work);
    corner_.reset();
}

void HouseTool::removeCorner(Workspace& work) {
    if (!work.house || !work.houseEdge) {
        work.message = work.house ? "Click an edge of the outline: Del takes away the corner where it begins"
                                  : "Click a house, then an edge: Del takes away the corner where it begins";
        return;
    }
    House house = houseNow(work.context.get(), *work.house);
    const uint32_t corner = *work.houseEdge;
    if (corner >= house.corners.size()) return;
    const Ring ring = ringOf(house, corner);
    if (ring.size() < 4 && ring.number == 0) {
        work.message = "An outline has at least three corners";
        return;
    }
    // A courtyard of three goes as a whole.
    const size_t first = ring.size() < 4 ? ring.first : corner, count = ring.size() < 4 ? ring.size() : 1;
    const auto from = house.corners.begin() + std::ptrdiff_t(first);
    house.corners.erase(from, from + std::ptrdiff_t(count));
    std::erase_if(house.edges, [&](const House::Edge& e) { return e.edge >= first && e.edge < first + count; });
    renumber(house, uint32_t(first + count), -int(count));
    if ((house.rings.at(ring.number) -= uint32_t(count)) == 0)
        house.rings.erase(house.rings.begin() + std::ptrdiff_t(ring.number));
    if (work.perform(SetHouse{house})) work.houseEdge.reset();
}

namespace {

void noteLength(const Workspace& work, const House& house, const Outline& points, size_t edge) {
    const size_t next = ringOf(house, edge).after(edge);
    if (!points[edge] || !points[next]) return;
    const auto &a = house.corners[edge], &b = house.corners[next];
    char text[32];
    std::snprintf(text, sizeof text, "%.2f m", std::hypot(b[0] - a[0], b[1] - a[1]));
    noteAt(work, (*points[edge] + *points[next]) / 2.f, text);
}

}  // namespace

void HouseTool::draw(const Workspace& work) const {
    if (!work.house) return;
    const House house = houseNow(work.context.get(), *work.house);
    const Outline points = outline(work, house);
    const std::vector<glm::vec3> eaves = eavesOf(work, house);
    std::vector<glm::vec3> places = eaves;  // then of each edge's dashes
    for (size_t i = 0; i < eaves.size(); ++i)
        for (int dash = 0; dash < kDashes; ++dash)
            places.push_back(dashOf(eaves[i], eaves[ringOf(house, i).after(i)], float(dash) + .5f));
    const std::vector<bool> hidden = work.hidden(places);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float s = work.scale;
    for (size_t i = 0; i < points.size(); ++i) {
        const auto own = std::find_if(house.edges.begin(), house.edges.end(),
                                      [&](const House::Edge& edge) { return edge.edge == i; });
        ImU32 colour = kOutline;
        if (own != house.edges.end() && own->end == "gable") colour = kGable;
        if (own != house.edges.end() && own->end == "eave") colour = kEave;
        if (work.houseEdge == uint32_t(i)) colour = kChosen;
        drawEdge(work, eaves[i], eaves[ringOf(house, i).after(i)], colour,
                 hidden.begin() + std::ptrdiff_t(eaves.size() + i * kDashes));
    }
    for (size_t i = 0; i < points.size(); ++i) {
        if (!points[i]) continue;
        const ImU32 colour = corner_ && work.houseEdge == i ? kChosen : kOutline;
        const bool faint = hidden[i];
        list.AddCircleFilled({points[i]->x, points[i]->y}, 6 * s, faint ? dimmed(kShade) : kShade);
        list.AddCircleFilled({points[i]->x, points[i]->y}, 4.5f * s, faint ? dimmed(colour) : colour);
    }
    if (!work.houseEdge || *work.houseEdge >= points.size()) return;
    noteLength(work, house, points, *work.houseEdge);
    if (corner_) noteLength(work, house, points, ringOf(house, *work.houseEdge).before(*work.houseEdge));
}

}  // namespace sample
