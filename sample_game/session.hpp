#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sample_game/grammar_files.hpp"
#include "sample_game/workspace.hpp"
#include "tools/document/run.hpp"

namespace sample {

// The document's life on disk: saving, autosaves, what changes there from outside, and runs that are recorded.
class Session {
  public:
    // After the document was opened from `file`.
    void begin(Workspace& work, const std::string& file);
    // Once a frame, with the seconds since the program's start: looks at grammars' files and autosaves in time.
    // True: something has changed.
    bool step(Workspace& work, double now);
    // The end of what is open: what wasn't saved stays as an autosave, unless it is given up.
    void end(Workspace& work);

    const std::string& file() const { return file_; }  // that was opened, with its whole path
    // The project's folder; empty: the document was never saved.
    const std::string& folder() const { return folder_; }
    // As the title says it.
    std::string name(const Workspace& work) const;
    bool modified(const Workspace& work) const { return work.document->state() != savedState_; }
    void save(Workspace& work, const std::string& folder);
    // Into its folder, when the user has seen that it is being saved: by saveDue() at the end of the frame.
    void saveSoon(Workspace& work);
    bool saveDue(Workspace& work);  // false: nothing is
    // Of an earlier run that ended without saving; empty: there is none. Asked until answered.
    const std::string& recovery() const { return recovery_; }
    void forgetRecovery(bool deleteIt);
    // What is done in the document from now on is a recorded run's: it is kept nowhere, until the user saves it.
    void replays();
    // What follows is the user's.
    void endReplay(const Workspace& work) { savedState_ = work.document->state(); }

    // What to open next; the application does it.
    std::string openNext;
    // A surface's or the town's file has changed: what is open is to be opened again over it.
    bool reload = false;

    // Where the document belongs, over a reload of what it is in now.
    struct Origin {
        std::string file, folder;
        bool modified = false;
    };
    Origin origin(const Workspace& work) const { return {file_, folder_, modified(work)}; }
    void setOrigin(const Workspace& work, const Origin& origin);
    bool quit = false;
    bool givesUp = false;       // what isn't saved at the end of what is open
    double autosaveEvery = 60;  // seconds

    bool recording() const { return recorder_.on(); }
    // Of what was opened; the run's file names it.
    bool startRecording(Workspace& work, const std::string& path, uint32_t width, uint32_t height);
    void stopRecording(Workspace& work);
    void nextFrame() { recorder_.nextFrame(); }

  private:
    std::string autosaveFolder() const;
    void keep(Workspace& work);  // what isn't saved, as an autosave; what is, needs none
    void dropKept() const;       // the autosave
    bool watchGrammars(Workspace& work);
    bool watchModels(const Workspace& work);

    std::string file_, folder_, recovery_, recordingTo_;
    std::string recoveredFrom_;  // the autosave's folder of what was never saved; it goes on there
    bool replayed_ = false, saveSoon_ = false;
    uint64_t savedState_ = 0, autosavedState_ = 0;  // see Document::state
    double nextAutosave_ = 0, nextLook_ = 0;
    GrammarFiles grammarFiles_;
    std::vector<std::filesystem::file_time_type> modelTimes_;
    espalier::document::Recorder recorder_;
};

}  // namespace sample
