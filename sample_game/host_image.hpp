#pragma once

#include <string>

#include "sample_game/vulkan_host.hpp"

namespace sample {

// An image of one colour plane with memory and view of its own, on the sample's device. The host outlives it.
class HostImage {
  public:
    explicit HostImage(const VulkanHost& host) : host_(host) {}
    HostImage(const HostImage&) = delete;
    ~HostImage();

    // Made anew where size or format is another; waits for the GPU then. False: see error().
    bool make(VkFormat format, uint32_t width, uint32_t height, VkImageUsageFlags usage);
    // A picture to be sampled: width * height pixels of 4 bytes, rows top to bottom. Waits for the GPU.
    bool show(const unsigned char* rgba, uint32_t width, uint32_t height);

    VkImage image() const { return image_; }
    VkImageView view() const { return view_; }
    const std::string& error() const { return error_; }

  private:
    bool check(VkResult result, const char* what);
    bool copy(VkBuffer from);
    void record(VkCommandBuffer commands, VkBuffer from) const;
    void drop();

    const VulkanHost& host_;
    std::string error_;
    VkImage image_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    VkExtent2D size_{};
};

}  // namespace sample
