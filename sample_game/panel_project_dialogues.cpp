// Where a project is saved, what is opened, and what becomes of work that isn't saved.
#include <sys/stat.h>

#include <ctime>
#include <filesystem>

#include "sample_game/additions.hpp"
#include "sample_game/dialogue.hpp"
#include "sample_game/folder_list.hpp"
#include "sample_game/model_bake.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/replay.hpp"
#include "tools/scene/scene_file.hpp"

namespace sample {
namespace {

using Turn = Dialogues::Turn;
using espalier::document::AddGrammar;
namespace fs = std::filesystem;

// Where the user was last; empty: nowhere yet.
std::string folderOf(const std::string& path) {
    return path.substr(0, path.rfind('/') + 1);
}

// When a file was written, as words of a sentence; empty: that isn't known.
std::string keptAt(const std::string& file) {
    struct stat info {};
    if (file.empty() || ::stat(file.c_str(), &info) != 0) return {};
    char text[64];
    std::tm when{};
    return ::localtime_r(&info.st_mtime, &when) && std::strftime(text, sizeof text, " on %d %B at %H:%M", &when) ? text
                                                                                                                 : "";
}

void recoveryDialogue(Session& session) {
    const bool asks = !session.autosaves().recovery().empty() && session.openNext != session.autosaves().recovery();
    if (asks) ImGui::OpenPopup("Unsaved work");
    if (beginDialogue("Unsaved work")) {
        say("The last session ended without saving. What it had changed was kept" +
            keptAt(session.autosaves().recovery()) + ".");
        if (!session.autosaves().refused().empty()) say("It couldn't be opened: " + session.autosaves().refused());
        // A key that was meant for something else, such as the Esc that ends a replay, is no answer.
        const bool answers = !ImGui::IsWindowAppearing();
        if (ImGui::Button("Open it") || (answers && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false))) {
            session.openNext = session.autosaves().recovery();
            ImGui::CloseCurrentPopup();
        }
        ImGui::SameLine();
        static bool sure = false;  // one click too many must not cost an hour's work
        if (ImGui::IsWindowAppearing()) sure = false;
        if (ImGui::Button(sure ? "Yes, throw it away" : "Throw it away")) {
            const bool again = ImGui::GetIO().MouseClickedLastCount[0] > 1;  // a double click isn't two answers
            if (sure && !again) {
                session.autosaves().forgetRecovery(true);
                ImGui::CloseCurrentPopup();
            }
            sure = !sure || again;
        }
        if (session.autosaves().recoveryWaits()) {
            ImGui::SameLine();
            const bool escape = answers && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false);
            const bool later = ImGui::Button("Decide later") || escape;
            toolTip("It stays where it is, and is offered again when this is opened next");
            if (later) session.autosaves().putOffRecovery(), sure = false;
        }
        if (sure) say("It can't be brought back.");
        if (session.autosaves().recovery().empty()) ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
    }
}

// Another's work would go if this project were saved there, or its files lie among others.
Doubt doubtOfSaving(const Session& session, const std::string& folder) {
    std::error_code ignored;
    const std::string place = wholePath(folder);
    if (place == session.folder()) {
        const std::string changed = " has been saved by somebody else since it was opened",
                          holds = " holds what another session hasn't saved";
        if (session.autosaves().holdsBack())
            return {place + (session.changedByOthers() ? changed + ", and" + holds : holds) + ".", "Throw that away?",
                    "Throw away, save"};
        return session.changedByOthers() ? Doubt{place + changed + "."} : Doubt{};
    }
    if (fs::exists(fs::path(place) / espalier::scene::kProjectFile, ignored)) return {place + " is a project already."};
    if (fs::directory_iterator(place, ignored) == fs::directory_iterator()) return {};  // empty, or to be made
    return {place + " holds other files.", "Save the project among them?", "Save there"};
}

std::vector<std::string> withModels(std::vector<std::string> endings) {
    endings.insert(endings.end(), std::begin(kModelEndings), std::end(kModelEndings));
    return endings;
}

// What is open is saved, or may be given up.
void leave(Session& session) {
    if (dialogues().next->empty())
        session.quit = true;
    else
        session.openNext = *dialogues().next;
    dialogues().next.reset();
}

