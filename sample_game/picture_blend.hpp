#pragma once

#include <string>

#include "sample_game/host_image.hpp"

namespace sample {

// Lays a picture over an image by a share: as it is, stretched to the viewport.
class PictureBlend {
  public:
    explicit PictureBlend(const VulkanHost& host) : host_(host) {}
    PictureBlend(const PictureBlend&) = delete;
    ~PictureBlend();

    // For images of that format. Once.
    bool create(VkFormat format);
    bool made() const { return pipeline_ != VK_NULL_HANDLE; }
    // from: in SHADER_READ_ONLY_OPTIMAL. onto: in COLOR_ATTACHMENT_OPTIMAL, and stays so; share: 0 to 1.
    void lay(VkCommandBuffer commands, const HostImage& from, VkImageView onto, const VkRect2D& where,
             float share) const;
    const std::string& error() const { return error_; }

  private:
    bool check(VkResult result, const char* what);
    bool makeLayouts();

    const VulkanHost& host_;
    std::string error_;
    VkSampler sampler_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};

}  // namespace sample
