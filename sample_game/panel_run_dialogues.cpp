// What is recorded, and what of it is seen again.
#include "sample_game/dialogue.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/replay.hpp"

namespace sample {

void askToRecord() {
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
    askPath(work, session, {"Record a run", "File for what is done from now on (.jsonl):", "Record", d.run, {".jsonl"}},
            [&](const char* file) {
                const std::string path = Replay::names(file) ? file : std::string(file) + ".jsonl";
                session.startRecording(work, path, uint32_t(work.window.x), uint32_t(work.window.y),
                                       [&work](bool good) { endWait(work, good); });
            });
}

}  // namespace sample
