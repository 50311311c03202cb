// A slider, check box or colour for every parameter of every grammar, its presets, and the window with its text.
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "sample_game/panels.hpp"
#include "sample_game/settings.hpp"
#include "sample_game/theme.hpp"

namespace sample {
namespace {

using namespace espalier::document;

const ImVec4 kErrorColour{1, .55f, .45f, 1};

float encodeSrgb(float v) {
    return v <= .0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - .055f;
}
float decodeSrgb(float v) {
    return v <= .04045f ? v / 12.92f : std::pow((v + .055f) / 1.055f, 2.4f);
}

// "%.2f m": as many digits as the range asks for; a unit may hold a percent sign.
std::string formatOf(const EspParamInfo& param) {
    const float range = std::max(std::abs(param.low), std::abs(param.high));
    const int digits = param.kind == ESP_PARAM_INT ? 0
                       : range < .1f               ? 4
                       : range < 1.5f              ? 3
                       : range < 15                ? 2
                       : range < 150               ? 1
                                                   : 0;
    std::string format = param.low > 0 && param.high / param.low > 200 ? "%.3g" : "%." + std::to_string(digits) + "f";
    if (param.unit[0]) format += " ";
    for (const char* c = param.unit; *c; ++c) format += *c == '%' ? std::string("%%") : std::string(1, *c);
    return format;
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
        const bool changed = ImGui::Checkbox(param.label, &on);
        ImGui::PopItemFlag();
        value[0] = on;
        return changed;
    }
    if (param.kind == ESP_PARAM_COLOUR) {
        float shown[3];
        for (int i = 0; i < 3; ++i) shown[i] = encodeSrgb(value[i]);
        // As the grammar's text writes it; a click on the field at its end opens the picker.
        if (!ImGui::ColorEdit3("##value", shown, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_DisplayHex))
            return false;
        for (int i = 0; i < 3; ++i) value[i] = decodeSrgb(shown[i]);
        return true;
    }
    // Ranges over several decades, such as 0.02 to 20, get a slider by ratio.
    const bool wide = param.low > 0 && param.high / param.low > 200;
    return slider("##value", value, param.low, param.high, several ? "several" : formatOf(param).c_str(), wide);
}

namespace {

void paramRow(Workspace& work, uint32_t grammar, const EspParamInfo& param) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing,
                        {ImGui::GetStyle().ItemSpacing.x, ImGui::GetStyle().ItemSpacing.y / 3});
    if (param.kind != ESP_PARAM_BOOL) ImGui::TextUnformatted(param.label);
    ImGui::PopStyleVar();
    const float button = ImGui::GetFrameHeight();
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x);
    float value[3];
    std::memcpy(value, param.value, sizeof value);
    bool changed = editParam(param, value);
    uint32_t gesture = changed ? widgetGesture(work) : 0;
    const bool number = param.kind == ESP_PARAM_FLOAT || param.kind == ESP_PARAM_INT;
    toolTip((param.name + std::string(number ? "\nDouble click or Ctrl+click to type a value" : "")).c_str());
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

std::vector<Param> values(const Workspace& work, EspGrammar grammar) {
    std::vector<Param> all;
    for (uint32_t i = 0; i < espParamCount(work.context.get(), grammar); ++i) {
        EspParamInfo info;
        if (espParamInfo(work.context.get(), grammar, i, &info) == ESP_OK)
            all.push_back({info.name, {info.value, info.value + (info.kind == ESP_PARAM_COLOUR ? 3 : 1)}});
    }
    return all;
}

