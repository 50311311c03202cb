// Files in and out, whole. Writing goes through a neighbour that is renamed, so that nothing is ever half-written.
#include "runtime/core/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <cstring>

namespace espalier {
namespace {

Failure systemFailure(const std::filesystem::path& path, const std::string& what, int error) {
    return Failure(path.string(), what + ": " + std::strerror(error));
}

class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return fd_; }
    int close() { return ::close(std::exchange(fd_, -1)); }

  private:
    int fd_;
};

template <class Container>
Result<Container> readWhole(const std::filesystem::path& path) {
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));  // a pipe may have no other end
    if (file.get() < 0) return systemFailure(path, "cannot be opened", errno);
    struct stat info {};
    if (::fstat(file.get(), &info) != 0) return systemFailure(path, "cannot be read", errno);
    if (S_ISDIR(info.st_mode)) return Failure(path.string(), "is a folder, not a file");
    if (S_ISCHR(info.st_mode) || S_ISBLK(info.st_mode)) return Failure(path.string(), "is a device, not a file");
    if (S_ISFIFO(info.st_mode) || S_ISSOCK(info.st_mode)) return Failure(path.string(), "is a pipe, not a file");
    try {
        Container bytes;
        bytes.resize(size_t(info.st_size));
        size_t have = 0;
        for (;;) {  // growing files and those of /proc have no size to trust
            if (have == bytes.size()) bytes.resize(have + 65536);
            ssize_t got = ::read(file.get(), bytes.data() + have, bytes.size() - have);
            if (got < 0 && errno == EINTR) continue;
            if (got < 0) return systemFailure(path, "cannot be read", errno);
            if (got == 0) break;
            have += size_t(got);
        }
        bytes.resize(have);
        return bytes;
    } catch (const std::exception&) {  // bad_alloc, or length_error of a size that nothing could hold
        return systemFailure(path, "cannot be read", ENOMEM);
    }
}

// A file that nobody has, beside `path`; the process's file mode mask applies.
int makeNeighbour(const std::filesystem::path& path, std::string& name) {
    constexpr int kAttempts = 100;
    for (int attempt = 0;; ++attempt) {
        name = neighbourOf(path);
        const int fd = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (fd >= 0 || errno != EEXIST || attempt == kAttempts) return fd;
    }
}

// What a link leads to, or else the path itself: a link that leads nowhere yet is followed, too.
std::filesystem::path behindLinks(const std::filesystem::path& path) {
    constexpr int kMostLinks = 40;
    std::filesystem::path behind = path;
    std::error_code error;
    for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(behind, error); ++i)
        behind = behind.parent_path() / std::filesystem::read_symlink(behind, error);
    return behind;
}

int writeAll(int fd, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        ssize_t put = ::write(fd, bytes.data(), bytes.size());
        if (put < 0 && errno == EINTR) continue;
        if (put < 0) return errno;
        bytes = bytes.subspan(size_t(put));
    }
    return 0;
}

}  // namespace

Result<std::vector<std::byte>> readFile(const std::filesystem::path& path) {
    return readWhole<std::vector<std::byte>>(path);
}

Result<std::string> readTextFile(const std::filesystem::path& path) {
    return readWhole<std::string>(path);
}

std::string neighbourOf(const std::filesystem::path& path) {
    uint64_t random = 0;
    (void)::getentropy(&random, sizeof random);
    char digits[24];
    std::snprintf(digits, sizeof digits, ".%016" PRIx64, random);
    return path.string() + digits + ".partial";
}

Status writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes, Links links) {
    const bool follow = links == Links::follow;
    std::error_code error;
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
    if (error) return Failure(path.string(), "its folder cannot be made: " + error.message());
    const std::filesystem::file_type type =
        (follow ? std::filesystem::status(path, error) : std::filesystem::symlink_status(path, error)).type();
    using Type = std::filesystem::file_type;
    if (type == Type::directory) return Failure(path.string(), "is a folder, not a file");
    // A pipe or a device is no file that could be replaced: renaming over /dev/null would be a disaster.
    const bool special = type == Type::character || type == Type::block || type == Type::fifo || type == Type::socket;
    if (special && follow) {
        Descriptor device(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
        const int failed = device.get() < 0 ? errno : writeAll(device.get(), bytes);
        return failed ? Status(systemFailure(path, "cannot be written", failed)) : Status(Done{});
    }

    const std::filesystem::path target = follow ? behindLinks(path) : path;
    std::string partial;
    Descriptor file(makeNeighbour(target, partial));
    if (file.get() < 0) return systemFailure(path, "cannot be written", errno);
    int reason = writeAll(file.get(), bytes);
    if (file.close() != 0 && !reason) reason = errno;
    if (!reason && ::rename(partial.c_str(), target.c_str()) != 0) reason = errno;
    if (!reason) return Done{};
    ::unlink(partial.c_str());
    return systemFailure(path, "cannot be written", reason);
}

Status writeFile(const std::filesystem::path& path, std::string_view text, Links links) {
    return writeFile(path, std::as_bytes(std::span(text.data(), text.size())), links);
}

}  // namespace espalier
