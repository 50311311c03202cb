// Write beside, flush, rename, flush the folder: POSIX promises that a reader sees the old file or the new one.
#include "tools/document/durable.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

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

}  // namespace

const char* const kUnfinished = ".unfinished-";

bool writeDurably(const std::string& path, const std::function<bool(const std::string&, std::string&)>& write,
                  std::string& error) {
    const fs::path place(path), folder = place.has_parent_path() ? place.parent_path() : ".";
    const std::string beside =
        (folder / (kUnfinished + std::to_string(::getpid()) + "-" + place.filename().string())).string();
    bool good = write(beside, error) && flush(beside, O_RDONLY, error);
    if (good && std::rename(beside.c_str(), path.c_str()) != 0) {
        error = path + ": can't be written: " + std::strerror(errno);
        good = false;
    }
    if (!good) ::unlink(beside.c_str());
    return good && flush(folder.string(), O_RDONLY | O_DIRECTORY, error);
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
        const bool good = file >= 0 && at == text.size();
        if (!good) why = path + ": can't be written: " + std::strerror(errno);
        if (file >= 0 && ::close(file) != 0 && good) why = path + ": can't be written: " + std::strerror(errno);
        return good && why.empty();
    };
    return writeDurably(path, write, error);
}

}  // namespace espalier::document
