#pragma once

// What the fuzzed functions share: files in memory, and promises that end the program when broken.

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

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

inline void require(bool kept, const char* promise) {
    if (kept) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

inline void checkMessage(const Failure& failure) {
    require(!failure.diagnostics.empty() && !failure.diagnostics.front().message.empty(), "a failure has a message");
}

}  // namespace espalier::fuzz
