#pragma once

#include <optional>
#include <string>

#include "sample_game/workspace.hpp"
#include "tools/document/run.hpp"

namespace sample {

// A recorded run that is done again in the window, at the pace that it was recorded at.
class Replay {
  public:
    // Whether a file's name is a run's.
    static bool names(const std::string& file) { return file.ends_with(".jsonl"); }
    // What the run begins with is to be opened next, then begin() is due. False: `error` tells file, place and cause.
    bool read(const std::string& path, std::string& error);
    const std::string& scene() const { return run_->head.scene; }
    const std::string& path() const { return path_; }
    void begin(double now) { began_ = now; }
    void forget() { run_.reset(); }

    bool on() const { return run_ && began_ >= 0; }
    // What the run had done by now, in seconds. False: that was all of it, or it went wrong.
    bool step(Workspace& work, double now);
    // Ends it where it is.
    void stop(Workspace& work);

  private:
    std::string path_, status_;
    std::optional<espalier::document::Run> run_;
    double began_ = -1;
    size_t next_ = 0;                 // of the run's lines
    uint32_t theirs_ = 0, ours_ = 0;  // the last gesture, in the run and here; 0: there was none
};

}  // namespace sample
