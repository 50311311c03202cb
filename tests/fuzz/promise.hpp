#pragma once

// What the fuzzed functions share: files in memory, and promises that end the program when broken.

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "runtime/core/result.hpp"
#include "tests/fuzz/targets.hpp"

namespace espalier::fuzz {

// A file that lives in memory, with a name by which it can be opened. Nothing lies beside it.
class MemoryFile {
  public:
    explicit MemoryFile(Bytes bytes) : fd_(::memfd_create("fuzz", MFD_CLOEXEC)) {
        for (size_t at = 0; at < bytes.size();) {
            ssize_t put = ::write(fd_, bytes.data() + at, bytes.size() - at);
            if (put <= 0) std::abort();
            at += size_t(put);
        }
    }
    ~MemoryFile() { ::close(fd_); }
    MemoryFile(const MemoryFile&) = delete;
    std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

  private:
    int fd_;
};

// A folder in memory that is empty, and goes with the process.
class MemoryFolder {
  public:
    MemoryFolder() {
        const char* shared = "/dev/shm";
        std::error_code none;
        const std::filesystem::path place =
            std::filesystem::is_directory(shared, none) ? shared : std::filesystem::temp_directory_path();
        std::string name = (place / "espalier-fuzz-XXXXXX").string();
        if (!::mkdtemp(name.data())) std::abort();
        path = name;
    }
    ~MemoryFolder() {
        clear();
        std::error_code none;
        std::filesystem::remove(path, none);
    }
    MemoryFolder(const MemoryFolder&) = delete;
    void clear() const {
        std::error_code none;
        for (const auto& entry : std::filesystem::directory_iterator(path, none))
            std::filesystem::remove_all(entry.path(), none);
    }
    void write(const std::string& name, std::string_view text) const {
        std::ofstream(path / name, std::ios::binary).write(text.data(), std::streamsize(text.size()));
    }
    std::filesystem::path path;
};

inline std::string_view textOf(Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline void require(bool kept, const char* promise) {
    if (kept) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

inline void checkMessage(const Failure& failure) {
    require(!failure.diagnostics.empty() && !failure.diagnostics.front().message.empty(), "a failure has a message");
}

}  // namespace espalier::fuzz
