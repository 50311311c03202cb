#pragma once

#include "sample_game/vulkan_host.hpp"

namespace sample {

// A 2D image of one level with memory of its own. The GPU must have done with it before make() and before its end.
class HostImage {
  public:
    explicit HostImage(const VulkanHost& host) : host_(host) {}
    HostImage(const HostImage&) = delete;
    ~HostImage() { drop(); }

    // In place of what there was. Not VK_SUCCESS: there is none.
    VkResult make(VkFormat format, VkExtent2D size, VkImageUsageFlags usage);
    void drop();

    VkImage image() const { return image_; }
    VkImageView view() const { return view_; }
    VkExtent2D size() const { return size_; }

  private:
    VkResult fill(VkFormat format, VkImageUsageFlags usage);

    const VulkanHost& host_;
    VkImage image_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkExtent2D size_{};
};

}  // namespace sample