void presets(Workspace& work, uint32_t index) {
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

// Of "file:line:column: rule: message" lines, those of this file by their line.
std::vector<std::pair<int, std::string>> mistakes(const espalier::scene::LoadedGrammar& grammar) {
    std::vector<std::pair<int, std::string>> found;
    std::istringstream lines(grammar.error);
    for (std::string line; std::getline(lines, line);) {
        int number = 0;
        std::string text = line;
        if (line.rfind(grammar.file + ":", 0) == 0) {
            const std::string rest = line.substr(grammar.file.size() + 1);
            number = std::atoi(rest.c_str());
            text = "line " + rest;
        }
        found.push_back({number, text});
    }
    return found;
}

struct TextState {
    std::string shown;                     // what the widget holds
    const std::string* outside = nullptr;  // what it is to hold instead
    int cursorLine = 0, scrolledLine = -1;
    float cursorX = 0, scrolledX = -1;  // within the line
    float changedAt = -1e9f;
    uint32_t gesture = 0;
};

int onEdit(ImGuiInputTextCallbackData* data) {
    auto& state = *static_cast<TextState*>(data->UserData);
    if (data->EventFlag == ImGuiInputTextFlags_CallbackResize) {
        state.shown.resize(size_t(data->BufTextLen));
        data->Buf = state.shown.data();
    } else {
        if (state.outside) {
            // The cursor stays where it is, or with what stands behind the change.
            const std::string& now = *state.outside;
            const auto change = std::mismatch(now.begin(), now.end(), data->Buf, data->Buf + data->BufTextLen).first;
            const int before = int(change - now.begin()), cursor = data->CursorPos;
            const int moved = std::max(before, cursor + int(now.size()) - data->BufTextLen);
            data->DeleteChars(0, data->BufTextLen);
            data->InsertChars(0, state.outside->c_str());
            data->CursorPos = cursor <= before ? cursor : moved;
            data->ClearSelection();
        }
        const char *text = data->Buf, *cursor = text + data->CursorPos, *begin = cursor;
        while (begin > text && begin[-1] != '\n') --begin;
        state.cursorLine = int(std::count(text, cursor, '\n'));
        state.cursorX = ImGui::CalcTextSize(begin, cursor).x;
    }
    return 0;
}

// The document's undo, in the text as everywhere: the widget has none of its own.
void takeUndoKeys(Workspace& work, TextState& state) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!io.KeyCtrl) return;
    const bool z = ImGui::IsKeyPressedMap(ImGuiKey_Z), y = ImGui::IsKeyPressedMap(ImGuiKey_Y);
    if (z && !io.KeyShift && work.document->undoName()) work.perform(Undo{});
    if ((y || (z && io.KeyShift)) && work.document->redoName()) work.perform(Redo{});
    if (z || y) state.gesture = 0;  // what is typed next is a step of its own
}

void lineNumbers(int lines, const std::vector<std::pair<int, std::string>>& wrong, float width, float height) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float line = ImGui::GetFontSize(), pad = ImGui::GetStyle().FramePadding.y;
    for (int i = 1; i <= lines; ++i) {
        const auto found = std::find_if(wrong.begin(), wrong.end(), [&](const auto& w) { return w.first == i; });
        const std::string text = std::to_string(i);
        const ImVec2 place{at.x + width - ImGui::CalcTextSize(text.c_str()).x - 6, at.y + pad + line * float(i - 1)};
        if (found != wrong.end()) {
            list.AddRectFilled({at.x, place.y}, {at.x + width - 2, place.y + line}, IM_COL32(150, 40, 30, 255), 2);
            if (ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows |
                                       ImGuiHoveredFlags_AllowWhenBlockedByActiveItem) &&
                ImGui::IsMouseHoveringRect({at.x, place.y}, {at.x + width, place.y + line}))
                ImGui::SetTooltip("%s", found->second.c_str());
        }
        list.AddText(place, ImGui::GetColorU32(found != wrong.end() ? ImGuiCol_Text : ImGuiCol_TextDisabled),
                     text.c_str());
    }
    ImGui::Dummy({width, height});
}

}  // namespace

void grammarsPanel(Workspace& work) {
    for (uint32_t i = 0; i < work.scene().grammars.size(); ++i) {
        const auto& grammar = work.scene().grammars[i];
        ImGui::PushID(int(i));
        if (ImGui::CollapsingHeader(grammarName(work.scene(), i).c_str(),
                                    i == 0 ? ImGuiTreeNodeFlags_DefaultOpen : 0)) {
            const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
            if (ImGui::Button("Text  F4", {half, 0})) {
                work.layout.grammar = !work.layout.grammar || work.openGrammar != i;
                work.openGrammar = i;
            }
            toolTip("Edit the grammar: the plant follows as you type");
            ImGui::SameLine();
            presets(work, i);
            if (!grammar.error.empty()) {
                ImGui::PushStyleColor(ImGuiCol_Text, kErrorColour);
                ImGui::TextWrapped("The text has mistakes; what grew last goes on growing.");
                ImGui::PopStyleColor();
            }
            for (uint32_t p = 0; p < espParamCount(work.context.get(), grammar.id); ++p) {
                EspParamInfo info;
                if (espParamInfo(work.context.get(), grammar.id, p, &info) != ESP_OK) continue;
                ImGui::PushID(int(p));
                paramRow(work, i, info);
                ImGui::PopID();
            }
        }
        ImGui::PopID();
    }
}

