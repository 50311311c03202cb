#pragma once

// What a growth runs, as rows: kernels over so many groups, one after another. The same list is recorded for a device
// or runs at once as native code (runner.hpp); CPU references run it too (host_runner.hpp).

#include <array>
#include <cstddef>
#include <cstring>
#include <functional>
#include <type_traits>
#include <vector>

#include "runtime/core/check.hpp"
#include "runtime/gpu/program.hpp"

namespace espalier {

// What the kernels of a list share, as bits that their table names. A stage waits for those before it that have written
// what it reads or writes, and for those that have read what it writes.
using Things = uint32_t;

// A row of a table of kernels.
struct Kernel {
    const char* shader = "";       // its path below shaders/; native code goes by the same name
    Things reads = 0, writes = 0;  // what it reads and writes is among both
    uint32_t groupItems = 0;       // its local size along x, where somebody relies on that; 0: any
};

// What a kernel is handed: a trivially copyable record.
class Environment {
  public:
    template <class T>
    void set(const T& record) {
        static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= kMost);
        std::memcpy(bytes_.data(), &record, sizeof record);
        size_ = sizeof record;
    }
    // Of the type that was set.
    template <class T>
    T& as() {
        requireEqual(uint32_t(sizeof(T)), size_, "bytes of a stage's environment");
        return *reinterpret_cast<T*>(bytes_.data());
    }
    const void* data() const { return bytes_.data(); }
    uint32_t size() const { return size_; }  // 0: none

  private:
    static constexpr size_t kMost = 256;
    alignas(16) std::array<std::byte, kMost> bytes_;
    uint32_t size_ = 0;
};

struct Groups {
    std::array<uint32_t, 3> count{1, 1, 1};
    // If given, a VkDispatchIndirectCommand there says how many.
    const Buffer* from = nullptr;
    uint64_t offset = 0;  // bytes
    Things thing = 0;     // that it is
};

struct Stage {
    Kernel kernel;
    const char* pass = "";  // that it is timed as; of stages that follow each other it is one
    Environment push;       // push data, and what native code is handed
    Environment native;     // what native code is handed instead, if anything
    Groups groups;
    std::vector<SpecConstant> constants;
    std::vector<Binding> bindings;
    uint64_t laneBytes = 0;  // memory of its lanes, which a device binds last; native code needs none
    uint32_t rounds = 1;     // a dispatch goes on where the one before has ended; native code needs one
    // Waves: it runs once for each of [firstWave, lastWave), as `turn` makes it for that one. Native code leaves out
    // those after one in which nothing waits. together: in each wave so many stages run, this and those behind it.
    uint32_t firstWave = 0, lastWave = 1, together = 1;
    std::function<void(Stage& stage, uint32_t wave)> turn;
    bool watched = true;  // else it is brought to its end whoever watches
};
using StageList = std::vector<Stage>;

}  // namespace espalier
