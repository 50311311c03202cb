// What is recorded, and what of it is seen again.
#include <filesystem>

#include "sample_game/dialogue.hpp"
#include "sample_game/folder_list.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/replay.hpp"

namespace sample {

namespace fs = std::filesystem;

void askToRecord() {
    PathText& run = dialogues().run;
    put(run, freeName(run[0] ? run.data() : "run.jsonl", ".jsonl"));
    ask("Record a run");
}
void askToReplay() {
    ask("Replay a run");
}

void runDialogues(Workspace& work, Session& session) {
    Dialogues& d = dialogues();
    askPath(work, session, {"Replay a run", "A run that was recorded:", "Replay", d.run, {".jsonl"}},
            [&](const char* file) {
                espalier::document::Run run;  // before anything is given up for it
                const bool good = readRun(file, run, work.error);
                if (good) askToLeave(work, session, file);  // what can't be opened asks again, see askToOpen
                d.turn = turnOf(work, good);
            });
    const auto named = [](const std::string& file) { return Replay::names(file) ? file : file + ".jsonl"; };
    const auto taken = [&](const std::string& file) -> Doubt {
        std::error_code ignored;
        return {fs::exists(fs::symlink_status(named(file), ignored)) ? wholePath(named(file)) + " is there already."
                                                                     : ""};
    };
    askPath(work, session,
            {"Record a run", "File for what is done from now on (.jsonl):", "Record", d.run, {".jsonl"}, false, taken},
            [&](const char* file) {
                session.startRecording(work, named(file), uint32_t(work.window.x), uint32_t(work.window.y),
                                       [&work](bool good) { endWait(work, good); });
            });
}

}  // namespace sample
