// Files in and out, whole. Writing goes through a neighbour that is renamed, so that nothing is ever half-written.
#include "runtime/core/file.hpp"

#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <memory>

#include "runtime/core/platform.hpp"

namespace espalier {
namespace {

Failure systemFailure(const std::filesystem::path& path, const std::string& what, int error) {
    return Failure(path.string(), what + ": " + std::strerror(error));
}

template <class Container>
Result<Container> readWhole(const std::filesystem::path& path) {
    using Kind = platform::File::Kind;
    platform::File file(path, platform::File::Open::read);
    if (file.error() != 0) return systemFailure(path, "cannot be opened", file.error());
    Kind kind;
    uint64_t size = 0;
    if (const int error = file.describe(kind, size)) return systemFailure(path, "cannot be read", error);
    if (kind == Kind::folder) return Failure(path.string(), "is a folder, not a file");
    if (kind == Kind::device) return Failure(path.string(), "is a device, not a file");
    if (kind == Kind::pipe) return Failure(path.string(), "is a pipe, not a file");
    try {
        Container bytes;
        bytes.resize(size_t(size));
        size_t have = 0;
        for (;;) {  // growing files and those of /proc have no size to trust
            if (have == bytes.size()) bytes.resize(have + 65536);
            size_t got = 0;
            const int error = file.read(std::as_writable_bytes(std::span(bytes)).subspan(have), got);
            if (error != 0) return systemFailure(path, "cannot be read", error);
            if (got == 0) break;
            have += got;
        }
        bytes.resize(have);
        return bytes;
    } catch (const std::exception&) {  // bad_alloc, or length_error of a size that nothing could hold
        return systemFailure(path, "cannot be read", ENOMEM);
    }
}

// A file that nobody has, beside `path`.
std::unique_ptr<platform::File> makeNeighbour(const std::filesystem::path& path, std::string& name) {
    constexpr int kAttempts = 100;
    for (int attempt = 0;; ++attempt) {
        name = neighbourOf(path);
        auto file = std::make_unique<platform::File>(name, platform::File::Open::create);
        if (file->error() != EEXIST || attempt == kAttempts) return file;
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

}  // namespace

Result<std::vector<std::byte>> readFile(const std::filesystem::path& path) {
    return readWhole<std::vector<std::byte>>(path);
}

Result<std::string> readTextFile(const std::filesystem::path& path) {
    return readWhole<std::string>(path);
}

std::string neighbourOf(const std::filesystem::path& path) {
    char digits[24];
    std::snprintf(digits, sizeof digits, ".%016" PRIx64, platform::randomBits());
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
        platform::File device(path, platform::File::Open::write);
        const int failed = device.error() != 0 ? device.error() : device.write(bytes);
        return failed ? Status(systemFailure(path, "cannot be written", failed)) : Status(Done{});
    }

    const std::filesystem::path target = follow ? behindLinks(path) : path;
    std::string partial;
    const std::unique_ptr<platform::File> file = makeNeighbour(target, partial);
    if (file->error() != 0) return systemFailure(path, "cannot be written", file->error());
    int reason = file->write(bytes);
    if (const int failed = file->close(); !reason) reason = failed;
    if (!reason) {
        std::filesystem::rename(partial, target, error);
        reason = error.value();
    }
    if (!reason) return Done{};
    std::filesystem::remove(partial, error);
    return systemFailure(path, "cannot be written", reason);
}

Status writeFile(const std::filesystem::path& path, std::string_view text, Links links) {
    return writeFile(path, std::as_bytes(std::span(text.data(), text.size())), links);
}

}  // namespace espalier
