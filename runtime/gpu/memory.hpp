#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "runtime/core/result.hpp"
#include "runtime/gpu/functions.hpp"

namespace espalier {

// device: fastest for kernels, mapped only where the machine has one kind of memory.
// upload: the CPU writes in order, the GPU reads. readback: the GPU writes, the CPU reads (cached).
enum class BufferUse { device, upload, readback };

// A piece of a VkDeviceMemory. mapped: where the CPU sees its first byte (coherent), or null.
struct MemoryBlock {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    VkDeviceSize size = 0;
    std::byte* mapped = nullptr;
    uint64_t token = 0;  // the source's own mark
};

struct MemoryRequest {
    VkMemoryRequirements requirements;
    BufferUse use = BufferUse::device;
    bool image = false;  // an optimally tiled image: kept apart from buffers
    const char* name = "";
};

// Where a device's memory comes from. A host that has an allocator of its own derives from this and hands it in
// with HostDevice; it must outlive the Device. Memory for buffers must be allocated with
// VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT. Called from the device's thread only.
class MemorySource {
  public:
    virtual ~MemorySource() = default;
    // Fails when memory has run out.
    virtual Result<MemoryBlock> allocate(const MemoryRequest& request) = 0;
    virtual void free(const MemoryBlock& block) noexcept = 0;
    // Gives back to Vulkan what is only kept for later requests.
    virtual void trim() {}
    // Bytes handed out, and bytes taken from Vulkan for that.
    virtual uint64_t bytesUsed() const = 0;
    virtual uint64_t bytesReserved() const = 0;
};

// The default: blocks of 64 MiB a memory type, cut by a best-fit free list. Up to `keepBytes` of empty blocks stay
// for reuse, since the first touch of fresh memory costs more than the work on it (1 to 1.6 GB/s on a CPU device).
// software: memory is the process's own, and what nobody has touched since it was taken costs none.
std::unique_ptr<MemorySource> makePooledMemory(const DeviceFunctions& vk, VkDevice device,
                                               const VkPhysicalDeviceMemoryProperties& properties, bool software,
                                               uint64_t keepBytes = 1ull << 30);

}  // namespace espalier
