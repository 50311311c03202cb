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
    // Of the open one. acts: what it was told is done in the next frame, when the user has seen that; waits: for work
    // beside the frames; done: it closes; failed: it stays, with `why`.
    enum class Turn { asks, acts, waits, done, failed } turn = Turn::asks;
    std::string why;
    bool asks = false;    // one that asks for a path was open in the last frame
    bool leaves = false;  // for what is next, as soon as nothing is under way
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
    // Rows, about, of what else the dialogue shows.
    const float others = dialogues().turn == Dialogues::Turn::failed ? 9 : 7;
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

using Turn = Dialogues::Turn;

Turn turnOf(const Workspace& work, bool good) {
    dialogues().why = work.error;
    return good ? Turn::done : Turn::failed;
}

// The end of what a dialogue waits for. Cancelled, it asks again.
void endWait(const Workspace& work, bool good) {
    const bool cancelled = !good && work.error.empty();
    if (dialogues().turn == Turn::waits) dialogues().turn = cancelled ? Turn::asks : turnOf(work, good);
}

// How far it is; true: it is told to act.
bool showTurn(Background& background, bool confirmed) {
    Dialogues& d = dialogues();
    if (d.turn == Turn::waits && background.slow()) {
        say(background.title());
        ImGui::ProgressBar(background.progress(), {dialogueWidth(), 0});
    }
    if (d.turn == Turn::failed) say(d.why, kBad);
    if (d.turn == Turn::acts) return true;
    if (confirmed && d.turn != Turn::waits && d.turn != Turn::done) {
        d.turn = Turn::acts;
        ImGui::TextUnformatted("One moment ...");
    }
    return false;
}

