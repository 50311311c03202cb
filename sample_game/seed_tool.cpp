// Clicks and drags -> seeds that come, move and go. Markers are drawn over the scene.
#define GLFW_INCLUDE_NONE
#include "sample_game/seed_tool.hpp"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace sample {
namespace {

using namespace espalier::document;
using espalier::scene::Seed;

constexpr float kReach = 11;        // pixels at 96 dpi around a seed's marker
constexpr float kArrow = .3f;       // metres
constexpr float kAlongView = .97f;  // cosine between an arrow and the view

// The ground there, unless that is beneath a panel or outside the window.
std::optional<EspHit> seen(const Workspace& work, glm::vec2 at) {
    return inScene(at.x, at.y) ? work.pickGround(at) : std::nullopt;
}

// How many are chosen and there: undo may have taken some away, which redo brings back as chosen.
ptrdiff_t chosenCount(const Workspace& work) {
    return std::ranges::count_if(work.selected, [&](uint32_t key) { return work.document->seed(key) != nullptr; });
}

}  // namespace

SeedRecord SeedTool::newSeed(Workspace& work, const EspHit& hit) const {
    return {work.document->freshKey(), work.plantGrammar, array(vec(hit.position)), {0, 1, 0}, std::random_device()()};
}

void SeedTool::plant(Workspace& work, const SeedRecord& seed, uint32_t gesture) {
    if (!work.perform(AddSeeds{{seed}, {uint32_t(work.scene().seeds.size())}}, gesture)) return;
    work.selected.insert(seed.key);
    changed_ = true;
}

uint32_t SeedTool::seedAt(const Workspace& work, glm::vec2 at) const {
    uint32_t best = 0;
    float nearest = kReach * work.scale;
    for (const Seed& seed : work.scene().seeds) {
        const auto place = work.place(vec(seed.position));
        if (seed.hidden || !place || glm::distance(*place, at) > nearest || !work.visible(vec(seed.position))) continue;
        nearest = glm::distance(*place, at);
        best = seed.key;
    }
    return best;
}

bool SeedTool::arrowAt(const Workspace& work, glm::vec2 at) const {
    return std::ranges::any_of(work.scene().seeds, [&](const Seed& seed) {
        if (!work.selected.count(seed.key) || glm::length(vec(seed.direction)) == 0) return false;
        const auto tip = work.place(vec(seed.position) + kArrow * glm::normalize(vec(seed.direction)));
        return tip && glm::distance(*tip, at) < kReach * work.scale;
    });
}

template <class Change>
void SeedTool::changeChosen(Workspace& work, Change&& change) {
    ChangeSeeds action;
    bool frozen = false;
    for (uint32_t key : work.selected)
        if (const Seed* seed = work.document->seed(key); seed && !seed->frozen) {
            action.seeds.push_back(work.document->recordOf(*seed));
            change(action.seeds.back());
        } else {
            frozen = frozen || seed;
        }
    if (!action.seeds.empty() && !work.perform(action, gesture_)) return;
    changed_ = changed_ || !action.seeds.empty();
    if (frozen) work.say("A frozen plant stays where it is: thaw it to move or turn it");
}

void SeedTool::press(Workspace& work, const PointerEvent& event) {
    const glm::vec2 at{event.x, event.y};
    from_ = last_ = at;
    grip_ = {};
    moved_ = changed_ = false;
    gesture_ = work.newGesture();
    if ((event.mods & GLFW_MOD_CONTROL) && !(event.mods & GLFW_MOD_SHIFT)) return beginRow(work, at);
    if (const uint32_t key = seedAt(work, at)) {
        const bool more = event.mods & GLFW_MOD_SHIFT;
        if (more && work.selected.erase(key)) return;
        if (!more && !work.selected.count(key)) work.selected.clear();
        work.selected.insert(key);
        alone_ = more ? 0 : key;
        drag_ = Drag::move;
        return;
    }
    if (event.mods & GLFW_MOD_SHIFT) {  // wherever it begins
        drag_ = Drag::box;
        return;
    }
    if (arrowAt(work, at)) {
        drag_ = Drag::turn;
        return;
    }
    work.selected.clear();
    const auto hit = work.pickGround(at);
    if (!hit) return work.say(kNoGround);
    pending_ = newSeed(work, *hit);
    drag_ = Drag::direction;
}

// At a seed it goes on from that one, which stays as it is.
void SeedTool::beginRow(Workspace& work, glm::vec2 at) {
    work.selected.clear();
    const Seed* seed = work.document->seed(seedAt(work, at));
    const auto hit = work.pickGround(at);
    if (!hit && !seed) return work.say(kNoGround);
    drag_ = Drag::row;
    firstInRow_ = !seed;
    lastInRow_ = seed ? vec(seed->position) : vec(hit->position);
    if (seed) {
        work.selected = {seed->key};
        return;
    }
    pending_ = newSeed(work, *hit);
    plant(work, pending_, gesture_);
}

