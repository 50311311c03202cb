// Write beside, flush, rename, flush the folder: POSIX promises that a reader sees the old file or the new one.
#include "tools/document/durable.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

#include "tools/scene/text_file.hpp"

namespace espalier::document {
namespace {

namespace fs = std::filesystem;

bool flush(const std::string& path, int flags, std::string& error) {
    const int file = ::open(path.c_str(), flags | O_CLOEXEC);
    const bool good = file >= 0 && ::fsync(file) == 0;
    if (!good) error = path + ": can't be flushed to the disk: " + std::strerror(errno);
    if (file >= 0) ::close(file);
    return good;
}

constexpr const char* kUnfinished = ".unfinished-";

}  // namespace

bool isAbandoned(const std::string& name) {
    if (!name.starts_with(kUnfinished)) return false;
    const long writer = std::strtol(name.c_str() + std::strlen(kUnfinished), nullptr, 10);
    return writer <= 0 || (::kill(pid_t(writer), 0) != 0 && errno == ESRCH);
}

Unfinished::Unfinished(const std::string& path) : path_(path), place_(scene::behindLinks(path).string()) {
    const fs::path place(place_), folder = place.has_parent_path() ? place.parent_path() : ".";
    folder_ = folder.string();
    beside_ = (folder / (kUnfinished + std::to_string(::getpid()) + "-" + place.filename().string())).string();
}

Unfinished::~Unfinished() {
    if (!taken_) ::unlink(beside_.c_str());
}

bool Unfinished::write(const WriteFile& make, std::string& error) {
    if (make(beside_, error) && flush(beside_, O_RDONLY, error)) return true;
    // The user knows the file by its own name.
    if (error.starts_with(beside_)) error.replace(0, beside_.size(), path_);
    return false;
}

bool Unfinished::take(std::string& error) {
    // Who may read and write it stays as it was.
    struct stat before {};
    if (::stat(place_.c_str(), &before) == 0) (void)::chmod(beside_.c_str(), before.st_mode & 07777);
    taken_ = std::rename(beside_.c_str(), place_.c_str()) == 0;
    if (!taken_) error = path_ + ": can't be written: " + std::strerror(errno);
    return taken_ && flush(folder_, O_RDONLY | O_DIRECTORY, error);
}

bool writeDurably(const std::string& path, const WriteFile& make, std::string& error) {
    Unfinished file(path);
    return file.write(make, error) && file.take(error);
}

bool writeTextDurably(const std::string& path, const std::string& text, std::string& error) {
    const auto write = [&](const std::string& name, std::string& why) {
        const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
        size_t at = 0;
        while (file >= 0 && at < text.size()) {
            const ssize_t wrote = ::write(file, text.data() + at, text.size() - at);
            if (wrote < 0 && errno == EINTR) continue;
            if (wrote < 0) break;
            at += size_t(wrote);
        }
        bool good = file >= 0 && at == text.size();
        if (!good) why = path + ": can't be written: " + std::strerror(errno);
        if (file >= 0 && ::close(file) != 0 && good) {
            good = false;
            why = path + ": can't be written: " + std::strerror(errno);
        }
        return good;
    };
    return writeDurably(path, write, error);
}

bool makeFolderDurably(const std::string& folder, std::string& error) {
    std::vector<fs::path> missing;
    std::error_code code;
    for (fs::path at = scene::absolutePath(folder); at.has_relative_path() && !fs::exists(at, code);
         at = at.parent_path())
        missing.push_back(at);
    fs::create_directories(folder, code);
    if (code) error = folder + ": can't be made: " + code.message();
    return !code && std::ranges::all_of(missing, [&](const fs::path& made) {
        return flush(made.parent_path().string(), O_RDONLY | O_DIRECTORY, error);
    });
}

}  // namespace espalier::document
