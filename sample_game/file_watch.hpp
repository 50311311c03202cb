#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace sample {

// What tells cheaply that a file may have changed. One that isn't there: nothing but zeros.
struct FileStamp {
    std::filesystem::file_time_type time{};
    uintmax_t size = 0;
    uint64_t number = 0;  // the file system's: one that takes a file's place may be as long and of the same instant
    bool operator==(const FileStamp&) const = default;
};
FileStamp stampOf(const std::filesystem::path& file);

constexpr std::filesystem::file_time_type kNeverWritten = std::filesystem::file_time_type::max();
// Whether a file of that time was written since. What lies in the future was set so, or by another clock: it tells
// nothing, and would for ever.
bool writtenSince(const FileStamp& stamp, std::filesystem::file_time_type read);

// Files that other programs may write. They are read only when their stamps change, and only other bytes count.
class FileWatch {
  public:
    // As they are now they count as seen, but what was written since `read`, when whoever asks began to read them.
    void begin(std::vector<std::string> files, std::filesystem::file_time_type read = kNeverWritten);
    // Whether one of them holds other bytes than at begin() or when this last was true. One that is being written, so
    // that its stamp isn't the last look's, waits; one that can't be read counts as it was.
    bool changed();

  private:
    struct File {
        std::string path;
        FileStamp seen, last;  // that the hash is of; of the last look
        uint64_t hash = 0;
    };
    std::vector<File> files_;
};

}  // namespace sample