void leavingDialogue(Workspace& work, Session& session) {
    if (!beginDialogue("Unsaved changes")) return;
    Dialogues& d = dialogues();
    const auto named = [](const std::string& file) {
        const bool project = fs::path(file).filename() == espalier::scene::kProjectFile;
        return espalier::scene::lastPart(project ? fs::path(file).parent_path().string() : file);
    };
    const std::string next = !d.next           ? ""
                             : d.next->empty() ? "Before the program ends:\n"
                                               : "Before " + named(*d.next) + " is opened:\n";
    say(next + session.name(work) + " has changes that aren't saved.");
    const bool saves = ImGui::Button("Save") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false);
    ImGui::SameLine();
    const bool gives = ImGui::Button("Don't save");
    ImGui::SameLine();
    const bool stays = ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (saves || gives || stays || !d.next) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    if (stays) d.next.reset();
    if (!d.next) return;
    session.givesUp = gives;
    if (gives) leave(session);
    if (saves) d.leaves = askToSave(work, session);  // else the dialogue goes on with it
}

}  // namespace

void askElsewhere(Workspace& work, const Session& session) {
    Dialogues& d = dialogues();
    if (!session.modified(work)) d.unsaved.clear();
    if (d.unsaved.empty() || d.asks || d.open) return;
    work.error = std::exchange(d.unsaved, {});
    ask("Save the project");
    d.turn = turnOf(work, false);
}

// What can't be saved asks for another place, and nothing is left before that.
bool askToSave(Workspace& work, Session& session, bool elsewhere) {
    const std::string& own = session.folder();
    const Doubt found = own.empty() ? Doubt{} : doubtOfSaving(session, own);
    put(dialogues().project, elsewhere && !own.empty() ? freeName(own) : own);
    if (own.empty() || elsewhere || !found.why.empty()) {
        ask("Save the project");
        if (!elsewhere && !found.why.empty()) doubt(own, found);
        return false;
    }
    session.save(work, session.folder(), [&work, &session](bool good) {
        if (good) return;
        Dialogues& d = dialogues();
        d.leaves = false;
        if (work.error.empty()) return d.next.reset();  // cancelled
        d.unsaved = work.error;
        askElsewhere(work, session);
    });
    return true;
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

bool asksToQuit() {
    return dialogues().next == "";
}

void askToOpen(const std::string& refused, const std::string& why) {
    Dialogues& d = dialogues();
    const bool run = Replay::names(refused);
    ask(run ? "Replay a run" : "Open");
    if (!refused.empty()) d.turn = Turn::failed, d.why = why;
    put(run ? d.run : d.file, refused.empty() ? folderOf(d.file.data()) : refused);
}

void beginOpeningIn(const std::string& recent) {
    put(dialogues().file, folderOf(recent));
}

void askForGrammar() {
    PathText& file = dialogues().grammar;
    put(file, file[0] ? folderOf(file.data()) : espalier::scene::contentFolder() + "/grammars/");
    ask("Add a grammar");
}

void askForModel() {
    PathText& model = dialogues().model;
    put(model, folderOf(model[0] ? model.data() : dialogues().file.data()));
    ask("Add a model");
}

void projectDialogues(Workspace& work, Session& session) {
    Dialogues& d = dialogues();
    askPath(work, session,
            {"Save the project",
             "Folder of the project:",
             "Save",
             d.project,
             {},
             true,
             [&](const std::string& folder) { return doubtOfSaving(session, folder); }},
            [&](const char* folder) {
                session.save(work, folder, [&work](bool good) {
                    endWait(work, good);
                    dialogues().leaves = good;
                });
            });
    // What can't be opened asks again, see askToOpen.
    askPath(
        work, session,
        {"Open", "A project's folder, a scene (.json) or a model (.glb, .obj ...), which is baked first if need be:",
         "Open", d.file, withModels({".json", ".geojson"}), true},
        [&](const char* file) {
            if (isModel(file)) {
                openModel(work, session, file);
                d.turn = turnOf(work, true);
                return;
            }
            // What can't be opened is told before anybody is asked about unsaved work.
            const bool good = Replay::names(file) || espalier::scene::mayOpen(file, work.error);
            if (good) askToLeave(work, session, file);
            d.turn = turnOf(work, good);
        });
    askPath(work, session,
            {"Add a model", "A model (.glb, .obj ...), which is baked first if need be, or a baked surface:", "Add",
             d.model, withModels({}), false},
            [&](const char* file) {
                work.error.clear();
                addModels(work, session, {file});
                d.turn = turnOf(work, work.error.empty());
            });
    askPath(work, session, {"Add a grammar", "A grammar's file (.grammar):", "Add", d.grammar, {".grammar"}, false},
            [&](const char* file) {
                work.error.clear();
                const bool good = work.perform(AddGrammar{file});
                if (good) work.plantGrammar = uint32_t(work.scene().grammars.size() - 1);
                d.turn = turnOf(work, good);
            });
    recoveryDialogue(session);
    leavingDialogue(work, session);
    if (d.leaves && d.next && session.idle()) askToLeave(work, session, std::string(*d.next));
}

}  // namespace sample
