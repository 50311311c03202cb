// The window with a grammar's text: it compiles as it is typed, and what is wrong stands at its line.
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "sample_game/panels.hpp"
#include "sample_game/theme.hpp"

namespace sample {
namespace {

using namespace espalier::document;

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
            ImGui::PushStyleColor(ImGuiCol_Text, kBad);
            for (size_t i = 0; i < wrong.size() && i < 4; ++i) ImGui::TextWrapped("%s", wrong[i].second.c_str());
            ImGui::PopStyleColor();
        }
    }
    ImGui::End();
}

}  // namespace sample
