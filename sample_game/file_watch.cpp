// Stamps at each look, bytes when a stamp has changed and stands still.
#include "sample_game/file_watch.hpp"

#include <sys/stat.h>

#include <fstream>
#include <optional>
#include <utility>

#include "tools/scene/hash.hpp"

namespace sample {
namespace {

namespace fs = std::filesystem;

// Of all bytes; nothing if they can't be read.
std::optional<uint64_t> contentOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<char> piece(size_t(1) << 20);
    uint64_t hash = 0;
    while (file) {
        file.read(piece.data(), std::streamsize(piece.size()));
        hash = espalier::scene::hashOf(piece.data(), size_t(file.gcount()), hash);
    }
    return file.eof() ? std::optional(hash) : std::nullopt;
}

}  // namespace

FileStamp stampOf(const fs::path& file) {
    std::error_code noTime, noSize;
    struct stat found {};
    const bool there = stat(file.c_str(), &found) == 0;
    const FileStamp stamp{fs::last_write_time(file, noTime), fs::file_size(file, noSize), found.st_ino};
    return !there || noTime || noSize ? FileStamp{} : stamp;
}

bool writtenSince(const FileStamp& stamp, fs::file_time_type read) {
    return stamp.time >= read && stamp.time <= fs::file_time_type::clock::now();
}

void FileWatch::begin(std::vector<std::string> files, fs::file_time_type read) {
    files_.clear();
    for (std::string& path : files) {
        const FileStamp stamp = stampOf(path);
        const bool since = writtenSince(stamp, read);
        const uint64_t hash = since ? 0 : contentOf(path).value_or(0);
        files_.push_back({std::move(path), since ? FileStamp{} : stamp, stamp, hash});
    }
}

bool FileWatch::changed() {
    bool any = false;
    for (File& file : files_) {
        const FileStamp now = stampOf(file.path), before = std::exchange(file.last, now);
        if (now == file.seen || now != before || now == FileStamp{}) continue;
        const std::optional<uint64_t> hash = contentOf(file.path);
        if (!hash) continue;
        any = any || *hash != file.hash;
        file.seen = now;
        file.hash = *hash;
    }
    return any;
}

}  // namespace sample