// A dialogue that asks for a path, and stays with what went wrong until `act`, which is given the path, or the work
// that it began, is done.
template <class Act>
void askPath(Workspace& work, Session& session, const char* title, const char* label, const char* button, char* path,
             size_t size, const std::vector<std::string>& endings, Act&& act) {
    Dialogues& d = dialogues();
    bool confirmed = false;
    if (!beginDialogue(title)) return;
    d.asks = true;
    say(label);
    ImGui::SetNextItemWidth(dialogueWidth());
    if (!ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();  // it is all that one can type into
    const bool waits = d.turn == Turn::waits;
    confirmed = ImGui::InputText("##path", path, size,
                                 ImGuiInputTextFlags_EnterReturnsTrue | (waits ? ImGuiInputTextFlags_ReadOnly : 0));
    ImGui::BeginDisabled(waits);
    confirmed |= showFolder(path, size, endings);
    confirmed |= ImGui::Button(button);
    ImGui::EndDisabled();
    ImGui::SameLine();
    const bool cancelled = ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (showTurn(session.background(), confirmed && path[0])) {
        work.error.clear();
        d.turn = Turn::waits;
        act(path);
    }
    if (cancelled && waits) {
        session.background().cancelLast();
    } else if (cancelled || d.turn == Turn::done) {
        if (cancelled) d.next.reset();
        d.asks = false;
        d.turn = Turn::asks;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}
void ask(const char* title) {
    dialogues().open = title;
    dialogues().turn = Turn::asks;
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

// Pictures of layers, out and in, beside the frames.
void layerDialogues(Workspace& work, Session& session) {
    Dialogues& d = dialogues();
    const bool town = work.townLayer(d.layer);
    const auto told = [&work](const Work& over, const std::string& message) {
        work.redraw = true;
        work.error = over.error();
        work.message = over.state() == Work::State::done ? message : "";
        endWait(work, over.state() == Work::State::done);
    };
    const char* asked = town ? "Picture of the town from above, north up (.png, .exr):"
                             : "Picture in the surface's walk UVs, as Export writes it (.png, .exr):";
    askPath(work, session, "Import a layer", asked, "Import", d.picture, sizeof d.picture, {".png", ".exr"},
            [&](const std::string& file) {
                const uint32_t gesture = work.newGesture();
                session.background().ask({"Importing " + file,
                                          [&work, layer = d.layer, town, file, gesture] {
                                              return importing(*work.document, layer, town, file, gesture);
                                          },
                                          [told, file](const Work& over) {
                                              const std::string note = over.note();
                                              told(over, "Read: " + wholePath(file) +
                                                             (note.empty() ? "" : " (" + note + ")"));
                                          }});
            });
    askPath(work, session, "Export a layer", "File of the picture (.png: 16 bits, .exr: floats):", "Export", d.picture,
            sizeof d.picture, {".png", ".exr"}, [&](const std::string& file) {
                session.background().ask(
                    {"Exporting " + d.layer,
                     [&work, layer = d.layer, town, file] { return exporting(*work.document, layer, town, file); },
                     [told, file](const Work& over) { told(over, "Written: " + wholePath(file)); }});
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
    Dialogues& d = dialogues();
    say(session.name(work) + " has changes that aren't saved.");
    const bool saves = ImGui::Button("Save") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false);
    ImGui::SameLine();
    const bool gives = ImGui::Button("Give them up");
    ImGui::SameLine();
    const bool stays = ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (saves || gives || stays || !d.next) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    if (stays) d.next.reset();
    if (!d.next) return;
    session.givesUp = gives;
    if (gives) leave(session);
    if (saves) {
        askToSave(work, session);
        d.leaves = !session.folder().empty();  // else the dialogue goes on with it
    }
}

}  // namespace

// What can't be saved asks for another place, and nothing is left before that.
void askToSave(Workspace& work, Session& session, bool elsewhere) {
    put(dialogues().project, sizeof dialogues().project, session.folder());
    if (session.folder().empty() || elsewhere) return ask("Save the project");
    session.save(work, session.folder(), [&work](bool good) {
        if (good) return;
        Dialogues& d = dialogues();
        d.leaves = false;
        if (work.error.empty()) return d.next.reset();  // cancelled
        if (d.asks || d.open) return;
        ask("Save the project");
        d.turn = turnOf(work, false);
    });
}

void askToRecord() {
    ask("Record a run");
}
void askToReplay() {
    ask("Replay a run");
}

bool askToLeave(Workspace& work, Session& session, const std::string& next) {
    Dialogues& d = dialogues();
    d.next = next;
    d.leaves = !session.idle();
    if (d.leaves) return false;
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

bool closeMenus() {
    const auto& open = ImGui::GetCurrentContext()->OpenPopupStack;
    int level = open.Size;
    while (level > 0 && open[level - 1].Window && !(open[level - 1].Window->Flags & ImGuiWindowFlags_Modal)) --level;
    if (level == open.Size) return false;
    ImGui::ClosePopupToLevel(level, true);
    return true;
}

void askToOpen(const std::string& refused, const std::string& why) {
    Dialogues& d = dialogues();
    const bool run = Replay::names(refused);
    ask(run ? "Replay a run" : "Open");
    if (!refused.empty()) d.turn = Turn::failed, d.why = why;
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
    askPath(work, session, "Save the project", "Folder of the project:", "Save", d.project, sizeof d.project, {},
            [&](const char* folder) {
                session.save(work, folder, [&work](bool good) {
                    endWait(work, good);
                    dialogues().leaves = good;
                });
            });
    // What can't be opened asks again, see askToOpen.
    const auto open = [&](const char* file) {
        askToLeave(work, session, file);
        d.turn = Turn::done;
    };
    askPath(work, session, "Open", "A project's folder, a scene (.json) or a baked surface (.glb):", "Open", d.file,
            sizeof d.file, {".json", ".glb"}, open);
    askPath(work, session, "Replay a run", "A run that was recorded:", "Replay", d.run, sizeof d.run, {".jsonl"},
            [&](const char* file) {
                Run run;  // before anything is given up for it
                if (readRun(file, run, work.error))
                    open(file);
                else
                    d.turn = turnOf(work, false);
            });
    askPath(work, session, "Record a run", "File for what is done from now on (.jsonl):", "Record", d.run, sizeof d.run,
            {".jsonl"}, [&](const char* file) {
                const std::string path = Replay::names(file) ? file : std::string(file) + ".jsonl";
                d.turn =
                    turnOf(work, session.startRecording(work, path, uint32_t(work.window.x), uint32_t(work.window.y)));
            });
    layerDialogues(work, session);
    recoveryDialogue(session);
    leavingDialogue(work, session);
    if (d.leaves && d.next && session.idle()) askToLeave(work, session, std::string(*d.next));
}

}  // namespace sample
