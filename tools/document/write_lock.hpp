#pragma once

#include <chrono>
#include <string>

#include "tools/document/work.hpp"
#include "tools/scene/folder.hpp"

namespace espalier::document {

// A project's folder while something is written into it and what nothing names any more is swept out: what others write
// meanwhile nothing names yet, so they wait. Released at the latest when the program ends, however it does.
class WriteLock {
  public:
    WriteLock() = default;
    ~WriteLock();
    WriteLock(const WriteLock&) = delete;
    // Waits until others have written. False: it was called off, or `error` says that this took them too long, or that
    // a link lies in the lock's place. Where nothing can be locked nobody is waited for.
    bool take(const std::string& folder, std::chrono::seconds longest, Progress& progress, std::string& error);

  private:
    using Clock = std::chrono::steady_clock;
    bool wait(Clock::time_point end, Progress& progress, std::string& error) const;
    bool isThere() const;

    scene::Folder folder_;
    int file_ = -1;
};

}  // namespace espalier::document
