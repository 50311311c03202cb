// Values of a grammar's parameters that the user keeps under names.
#include <imgui.h>

#include "sample_game/panels.hpp"
#include "sample_game/settings.hpp"

namespace sample {
namespace {

using namespace espalier::document;

std::vector<Param> values(const Workspace& work, EspGrammar grammar) {
    std::vector<Param> all;
    for (uint32_t i = 0; i < espParamCount(work.context.get(), grammar); ++i) {
        EspParamInfo info;
        if (espParamInfo(work.context.get(), grammar, i, &info) == ESP_OK)
            all.push_back({info.name, {info.value, info.value + (info.kind == ESP_PARAM_COLOUR ? 3 : 1)}});
    }
    return all;
}

}  // namespace

void presetsPanel(Workspace& work, uint32_t index) {
    const auto& grammar = work.scene().grammars[index];
    static char name[64] = "";  // of the preset that is being saved
    ImGui::SetNextItemWidth(-1);
    const bool open = ImGui::BeginCombo("##presets", "Presets");
    if (!open) toolTip("Values kept under a name, and those that the grammar says");
    if (!open) return;
    const auto apply = [&](const std::vector<Param>& params) {
        const uint32_t gesture = work.newGesture();
        for (const Param& param : params) work.perform(SetParam{index, param}, gesture);
    };
    if (ImGui::Selectable("As the grammar says")) {
        std::vector<Param> initial = values(work, grammar.id);
        for (uint32_t i = 0; i < initial.size(); ++i) {
            EspParamInfo info;
            if (espParamInfo(work.context.get(), grammar.id, i, &info) == ESP_OK)
                initial[i].value.assign(info.initial, info.initial + initial[i].value.size());
        }
        apply(initial);
    }
    for (const std::string& preset : presetNames(grammarName(work.scene(), index)))
        if (ImGui::Selectable(preset.c_str())) {
            std::vector<Param> params;
            if (readPreset(grammarName(work.scene(), index), preset, params, work.error)) apply(params);
        }
    ImGui::Separator();
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 12);
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    bool keeps = ImGui::InputTextWithHint("##name", "name for these values", name, sizeof name,
                                          ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    ImGui::BeginDisabled(!name[0]);
    keeps |= ImGui::Button("Keep");
    ImGui::EndDisabled();
    toolTip("Keeps the values as they are now under this name, for this grammar in any scene");
    if (keeps && name[0] && writePreset(grammarName(work.scene(), index), name, values(work, grammar.id), work.error)) {
        work.message = std::string("Kept: ") + name;
        name[0] = 0;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndCombo();
}

}  // namespace sample
