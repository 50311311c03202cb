// Write beside, rename: POSIX promises that a reader sees the old file or the new one.
#include "tools/scene/unfinished.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

constexpr const char* kPrefix = ".unfinished-";

// With the process, so that what is left behind can be told, and a number that nobody can foresee.
std::string anyName() {
    uint64_t random = 0;
    (void)::getentropy(&random, sizeof random);
    char text[64];
    std::snprintf(text, sizeof text, "%s%d-%016" PRIx64, kPrefix, int(::getpid()), random);
    return text;
}

}  // namespace

bool Unfinished::isAbandoned(const std::string& name) {
    if (!name.starts_with(kPrefix)) return false;
    const long writer = std::strtol(name.c_str() + std::strlen(kPrefix), nullptr, 10);
    return writer <= 0 || (::kill(pid_t(writer), 0) != 0 && errno == ESRCH);
}

Unfinished::Unfinished(const std::string& path) : folder_(&own_), path_(path) {
    const std::filesystem::path place = behindLinks(path);
    own_ = Folder::at(place.has_parent_path() ? place.parent_path().string() : ".", why_);
    name_ = place.filename().string();
}

Unfinished::Unfinished(const Folder& folder, std::string name)
    : folder_(&folder), path_(folder.pathOf(name)), name_(std::move(name)) {}

Unfinished::~Unfinished() {
    if (file_ >= 0) ::close(file_);
    if (!beside_.empty()) folder_->remove(beside_);
}

bool Unfinished::fail(std::string& error) const {
    error = path_ + ": can't be written: " + std::strerror(errno ? errno : EIO);
    return false;
}

bool Unfinished::make(std::string& error) {
    constexpr int kAttempts = 100;
    if (!*folder_ || !Folder::isName(name_)) {
        error = path_ + ": can't be written: " + (*folder_ ? "it has no name" : why_);
        return false;
    }
    struct stat before {};
    const bool replaces =
        ::fstatat(folder_->handle(), name_.c_str(), &before, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(before.st_mode);
    const mode_t mode = replaces ? before.st_mode & 0777 : 0666;
    for (int i = 0; file_ < 0 && i < kAttempts; ++i) {
        const std::string name = anyName();
        file_ = ::openat(folder_->handle(), name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
        if (file_ >= 0) beside_ = name;
        if (file_ < 0 && errno != EEXIST) break;
    }
    if (file_ < 0) return fail(error);
    if (replaces) (void)::fchmod(file_, mode);  // whatever this process's mask is
    return true;
}

bool Unfinished::write(std::string_view bytes, std::string& error) {
    if (file_ < 0 && !make(error)) return false;
    while (!bytes.empty()) {
        const ssize_t put = ::write(file_, bytes.data(), bytes.size());
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) return fail(error);
        bytes.remove_prefix(size_t(put));
    }
    return true;
}

bool Unfinished::flush(std::string& error) {
    return ::fsync(file_) == 0 || fail(error);
}

bool Unfinished::take(std::string& error) {
    if (::close(std::exchange(file_, -1)) != 0) return fail(error);
    if (::renameat(folder_->handle(), beside_.c_str(), folder_->handle(), name_.c_str()) != 0) return fail(error);
    beside_.clear();
    return true;
}

}  // namespace espalier::scene
