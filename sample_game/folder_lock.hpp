#pragma once

#include <string>

namespace sample {

// A folder that one editor keeps its own in: others that ask so see that it is taken, until it is released or the
// program has ended, however it did.
class FolderLock {
  public:
    FolderLock() = default;
    ~FolderLock() { release(); }
    FolderLock(const FolderLock&) = delete;
    // In place of what is held. False: somebody else has it. Where there is no such folder, or folders can't be locked,
    // as on some network drives, nobody is held off.
    bool take(const std::string& folder);
    void release();
    bool held() const { return held_; }

  private:
    int file_ = -1;
    bool held_ = false;
};

}  // namespace sample