void SeedTool::follow(Workspace& work, glm::vec2 at) {
    moved_ = moved_ || glm::distance(at, from_) > 4 * work.scale;
    if (drag_ == Drag::box) {
        last_ = at;
        return;
    }
    if (!moved_) return;
    if (drag_ == Drag::row) {
        plantRow(work, at);
        last_ = at;
        return;
    }
    const bool one = drag_ == Drag::move && chosenCount(work) == 1;
    const auto hit = seen(work, one ? at + grip_ : at);
    if (!hit) return;
    const glm::vec3 point = vec(hit->position);
    const auto towards = [&](SeedRecord& seed) {
        const glm::vec3 to = point - vec(seed.position);
        if (glm::length(to) > 1e-4f) seed.direction = array(glm::normalize(to));
    };
    if (drag_ == Drag::direction) {
        towards(pending_);
    } else if (drag_ == Drag::turn) {
        changeChosen(work, towards);
    } else if (drag_ == Drag::move) {
        // A single one goes with the mouse onto whatever surface lies there, several stand to each other as they did.
        const auto before = seen(work, last_);
        if (one)
            changeChosen(work, [&](SeedRecord& seed) { seed.position = array(point); });
        else if (before)
            changeChosen(work, [&, by = point - vec(before->position)](SeedRecord& seed) {
                seed.position = array(vec(seed.position) + by);
            });
    }
    last_ = at;
}

// As evenly as the step says, however far the mouse has gone since the last frame.
void SeedTool::plantRow(Workspace& work, glm::vec2 at) {
    const int parts = 1 + int(glm::distance(last_, at) / (4 * work.scale));
    for (int i = 1; i <= parts; ++i) {
        const auto hit = seen(work, glm::mix(last_, at, float(i) / float(parts)));
        if (!hit || !lastInRow_ || glm::distance(vec(hit->position), *lastInRow_) < work.layout.rowStep) continue;
        SeedRecord next = newSeed(work, *hit);
        if (work.layout.rowAlong) next.direction = array(glm::normalize(vec(hit->position) - *lastInRow_));
        if (work.layout.rowAlong && std::exchange(firstInRow_, false)) {  // only now it is known where the row goes
            pending_.direction = next.direction;
            work.perform(ChangeSeeds{{pending_}}, gesture_);
        }
        plant(work, next, gesture_);
        lastInRow_ = vec(hit->position);
    }
}

bool SeedTool::take(Workspace& work, const PointerEvent& event) {
    using Kind = PointerEvent::Kind;
    const glm::vec2 at{event.x, event.y};
    const bool left = event.button == GLFW_MOUSE_BUTTON_LEFT;
    if (byKey_ && event.kind != Kind::move) {
        if (event.kind == Kind::press && !left)
            cancel(work);
        else if (event.kind == Kind::press)
            finish(work);
        return true;
    }
    if (event.kind == Kind::press && left && drag_ == Drag::none) {
        press(work, event);
        return true;
    }
    if (drag_ == Drag::none) return false;
    if (event.kind == Kind::move) {
        follow(work, at);
    } else if (event.kind == Kind::release && left) {
        if (drag_ == Drag::direction) plant(work, pending_, gesture_);
        if (drag_ == Drag::box) selectBox(work);
        if (drag_ == Drag::move && !moved_ && alone_) work.selected = {alone_};
        drag_ = Drag::none;
    }
    return true;
}

void SeedTool::grab(Workspace& work, glm::vec2 at, bool turns) {
    if (chosenCount(work) > 0 && drag_ == Drag::none) followMouse(work, at, turns);
}

void SeedTool::followMouse(Workspace& work, glm::vec2 at, bool turns) {
    from_ = last_ = at;
    grip_ = {};
    if (chosenCount(work) == 1)
        for (uint32_t key : work.selected)
            if (const Seed* seed = work.document->seed(key)) grip_ = work.place(vec(seed->position)).value_or(at) - at;
    moved_ = byKey_ = true;
    changed_ = false;
    gesture_ = work.newGesture();
    drag_ = turns ? Drag::turn : Drag::move;
    work.underWay = turns ? "Move the mouse: turn   click: keep it   Esc: as it was"
                          : "Move the mouse: move   click: keep it   Esc: as it was";
}

void SeedTool::duplicate(Workspace& work, glm::vec2 at) {
    if (work.selected.empty() || drag_ != Drag::none) return;
    AddSeeds copies;
    for (const Seed& seed : work.scene().seeds) {
        if (!work.selected.count(seed.key)) continue;
        SeedRecord copy = work.document->recordOf(seed);
        copy.key = work.document->freshKey();
        copy.number = std::random_device()();
        copy.frozen = {};
        copy.line.clear();  // which leads the other one
        copies.seeds.push_back(std::move(copy));
        copies.places.push_back(uint32_t(work.scene().seeds.size() + copies.places.size()));
    }
    if (copies.seeds.empty()) return;  // what was chosen has gone
    copied_ = std::exchange(work.selected, {});
    for (const SeedRecord& copy : copies.seeds) work.selected.insert(copy.key);
    followMouse(work, at, false);
    changed_ = work.perform(copies, gesture_);
    if (!changed_) cancel(work);
}

