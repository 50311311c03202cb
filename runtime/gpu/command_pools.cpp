// Command buffers that go round with the timeline.
#include "runtime/gpu/command_pools.hpp"

#include <algorithm>

#include "runtime/gpu/retire.hpp"

namespace espalier {

CommandPools::~CommandPools() {
    for (Slot& slot : slots_) device_.vk().vkDestroyCommandPool(device_.handle(), slot.pool, nullptr);
}

Result<uint32_t> CommandPools::acquire(uint64_t serial) {
    const DeviceFunctions& vk = device_.vk();
    const uint64_t oldest = device_.retireQueue().oldestPending();
    auto vacant = std::ranges::find_if(slots_, [&](const Slot& slot) { return slot.serial < oldest; });
    if (vacant != slots_.end()) {
        if (!device_.succeeded(vk.vkResetCommandPool(device_.handle(), vacant->pool, 0)))
            return gpuFailure(device_, "commands", "using a command pool again");
        vacant->serial = serial;
        return uint32_t(vacant - slots_.begin());
    }
    Slot slot;
    slot.serial = serial;
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = device_.info().queueFamily;
    if (!device_.succeeded(vk.vkCreateCommandPool(device_.handle(), &pool, nullptr, &slot.pool)))
        return gpuFailure(device_, "commands", "making a command pool");
    slots_.push_back(slot);
    VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    info.commandPool = slot.pool;
    info.commandBufferCount = 1;
    if (!device_.succeeded(vk.vkAllocateCommandBuffers(device_.handle(), &info, &slots_.back().commands))) {
        vk.vkDestroyCommandPool(device_.handle(), slot.pool, nullptr);
        slots_.pop_back();
        return gpuFailure(device_, "commands", "making a command buffer");
    }
    return uint32_t(slots_.size() - 1);
}

}  // namespace espalier
