// A slider, check box or colour for every parameter of every grammar.
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <utility>
#include <vector>

#include "sample_game/panels.hpp"
#include "sample_game/theme.hpp"
#include "tools/scene/param_words.hpp"

namespace sample {
namespace {

using namespace espalier::document;
using espalier::scene::paramWords;

// "%.2f m": as many digits as the range asks for; a unit may hold a percent sign.
std::string formatOf(const EspParamInfo& param) {
    const float range = std::max(std::abs(param.low), std::abs(param.high));
    const int digits = range < .1f ? 4 : range < 1.5f ? 3 : range < 15 ? 2 : range < 150 ? 1 : 0;
    std::string format = param.low > 0 && param.high / param.low > 200 ? "%.3g" : "%." + std::to_string(digits) + "f";
    if (param.unit[0]) format += " ";
    for (const char* c = param.unit; *c; ++c) format += *c == '%' ? std::string("%%") : std::string(1, *c);
    return format;
}

// What its label tells, its name in the text, and what is no matter of course about its slider.
std::string paramTip(const EspParamInfo& param) {
    const std::string tip = paramWords(param.label).tip, first = tip.empty() ? "" : tip + "\n";
    if (param.kind != ESP_PARAM_FLOAT) return first + param.name;
    char text[200];
    std::snprintf(text, sizeof text,
                  "%s in the grammar's text: %.4g to %.4g%s%s, there %.4g\nDouble click or Ctrl+click to type a value",
                  param.name, param.low, param.high, param.unit[0] ? " " : "", param.unit, param.initial[0]);
    return first + text;
}

bool isInitial(const EspParamInfo& param) {
    const int count = param.kind == ESP_PARAM_COLOUR ? 3 : 1;
    for (int i = 0; i < count; ++i)
        if (std::abs(param.value[i] - param.initial[i]) > 1e-6f * std::max(1.f, std::abs(param.initial[i])))
            return false;
    return true;
}

}  // namespace

bool editParam(const EspParamInfo& param, float* value, bool several) {
    if (param.kind == ESP_PARAM_BOOL) {
        bool on = value[0] != 0;
        ImGui::PushItemFlag(ImGuiItemFlags_MixedValue, several);
        const bool changed = checkBox(paramWords(param.label).name.c_str(), &on);
        ImGui::PopItemFlag();
        value[0] = on;
        return changed;
    }
    if (param.kind == ESP_PARAM_COLOUR) return editColour("##value", value);
    // Ranges over several decades, such as 0.02 to 20, get a slider by ratio.
    const bool wide = param.low > 0 && param.high / param.low > 200;
    return slider("##value", value, param.low, param.high, several ? "several" : formatOf(param).c_str(), wide);
}

namespace {

void paramRow(Workspace& work, uint32_t grammar, const EspParamInfo& param) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing,
                        {ImGui::GetStyle().ItemSpacing.x, ImGui::GetStyle().ItemSpacing.y / 3});
    if (param.kind != ESP_PARAM_BOOL) label(paramWords(param.label).name.c_str());
    ImGui::PopStyleVar();
    const float button = ImGui::GetFrameHeight();
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x);
    float value[3];
    std::memcpy(value, param.value, sizeof value);
    bool changed = editParam(param, value);
    uint32_t gesture = changed ? widgetGesture(work) : 0;
    toolTip(paramTip(param).c_str());
    if (!isInitial(param)) {
        ImGui::SameLine();
        if (ImGui::Button("\u21ba", {button, button})) {
            std::memcpy(value, param.initial, sizeof value);
            changed = true;
            gesture = 0;
        }
        toolTip("Back to the grammar's own value");
    }
    const int count = param.kind == ESP_PARAM_COLOUR ? 3 : 1;
    if (changed) work.perform(SetParam{grammar, {param.name, {value, value + count}}}, gesture);
}

bool makesRoofs(const Workspace& work, uint32_t index) {
    EspGrammar town{};
    return work.town() && espTownGrammar(work.context.get(), &town) == ESP_OK &&
           town.id == work.scene().grammars[index].id.id;
}

