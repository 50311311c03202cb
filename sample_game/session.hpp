#pragma once

#include <functional>
#include <string>
#include <utility>

#include "sample_game/autosaves.hpp"
#include "sample_game/background.hpp"
#include "sample_game/file_watch.hpp"
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

    // That was opened, with its whole path.
    const std::string& file() const { return autosaves_.origin().file; }
    // The project's folder; empty: the document was never saved.
    const std::string& folder() const { return autosaves_.origin().folder; }
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
    // What is kept of what isn't saved, and what earlier editors have left.
    Autosaves& autosaves() { return autosaves_; }
    const Autosaves& autosaves() const { return autosaves_; }
    // What is done in the document from now on is a recorded run's, and isn't kept before its end.
    void replays(const std::string& run);
    // What the run has changed counts as not saved, and is kept by the run's name, with what the user does now. What
    // was so, when a session ended, is offered.
    void endReplay() { autosaves_.endReplay(); }

    // What to open next; the application does it.
    std::string openNext;
    // A surface's or the town's file has changed: what is open is to be opened again over it.
    bool reload = false;

    // Where the document belongs, over a reload of what it is in now.
    struct Origin {
        Autosaves::Origin autosaves;
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
    // Ends a recording that can't be written any more.
    void nextFrame(Workspace& work);

  private:
    FileStamp projectNow() const;             // of its file; none without a folder
    bool keeps(const Workspace& work) const;  // what isn't saved is to become an autosave
    void keepSoon(Workspace& work);
    void keepNow(Workspace& work);
    void kept(Workspace& work, uint64_t state);
    void notKept(Workspace& work, const std::string& why);
    void tellKept(Workspace& work, const std::string& news);
    void noticeLoss(Workspace& work);
    void followAdditions(const Workspace& work);
    bool record(Workspace& work, const std::string& path, espalier::document::RunHead head);
    void beginRun(Workspace& work);
    void saved(const std::string& folder, uint64_t state);
    bool watchGrammars(Workspace& work);

    Autosaves autosaves_;
    std::string recordingTo_;
    std::string toldKept_;  // the last news of autosaves; empty: all is well
    bool missing_ = false;  // the project, at the last look
    bool whole_ = false;    // file() says all that was opened
    bool saving_ = false;
    FileStamp project_;                             // its file when it was opened or saved
    FileStamp keptBeside_;                          // likewise when the latest autosave was made
    uint64_t savedState_ = 0, autosavedState_ = 0;  // see Document::state
    double nextAutosave_ = 0, nextLook_ = 0;
    GrammarFiles grammarFiles_;
    FileWatch models_;                     // of surfaces and town
    std::pair<size_t, size_t> watched_{};  // how many surfaces and grammars these know of
    espalier::document::Recorder recorder_;
    std::string lostRun_;  // why one ended by itself: told once more at the end
    Background background_;
};

}  // namespace sample
