// What menus and keys ask: which dialogue is open, and whose the keys are meanwhile.
#include <imgui.h>
#include <imgui_internal.h>

#include <filesystem>

#include "sample_game/dialogue.hpp"
#include "sample_game/folder_list.hpp"
#include "sample_game/panels.hpp"

namespace sample {

using Turn = Dialogues::Turn;

bool dialogueAsked() {
    return dialogues().open != nullptr;
}

void closeDialogues() {
    dialogues().open = nullptr;
    dialogues().asks = false;
    if (dialogues().turn != Turn::waits) dialogues().turn = Turn::asks;
    dialogues().next.reset();
    if (!ImGui::GetCurrentContext()->OpenPopupStack.empty()) ImGui::ClosePopupToLevel(0, false);
}

bool awaitsText() {
    const Dialogues& d = dialogues();
    return d.turn == Turn::acts || d.turn == Turn::waits || ((d.open || d.asks) && !ImGui::GetIO().WantTextInput);
}

bool dialogueWaits() {
    return dialogues().turn == Turn::waits;
}

bool usesPanels() {
    const ImGuiContext& gui = *ImGui::GetCurrentContext();
    return dialogueAsked() || !gui.OpenPopupStack.empty() || (ImGui::IsAnyItemActive() && ImGui::GetIO().WantTextInput);
}

bool closeMenus() {
    const auto& open = ImGui::GetCurrentContext()->OpenPopupStack;
    int level = open.Size;
    while (level > 0 && open[level - 1].Window && !(open[level - 1].Window->Flags & ImGuiWindowFlags_Modal)) --level;
    if (level == open.Size) return false;
    ImGui::ClosePopupToLevel(level, true);
    return true;
}

void showDialogues(Workspace& work, Session& session) {
    Dialogues& d = dialogues();
    d.asks = false;
    if (d.open) {
        if (!d.project[0]) put(d.project, freeName(std::filesystem::path(session.name(work)).stem().string()));
        const std::string& place = session.folder().empty() ? session.file() : session.folder();
        if (!d.file[0]) put(d.file, std::filesystem::path(place).parent_path().string() + "/");
        if (!d.run[0]) put(d.run, "run.jsonl");
        ImGui::OpenPopup(d.open);
        d.open = nullptr;
    }
    projectDialogues(work, session);
    exportDialogue(work, session);
    runDialogues(work, session);
    layerDialogues(work, session);
    lookDialogues(work, session);
    fieldDialogue(work, session);
    askElsewhere(work, session);
}

}  // namespace sample