void showGrammarWindow(Workspace& work) {
    if (!work.layout.grammar || work.scene().grammars.empty()) return;
    static TextState state;
    work.openGrammar = std::min(work.openGrammar, uint32_t(work.scene().grammars.size() - 1));
    const auto& grammar = work.scene().grammars[work.openGrammar];
    const float s = work.scale;
    const std::string title = grammarName(work.scene(), work.openGrammar) + "###grammar";
    if (beginWindow(work, title.c_str(), &work.layout.grammar, {work.window.x - 600 * s, 60 * s}, {580 * s, 520 * s})) {
        const auto wrong = mistakes(grammar);
        // Undo and files change the text from outside, also while the cursor is in it: the widget has a copy then.
        const std::string outside = grammar.text;
        state.outside = state.shown != outside ? &outside : nullptr;
        state.shown = outside;
        const int lines = 1 + int(std::count(state.shown.begin(), state.shown.end(), '\n'));
        const float below =
            ImGui::GetFontSize() * (1.6f + (wrong.empty() ? 0 : 1.4f * float(std::min<size_t>(wrong.size(), 4))));
        ImGui::PushFont(textFont());
        const float line = ImGui::GetFontSize();
        const float height = line * float(lines + 1) + 2 * ImGui::GetStyle().FramePadding.y;
        if (ImGui::BeginChild("text", {0, -below}, false, ImGuiWindowFlags_HorizontalScrollbar)) {
            const float margin = ImGui::CalcTextSize("0000").x + 8;
            const float whole = ImGui::CalcTextSize(state.shown.c_str()).x + 2 * line;
            lineNumbers(lines, wrong, margin, height);
            ImGui::SameLine(0, 0);
            const ImGuiInputTextFlags flags = ImGuiInputTextFlags_AllowTabInput | ImGuiInputTextFlags_CallbackResize |
                                              ImGuiInputTextFlags_CallbackAlways | ImGuiInputTextFlags_NoUndoRedo;
            ImGui::PushID(int(work.openGrammar));
            const bool changed = ImGui::InputTextMultiline("##grammar", state.shown.data(), state.shown.size() + 1,
                                                           {std::max(whole, ImGui::GetContentRegionAvail().x), height},
                                                           flags, onEdit, &state);
            ImGui::PopID();
            if (ImGui::IsItemActive() && (state.cursorLine != state.scrolledLine || state.cursorX != state.scrolledX)) {
                state.scrolledLine = state.cursorLine;
                state.scrolledX = state.cursorX;
                const float y = line * float(state.cursorLine), high = ImGui::GetWindowHeight() - line;
                if (y < ImGui::GetScrollY()) ImGui::SetScrollY(y);
                if (y + 2 * line > ImGui::GetScrollY() + high) ImGui::SetScrollY(y + 2 * line - high);
                const float x = margin + state.cursorX, wide = ImGui::GetWindowWidth() - line;
                if (state.cursorX < ImGui::GetScrollX()) ImGui::SetScrollX(state.cursorX);
                if (x + 2 * line > ImGui::GetScrollX() + wide) ImGui::SetScrollX(x + 2 * line - wide);
            }
            // Escape leaves the text. ImGui would take back all that was typed since it was clicked at.
            const bool left = ImGui::IsItemDeactivated() && ImGui::IsKeyPressedMap(ImGuiKey_Escape);
            if (ImGui::IsItemActive()) takeUndoKeys(work, state);
            if (changed && !left && state.shown != grammar.text) {
                // A pause ends a step of undo.
                if (ImGui::GetTime() - state.changedAt > 1.5 || !state.gesture) state.gesture = work.newGesture();
                state.changedAt = float(ImGui::GetTime());
                work.perform(work.document->withText(work.openGrammar, state.shown), state.gesture);
            }
        }
        ImGui::EndChild();
        ImGui::PopFont();
        if (wrong.empty()) {
            ImGui::TextDisabled("It compiles. %d lines, %s", lines,
                                std::filesystem::path(grammar.file).filename().c_str());
            toolTip(grammar.file.c_str());
        } else {
            ImGui::PushStyleColor(ImGuiCol_Text, kErrorColour);
            for (size_t i = 0; i < wrong.size() && i < 4; ++i) ImGui::TextWrapped("%s", wrong[i].second.c_str());
            ImGui::PopStyleColor();
        }
    }
    ImGui::End();
}

}  // namespace sample
