// Files by name relative to an open folder: nobody can put a link in between.
#include "tools/scene/folder.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

namespace espalier::scene {
namespace {

bool hasType(int folder, const std::string& name, mode_t type) {
    struct stat found {};
    return Folder::isName(name) && ::fstatat(folder, name.c_str(), &found, AT_SYMLINK_NOFOLLOW) == 0 &&
           (found.st_mode & S_IFMT) == type;
}

std::string because(int reason) {
    return reason == ELOOP || reason == ENOTDIR ? "is a link, or no folder" : std::strerror(reason);
}

}  // namespace

Folder::~Folder() {
    if (handle_ >= 0) ::close(handle_);
}
Folder::Folder(Folder&& other) noexcept : handle_(std::exchange(other.handle_, -1)), path_(std::move(other.path_)) {}
Folder& Folder::operator=(Folder&& other) noexcept {
    std::swap(handle_, other.handle_);
    std::swap(path_, other.path_);
    return *this;
}

Folder Folder::at(const std::string& path, std::string& error) {
    Folder made;
    made.path_ = path;
    constexpr int kOpen = O_DIRECTORY | O_CLOEXEC;
    made.handle_ = ::open(path.empty() ? "." : path.c_str(), O_RDONLY | kOpen);
    // One that may be written into but not listed.
    if (made.handle_ < 0 && errno == EACCES) made.handle_ = ::open(path.c_str(), O_PATH | kOpen);
    if (made.handle_ < 0) error = path + ": can't be opened: " + std::strerror(errno);
    return made;
}

Folder Folder::in(const std::string& name, bool make, std::string& error) const {
    Folder made;
    made.path_ = pathOf(name);
    if (!isName(name)) {
        error = made.path_ + ": isn't the name of a folder";
        return made;
    }
    if (make && ::mkdirat(handle_, name.c_str(), 0777) == 0 && !flush(error)) return made;
    made.handle_ = ::openat(handle_, name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (made.handle_ < 0) error = made.path_ + ": can't be used: " + because(errno);
    return made;
}

std::string Folder::pathOf(const std::string& name) const {
    return (std::filesystem::path(path_) / name).string();
}

bool Folder::holdsFile(const std::string& name) const {
    return hasType(handle_, name, S_IFREG);
}

bool Folder::holdsLink(const std::string& name) const {
    return hasType(handle_, name, S_IFLNK);
}

std::vector<std::string> Folder::names() const {
    std::vector<std::string> all;
    const int own = ::openat(handle_, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const std::unique_ptr<DIR, int (*)(DIR*)> listed(own < 0 ? nullptr : ::fdopendir(own), ::closedir);
    if (!listed && own >= 0) ::close(own);
    while (const dirent* entry = listed ? ::readdir(listed.get()) : nullptr)
        if (isName(entry->d_name)) all.push_back(entry->d_name);
    return all;
}

void Folder::remove(const std::string& name) const {
    if (isName(name)) ::unlinkat(handle_, name.c_str(), 0);
}

void Folder::removeFolder(const std::string& name) const {
    if (isName(name)) ::unlinkat(handle_, name.c_str(), AT_REMOVEDIR);
}

bool Folder::flush(std::string& error) const {
    if (::fsync(handle_) == 0) return true;
    error = path_ + ": can't be flushed to the disk: " + std::strerror(errno);
    return false;
}

bool Folder::isName(std::string_view text) {
    return !text.empty() && text != "." && text != ".." && text.find('/') == std::string_view::npos &&
           text.find('\0') == std::string_view::npos;
}

}  // namespace espalier::scene