void SeedTool::cancel(Workspace& work) {
    if (drag_ != Drag::none && changed_) work.takeBack(gesture_);
    if (!copied_.empty()) work.selected = copied_;
    finish(work);
}

void SeedTool::finish(Workspace& work) {
    drag_ = Drag::none;
    byKey_ = changed_ = false;
    copied_.clear();
    work.underWay = nullptr;
}

void SeedTool::remove(Workspace& work) {
    RemoveSeeds action;
    for (const Seed& seed : work.scene().seeds)
        if (work.selected.count(seed.key)) action.keys.push_back(seed.key);
    if (action.keys.empty())
        work.say("No seed is chosen: click one");
    else
        work.perform(action);
}

void SeedTool::selectBox(Workspace& work) const {
    const glm::vec2 low = glm::min(from_, last_), high = glm::max(from_, last_);
    for (const Seed& seed : work.scene().seeds) {
        const auto at = work.place(vec(seed.position));
        if (!seed.hidden && at && glm::clamp(*at, low, high) == *at && work.visible(vec(seed.position)))
            work.selected.insert(seed.key);
    }
}

void SeedTool::selectAll(Workspace& work) {
    for (const Seed& seed : work.scene().seeds)
        if (!seed.hidden) work.selected.insert(seed.key);
}

void SeedTool::draw(const Workspace& work) const {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float s = work.scale;
    // Along the view an arrow is a point: a ring stands for its head, a ring with a cross for its feathers.
    const auto ring = [&](glm::vec2 at, bool away, ImU32 colour, float width) {
        const float r = 9 * s, c = r * .7f;
        list.AddCircle({at.x, at.y}, r, IM_COL32(0, 0, 0, 150), 0, width + 2 * s);
        list.AddCircle({at.x, at.y}, r, colour, 0, width);
        if (!away) return;
        list.AddLine({at.x - c, at.y - c}, {at.x + c, at.y + c}, colour, width);
        list.AddLine({at.x - c, at.y + c}, {at.x + c, at.y - c}, colour, width);
    };
    const auto arrow = [&](glm::vec3 from, glm::vec3 direction, ImU32 colour, float width) {
        const auto a = work.place(from), b = work.place(from + kArrow * direction);
        if (!a || !b) return;
        const float along = glm::dot(direction, glm::normalize(from - work.camera.eye()));
        if (std::abs(along) > kAlongView) return ring(*a, along > 0, colour, width);
        list.AddLine({a->x, a->y}, {b->x, b->y}, IM_COL32(0, 0, 0, 150), width + 2 * s);
        list.AddLine({a->x, a->y}, {b->x, b->y}, colour, width);
        const glm::vec2 way = *b - *a;
        const float length = glm::length(way);
        if (length < 4) return;
        const glm::vec2 d = way / length * 7.f * s, side{-d.y * .6f, d.x * .6f};
        list.AddTriangleFilled({b->x + d.x * .4f, b->y + d.y * .4f},
                               {b->x - d.x * .6f + side.x, b->y - d.y * .6f + side.y},
                               {b->x - d.x * .6f - side.x, b->y - d.y * .6f - side.y}, colour);
    };
    for (const Seed& seed : work.scene().seeds) {
        const glm::vec3 point = vec(seed.position);
        const auto at = work.place(point);
        if (!at) continue;
        const bool chosen = work.selected.count(seed.key);
        if (seed.hidden && !chosen) continue;
        const ImU32 alpha = work.visible(point) ? 0xFF000000 : 0x50000000;
        const ImU32 colour = (chosen ? IM_COL32(255, 190, 60, 0) : IM_COL32(235, 245, 225, 0)) | alpha;
        const glm::vec3 direction = vec(seed.direction);
        if (chosen && glm::length(direction) > 0) arrow(point, glm::normalize(direction), colour, 2 * s);
        list.AddCircleFilled({at->x, at->y}, 5.5f * s, IM_COL32(0, 0, 0, 0) | (alpha / 2 & 0xFF000000));
        list.AddCircleFilled({at->x, at->y}, 4 * s, colour);
        if (seed.frozen) list.AddCircle({at->x, at->y}, 7 * s, IM_COL32(120, 200, 255, 0) | alpha, 0, 2 * s);
    }
    if (drag_ == Drag::box) {
        list.AddRectFilled({from_.x, from_.y}, {last_.x, last_.y}, IM_COL32(255, 190, 60, 30));
        list.AddRect({from_.x, from_.y}, {last_.x, last_.y}, IM_COL32(255, 190, 60, 200), 0, 0, s);
    }
    if (drag_ == Drag::direction)
        arrow(vec(pending_.position), vec(pending_.direction), IM_COL32(255, 190, 60, 255), 2.5f * s);
}

}  // namespace sample
