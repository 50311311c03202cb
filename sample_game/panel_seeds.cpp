// What is planted next, and what the chosen seeds have of their own.
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <limits>

#include "sample_game/panels.hpp"
#include "tools/scene/param_words.hpp"

namespace sample {
namespace {

using namespace espalier::document;
using espalier::scene::Seed;

// Values that the chosen seeds have in place of their grammar's.
void ownValues(Workspace& work, std::vector<SeedRecord> chosen) {
    if (!ImGui::TreeNode("Values of their own")) return;
    ImGui::PushID(int(chosen[0].key));  // what is typed is theirs
    std::erase_if(chosen, [grammar = chosen[0].grammar](const SeedRecord& seed) { return seed.grammar != grammar; });
    const EspGrammar grammar = work.scene().grammars[chosen[0].grammar].id;
    for (uint32_t i = 0; i < espParamCount(work.context.get(), grammar); ++i) {
        EspParamInfo info;
        if (espParamInfo(work.context.get(), grammar, i, &info) != ESP_OK) continue;
        using Value = std::array<float, 3>;
        const size_t count = info.kind == ESP_PARAM_COLOUR ? 3 : 1;
        const auto valueOf = [&](const float* from) {
            Value value{};
            std::copy_n(from, count, value.begin());
            return value;
        };
        const auto named = [&](const Param& param) { return param.name == info.name; };
        std::vector<Value> own;  // of those that have one
        for (const SeedRecord& seed : chosen)
            if (const auto param = std::ranges::find_if(seed.params, named);
                param != seed.params.end() && param->value.size() == count)
                own.push_back(valueOf(param->value.data()));
        bool has = !own.empty();
        Value value = has ? own[0] : valueOf(info.value);
        const bool several = std::ranges::any_of(own, [&](const Value& other) { return other != value; });
        const bool some = has && own.size() < chosen.size();
        ImGui::PushID(info.name);
        ImGui::PushItemFlag(ImGuiItemFlags_MixedValue, some);
        bool changed = checkBox(espalier::scene::paramWords(info.label).name.c_str(), &has);
        ImGui::PopItemFlag();
        toolTip("A value of their own in place of the grammar's");
        has = has || some;  // those that had none get it, too
        uint32_t gesture = 0;
        if (has && !changed) {
            info.label = "On";
            ImGui::SetNextItemWidth(-1);
            changed = editParam(info, value.data(), several);
            gesture = changed ? widgetGesture(work) : 0;
        }
        ImGui::PopID();
        if (!changed) continue;
        for (SeedRecord& seed : chosen) {
            std::erase_if(seed.params, named);
            if (has) seed.params.push_back({info.name, {value.begin(), value.begin() + count}});
        }
        work.changeSeeds({chosen}, gesture);
    }
    ImGui::PopID();
    ImGui::TreePop();
}

const char* whyBarren(const Workspace& work, const EspPlantInfo& plant) {
    if (plant.end == ESP_END_NO_GROUND)
        return "Nothing grows from it: no ground goes on from here. Key 2 shows the ground.";
    if (plant.end == ESP_END_BY_LIMIT) return "Nothing grows from it: the scene's plants are as many as they may be.";
    if (plant.end == ESP_END_BY_RULES && plant.nodes == 0)
        return "Nothing grows from it: it is pruned. P and Let all grow again bring it back.";
    if (work.scene().layers.empty()) return "Nothing grows from it: its rules make nothing here.";
    return "Nothing grows from it: it may be that a layer is empty here. B shows what is painted.";
}

// A list of the scene's grammars, where there are several. The one that is taken of it; nothing: none.
std::optional<uint32_t> chooseGrammar(const Workspace& work, const char* label, uint32_t now, const char* tip) {
    std::optional<uint32_t> taken;
    const auto& grammars = work.scene().grammars;
    if (grammars.size() < 2) return taken;
    rowLabel(label);
    ImGui::PushID(label);
    if (beginCombo("##grammar", grammarName(work.scene(), now))) {
        for (uint32_t i = 0; i < grammars.size(); ++i)
            if (ImGui::Selectable(grammarName(work.scene(), i).c_str(), i == now)) taken = i;
        ImGui::EndCombo();
    }
    ImGui::PopID();
    toolTip(tip);
    return taken;
}

// The row of random numbers. The gesture of what has changed; 0: nothing has.
uint32_t randomNumbers(Workspace& work, std::vector<SeedRecord>& chosen) {
    uint32_t gesture = 0;
    int64_t number = chosen[0].number;
    rowLabel("Random no.");
    const float another = ImGui::CalcTextSize("Another").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - another - ImGui::GetStyle().ItemSpacing.x);
    const bool several = std::ranges::any_of(chosen, [&](const SeedRecord& seed) { return seed.number != number; });
    ImGui::PushID(int(chosen[0].key));
    const bool typed =
        ImGui::InputScalar("##number", ImGuiDataType_S64, &number, nullptr, nullptr, several ? "%lld \u2026" : "%lld");
    const bool escaped = ImGui::IsItemDeactivated() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false);
    if (escaped) {
        work.takeBack(work.gesture());
    } else if (typed) {
        number = std::clamp<int64_t>(number, 0, std::numeric_limits<uint32_t>::max());
        for (SeedRecord& seed : chosen) seed.number = uint32_t(number++);
        gesture = widgetGesture(work);
    }
    ImGui::PopID();
    toolTip(chosen.size() == 1 ? "Its random number: another one grows another plant"
                               : "Typed: the first one's random number, the others get those that follow it");
    ImGui::SameLine();
    if (ImGui::Button("Another", {-1, 0})) {
        for (SeedRecord& seed : chosen) seed.number = seed.number * 747796405u + 2891336453u;
        gesture = work.newGesture();
    }
    toolTip("Another random number: another plant from the same seed");
    return gesture;
}

