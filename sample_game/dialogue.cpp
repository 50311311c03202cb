// A dialogue that asks for a path: what is typed or clicked, how far what follows from it is, and what went wrong.
#include "sample_game/dialogue.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "sample_game/folder_list.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/theme.hpp"

namespace sample {

using Turn = Dialogues::Turn;

Dialogues& dialogues() {
    static Dialogues state;
    return state;
}

void ask(const char* title) {
    dialogues().open = title;
    dialogues().turn = Turn::asks;
}

void put(PathText& to, const std::string& text) {
    std::snprintf(to.data(), to.size(), "%s", text.c_str());
}

void doubt(const std::string& path, const Doubt& found) {
    dialogues().turn = Turn::confirms;
    dialogues().doubted = path;
    dialogues().why = found.why + " " + found.question;
    dialogues().yes = found.yes;
}

// Windows that appear for the first time would lie over it.
bool beginDialogue(const char* title) {
    if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return false;
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    return true;
}

namespace {

float dialogueWidth() {
    return std::min(ImGui::GetFontSize() * 32, ImGui::GetIO().DisplaySize.x - 4 * ImGui::GetStyle().WindowPadding.x);
}

// What lies in the folder of the path, to be clicked. True: what may be answered with was clicked twice.
bool showFolder(const PathQuestion& question) {
    static struct {
        std::string typed;
        double read = -1;
        std::vector<FolderEntry> entries;
    } shown;
    const std::string typed = expanded(question.path.data());
    if (shown.typed != typed || ImGui::GetTime() > shown.read + 2)
        shown = {typed, ImGui::GetTime(), listFolder(typed, question.endings)};
    bool answered = false;
    const std::string whole = wholePath(typed.substr(0, typed.rfind('/') + 1));
    say("In " + whole, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    // Rows, about, of what else the dialogue shows.
    const float others = dialogues().turn == Turn::failed || dialogues().turn == Turn::confirms ? 9 : 7;
    const float line = ImGui::GetTextLineHeightWithSpacing(), display = ImGui::GetIO().DisplaySize.y;
    const float height = std::clamp(display - others * ImGui::GetFrameHeightWithSpacing(), 3 * line, 8 * line);
    if (ImGui::BeginChild("folder", {dialogueWidth(), height}, true))
        for (const FolderEntry& entry : shown.entries) {
            const bool known = entry.kind == FolderEntry::project;
            const std::string text = known ? entry.name + "/   project" : entry.name;
            const ImGuiSelectableFlags flags =
                ImGuiSelectableFlags_AllowDoubleClick | ImGuiSelectableFlags_DontClosePopups;
            const bool taken = ImGui::Selectable(text.c_str(), entry.path == typed, flags);
            if (!entry.detail.empty()) {
                ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(entry.detail.c_str()).x);
                ImGui::TextDisabled("%s", entry.detail.c_str());
            }
            if (!taken) continue;
            const bool enters = entry.kind == FolderEntry::folder || (known && !question.projects);
            put(question.path, known && enters ? entry.path + "/" : entry.path);
            answered = !enters && ImGui::IsMouseDoubleClicked(0);
        }
    ImGui::EndChild();
    return answered;
}

void makeFolder(Workspace& work, PathText& path) {
    std::error_code failed;
    const std::string folder = wholePath(expanded(path.data()));
    std::filesystem::create_directories(folder, failed);
    if (!failed) return put(path, folder + "/");
    work.error = folder + ": can't be made: " + failed.message();
    dialogues().turn = turnOf(work, false);
}

// Whether it is told to act after all: what would go by it is asked about once for each path.
bool doubted(const PathQuestion& question, bool confirmed) {
    Dialogues& d = dialogues();
    const std::string path = expanded(question.path.data());
    // A double click on the button isn't two answers.
    const bool again = ImGui::IsMouseReleased(0) && ImGui::GetIO().MouseClickedLastCount[0] > 1;
    if (d.turn == Turn::confirms && path == d.doubted) return confirmed && !again;
    if (d.turn == Turn::confirms) d.turn = Turn::asks;
    if (!confirmed || !question.doubts || (d.turn != Turn::asks && d.turn != Turn::failed)) return confirmed;
    const Doubt found = question.doubts(path);
    if (!found.why.empty()) doubt(path, found);
    return found.why.empty();
}

// How far it is; true: it is told to act.
bool showTurn(Background& background, bool confirmed) {
    Dialogues& d = dialogues();
    if (d.turn == Turn::waits && background.slow()) {
        say(background.title());
        progressBar(background, dialogueWidth());
    }
    if (d.turn == Turn::failed) say(d.why, kBad);
    if (d.turn == Turn::confirms) say(d.why, kWarning);
    if (d.turn == Turn::acts) return true;
    if (confirmed && d.turn != Turn::waits && d.turn != Turn::done) {
        d.turn = Turn::acts;
        ImGui::TextUnformatted("One moment ...");
    }
    return false;
}

}  // namespace

void say(const std::string& text, ImVec4 colour) {
    ImGui::PushTextWrapPos(dialogueWidth());
    ImGui::TextColored(colour, "%s", text.c_str());
    ImGui::PopTextWrapPos();
}

Turn turnOf(const Workspace& work, bool good) {
    dialogues().why = work.error;
    return good ? Turn::done : Turn::failed;
}

void endWait(const Workspace& work, bool good) {
    const bool cancelled = !good && work.error.empty();
    if (dialogues().turn == Turn::waits) dialogues().turn = cancelled ? Turn::asks : turnOf(work, good);
}

void askPath(Workspace& work, Session& session, const PathQuestion& question,
             const std::function<void(const char* path)>& act) {
    Dialogues& d = dialogues();
    if (!beginDialogue(question.title)) return;
    PathText& path = question.path;
    d.asks = true;
    if (ImGui::IsWindowAppearing()) ++d.openings;
    say(question.label);
    ImGui::SetNextItemWidth(dialogueWidth());
    if (!ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();  // it is all that one can type into
    const bool waits = d.turn == Turn::waits;
    const ImGuiInputTextFlags flags = waits ? ImGuiInputTextFlags_ReadOnly : 0;
    const PathText before = path;
    ImGui::PushID(d.openings);
    bool confirmed = ImGui::InputText("##path", path.data(), path.size(), ImGuiInputTextFlags_EnterReturnsTrue | flags);
    ImGui::PopID();
    ImGui::BeginDisabled(waits);
    confirmed |= showFolder(question);
    confirmed |= ImGui::Button(d.turn == Turn::confirms ? d.yes : question.button);
    ImGui::EndDisabled();
    if (path != before && d.turn == Turn::failed) {  // what went wrong was of another path
        work.remedied(d.why);
        d.turn = Turn::asks;
    }
    confirmed = doubted(question, confirmed && path[0]);
    ImGui::SameLine();
    if (question.doubts && !waits) {
        if (ImGui::Button("New folder")) makeFolder(work, path);
        toolTip("Makes the folder that is typed, and goes into it");
        ImGui::SameLine();
    }
    const bool cancelled = ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (showTurn(session.background(), confirmed)) {
        work.error.clear();
        d.turn = Turn::waits;
        act(expanded(path.data()).c_str());
    }
    if (cancelled && waits) {
        session.background().cancelLast();
    } else if (cancelled || d.turn == Turn::done) {
        if (cancelled) d.next.reset();
        if (cancelled && d.turn == Turn::failed)
            work.remedied(d.why);  // it was read here, and nobody wants it any more
        d.asks = false;
        d.turn = Turn::asks;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

}  // namespace sample
