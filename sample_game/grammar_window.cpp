// The window with a grammar's text: it compiles as it is typed, and what is wrong stands at its line.
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "sample_game/grammar_colours.hpp"
#include "sample_game/grammar_files.hpp"
#include "sample_game/grammar_offer.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/remarks.hpp"
#include "sample_game/theme.hpp"

namespace sample {
namespace {

using namespace espalier::document;

struct TextState {
    std::string shown;                     // what the widget holds
    const std::string* outside = nullptr;  // what it is to hold instead
    int cursorLine = 0, scrolledLine = -1;
    float cursorX = 0, scrolledX = -1;  // within the line
    int foundLine = 0;                  // by the field above the text; from 1
    int wantedLine = 0;                 // is to be seen; from 1, 0: none
    bool wanted = false;                // the cursor is to be in it
    float changedAt = -1e9f;
    uint32_t gesture = 0;
    size_t cursor = 0;  // bytes before it
    Offer offer;
};

int onEdit(ImGuiInputTextCallbackData* data) {
    auto& state = *static_cast<TextState*>(data->UserData);
    if (data->EventFlag == ImGuiInputTextFlags_CallbackResize) {
        state.shown.resize(size_t(data->BufTextLen));
        data->Buf = state.shown.data();
    } else if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion) {
        state.offer.take(*data);
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
        state.cursor = size_t(data->CursorPos);
        state.cursorLine = int(std::count(text, cursor, '\n'));
        state.cursorX = ImGui::CalcTextSize(begin, cursor).x;
    }
    return 0;
}

// The document's undo, since the widget has none of its own; but only of texts: who types doesn't look at the scene.
void takeUndoKeys(Workspace& work, TextState& state) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!io.KeyCtrl) return;
    const bool z = ImGui::IsKeyPressedMap(ImGuiKey_Z), y = ImGui::IsKeyPressedMap(ImGuiKey_Y);
    if (!z && !y) return;
    state.gesture = 0;  // what is typed next is a step of its own
    const bool back = z && !io.KeyShift;
    const char* step = back ? work.document->undoName() : work.document->redoName();
    if (step && std::string(step).starts_with(kEditText))
        back ? work.perform(Undo{}) : work.perform(Redo{});
    else
        work.say(std::string(back ? "Nothing more of the text to undo" : "Nothing of the text to redo") +
                 (step ? std::string("; outside it: ") + step : ""));
}

constexpr ImU32 kBadLine = IM_COL32(150, 40, 30, 255), kWarningLine = IM_COL32(125, 90, 15, 255);

// Beside the text, which they are scrolled with up and down, not sideways.
void lineNumbers(int lines, const std::vector<Remark>& remarks, ImVec2 place, ImVec2 size, float scrolled) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 end{place.x + size.x, place.y + size.y}, at{place.x, place.y - scrolled};
    const bool hovered = ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem) &&
                         ImGui::IsMouseHoveringRect(place, end);
    ImGui::PushClipRect(place, end, true);
    const float line = ImGui::GetFontSize(), pad = ImGui::GetStyle().FramePadding.y;
    for (int i = 1; i <= lines; ++i) {
        const auto found = std::ranges::find(remarks, i, &Remark::line);  // a mistake, if there is one
        const std::string text = std::to_string(i);
        const ImVec2 from{end.x - ImGui::CalcTextSize(text.c_str()).x - 6, at.y + pad + line * float(i - 1)};
        if (found != remarks.end()) {
            list.AddRectFilled({at.x, from.y}, {end.x - 2, from.y + line}, found->warning ? kWarningLine : kBadLine, 2);
            if (hovered && ImGui::IsMouseHoveringRect({at.x, from.y}, {end.x, from.y + line})) tip(found->text.c_str());
        }
        list.AddText(from, ImGui::GetColorU32(found != remarks.end() ? ImGuiCol_Text : ImGuiCol_TextDisabled),
                     text.c_str());
    }
    ImGui::PopClipRect();
}

