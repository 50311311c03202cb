#pragma once

// What differs between operating systems and between compilers, all of it: a port changes this header, platform.cpp and
// nothing else of the runtime. Functions throw nothing but std::bad_alloc; error codes are those of <cerrno>.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

// Of compilers. Hints: where a compiler doesn't know one, the result is the same and comes later.
#if defined(__GNUC__)
// All that the function calls is compiled into it.
#define ESPALIER_FLATTEN __attribute__((flatten))
// Likewise, and it is compiled into nothing.
#define ESPALIER_SELDOM __attribute__((noinline, flatten))
// What lies at an address will be read, or written.
#define ESPALIER_WILL_READ(address) __builtin_prefetch(address)
#define ESPALIER_WILL_WRITE(address) __builtin_prefetch(address, 1)
// Nothing else leads to what the reference leads to.
#define ESPALIER_ALONE __restrict
#else
#define ESPALIER_FLATTEN
#define ESPALIER_SELDOM
#define ESPALIER_WILL_READ(address) ((void)(address))
#define ESPALIER_WILL_WRITE(address) ((void)(address))
#define ESPALIER_ALONE
#endif

// Of functions with loops over lanes (lanes.hpp): compiled for wider vectors. Not by clang, which hands small vectors
// over in registers, also where it inlines, and makes none of loops over them: such loops take a third more time than
// lanes one by one.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define ESPALIER_HAS_WIDE_VECTORS 1
#define ESPALIER_AVX2 __attribute__((flatten, target("avx2")))
#define ESPALIER_AVX512 __attribute__((flatten, target("avx512f,avx512bw,avx512dq,avx512vl")))
#else
#define ESPALIER_HAS_WIDE_VECTORS 0
#define ESPALIER_AVX2
#define ESPALIER_AVX512
#endif
// Picks one of both at run time, which AddressSanitizer can't stand; no fused operations, so the bits are the same.
#if ESPALIER_HAS_WIDE_VECTORS && !defined(__SANITIZE_ADDRESS__)
#define ESPALIER_LANES __attribute__((flatten, target_clones("avx2", "default")))
#else
#define ESPALIER_LANES ESPALIER_FLATTEN
#endif

namespace espalier {

// Vectors of eight floats, AVX2's, or of 16, AVX-512's, or narrower ones.
enum class VectorKind { narrow, avx2, avx512 };

namespace platform {

// The widest that this processor has and the compiler makes use of.
VectorKind widestVectors();

// Shared libraries. Null: there is none, or it hasn't got the function. A library stays loaded until the process ends,
// also after close().
extern const char* const kVulkanLoader;
void* openLibrary(const char* name);
void* functionOf(void* library, const char* name);
void closeLibrary(void* library);
// The file of the library or program that holds a function, as far as that is known; else empty.
std::filesystem::path fileOfCode(const void* function);

// Processes.
uint64_t processNumber();
bool processRuns(uint64_t number);

// Unlike what any other call gives, in any process.
uint64_t randomBits();

// Memory of the process's own. Asks for large pages, which random reads miss less often, and first writes wait for
// less; drops what whole pages hold, so that they cost nothing until they are touched. Both do nothing where the system
// has no such thing, or the memory is of another kind.
void askForLargePages(void* at, uint64_t size) noexcept;
void dropPages(void* at, uint64_t size) noexcept;

// A file that is open; never inherited by other processes.
class File {
  public:
    enum class Open {
        read,    // doesn't wait for a pipe's other end
        write,   // what is there
        create,  // fails with EEXIST where anything has that name, a link too; the process's file mode mask applies
    };
    enum class Kind { file, folder, device, pipe };

    File(const std::filesystem::path& path, Open how);
    ~File();
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    // Why it couldn't be opened; 0: it is.
    int error() const { return error_; }
    // 0, or why not.
    int describe(Kind& kind, uint64_t& size) const;
    int read(std::span<std::byte> into, size_t& got);  // 0 got: it ends there
    int write(std::span<const std::byte> bytes);       // all of them
    int close();

  private:
    int descriptor_ = -1, error_ = 0;
};

}  // namespace platform
}  // namespace espalier
