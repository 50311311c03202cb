// Clicks and drags -> elements that come, move and turn. Markers are drawn over the scene.
#define GLFW_INCLUDE_NONE
#include "sample_game/field_tool.hpp"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "sample_game/widgets.hpp"

namespace sample {
namespace {

using namespace espalier::document;
using espalier::scene::SceneElement;
using espalier::scene::SceneField;

constexpr float kElementReach = 12;    // pixels at 96 dpi around a marker
constexpr float kElementArrow = .12f;  // of the scene's size
constexpr float kStrokeStep = .6f;     // between a stroke's elements, of the reach of elements
constexpr float kStrokeWidth = 1.5f;   // how far one of them is felt, of that

float arrowOf(const Workspace& work) {
    return kElementArrow * work.reach();
}

glm::vec3 tipOf(const Workspace& work, const SceneElement& e) {
    const glm::vec3 direction = vec(e.direction);
    const float length = glm::length(direction);
    return vec(e.position) + (length > 0 ? direction * (arrowOf(work) / length) : glm::vec3(0));
}

// Calls fn(surface, index, element) for the elements of the field in hand.
template <class F>
void eachElement(const Workspace& work, F&& fn) {
    for (size_t s = 0; s < work.scene().surfaces.size(); ++s) {
        const SceneField field = fieldNow(work, s);
        for (size_t i = 0; i < field.elements.size(); ++i) fn(s, i, field.elements[i]);
    }
}

}  // namespace

std::vector<std::string> designedFields(const Workspace& work) {
    std::vector<std::string> names;
    for (const auto& grammar : work.scene().grammars)
        for (uint32_t i = 0; i < espFieldCount(work.context.get(), grammar.id); ++i) {
            const std::string name = espFieldName(work.context.get(), grammar.id, i);
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
        }
    return names;
}

SceneField fieldNow(const Workspace& work, size_t surface) {
    const auto& fields = work.scene().surfaces[surface].fields;
    const auto known = std::ranges::find(fields, work.field.name, &SceneField::name);
    return known != fields.end() ? *known : SceneField{work.field.name};
}

const SceneElement* chosenElement(const Workspace& work) {
    const auto& surfaces = work.scene().surfaces;
    if (!work.field.element || work.field.surface >= surfaces.size()) return nullptr;
    const auto& fields = surfaces[work.field.surface].fields;
    const auto known = std::ranges::find(fields, work.field.name, &SceneField::name);
    if (known == fields.end() || *work.field.element >= known->elements.size()) return nullptr;
    return &known->elements[*work.field.element];
}

void changeElement(Workspace& work, uint32_t gesture, const std::function<void(SceneElement&)>& change) {
    if (!chosenElement(work)) return;
    SceneField field = fieldNow(work, work.field.surface);
    change(field.elements[*work.field.element]);
    work.perform(SetField{uint32_t(work.field.surface), std::move(field)}, gesture);
}

void FieldTool::place(Workspace& work, const EspHit& hit) {
    const auto surface = surfaceUnder(work, hit);
    if (!surface) return;
    SceneField field = fieldNow(work, *surface);
    SceneElement element;
    element.kind = work.field.kind;
    element.position = array(vec(hit.position));
    element.direction = {0, -1, 0};
    element.radius = work.field.radius;
    field.elements.push_back(element);
    if (!work.perform(SetField{uint32_t(*surface), field}, gesture_)) return;
    work.field.surface = *surface;
    work.field.element = field.elements.size() - 1;
    changed_ = true;
    drag_ = Drag::direction;
}

// One element a step of the stroke, all of them one undo step.
void FieldTool::layStroke(Workspace& work, const EspHit& hit) {
    if (surfaceUnder(work, hit) != work.field.surface) return;
    const glm::vec3 point = vec(hit.position), way = point - laid_;
    const float step = kStrokeStep * fieldReach(work);
    if (glm::length(way) < step) return;
    SceneField field = fieldNow(work, work.field.surface);
    SceneElement element;
    element.position = array(point);
    element.direction = array(glm::normalize(way));
    element.radius = kStrokeWidth * step;
    field.elements.push_back(element);
    if (!work.perform(SetField{uint32_t(work.field.surface), std::move(field)}, gesture_)) return;
    laid_ = point;
    changed_ = true;
}

void FieldTool::press(Workspace& work, glm::vec2 at) {
    const std::vector<std::string> names = designedFields(work);
    if (names.empty()) return work.say("No grammar of this scene reads a field");
    if (std::ranges::find(names, work.field.name) == names.end()) work.field.name = names.front();
    from_ = at;
    moved_ = changed_ = false;
    gesture_ = work.newGesture();
    if (brushesField(work)) {
        const auto surface = brush_.begin(work, at, gesture_);
        if (!surface) return work.say("No surface there");
        if (work.field.surface != *surface) work.field.element.reset();
        work.field.surface = *surface;
        drag_ = Drag::brush;
        return;
    }
    if (const SceneElement* chosen = chosenElement(work)) {
        const auto tip = work.place(tipOf(work, *chosen));
        if (tip && glm::distance(*tip, at) < kElementReach * work.scale) {
            drag_ = Drag::direction;
            return;
        }
    }
    float nearest = kElementReach * work.scale;
    eachElement(work, [&](size_t surface, size_t index, const SceneElement& e) {
        const auto there = work.place(vec(e.position));
        if (!there || glm::distance(*there, at) > nearest || !work.visible(vec(e.position))) return;
        nearest = glm::distance(*there, at);
        work.field.surface = surface;
        work.field.element = index;
        drag_ = Drag::move;
    });
    if (drag_ == Drag::move) return;
    const auto hit = work.pick(at);
    if (!hit) return work.say("No surface there");
    if (work.field.kind != kStroke) return place(work, *hit);
    const auto surface = surfaceUnder(work, *hit);
    if (!surface) return;
    work.field.surface = *surface;
    work.field.element.reset();
    laid_ = vec(hit->position);
    drag_ = Drag::stroke;
}

void FieldTool::follow(Workspace& work, glm::vec2 at) {
    if (drag_ == Drag::brush) {
        brush_.follow(work, at);
        changed_ = brush_.changed();
        return;
    }
    moved_ = moved_ || glm::distance(at, from_) > 4 * work.scale;
    const auto hit = moved_ ? work.pick(at) : std::nullopt;
    if (!hit) return;
    if (drag_ == Drag::stroke) return layStroke(work, *hit);
    const glm::vec3 point = vec(hit->position);
    changeElement(work, gesture_, [&](SceneElement& e) {
        const glm::vec3 to = point - vec(e.position);
        if (drag_ == Drag::move)
            e.position = array(point);
        else if (glm::length(to) > 1e-4f * work.reach())
            e.direction = array(glm::normalize(to));
    });
    changed_ = true;
}

bool FieldTool::take(Workspace& work, const PointerEvent& event) {
    using Kind = PointerEvent::Kind;
    const bool left = event.button == GLFW_MOUSE_BUTTON_LEFT;
    if (event.kind == Kind::press && left && drag_ == Drag::none) {
        press(work, {event.x, event.y});
        return true;
    }
    if (drag_ == Drag::none) return false;
    if (event.kind == Kind::move) follow(work, {event.x, event.y});
    if (event.kind == Kind::release && left) {
        if (drag_ == Drag::brush) changed_ = brush_.changed();
        if ((drag_ == Drag::stroke || drag_ == Drag::brush) && !changed_)
            work.say("Drag over the model: the field follows");
        drag_ = Drag::none;
    }
    return true;
}

void FieldTool::cancel(Workspace& work) {
    if (drag_ == Drag::brush) changed_ = brush_.changed();
    if (drag_ != Drag::none && changed_) work.takeBack(gesture_);
    drag_ = Drag::none;
}

void FieldTool::forget(Workspace& work) {
    turns_ = {};
    work.field.surface = 0;
    work.field.element.reset();
}

void FieldTool::remove(Workspace& work) {
    if (!chosenElement(work)) return work.say("No element is chosen: click one");
    SceneField field = fieldNow(work, work.field.surface);
    field.elements.erase(field.elements.begin() + std::ptrdiff_t(*work.field.element));
    work.perform(SetField{uint32_t(work.field.surface), std::move(field)});
    work.field.element.reset();
}

std::string indexText(float index) {
    constexpr int kMostDirections = 12;
    int parts = 1;
    while (parts < kMostDirections && std::abs(index * float(parts) - std::round(index * float(parts))) > .01f) ++parts;
    const long turns = std::lround(index * float(parts));
    return (turns > 0 ? "+" : "") + std::to_string(turns) + (parts > 1 ? "/" + std::to_string(parts) : "");
}

// Beside the marks that the view of the field has there.
void FieldTool::drawIndices(const Workspace& work) {
    constexpr size_t kMost = 200;  // more say nothing
    const std::string& name = work.scene().viewLayer;
    if (turns_.name != name || turns_.revision != work.document->revision()) {
        turns_ = {name, work.document->revision(), {}};
        for (const auto& surface : work.scene().surfaces) {
            uint32_t count = 0;
            if (espFieldSingularities(work.context.get(), surface.id, name.c_str(), nullptr, &count) != ESP_OK)
                continue;
            const size_t before = turns_.all.size();
            turns_.all.resize(before + count);
            (void)espFieldSingularities(work.context.get(), surface.id, name.c_str(), turns_.all.data() + before,
                                        &count);
        }
    }
    if (turns_.all.size() > kMost) return;
    for (const EspSingularity& s : turns_.all)
        if (const auto at = work.place(vec(s.position)); at && work.visible(vec(s.position)))
            noteAt(work, *at + glm::vec2(0, 18 * work.scale), indexText(s.index).c_str());  // below an element
}

void FieldTool::draw(const Workspace& work) {
    if (work.scene().look.view == ESP_VIEW_FIELD && drag_ == Drag::none) drawIndices(work);
    if (brushesField(work)) brush_.draw(work);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float s = work.scale;
    const SceneElement* chosen = chosenElement(work);
    eachElement(work, [&](size_t surface, size_t index, const SceneElement& e) {
        const auto at = work.place(vec(e.position)), tip = work.place(tipOf(work, e));
        if (!at || !work.visible(vec(e.position))) return;
        const bool own = chosen && surface == work.field.surface && index == *work.field.element;
        const ImU32 colour = own ? IM_COL32(255, 190, 60, 255) : IM_COL32(120, 200, 255, 255);
        if (tip) {
            list.AddLine({at->x, at->y}, {tip->x, tip->y}, IM_COL32(0, 0, 0, 150), 5 * s);
            list.AddLine({at->x, at->y}, {tip->x, tip->y}, colour, 2.5f * s);
            list.AddCircleFilled({tip->x, tip->y}, 4 * s, colour);
        }
        list.AddCircleFilled({at->x, at->y}, 8 * s, IM_COL32(0, 0, 0, 170));
        list.AddCircle({at->x, at->y}, 8 * s, colour, 0, 2 * s);
        const char letter[] = {char(std::toupper(e.kind[0])), 0};
        const ImVec2 size = ImGui::CalcTextSize(letter);
        list.AddText({at->x - size.x / 2, at->y - size.y / 2}, colour, letter);
    });
}

}  // namespace sample
