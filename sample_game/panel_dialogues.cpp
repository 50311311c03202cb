// What menus and keys ask: paths, and what becomes of work that isn't saved.
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include "sample_game/folder_list.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/replay.hpp"
#include "sample_game/theme.hpp"
#include "tools/document/layer_files.hpp"

namespace sample {
namespace {

using namespace espalier::document;

struct Dialogues {
    const char* open = nullptr;
    bool failed = false;  // the open one's last try
    bool acts = false;    // what it was told is done in the next frame, when the user has seen that
    bool asks = false;    // one that asks for a path was open in the last frame
    char project[512] = "", file[512] = "", run[512] = "", picture[512] = "";
    std::string layer;                // of the picture
    std::optional<std::string> next;  // what is opened once this is saved or given up; "": nothing, the program ends
};

Dialogues& dialogues() {
    static Dialogues state;
    return state;
}

// Windows that appear for the first time would lie over it.
bool beginDialogue(const char* title) {
    if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return false;
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    return true;
}

float dialogueWidth() {
    return std::min(ImGui::GetFontSize() * 32, ImGui::GetIO().DisplaySize.x - 4 * ImGui::GetStyle().WindowPadding.x);
}

void say(const std::string& text, ImVec4 colour = ImGui::GetStyleColorVec4(ImGuiCol_Text)) {
    ImGui::PushTextWrapPos(dialogueWidth());
    ImGui::TextColored(colour, "%s", text.c_str());
    ImGui::PopTextWrapPos();
}

// What lies in the folder of `path`, to be clicked. True: a file or project was clicked twice.
bool showFolder(char* path, size_t size, const std::vector<std::string>& endings) {
    static struct {
        std::string typed;
        double read = -1;
        std::vector<FolderEntry> entries;
    } shown;
    if (shown.typed != path || ImGui::GetTime() > shown.read + 2)
        shown = {path, ImGui::GetTime(), listFolder(path, endings)};
    bool taken = false;
    const std::string whole = wholePath(std::string(path).substr(0, std::string(path).rfind('/') + 1));
    say("In " + whole, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    const float others = dialogues().failed ? 9 : 7;  // rows, about, of what else the dialogue shows
    const float line = ImGui::GetTextLineHeightWithSpacing(), display = ImGui::GetIO().DisplaySize.y;
    const float height = std::clamp(display - others * ImGui::GetFrameHeightWithSpacing(), 3 * line, 8 * line);
    if (ImGui::BeginChild("folder", {dialogueWidth(), height}, true))
        for (const FolderEntry& entry : shown.entries) {
            const bool known = entry.kind == FolderEntry::project;
            const std::string text = known ? entry.name + "   project" : entry.name;
            const ImGuiSelectableFlags flags =
                ImGuiSelectableFlags_AllowDoubleClick | ImGuiSelectableFlags_DontClosePopups;
            if (!ImGui::Selectable(text.c_str(), entry.path == path, flags)) continue;
            std::snprintf(path, size, "%s", entry.path.c_str());
            taken = entry.kind != FolderEntry::folder && ImGui::IsMouseDoubleClicked(0);
        }
    ImGui::EndChild();
    return taken;
}

// A dialogue that asks for a path, and stays with what went wrong until `act`, which is given the path, returns true.
template <class Act>
void askPath(Workspace& work, const char* title, const char* label, const char* button, char* path, size_t size,
             const std::vector<std::string>& endings, Act&& act) {
    bool confirmed = false;
    if (!beginDialogue(title)) return;
    dialogues().asks = true;
    say(label);
    ImGui::SetNextItemWidth(dialogueWidth());
    if (!ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();  // it is all that one can type into
    confirmed = ImGui::InputText("##path", path, size, ImGuiInputTextFlags_EnterReturnsTrue);
    confirmed |= showFolder(path, size, endings);
    confirmed |= ImGui::Button(button);
    ImGui::SameLine();
    const bool cancelled = ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    const bool done = std::exchange(dialogues().acts, false);
    if (done) {
        work.error.clear();
        dialogues().failed = !act(path);
    } else if (confirmed && path[0]) {
        dialogues().acts = true;
        dialogues().failed = false;
        ImGui::TextUnformatted("One moment ...");
    }
    if (dialogues().failed) say(work.error, kBad);
    if (cancelled) dialogues().next.reset();
    if (cancelled || (done && !dialogues().failed)) {
        dialogues().asks = dialogues().acts = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}
void ask(const char* title) {
    dialogues().open = title;
    dialogues().failed = false;
}

// What is open is saved, or may be given up.
void leave(Session& session) {
    if (dialogues().next->empty())
        session.quit = true;
    else
        session.openNext = *dialogues().next;
    dialogues().next.reset();
}

void put(char* to, size_t size, const std::string& text) {
    std::snprintf(to, size, "%s", text.c_str());
}

void layerDialogues(Workspace& work) {
    Dialogues& d = dialogues();
    const bool town = work.townLayer(d.layer);
    const char* asked = town ? "Picture of the town from above, north up (.png, .exr):"
                             : "Picture in the surface's walk UVs, as Export writes it (.png, .exr):";
    askPath(work, "Import a layer", asked, "Import", d.picture, sizeof d.picture, {".png", ".exr"},
            [&](const char* file) {
                if (town) return work.perform(LoadTownLayer{d.layer, file});
                std::string note;
                work.redraw = true;
                if (!importLayer(*work.document, d.layer, file, work.newGesture(), note, work.error)) return false;
                work.message = "Read: " + wholePath(file) + (note.empty() ? "" : " (" + note + ")");
                return true;
            });
    askPath(work, "Export a layer", "File of the picture (.png: 16 bits, .exr: floats):", "Export", d.picture,
            sizeof d.picture, {".png", ".exr"}, [&](const char* file) {
                if (!(town ? exportTownLayer : exportLayer)(*work.document, d.layer, file, work.error)) return false;
                work.message = "Written: " + wholePath(file);
                return true;
            });
}

void recoveryDialogue(Session& session) {
    if (!session.recovery().empty()) ImGui::OpenPopup("Unsaved work");
    if (beginDialogue("Unsaved work")) {
        say("The last session ended without saving. What it had changed was kept.");
        if (session.recovery().empty()) ImGui::CloseCurrentPopup();
        if (ImGui::Button("Open it") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false)) {
            session.openNext = session.recovery();
            session.forgetRecovery(false);
            ImGui::CloseCurrentPopup();
        }
        ImGui::SameLine();
        if (ImGui::Button("Throw it away")) {
            session.forgetRecovery(true);
            ImGui::CloseCurrentPopup();
        }
        ImGui::EndPopup();
    }
}

void leavingDialogue(Workspace& work, Session& session) {
    if (!beginDialogue("Unsaved changes")) return;
    say(session.name(work) + " has changes that aren't saved.");
    const bool saves = ImGui::Button("Save") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false);
    ImGui::SameLine();
    const bool gives = ImGui::Button("Give them up");
    ImGui::SameLine();
    const bool stays = ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (saves || gives || stays || !dialogues().next) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    if (stays) dialogues().next.reset();
    if (!dialogues().next) return;
    if (saves && session.folder().empty()) askToSave(work, session);
    if (saves && !session.folder().empty()) session.save(work, session.folder());
    session.givesUp = gives;
    if (gives || (saves && !session.modified(work)))
        leave(session);
    else if (saves && !dialogues().open)
        dialogues().next.reset();  // it couldn't be saved
}

}  // namespace

void askToSave(Workspace& work, Session& session, bool elsewhere) {
    if (!session.folder().empty() && !elsewhere) return session.saveSoon(work);
    put(dialogues().project, sizeof dialogues().project, session.folder());
    ask("Save the project");
}

void askToRecord() {
    ask("Record a run");
}
void askToReplay() {
    ask("Replay a run");
}

bool askToLeave(Workspace& work, Session& session, const std::string& next) {
    dialogues().next = next;
    if (session.modified(work))
        ask("Unsaved changes");
    else
        leave(session);
    return !session.modified(work);
}

bool asksToLeave() {
    return dialogues().next.has_value();
}

void askForLayer(const std::string& layer, bool import) {
    Dialogues& d = dialogues();
    if (d.layer != layer) put(d.picture, sizeof d.picture, layer + ".exr");
    d.layer = layer;
    ask(import ? "Import a layer" : "Export a layer");
}

void closeDialogues() {
    dialogues().open = nullptr;
    dialogues().asks = dialogues().acts = false;
    dialogues().next.reset();
    if (!ImGui::GetCurrentContext()->OpenPopupStack.empty()) ImGui::ClosePopupToLevel(0, false);
}

bool awaitsText() {
    const Dialogues& d = dialogues();
    return d.acts || ((d.open || d.asks) && !ImGui::GetIO().WantTextInput);
}

bool closeMenus() {
    const auto& open = ImGui::GetCurrentContext()->OpenPopupStack;
    int level = open.Size;
    while (level > 0 && open[level - 1].Window && !(open[level - 1].Window->Flags & ImGuiWindowFlags_Modal)) --level;
    if (level == open.Size) return false;
    ImGui::ClosePopupToLevel(level, true);
    return true;
}

void askToOpen(const std::string& refused) {
    Dialogues& d = dialogues();
    const bool run = Replay::names(refused);
    d.open = run ? "Replay a run" : "Open";
    d.failed = !refused.empty();
    put(run ? d.run : d.file, sizeof d.file, refused);
}

void showDialogues(Workspace& work, Session& session) {
    Dialogues& d = dialogues();
    d.asks = false;
    if (d.open) {
        if (!d.project[0]) put(d.project, sizeof d.project, std::filesystem::path(session.name(work)).stem().string());
        const std::string& place = session.folder().empty() ? session.file() : session.folder();
        if (!d.file[0]) put(d.file, sizeof d.file, std::filesystem::path(place).parent_path().string() + "/");
        if (!d.run[0]) put(d.run, sizeof d.run, "run.jsonl");
        ImGui::OpenPopup(d.open);
        d.open = nullptr;
    }
    askPath(work, "Save the project", "Folder of the project:", "Save", d.project, sizeof d.project, {},
            [&](const char* folder) {
                session.save(work, folder);
                if (work.error.empty() && d.next) leave(session);
                return work.error.empty();
            });
    // What can't be opened asks again, see askToOpen.
    askPath(work, "Open", "A project's folder, a scene (.json) or a baked surface (.glb):", "Open", d.file,
            sizeof d.file, {".json", ".glb"}, [&](const char* file) {
                askToLeave(work, session, file);
                return true;
            });
    askPath(work, "Replay a run", "A run that was recorded:", "Replay", d.run, sizeof d.run, {".jsonl"},
            [&](const char* file) {
                Run run;  // before anything is given up for it
                if (!readRun(file, run, work.error)) return false;
                askToLeave(work, session, file);
                return true;
            });
    askPath(work, "Record a run", "File for what is done from now on (.jsonl):", "Record", d.run, sizeof d.run,
            {".jsonl"}, [&](const char* file) {
                const std::string path = Replay::names(file) ? file : std::string(file) + ".jsonl";
                return session.startRecording(work, path, uint32_t(work.window.x), uint32_t(work.window.y));
            });
    layerDialogues(work);
    recoveryDialogue(session);
    leavingDialogue(work, session);
}

}  // namespace sample
