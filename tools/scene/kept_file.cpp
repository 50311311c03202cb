// Programs that write files well put a new one in the place of the old, which lives on as long as it is open.
#include "tools/scene/kept_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace espalier::scene {

std::shared_ptr<const KeptFile> KeptFile::open(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    return file < 0 ? nullptr : std::shared_ptr<const KeptFile>(new KeptFile(file));
}

KeptFile::~KeptFile() {
    ::close(file_);
}

KeptFile::Stamp KeptFile::stampOf(const struct stat& file) {
    if (!S_ISREG(file.st_mode)) return {};
    return {file.st_dev, file.st_ino, file.st_size, file.st_mtim.tv_sec, file.st_mtim.tv_nsec};
}

KeptFile::Stamp KeptFile::stamp() const {
    struct stat found;
    return ::fstat(file_, &found) == 0 ? stampOf(found) : Stamp();
}

bool KeptFile::isStill(const std::string& path) const {
    struct stat found;
    return stamp_.size >= 0 && ::stat(path.c_str(), &found) == 0 && stampOf(found) == stamp_ && stamp() == stamp_;
}

bool KeptFile::read(std::string& bytes) const {
    if (stamp_.size < 0 || stamp() != stamp_) return false;
    bytes.resize(size_t(stamp_.size));
    for (size_t at = 0; at < bytes.size();) {
        const ssize_t got = ::pread(file_, bytes.data() + at, bytes.size() - at, off_t(at));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        at += size_t(got);
    }
    return stamp() == stamp_;
}

}  // namespace espalier::scene
