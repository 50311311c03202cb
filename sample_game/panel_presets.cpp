// Values of a grammar's parameters that the user keeps under names.
#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "sample_game/panels.hpp"
#include "sample_game/settings.hpp"

namespace sample {
namespace {

using namespace espalier::document;

struct Names {
    char kept[64] = "";    // of the preset that is being saved
    char wanted[64] = "";  // in place of `renamed`
    std::string renamed;   // which one gets another name; empty: none
    bool begins = false;   // that was asked for in the last frame
};

std::vector<Param> values(const Workspace& work, EspGrammar grammar, bool initial) {
    std::vector<Param> all;
    for (uint32_t i = 0; i < espParamCount(work.context.get(), grammar); ++i) {
        EspParamInfo info;
        if (espParamInfo(work.context.get(), grammar, i, &info) != ESP_OK) continue;
        const float* value = initial ? info.initial : info.value;
        all.push_back({info.name, {value, value + (info.kind == ESP_PARAM_COLOUR ? 3 : 1)}});
    }
    return all;
}

// One step of undo by the preset's name. What the grammar has lost since is told, and the rest taken.
void apply(Workspace& work, uint32_t index, const std::string& name, const std::vector<Param>& params) {
    const uint32_t gesture = work.newGesture();
    const std::vector<Param> before = values(work, work.scene().grammars[index].id, false);
    std::string lost;
    bool changes = false;
    for (const Param& param : params) {
        if (std::ranges::find(before, param) != before.end()) continue;
        const bool taken = work.perform(SetParam{index, param}, gesture);
        changes |= taken;
        if (!taken) lost += (lost.empty() ? "" : ", ") + param.name;
    }
    work.document->callStep(gesture, name + " of " + grammarName(work.scene(), index));
    work.error.clear();
    work.message = !lost.empty() ? "The grammar has no parameter any more that is called: " + lost
                   : changes     ? "Taken: " + name
                                 : "It has these values already: " + name;
}

void renameRow(Workspace& work, const std::string& grammar, Names& names) {
    ImGui::SetNextItemWidth(-1);
    if (std::exchange(names.begins, false)) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputText("##wanted", names.wanted, sizeof names.wanted,
                                          ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    toolTip("Return: it is called so");
    if (!entered || !names.wanted[0]) return;
    if (renamePreset(grammar, names.renamed, names.wanted, work.error)) names.renamed.clear();
}

constexpr uint32_t kPictureWidth = 192, kPictureHeight = 128;  // pixels

// The preset's picture before its name, if there is one; how high its row is. 0: as high as its letters.
float pictureCell(const Workspace& work, const std::string& file) {
    float aspect = 1;
    void* const picture = work.pictureOf ? work.pictureOf(file, aspect) : nullptr;
    if (!picture) return 0;
    const float high = ImGui::GetFontSize() * 3;
    ImGui::Image(picture, {high * aspect, high});
    if (ImGui::IsItemHovered() && !toolTipWaits()) {
        ImGui::BeginTooltip();
        ImGui::Image(picture, {kPictureWidth * 2 * work.scale, kPictureWidth * 2 * work.scale / aspect});
        ImGui::EndTooltip();
    }
    ImGui::SameLine();
    return high;
}

// A choice beside its picture, in the middle of the row.
bool pictureChoice(const char* name, ImVec2 size) {
    ImGui::PushStyleVar(ImGuiStyleVar_SelectableTextAlign, {0, .5f});
    const bool chosen = ImGui::Selectable(name, false, 0, size);
    ImGui::PopStyleVar();
    return chosen;
}

// True: its values are wanted.
bool presetRow(Workspace& work, const std::string& grammar, const std::string& name, Names& names) {
    const float gap = ImGui::GetStyle().ItemSpacing.x, pad = 2 * ImGui::GetStyle().FramePadding.x;
    const float buttons = ImGui::CalcTextSize("Rename\u00d7").x + 2 * pad + 2 * gap;
    const float high = pictureCell(work, presetPicture(grammar, name));
    const float room = std::max(ImGui::GetContentRegionAvail().x, ImGui::GetFontSize() * 18);
    const bool chosen = pictureChoice(name.c_str(), {room - buttons, high});
    toolTip("Takes these values, as one step of undo");
    ImGui::SameLine();
    if (ImGui::SmallButton("Rename")) {
        names.renamed = name;
        names.begins = true;
        std::snprintf(names.wanted, sizeof names.wanted, "%s", name.c_str());
    }
    ImGui::SameLine();
    if (ImGui::SmallButton("\u00d7") && removePreset(grammar, name, work.error)) work.message = "Removed: " + name;
    toolTip("Removes it; the last one that was removed can be brought back");
    return chosen;
}

void shippedRows(Workspace& work, uint32_t index) {
    const std::string& file = work.scene().grammars[index].file;
    ImGui::PushID("shipped");
    for (const std::string& name : shippedPresets(file)) {
        std::vector<Param> params;
        const float high = pictureCell(work, shippedPresetPicture(file, name));
        const bool chosen = pictureChoice(name.c_str(), {0, high});
        toolTip("Comes with the grammar; one step of undo");
        if (chosen && readShippedPreset(file, name, params, work.error)) apply(work, index, "Preset " + name, params);
    }
    ImGui::PopID();
}

void presetRows(Workspace& work, uint32_t index, const std::string& grammar, Names& names) {
    const std::vector<std::string> all = presetNames(grammar);
    for (const std::string& name : all) {
        ImGui::PushID(name.c_str());
        std::vector<Param> params;
        if (name == names.renamed)
            renameRow(work, grammar, names);
        else if (presetRow(work, grammar, name, names) && readPreset(grammar, name, params, work.error))
            apply(work, index, "Preset " + name, params);
        ImGui::PopID();
    }
    const std::string removed = removedPreset(grammar);
    if (removed.empty() || std::ranges::find(all, removed) != all.end()) return;
    if (ImGui::Selectable(("Bring back: " + removed).c_str(), false, ImGuiSelectableFlags_DontClosePopups) &&
        restorePreset(grammar, work.error))
        work.message = "It is back: " + removed;
    toolTip("The preset that was removed last");
}

void keepRow(Workspace& work, uint32_t index, const std::string& grammar, Names& names) {
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 12);
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    bool keeps = ImGui::InputTextWithHint("##name", "name for these values", names.kept, sizeof names.kept,
                                          ImGuiInputTextFlags_EnterReturnsTrue);
    const std::vector<std::string> all = presetNames(grammar);
    const std::string name = presetCalled(names.kept);
    const bool taken = std::ranges::find(all, name) != all.end();
    ImGui::SameLine();
    ImGui::BeginDisabled(!names.kept[0]);
    keeps |= ImGui::Button(taken ? "Replace" : "Keep");
    ImGui::EndDisabled();
    toolTip(
        "Keeps the values as they are now under this name, with a picture of the view, for this grammar in any scene");
    const std::vector<Param> params = values(work, work.scene().grammars[index].id, false);
    if (!keeps || !names.kept[0] || !writePreset(grammar, name, params, work.error)) return;
    work.error.clear();  // an earlier try's
    work.message = (taken ? "Replaced: " : "Kept: ") + name;
    work.writeView(presetPicture(grammar, name), kPictureWidth, kPictureHeight);
    names.kept[0] = 0;
    ImGui::CloseCurrentPopup();
}

}  // namespace

void presetsPanel(Workspace& work, uint32_t index) {
    static Names names;
    const std::string grammar = presetsOf(work.scene().grammars[index].file);
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##presets", "Presets")) {
        toolTip("Values kept under a name, and those that the grammar says");
        return;
    }
    if (ImGui::IsWindowAppearing()) names.renamed.clear();
    if (ImGui::Selectable("As the grammar says"))
        apply(work, index, "The text's own values", values(work, work.scene().grammars[index].id, true));
    shippedRows(work, index);
    if (!presetNames(grammar).empty()) ImGui::Separator();
    presetRows(work, index, grammar, names);
    ImGui::Separator();
    keepRow(work, index, grammar, names);
    ImGui::EndCombo();
}

}  // namespace sample
