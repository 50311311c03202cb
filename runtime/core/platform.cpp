// POSIX, and what Linux has beyond it.
#include "runtime/core/platform.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <limits>
#include <system_error>
#include <utility>

namespace espalier::platform {
namespace {

// madvise refuses what doesn't begin with a page.
uintptr_t pageBytes() {
    static const long size = sysconf(_SC_PAGESIZE);
    return size > 0 ? uintptr_t(size) : 4096;
}

uintptr_t pagesFrom(const void* at) {
    const uintptr_t page = pageBytes();
    return (reinterpret_cast<uintptr_t>(at) + page - 1) / page * page;
}

}  // namespace

VectorKind widestVectors() {
#if ESPALIER_HAS_WIDE_VECTORS
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        return VectorKind::avx512;
    if (__builtin_cpu_supports("avx2")) return VectorKind::avx2;
#endif
    return VectorKind::narrow;
}

#ifdef __APPLE__
const char* const kVulkanLoader = "libvulkan.1.dylib";
#else
const char* const kVulkanLoader = "libvulkan.so.1";
#endif

void* openLibrary(const char* name) {
    return ::dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
}

void* functionOf(void* library, const char* name) {
    return ::dlsym(library, name);
}

void closeLibrary(void* library) {
    ::dlclose(library);
}

std::filesystem::path fileOfCode(const void* function) {
    Dl_info info{};
    if (!::dladdr(function, &info) || !info.dli_fname) return {};
    std::error_code ignored;
    std::filesystem::path file = std::filesystem::canonical(info.dli_fname, ignored);
    return ignored ? std::filesystem::absolute(info.dli_fname, ignored) : file;
}

uint64_t processNumber() {
    return uint64_t(::getpid());
}

bool processRuns(uint64_t number) {
    const bool possible = number > 0 && number <= uint64_t(std::numeric_limits<pid_t>::max());
    return possible && (::kill(pid_t(number), 0) == 0 || errno == EPERM);
}

uint64_t randomBits() {
    uint64_t bits = 0;
    (void)::getentropy(&bits, sizeof bits);
    return bits;
}

void askForLargePages([[maybe_unused]] void* at, [[maybe_unused]] uint64_t size) noexcept {
#ifdef MADV_HUGEPAGE
    const uintptr_t end = reinterpret_cast<uintptr_t>(at) + size, first = pagesFrom(at);
    if (end > first) (void)::madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
#endif
}

void dropPages([[maybe_unused]] void* at, [[maybe_unused]] uint64_t size) noexcept {
#ifdef __linux__  // elsewhere what is dropped may keep its content
    const uintptr_t end = reinterpret_cast<uintptr_t>(at) + size, first = pagesFrom(at);
    const uintptr_t last = end / pageBytes() * pageBytes();
    if (last > first) (void)::madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
#endif
}

File::File(const std::filesystem::path& path, Open how) {
    int flags = O_CLOEXEC;
    if (how == Open::read) flags |= O_RDONLY | O_NONBLOCK;
    if (how == Open::write) flags |= O_WRONLY;
    if (how == Open::create) flags |= O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW;
    descriptor_ = ::open(path.c_str(), flags, 0666);
    error_ = descriptor_ < 0 ? errno : 0;
}

File::~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

int File::describe(Kind& kind, uint64_t& size) const {
    struct stat info {};
    if (::fstat(descriptor_, &info) != 0) return errno;
    const auto mode = info.st_mode;
    kind = S_ISDIR(mode)                      ? Kind::folder
           : S_ISCHR(mode) || S_ISBLK(mode)   ? Kind::device
           : S_ISFIFO(mode) || S_ISSOCK(mode) ? Kind::pipe
                                              : Kind::file;
    size = uint64_t(info.st_size);
    return 0;
}

int File::read(std::span<std::byte> into, size_t& got) {
    ssize_t count;
    do count = ::read(descriptor_, into.data(), into.size());
    while (count < 0 && errno == EINTR);
    got = count < 0 ? 0 : size_t(count);
    return count < 0 ? errno : 0;
}

int File::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t put = ::write(descriptor_, bytes.data(), bytes.size());
        if (put < 0 && errno == EINTR) continue;
        if (put < 0) return errno;
        bytes = bytes.subspan(size_t(put));
    }
    return 0;
}

int File::close() {
    return ::close(std::exchange(descriptor_, -1)) == 0 ? 0 : errno;
}

}  // namespace espalier::platform
