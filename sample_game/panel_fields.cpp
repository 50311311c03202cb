// The field in hand: its elements, and what it leans to.
#include <imgui.h>

#include <algorithm>

#include "sample_game/field_tool.hpp"
#include "sample_game/panels.hpp"

namespace sample {
namespace {

using namespace espalier::document;
using espalier::scene::SceneElement;
using espalier::scene::SceneField;

struct Kind {
    const char *name, *label, *tip;
};
constexpr Kind kKinds[] = {{kStroke, "Flow stroke", "A drag over the model lays directions along its way"},
                           {"regular", "Direction", "The field has this direction here"},
                           {"wedge", "Wedge", "The field turns about the place by half a turn"},
                           {"trisector", "Trisector", "By half a turn against the way around"},
                           {"node", "Node", "Directions lead away from the place"},
                           {"centre", "Centre", "Directions lead around the place"},
                           {"saddle", "Saddle", "The field turns by a whole turn against the way around"}};

const char* labelOf(const std::string& kind) {
    for (const Kind& k : kKinds)
        if (kind == k.name) return k.label;
    return "";
}

// True: another kind was taken. strokes: they are offered, too.
bool chooseKind(const char* id, std::string& kind, bool strokes) {
    bool changed = false;
    if (!beginCombo(id, labelOf(kind))) return false;
    for (const Kind& k : kKinds) {
        if (!strokes && k.name == std::string_view(kStroke)) continue;
        if (ImGui::Selectable(k.label, kind == k.name)) {
            kind = k.name;
            changed = true;
        }
        toolTip(k.tip);
    }
    ImGui::EndCombo();
    return changed;
}

void elementRows(Workspace& work) {
    for (size_t s = 0; s < work.scene().surfaces.size(); ++s) {
        const SceneField field = fieldNow(work, s);
        for (size_t i = 0; i < field.elements.size(); ++i) {
            ImGui::PushID(int(1000 * s + i));
            const bool chosen = work.field.element && *work.field.element == i && work.field.surface == s;
            const std::string text = std::to_string(i + 1) + "  " + labelOf(field.elements[i].kind);
            if (ImGui::Selectable(text.c_str(), chosen)) work.field.surface = s, work.field.element = i;
            ImGui::PopID();
        }
    }
}

void leanRow(Workspace& work) {
    if (work.scene().surfaces.empty()) return;
    float lean = fieldNow(work, 0).lean;
    if (labelledSlider("Leans down", &lean, 0, 8, "%.2f"))
        for (size_t s = 0; s < work.scene().surfaces.size(); ++s) {
            SceneField field = fieldNow(work, s);
            field.lean = lean;
            work.perform(SetField{uint32_t(s), std::move(field)}, widgetGesture(work));
        }
    toolTip("How much the field leans downward where no element is felt");
}

void viewRow(Workspace& work) {
    bool seen = work.scene().look.view == ESP_VIEW_FIELD;
    if (checkBox("Show the field", &seen))
        work.perform(SetView{seen ? "field" : "shaded", seen ? work.field.name : ""});
    toolTip(
        "Streaks along its directions, and a mark where it turns about a place: warm with the way around, blue against "
        "it");
}

void exactRow(Workspace& work) {
    if (work.scene().surfaces.empty()) return;
    bool exact = fieldNow(work, 0).exact;
    if (checkBox("Only these singularities", &exact)) {
        const uint32_t gesture = work.newGesture();
        for (size_t s = 0; s < work.scene().surfaces.size(); ++s) {
            SceneField field = fieldNow(work, s);
            field.exact = exact;
            work.perform(SetField{uint32_t(s), std::move(field)}, gesture);
        }
    }
    toolTip(
        "The field turns about the elements and nowhere else, but for what topology asks for: about a closed body "
        "without "
        "handles two whole turns together");
}

}  // namespace

void fieldsPanel(Workspace& work) {
    const std::vector<std::string> names = designedFields(work);
    if (names.empty()) return hint("No grammar of this scene reads a field. Open a grammar of patterns.");
    if (std::ranges::find(names, work.field.name) == names.end()) work.field.name = names.front();
    rowLabel("Field");
    if (beginCombo("##field", work.field.name)) {
        for (const std::string& name : names)
            if (ImGui::Selectable(name.c_str(), name == work.field.name)) {
                work.field.name = name;
                work.field.element.reset();
                if (work.scene().look.view == ESP_VIEW_FIELD) work.perform(SetView{"field", name});
            }
        ImGui::EndCombo();
    }
    toolTip("Which of the fields that the grammars read");
    rowLabel("Next");
    (void)chooseKind("##next", work.field.kind, true);
    toolTip("What a click or a drag places");
    viewRow(work);
    leanRow(work);
    exactRow(work);
    elementRows(work);
    if (const SceneElement* chosen = chosenElement(work)) {
        std::string kind = chosen->kind;
        rowLabel("Kind");
        if (chooseKind("##kind", kind, false))
            changeElement(work, work.newGesture(), [&](SceneElement& e) { e.kind = kind; });
        float radius = chosen->radius > 0 ? chosen->radius : .1f * work.reach();
        if (labelledSlider("Reach", &radius, .005f * work.reach(), work.reach(), "%.2f m", true)) {
            work.field.radius = radius;
            changeElement(work, widgetGesture(work), [&](SceneElement& e) { e.radius = radius; });
        }
        toolTip("How far the element is felt");
    } else {
        ImGui::TextDisabled("No element is chosen");
    }
    if (ImGui::Button("Remove all", {-1, 0})) {
        const uint32_t gesture = work.newGesture();
        for (size_t s = 0; s < work.scene().surfaces.size(); ++s)
            if (!fieldNow(work, s).elements.empty()) {
                SceneField field = fieldNow(work, s);
                field.elements.clear();
                work.perform(SetField{uint32_t(s), std::move(field)}, gesture);
            }
        work.field.element.reset();
    }
    toolTip("All elements of this field go; Ctrl+Z brings them back");
}

}  // namespace sample