void seedButtons(Workspace& work, const std::vector<SeedRecord>& chosen) {
    std::vector<uint32_t> growing, frozen;
    for (const SeedRecord& seed : chosen) (seed.frozen ? frozen : growing).push_back(seed.key);
    if (!growing.empty()) {
        if (ImGui::Button("Freeze", {-1, 0})) work.freeze(growing, true);
        toolTip("The plant stands as it is: neither paint nor sliders change it any more");
    }
    if (!frozen.empty()) {
        if (ImGui::Button("Thaw", {-1, 0})) work.freeze(frozen, false);
        toolTip("The plant grows again from what is there");
    }
    if (ImGui::Button("Remove  Del", {-1, 0})) {
        RemoveSeeds remove;
        for (const SeedRecord& seed : chosen) remove.keys.push_back(seed.key);
        work.perform(remove);
    }
    toolTip("The chosen seeds go, with what grew from them");
}

// One row of a seed's numbers for all that are chosen.
void chosenSeeds(Workspace& work) {
    std::vector<SeedRecord> chosen;
    for (const Seed& seed : work.scene().seeds)
        if (work.selected.count(seed.key)) chosen.push_back(work.document->recordOf(seed));
    if (chosen.empty()) {
        ImGui::TextDisabled("No seed is chosen");
        return;
    }
    if (chosen.size() == 1)
        ImGui::Text("Seed at %.2f, %.2f, %.2f", chosen[0].position[0], chosen[0].position[1], chosen[0].position[2]);
    else
        ImGui::Text("%zu seeds chosen", chosen.size());
    // Growth is read back for it: not while a seed is on its way, nor before it has grown.
    const bool settled = !work.underWay && work.grownRevision == work.document->revision();
    if (chosen.size() == 1 && settled && !ImGui::IsMouseDown(0))
        if (const auto plant = work.barren(chosen[0].key)) hint(whyBarren(work, *plant));
    uint32_t gesture = randomNumbers(work, chosen);
    if (const auto taken = chooseGrammar(work, "Grammar", chosen[0].grammar, "What grows from the chosen seeds")) {
        for (SeedRecord& seed : chosen) seed.grammar = *taken;
        gesture = work.newGesture();
    }
    if (gesture) work.changeSeeds({chosen}, gesture);
    ownValues(work, chosen);
    seedButtons(work, chosen);
}

}  // namespace

void seedsPanel(Workspace& work) {
    const auto& scene = work.scene();
    if (const auto taken = chooseGrammar(work, "Plant", work.plantGrammar, "What grows from the next seeds"))
        work.plantGrammar = *taken;
    chosenSeeds(work);
    labelledSlider("Row's step", &work.layout.rowStep, kLeastRowStep, kMostRowStep, "%.2f m", true);
    toolTip("Between two seeds of a row: Ctrl and a drag plant one");
    checkBox("A row's seeds look along it", &work.layout.rowAlong);
    toolTip("Else they look upward");
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    ImGui::BeginDisabled(scene.seeds.empty());
    if (ImGui::Button("Reseed all", {half, 0})) work.renumberSeeds();
    toolTip("Other random numbers for all seeds  (Shift+R)");
    ImGui::SameLine();
    if (ImGui::Button("Remove all", {half, 0})) {
        RemoveSeeds all;
        for (const Seed& seed : scene.seeds) all.keys.push_back(seed.key);
        work.perform(all);
    }
    toolTip("All seeds of the scene go; Ctrl+Z brings them back");
    ImGui::EndDisabled();
}

}  // namespace sample
