// flock of the folder itself: nothing is written for it, and nothing stays.
#include "sample_game/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

namespace sample {

bool FolderLock::take(const std::string& folder) {
    release();
    file_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    held_ = file_ < 0 || ::flock(file_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    if (!held_) release();
    return held_;
}

void FolderLock::release() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
    held_ = false;
}

}  // namespace sample
