#pragma once

#include <vector>

#include "runtime/gpu/commands.hpp"

namespace espalier {

// The images of a window. The surface stays the caller's and must outlive it.
class Swapchain {
  public:
    // extent: used where the surface leaves the size to us. vsync false: shown as soon as done, where the device can.
    static Result<Swapchain> create(Device& device, VkSurfaceKHR surface, VkExtent2D extent, bool vsync = true);
    ~Swapchain();
    Swapchain(Swapchain&& other) noexcept;
    Swapchain& operator=(Swapchain&&) = delete;

    VkFormat format() const { return format_; }  // 8-bit UNORM, not sRGB: the shader encodes
    VkExtent2D extent() const { return extent_; }

    // The image to draw into next, or null if the window has no area now (minimised) or the swapchain was made anew;
    // then try again next frame.
    Result<Image*> acquire(VkExtent2D windowExtent);
    // Takes the recording that drew into the acquired image, submits it and shows the image.
    Status present(Commands& commands);

  private:
    Swapchain() = default;
    Status build(VkExtent2D extent);

    Device* device_ = nullptr;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    bool vsync_ = true;
    bool stale_ = true;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    VkExtent2D extent_{};
    Owned<VkSwapchainKHR> swapchain_;
    std::vector<Image> images_;
    std::vector<Owned<VkSemaphore>> drawn_;     // one an image
    std::vector<Owned<VkSemaphore>> acquired_;  // one a frame in flight
    std::vector<uint64_t> frameValues_;         // the timeline's value that frees it
    uint32_t frame_ = 0;
    uint32_t image_ = 0;
};

}  // namespace espalier
