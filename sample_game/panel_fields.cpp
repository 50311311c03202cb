// The field in hand: its elements, its file, strokes over it, and what it leans to.
#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "sample_game/dialogue.hpp"
#include "sample_game/field_tool.hpp"
#include "sample_game/folder_list.hpp"
#include "sample_game/panels.hpp"

namespace sample {
namespace {

using namespace espalier::document;
using espalier::scene::SceneElement;
using espalier::scene::SceneField;

struct FieldKind {
    const char *name, *label, *tip;
};
constexpr const char* kAskField = "Load a field";

constexpr FieldKind kFieldKinds[] = {
    {kComb, "Comb", "A drag over the model turns the directions under the brush along its way"},
    {kSmooth, "Smooth", "Directions under the brush relax"},
    {kStroke, "Flow stroke", "A drag over the model lays directions along its way"},
    {"regular", "Direction", "The field has this direction here"},
    {"wedge", "Wedge", "The field turns about the place by half a turn"},
    {"trisector", "Trisector", "By half a turn against the way around"},
    {"node", "Node", "Directions lead away from the place"},
    {"centre", "Centre", "Directions lead around the place"},
    {"saddle", "Saddle", "The field turns by a whole turn against the way around"}};

const char* labelOf(const std::string& kind) {
    for (const FieldKind& k : kFieldKinds)
        if (kind == k.name) return k.label;
    return "";
}

bool drags(std::string_view kind) {
    return kind == kStroke || kind == kComb || kind == kSmooth;
}

// True: another kind was taken. all: not only elements.
bool chooseKind(const char* id, std::string& kind, bool all) {
    bool changed = false;
    if (!beginCombo(id, labelOf(kind))) return false;
    for (const FieldKind& k : kFieldKinds) {
        if (!all && drags(k.name)) continue;
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

// As one step, of all surfaces whose field isn't as `change` leaves it.
template <class F>
bool changeAll(Workspace& work, uint32_t gesture, F&& change) {
    bool good = true;
    for (size_t s = 0; s < work.scene().surfaces.size(); ++s) {
        const SceneField before = fieldNow(work, s);
        SceneField field = before;
        change(field);
        if (field != before) good = work.perform(SetField{uint32_t(s), std::move(field)}, gesture) && good;
    }
    return good;
}

void brushRows(Workspace& work) {
    float radius = fieldReach(work);
    if (labelledSlider("Radius", &radius, kSmallestBrush, mostFieldReach(work), "%.2f m", true))
        work.field.radius = radius;
    toolTip("How far the brush reaches; [ and ] change it");
    labelledSlider("Strength", &work.field.strength, 0, 1, "%.2f");
    toolTip("How much of the way there one stroke goes");
}

// As in the paper, to be compared.
void summedRow(Workspace& work) {
    if (work.scene().surfaces.empty()) return;
    const SceneField field = fieldNow(work, 0);
    bool summed = field.summed;
    if (checkBox("Summed as in Li 2011", &summed))
        changeAll(work, work.newGesture(), [&](SceneField& f) {
            f.summed = summed;
            f.exact = f.exact && !summed;
        });
    toolTip("The sum of what elements ask for, smoothed; it turns about many places that nobody asked for");
    float passes = float(field.passes);
    if (summed && labelledSlider("Passes", &passes, 0, 1000, "%.0f"))
        changeAll(work, widgetGesture(work), [&](SceneField& f) { f.passes = uint32_t(passes + .5f); });
}

// The surface in hand's.
void fileRow(Workspace& work) {
    if (work.field.surface >= work.scene().surfaces.size()) return;
    const SceneField field = fieldNow(work, work.field.surface);
    const float cross = field.file.empty() ? 0 : ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x;
    const float width = ImGui::GetContentRegionAvail().x - cross;
    const std::string text =
        field.file.empty() ? "Load from file \u2026" : std::filesystem::path(field.file).filename().string();
    if (ImGui::Button((shortened(text, width - 2 * ImGui::GetStyle().FramePadding.x) + "###file").c_str(), {width, 0}))
        ask(kAskField);
    toolTip((field.file + (field.file.empty() ? "" : "\n") +
             "A field that another program has computed: PLY with vectors or tensors at vertices, or OpenEXR over the "
             "walk's UVs")
                .c_str());
    if (field.file.empty()) return;
    ImGui::SameLine();
    if (ImGui::Button("\u00d7", {ImGui::GetFrameHeight(), 0})) {
        SceneField without = field;
        without.file.clear();
        without.given.reset();
        work.perform(SetField{uint32_t(work.field.surface), std::move(without)}, work.newGesture());
    }
    toolTip("Without the file");
}

void strokesRow(Workspace& work) {
    size_t count = 0;
    for (size_t s = 0; s < work.scene().surfaces.size(); ++s) count += fieldNow(work, s).strokes.size();
    if (count == 0) return;
    if (ImGui::Button("Remove strokes", {-1, 0})) {
        const uint32_t gesture = work.newGesture();
        for (size_t s = 0; s < work.scene().surfaces.size(); ++s)
            if (!fieldNow(work, s).strokes.empty())
                work.perform(TrimField{uint32_t(s), work.field.name, 0, 0}, gesture);
    }
    toolTip(("Strokes of brushes over this field: " + std::to_string(count) + "; Ctrl+Z brings them back").c_str());
}

void leanRow(Workspace& work) {
    if (work.scene().surfaces.empty()) return;
    float lean = fieldNow(work, 0).lean;
    if (labelledSlider("Leans down", &lean, 0, 8, "%.2f"))
        changeAll(work, widgetGesture(work), [&](SceneField& field) { field.lean = lean; });
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
    if (checkBox("Only these singularities", &exact))
        changeAll(work, work.newGesture(), [&](SceneField& field) {
            field.exact = exact;
            field.summed = field.summed && !exact;
        });
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
    toolTip("What a click or a drag places, or does");
    if (brushesField(work)) brushRows(work);
    viewRow(work);
    leanRow(work);
    exactRow(work);
    summedRow(work);
    fileRow(work);
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
        changeAll(work, work.newGesture(), [](SceneField& field) { field.elements.clear(); });
        work.field.element.reset();
    }
    toolTip("All elements of this field go; Ctrl+Z brings them back");
    strokesRow(work);
}

void fieldDialogue(Workspace& work, Session& session) {
    static PathText path{};
    askPath(work, session,
            {kAskField,
             "A field (.ply with vectors or tensors, .exr over the walk's UVs):",
             "Load",
             path,
             {".ply", ".exr"}},
            [&](const char* file) {
                SceneField field = fieldNow(work, work.field.surface);
                field.file = wholePath(file);
                field.given.reset();
                const bool good = work.perform(SetField{uint32_t(work.field.surface), field}, work.newGesture());
                if (good)
                    work.say(field.name + " is that of " + std::filesystem::path(file).filename().string() + " now");
                endWait(work, good);
            });
}

}  // namespace sample