// Return goes to the next line that holds what is typed.
void findField(Workspace& work, const std::string& text, TextState& state) {
    static char wanted[64] = "";
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputTextWithHint("##findText", "Find", wanted, sizeof wanted, ImGuiInputTextFlags_EnterReturnsTrue)) {
        const int line = findLine(text, wanted, state.foundLine);
        if (line > 0)
            state.wantedLine = state.foundLine = line;
        else if (wanted[0])
            work.say(std::string("Not in the text: ") + wanted);
        ImGui::SetKeyboardFocusHere(-1);  // for the next one
    }
    toolTip("Return goes to the next line that holds this");
}

// Above the text: its way to the file and back.
void fileRow(Workspace& work, const std::string& file, const std::string* inFile, TextState& state) {
    const auto& grammar = work.scene().grammars[work.openGrammar];
    ImGui::BeginDisabled(inFile && sameText(*inFile, grammar.text));
    if (ImGui::Button("Write to file") && writeGrammar(grammar.file, grammar.text, work.error)) {
        work.written = {work.openGrammar, grammar.text};
        work.error.clear();  // an earlier try's
        work.message = "Written, which undo doesn't take back: " + grammar.file;
    }
    toolTip(("For all scenes with this grammar: " + grammar.file +
             "\nUndo leaves files alone: it goes back to what was typed, and another click writes that")
                .c_str());
    ImGui::SameLine();
    ImGui::BeginDisabled(!inFile);
    if (ImGui::Button("Take from file") && inFile &&
        work.perform(work.document->withText(work.openGrammar, *inFile), work.newGesture()))
        work.message = "Read again: " + file + "; Ctrl+Z brings back what was typed here";
    toolTip("Gives up what was typed here");
    ImGui::EndDisabled();
    ImGui::EndDisabled();
    findField(work, grammar.text, state);
}

// Below the text: whether it compiles, and what is to be said of it; a click on that goes to its line.
void showRemarks(const espalier::scene::LoadedGrammar& grammar, const std::vector<Remark>& remarks, int lines,
                 TextState& state) {
    const std::string file = std::filesystem::path(grammar.file).filename().string();
    if (!grammar.error.empty())
        ImGui::TextColored(kBad, "It has mistakes; what grew last goes on growing.");
    else
        ImGui::TextDisabled("It compiles. %d lines, %s", lines, file.c_str());
    toolTip(grammar.file.c_str());
    if (remarks.empty()) return;
    ImGui::BeginChild("remarks");
    for (const Remark& remark : remarks) {
        ImGui::PushStyleColor(ImGuiCol_Text, remark.warning ? kWarning : kBad);
        ImGui::TextWrapped("%s", remark.text.c_str());
        ImGui::PopStyleColor();
        if (remark.line > 0 && ImGui::IsItemClicked()) state.wantedLine = remark.line;
    }
    ImGui::EndChild();
}

bool focused = false;

// Of the text's own window, which scrolls: where the cursor has gone is seen.
void followCursor(TextState& state, float line) {
    if (state.cursorLine == state.scrolledLine && state.cursorX == state.scrolledX) return;
    state.scrolledLine = state.cursorLine;
    state.scrolledX = state.cursorX;
    const float y = line * float(state.cursorLine), high = ImGui::GetWindowHeight() - line;
    if (y < ImGui::GetScrollY()) ImGui::SetScrollY(y);
    if (y + 2 * line > ImGui::GetScrollY() + high) ImGui::SetScrollY(y + 2 * line - high);
    const float x = state.cursorX, wide = ImGui::GetWindowWidth() - line;
    if (x < ImGui::GetScrollX()) ImGui::SetScrollX(x);
    if (x + 2 * line > ImGui::GetScrollX() + wide) ImGui::SetScrollX(x + 2 * line - wide);
}

