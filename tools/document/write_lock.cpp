// flock of a file that is there only meanwhile. The folder itself is what editors lock for as long as they have it
// open.
#include "tools/document/write_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

namespace espalier::document {
namespace {

constexpr std::chrono::milliseconds kLookEvery{20};
constexpr const char* kLock = ".writing";

}  // namespace

WriteLock::~WriteLock() {
    if (file_ < 0) return;
    folder_.remove(kLock);
    ::close(file_);
}

bool WriteLock::take(const std::string& folder, std::chrono::seconds longest, Progress& progress, std::string& error) {
    std::string ignored;
    folder_ = scene::Folder::at(folder, ignored);
    if (!folder_) return true;  // nor can what is to be written be, which will say why
    const Clock::time_point end = Clock::now() + longest;
    for (;;) {
        constexpr int kOpen = O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
        file_ = ::openat(folder_.handle(), kLock, O_RDWR | O_CREAT | kOpen, 0644);
        if (file_ < 0) file_ = ::openat(folder_.handle(), kLock, O_RDONLY | kOpen);  // another user's
        if (file_ < 0 && errno == ELOOP) {
            error = folder_.pathOf(kLock) + ": is a link, which no program of ours has made; remove it to save here";
            return false;
        }
        if (file_ < 0) return true;
        const bool good = wait(end, progress, error);
        if (good && isThere()) return true;
        ::close(file_);
        file_ = -1;
        if (!good) return false;
    }
}

bool WriteLock::wait(Clock::time_point end, Progress& progress, std::string& error) const {
    while (::flock(file_, LOCK_EX | LOCK_NB) != 0 && (errno == EWOULDBLOCK || errno == EINTR)) {
        if (!progress.at(0)) return false;
        if (Clock::now() > end) {
            error = folder_.pathOf(kLock) + ": another program is writing there and doesn't come to an end";
            return false;
        }
        std::this_thread::sleep_for(kLookEvery);
    }
    return true;
}

// Who had it before has removed the file that this one waited for.
bool WriteLock::isThere() const {
    struct stat ours;
    struct stat now;
    return ::fstat(file_, &ours) == 0 && ::fstatat(folder_.handle(), kLock, &now, AT_SYMLINK_NOFOLLOW) == 0 &&
           ours.st_ino == now.st_ino && ours.st_dev == now.st_dev;
}

}  // namespace espalier::document
