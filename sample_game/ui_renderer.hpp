#pragma once

#include <string>
#include <vector>

#include "sample_game/host_image.hpp"
#include "sample_game/mapped_buffer.hpp"

struct ImDrawData;

namespace sample {

// Draws Dear ImGui's lists with dynamic rendering over what a frame shows. (The packaged Vulkan backend of 1.86 wants a
// render pass, and would link against the loader's functions, which volk replaces.) An ImTextureID is a HostImage*,
// which is kept as long as a frame in flight may show it.
class UiRenderer {
  public:
    explicit UiRenderer(const VulkanHost& host)
        : host_(host),
          fonts_(host),
          vertices_{MappedBuffer(host), MappedBuffer(host)},
          indices_{MappedBuffer(host), MappedBuffer(host)} {}
    UiRenderer(const UiRenderer&) = delete;
    ~UiRenderer();

    // With the atlas of the current ImGui context, whose texture id it sets.
    bool create();
    // The fonts have changed: uploads them anew. Waits for the GPU.
    bool updateFonts();
    // Into the frame's image, which is in COLOR_ATTACHMENT_OPTIMAL and stays so.
    bool draw(const Frame& frame, const ImDrawData& lists);
    const std::string& error() const { return error_; }

  private:
    bool fail(const std::string& message);
    bool check(VkResult result, const char* what);
    bool makePipeline();
    void bind(VkCommandBuffer commands, const HostImage& picture);
    void record(const Frame& frame, const ImDrawData& lists);

    const VulkanHost& host_;
    std::string error_;
    VkSampler sampler_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    HostImage fonts_;
    MappedBuffer vertices_[kFramesInFlight], indices_[kFramesInFlight];
};

}  // namespace sample