// Where a grammar comes from and what grows by it.
std::string grammarTip(const Workspace& work, uint32_t index) {
    const auto& grammar = work.scene().grammars[index];
    const auto seeds = std::ranges::count(work.scene().seeds, index, &espalier::scene::Seed::grammar);
    return grammar.file + "\n" +
           (makesRoofs(work, index) ? "The town's houses are built by it"
            : seeds == 1            ? "One seed grows by it"
                                    : std::to_string(seeds) + " seeds grow by it") +
           "; values set here are for these alone";
}

// What is typed into the field above the parameters; those that hold its words are shown.
std::string& wantedParams() {
    static std::string wanted;
    return wanted;
}

void searchField() {
    char text[64];
    std::snprintf(text, sizeof text, "%s", wantedParams().c_str());
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    if (ImGui::InputTextWithHint("##find", "Find a value", text, sizeof text)) wantedParams() = text;
    toolTip("Shows only values with these words in their name, group or tip");
}

// By groups, in the order in which the text begins them; first those without one.
void paramRows(Workspace& work, uint32_t grammar) {
    const EspGrammar id = work.scene().grammars[grammar].id;
    std::vector<std::pair<std::string, std::vector<EspParamInfo>>> groups{{"", {}}};
    for (uint32_t p = 0; p < espParamCount(work.context.get(), id); ++p) {
        EspParamInfo info;
        if (espParamInfo(work.context.get(), id, p, &info) != ESP_OK) continue;
        if (!espalier::scene::holdsWords(std::string(info.label) + " " + info.name, wantedParams())) continue;
        const std::string group = paramWords(info.label).group;
        auto place = std::ranges::find(groups, group, [](const auto& known) { return known.first; });
        if (place == groups.end()) place = groups.insert(place, {group, {}});
        place->second.push_back(info);
    }
    for (const auto& [group, params] : groups) {
        if (!group.empty()) ImGui::TextColored(kGood, "%s", group.c_str());
        for (const EspParamInfo& info : params) {
            ImGui::PushID(info.name);  // what is typed stays this one's where a text gets others before it
            paramRow(work, grammar, info);
            ImGui::PopID();
        }
    }
}

}  // namespace

void grammarsPanel(Workspace& work) {
    if (!work.scene().grammars.empty()) searchField();
    // Beside the tool for houses what they are made by comes first, and is open.
    const bool houses = work.tool == Tool::houses;
    std::vector<uint32_t> order(work.scene().grammars.size());
    std::iota(order.begin(), order.end(), 0u);
    if (houses) std::stable_partition(order.begin(), order.end(), [&](uint32_t i) { return makesRoofs(work, i); });
    std::vector<uint32_t> shown;
    for (uint32_t i : order) {
        const auto& grammar = work.scene().grammars[i];
        ImGui::PushID(houses ? -1 - int(i) : int(i));
        const std::string name = grammarName(work.scene(), i);
        const float room = ImGui::GetContentRegionAvail().x - 2 * ImGui::GetFontSize();  // beside the arrow
        const bool open = ImGui::CollapsingHeader((shortened(name, room) + "###" + name).c_str(),
                                                  i == order.front() ? ImGuiTreeNodeFlags_DefaultOpen : 0);
        toolTip(grammarTip(work, i).c_str());
        if (open) {
            shown.push_back(i);
            const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
            if (ImGui::Button(i == work.shownGrammar ? "Text  F4###text" : "Text###text", {half, 0}))
                work.showGrammar(!work.layout.grammar || work.openGrammar != i, i);
            toolTip("Edit the grammar: what grows by it follows as you type");
            ImGui::SameLine();
            presetsPanel(work, i);
            if (!grammar.error.empty()) {
                ImGui::PushStyleColor(ImGuiCol_Text, kBad);
                ImGui::TextWrapped("The text has mistakes; what grew last goes on growing.");
                ImGui::PopStyleColor();
            }
            if (!grammar.warnings.empty()) {
                hint("The text has warnings: click to see them");
                if (ImGui::IsItemClicked()) work.showGrammar(true, i);
            }
            paramRows(work, i);
            looksPanel(work, i);
        }
        ImGui::PopID();
    }
    const bool known = shown.empty() || std::ranges::find(shown, work.openGrammar) != shown.end();
    work.shownGrammar = known ? work.openGrammar : shown.front();
}

}  // namespace sample