ImU32 colourOf(TokenKind kind) {
    switch (kind) {
        case TokenKind::comment:
            return ImGui::GetColorU32(ImGuiCol_TextDisabled);
        case TokenKind::word:
            return ImGui::GetColorU32(kGood);
        case TokenKind::name:
            return IM_COL32(240, 214, 140, 255);
        case TokenKind::number:
            return IM_COL32(150, 200, 245, 255);
        case TokenKind::text:
            return IM_COL32(240, 165, 115, 255);
        case TokenKind::plain:
            break;
    }
    return ImGui::GetColorU32(ImGuiCol_Text);
}

// Below the widget, which lets its own letters and cursor through to these: ImGui's are of one colour.
void drawText(const TextState& state, ImVec2 at, ImVec2 size, bool typing) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg));
    const float high = ImGui::GetFontSize(), left = at.x + ImGui::GetStyle().FramePadding.x;
    float y = at.y + ImGui::GetStyle().FramePadding.y;
    const float cursorY = y + high * float(state.cursorLine);
    const ImVec2 low = list.GetClipRectMin(), top = list.GetClipRectMax();
    bool inComment = false;
    const std::string_view text = state.shown;
    for (size_t begin = 0; begin < text.size() && y < top.y; y += high) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view line = text.substr(begin, end - begin);
        begin = end + 1;
        const std::vector<Token> tokens = tokensOf(line, inComment);  // also of lines that aren't seen: remarks go on
        if (y + high < low.y) continue;
        for (const Token& token : tokens) {
            const char* from = line.data() + token.begin;
            const float x = left + ImGui::CalcTextSize(line.data(), from).x;
            list.AddText({x, y}, colourOf(token.kind), from, from + token.length);
        }
    }
    const bool lit = std::fmod(ImGui::GetTime(), 1.2) < .8;
    if (typing && lit)
        list.AddLine({left + state.cursorX, cursorY}, {left + state.cursorX, cursorY + high},
                     ImGui::GetColorU32(ImGuiCol_Text));
}

// The text that is shown becomes the grammar's as it is typed.
void editText(Workspace& work, int lines, TextState& state) {
    const auto& grammar = work.scene().grammars[work.openGrammar];
    const float line = ImGui::GetFontSize();
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const ImVec2 size{std::max(ImGui::CalcTextSize(state.shown.c_str()).x + 2 * line, room.x),
                      std::max(line * float(lines + 1) + 2 * ImGui::GetStyle().FramePadding.y, room.y)};
    if (state.wantedLine) ImGui::SetScrollY(line * float(std::max(0, std::exchange(state.wantedLine, 0) - 3)));
    const ImGuiInputTextFlags tab =
        state.offer.open() ? ImGuiInputTextFlags_CallbackCompletion : ImGuiInputTextFlags_AllowTabInput;
    const ImGuiInputTextFlags flags =
        tab | ImGuiInputTextFlags_CallbackResize | ImGuiInputTextFlags_CallbackAlways | ImGuiInputTextFlags_NoUndoRedo;
    ImGui::PushID(int(work.openGrammar));
    if (std::exchange(state.wanted, false)) {  // as SetKeyboardFocusHere, which would also scroll to the top
        ImGuiContext& gui = *ImGui::GetCurrentContext();
        gui.NavNextActivateId = ImGui::GetID("##grammar");
        gui.NavNextActivateFlags = ImGuiActivateFlags_PreferInput | ImGuiActivateFlags_TryToPreserveState;
    }
    const ImGuiContext& gui = *ImGui::GetCurrentContext();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    drawText(state, at, size, gui.ActiveId != 0 && gui.ActiveId == ImGui::GetID("##grammar"));
    const ImVec4 none{0, 0, 0, 0};
    ImGui::PushStyleColor(ImGuiCol_Text, none);
    ImGui::PushStyleColor(ImGuiCol_FrameBg, none);
    const bool changed =
        ImGui::InputTextMultiline("##grammar", state.shown.data(), state.shown.size() + 1, size, flags, onEdit, &state);
    ImGui::PopStyleColor(2);
    ImGui::PopID();
    state.offer.follow(work, state.shown, state.cursor, ImGui::IsItemActive(), changed && !state.outside);
    const ImVec2 pad = ImGui::GetStyle().FramePadding;
    state.offer.draw(work, {at.x + pad.x + state.cursorX, at.y + pad.y + line * float(state.cursorLine + 1)});
    if (ImGui::IsItemActive()) followCursor(state, line);
    if (ImGui::IsItemActive()) takeUndoKeys(work, state);
    // Escape leaves the text. ImGui would take back all that was typed since it was clicked at.
    const bool left = ImGui::IsItemDeactivated() && ImGui::IsKeyPressedMap(ImGuiKey_Escape);
    if (left) work.message = "Esc again: letters are keys of the tools";
    if (!changed || left || state.shown == grammar.text) return;
    // A pause ends a step of undo.
    if (ImGui::GetTime() - state.changedAt > 1.5 || !state.gesture) state.gesture = work.newGesture();
    state.changedAt = float(ImGui::GetTime());
    work.perform(work.document->withText(work.openGrammar, state.shown), state.gesture);
}

