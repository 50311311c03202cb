#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "sample_game/background.hpp"
#include "sample_game/file_watch.hpp"
#include "sample_game/folder_lock.hpp"
#include "sample_game/grammar_files.hpp"
#include "sample_game/workspace.hpp"
#include "tools/document/run.hpp"

namespace sample {

// The document's life on disk: saving, autosaves, what changes there from outside, and runs that are recorded.
class Session {
  public:
    // After the document was opened from `file`, which began at `read`: files written since count as changed. `whole`:
    // the file says all of it, and nothing was said besides.
    void begin(Workspace& work, const std::string& file, std::filesystem::file_time_type read = kNeverWritten,
               bool whole = true);
    // Once a frame, with the seconds since the program's start: goes on with what is under way, looks at files that
    // others write, and autosaves in time. True: something has changed.
    bool step(Workspace& work, double now);
    // The end of what is open: what wasn't saved stays as an autosave, unless it is given up.
    void end(Workspace& work);

    const std::string& file() const { return file_; }  // that was opened, with its whole path
    // The project's folder; empty: the document was never saved.
    const std::string& folder() const { return folder_; }
    // As the title says it.
    std::string name(const Workspace& work) const;
    bool modified(const Workspace& work) const { return work.document->state() != savedState_; }
    // The document as it is when its turn comes; what is done to it meanwhile isn't part of it. `ended` is told whether
    // that is on the disk: if not, the project is as it was, and Workspace::error says why unless it was cancelled.
    using Ended = std::function<void(bool good)>;
    void save(Workspace& work, const std::string& folder, Ended ended);
    // The project in its folder isn't the one that was opened or saved here: somebody else has saved it since.
    bool changedByOthers() const;
    // Saves, exports and imports that are under way.
    Background& background() { return background_; }
    // Nothing that was asked for is: what is open may go.
    bool idle();
    // Of an earlier run that ended without saving; empty: there is none. Asked until answered: by opening it, too, once
    // it is open.
    const std::string& recovery() const { return recovery_; }
    void forgetRecovery(bool deleteIt);
    // It couldn't be opened, and is asked about again.
    void refuseRecovery(const std::string& why) { refused_ = why; }
    const std::string& refused() const { return refused_; }  // why; empty: it wasn't
    // Whether it can be decided on another time, what is done meanwhile being kept elsewhere.
    bool recoveryWaits() const;
    // One lies in the project's folder until the project is saved there, and that isn't to take it unasked: it was put
    // off, or is another editor's.
    bool holdsBack() const;
    // Until this is opened again; the next one, if there is another, is offered.
    void putOffRecovery();
    // What is done in the document from now on is a recorded run's, and isn't kept before its end.
    void replays(const std::string& run);
    // What the run has changed counts as not saved, and is kept by the run's name, with what the user does now. What
    // was so, when a session ended, is offered.
    void endReplay();

    // What to open next; the application does it.
    std::string openNext;
    // A surface's or the town's file has changed: what is open is to be opened again over it.
    bool reload = false;

    // Where the document belongs, over a reload of what it is in now.
    struct Origin {
        std::string file, folder, cannotKeep, recoveredFrom, unsaved, run;
        std::set<std::string> putOff;
        FileStamp project;
        bool whole = false, modified = false;
    };
    Origin origin(const Workspace& work) const;
    void setOrigin(const Workspace& work, const Origin& origin);
    bool quit = false;
    bool givesUp = false;       // what isn't saved at the end of what is open
    bool goesOn = false;        // it is opened again as it is: its autosave stays what it is
    double autosaveEvery = 60;  // seconds

    bool recording() const { return recorder_.on(); }
    // Of a scene as it was opened, or of how it is now, which is saved beside the run first; undo doesn't go further
    // back then, as in the replay, until the recording has ended. The run's file names it. `ended` is told whether it
    // records, as save()'s; nothing is to edit the document before that.
    void startRecording(Workspace& work, const std::string& path, uint32_t width, uint32_t height, Ended ended);
    void stopRecording(Workspace& work);
    void nextFrame() { recorder_.nextFrame(); }

  private:
    std::string ownAutosave() const;  // the file in the project's folder
    FileStamp projectNow() const;     // of its file; none without a folder
    std::string autosaveFolder() const;
    // Beside the user's settings, for what has no folder or can't write to it: the first that editors of the same would
    // take, or another of them. Empty: there is no place.
    std::string unsavedFolder(int number = 1) const;
    void claim();                             // what it is kept in, before others do
    void takePlace();                         // one of those, if it is to be kept there
    std::string leftBehind();                 // the latest, none that is put off
    bool keeps(const Workspace& work) const;  // what isn't saved is to become an autosave
    void keepSoon(Workspace& work);
    void keepNow(Workspace& work);
    void kept(Workspace& work, uint64_t state);
    void notKept(Workspace& work, const std::string& why);
    bool keepElsewhere(std::string why);  // false: there is no other place
    void tellKept(Workspace& work, const std::string& news);
    void noticeLoss(Workspace& work);
    void dropKept();  // the autosave
    bool record(Workspace& work, const std::string& path, espalier::document::RunHead head);
    void beginRun(Workspace& work);
    void saved(const std::string& folder, uint64_t state);
    bool watchGrammars(Workspace& work);

    std::string file_, folder_, recovery_, refused_, recordingTo_;
    std::set<std::string> putOff_;  // of recovery_'s, for as long as this is open
    std::string recoveredFrom_;     // the autosave's folder of what was never saved; it goes on there
    std::string unsaved_;           // the folder beside the user's settings that it is kept in; empty: none yet
    std::string run_;               // that was replayed; empty: none was
    std::string cannotKeep_;        // why the project's folder takes no autosave; empty: it does
    std::string toldKept_;          // the last news of autosaves; empty: all is well
    bool missing_ = false;          // the project, at the last look
    bool replaying_ = false;
    bool whole_ = false;  // file_ says all that was opened
    bool saving_ = false;
    FileStamp project_;                             // its file when it was opened or saved
    FileStamp keptBeside_;                          // likewise when the latest autosave was made
    FolderLock lock_;                               // of the project's folder, or of the recovered one
    FolderLock unsavedLock_;                        // of unsaved_, or of what is offered
    uint64_t savedState_ = 0, autosavedState_ = 0;  // see Document::state
    double nextAutosave_ = 0, nextLook_ = 0;
    GrammarFiles grammarFiles_;
    FileWatch models_;  // of surfaces and town
    espalier::document::Recorder recorder_;
    Background background_;
};

}  // namespace sample
