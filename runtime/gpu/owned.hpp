#pragma once

#include <utility>

#include "runtime/gpu/functions.hpp"
#include "runtime/gpu/memory.hpp"

namespace espalier {

class Device;

// Hands a handle to the device's retire queue: it is destroyed when all GPU work that was recorded before this
// call has finished. See retire.hpp.
void retire(Device& device, VkBuffer handle);
void retire(Device& device, VkImage handle);
void retire(Device& device, VkImageView handle);
void retire(Device& device, VkSampler handle);
void retire(Device& device, VkBufferView handle);
void retire(Device& device, VkPipeline handle);
void retire(Device& device, VkPipelineLayout handle);
void retire(Device& device, VkDescriptorSetLayout handle);
void retire(Device& device, const MemoryBlock& block);

// A Vulkan handle with one owner. Dropping it is safe at any time on the device's thread, also while the GPU still
// uses it. The Device must outlive it.
template <class Handle>
class Owned {
  public:
    Owned() = default;
    Owned(Device& device, Handle handle) : device_(&device), handle_(handle) {}
    Owned(Owned&& other) noexcept
        : device_(std::exchange(other.device_, nullptr)), handle_(std::exchange(other.handle_, Handle{})) {}
    Owned& operator=(Owned&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        other.reset();
        return *this;
    }
    ~Owned() { reset(); }

    void reset() {
        if (device_) retire(*device_, handle_);
        device_ = nullptr;
        handle_ = Handle{};
    }
    const Handle& get() const { return handle_; }
    explicit operator bool() const { return device_ != nullptr; }

  private:
    Device* device_ = nullptr;
    Handle handle_{};
};

}  // namespace espalier