// below: how much of the window's height stays free.
void showText(Workspace& work, const std::vector<Remark>& remarks, int lines, float below, TextState& state) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    // As high as the text's window, which ImGui makes no lower.
    const ImVec2 size{ImGui::CalcTextSize("0000").x + 8, std::max(4.f, ImGui::GetContentRegionAvail().y - below)};
    float scrolled = 0, bar = 0;  // below the text, to scroll it sideways
    // A click at the numbers is meant for the text.
    state.wanted |= ImGui::InvisibleButton("numbers", size);
    ImGui::SameLine(0, 0);
    if (ImGui::BeginChild("text", {0, -below}, false, ImGuiWindowFlags_HorizontalScrollbar)) {
        editText(work, lines, state);
        scrolled = ImGui::GetScrollY();
        bar = ImGui::GetCurrentWindow()->ScrollbarSizes.y;
    }
    ImGui::EndChild();
    lineNumbers(lines, remarks, at, {size.x, size.y - bar}, scrolled);
}

}  // namespace

bool grammarFocused() {
    return focused;
}

void leaveGrammar() {
    focused = false;
    ImGui::SetWindowFocus(nullptr);
}

void showGrammarWindow(Workspace& work) {
    focused = false;
    if (!work.layout.grammar || work.scene().grammars.empty()) return;
    static TextState state;
    work.openGrammar = std::min(work.openGrammar, uint32_t(work.scene().grammars.size() - 1));
    const auto& grammar = work.scene().grammars[work.openGrammar];
    const float s = work.scale;
    static FileText files;
    const std::string file = std::filesystem::path(grammar.file).filename().string();
    const std::string* inFile = files.of(grammar.file);
    const bool differs = !inFile || !sameText(*inFile, grammar.text);
    const std::string title =
        grammarName(work.scene(), work.openGrammar) + (differs ? "   differs from " + file : "") + "###grammar";
    if (beginWindow(work, title.c_str(), &work.layout.grammar, {work.window.x - 600 * s, 60 * s}, {580 * s, 520 * s})) {
        focused = ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows);
        fileRow(work, file, inFile, state);
        const std::vector<Remark> remarks = remarksOf(grammar);
        // Undo and files change the text from outside, also while the cursor is in it: the widget has a copy then.
        const std::string outside = grammar.text;
        state.outside = state.shown != outside ? &outside : nullptr;
        state.shown = outside;
        const int lines = 1 + int(std::count(state.shown.begin(), state.shown.end(), '\n'));
        const float shown = 1.4f * float(std::min<size_t>(remarks.size(), 4));  // more are scrolled to
        const float below = ImGui::GetFontSize() * (1.6f + shown);
        ImGui::PushFont(textFont());
        showText(work, remarks, lines, below, state);
        ImGui::PopFont();
        showRemarks(grammar, remarks, lines, state);
    }
    ImGui::End();
}

}  // namespace sample
