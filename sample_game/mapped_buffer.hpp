#pragma once

#include "sample_game/vulkan_host.hpp"

namespace sample {

// A buffer that the CPU writes and the GPU reads. The host outlives it.
class MappedBuffer {
  public:
    explicit MappedBuffer(const VulkanHost& host) : host_(host) {}
    MappedBuffer(const MappedBuffer&) = delete;
    ~MappedBuffer() { drop(); }

    // At least so many bytes; what was in it is lost where it has to grow. The GPU must be done with it. False: what
    // Vulkan says is in result().
    bool reserve(VkDeviceSize bytes, VkBufferUsageFlags usage);
    void drop();

    VkBuffer buffer() const { return buffer_; }
    void* bytes() const { return bytes_; }
    VkResult result() const { return result_; }

  private:
    const VulkanHost& host_;
    VkResult result_ = VK_SUCCESS;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    void* bytes_ = nullptr;
    VkDeviceSize size_ = 0;
};

}  // namespace sample
