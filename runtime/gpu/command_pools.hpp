#pragma once

#include <vector>

#include "runtime/gpu/device.hpp"

namespace espalier {

// Command buffers, each with a pool of its own, used again when their recording has finished.
class CommandPools {
  public:
    explicit CommandPools(Device& device) : device_(device) {}
    ~CommandPools();
    CommandPools(const CommandPools&) = delete;
    CommandPools& operator=(const CommandPools&) = delete;

    struct Slot {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        uint64_t serial = 0;  // of its recording; free when that is before the oldest pending one
    };
    // The index of a slot that is ready to be begun; fails when memory has run out.
    Result<uint32_t> acquire(uint64_t serial);
    const Slot& slot(uint32_t index) const { return slots_[index]; }

  private:
    Device& device_;
    std::vector<Slot> slots_;
};

}  // namespace espalier
