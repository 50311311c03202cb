#pragma once

#include <set>
#include <string>

#include "sample_game/folder_lock.hpp"

namespace sample {

// Where the autosave of what is open goes, and which ones editors that are gone have left. That is the project's
// folder, or, where there is none or it takes nothing, one beside the user's settings. No two editors share a place.
class Autosaves {
  public:
    // What the place follows from.
    struct Origin {
        std::string file;              // that was opened, with its whole path
        std::string folder;            // the project's; empty: the document was never saved
        std::string cannotKeep;        // why that takes no autosave; empty: it does
        std::string recoveredFrom;     // the autosave's folder of what was never saved; it goes on there
        std::string unsaved;           // the folder beside the user's settings that it is kept in; empty: none yet
        std::string run;               // that was replayed; empty: none was
        std::set<std::string> putOff;  // of recoveries, for as long as this is open
    };
    // What was opened from `file`. True: that is an autosave itself.
    bool open(const std::string& file);
    const Origin& origin() const { return at_; }
    // After a reload of what was open: where that belongs.
    void setOrigin(const Origin& origin);
    // The project is in its folder now, and nothing is left to be kept.
    void saved(const std::string& folder);
    // What is done from now on is a recorded run's, and isn't kept before its end; then it is by the run's name.
    void replays(const std::string& run);
    void endReplay();
    bool replaying() const { return replaying_; }
    // What is open ends, and no recovery is offered any more. False: one that is yet to be decided on lies where what
    // is open would be kept.
    bool end();
    void release();  // its place, to other editors

    // The folder to keep it in now; empty: there is none, or it isn't to be kept.
    std::string place() const;
    // Makes that this editor's, if it is beside the user's settings.
    void take();
    // The project's folder takes nothing. False: there is no other place.
    bool moveAway(std::string why);
    // It was kept: what the project's folder took before isn't the latest any more.
    void kept();
    void drop();

    // Of an earlier run that ended without saving; empty: there is none. Asked until answered: by opening it, too, once
    // it is open.
    const std::string& recovery() const { return recovery_; }
    void forgetRecovery(bool deleteIt);
    // It couldn't be opened, and is asked about again.
    void refuseRecovery(const std::string& why) { refused_ = why; }
    const std::string& refused() const { return refused_; }  // why; empty: it wasn't
    // Whether it can be decided on another time, what is done meanwhile being kept elsewhere.
    bool recoveryWaits() const;
    // Until this is opened again; the next one, if there is another, is offered.
    void putOffRecovery();
    // One lies in the project's folder until the project is saved there, and that isn't to take it unasked: it was put
    // off, or is another editor's.
    bool holdsBack() const;

  private:
    std::string own() const;  // the file in the project's folder
    // Beside the user's settings, for what has no folder or can't write to it: the first that editors of the same would
    // take, or another of them. Empty: there is no place.
    std::string unsavedFolder(int number = 1) const;
    void claim();              // what it is kept in, before others do
    std::string leftBehind();  // the latest, none that is put off

    Origin at_;
    std::string recovery_, refused_;
    bool replaying_ = false;
    FolderLock lock_;         // of the project's folder, or of the recovered one
    FolderLock unsavedLock_;  // of at_.unsaved, or of what is offered
};

}  // namespace sample
