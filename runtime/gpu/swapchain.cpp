// A window's images: made again when the window changes, shown in the order in which they were drawn.
#include "runtime/gpu/swapchain.hpp"

#include <algorithm>

#include "runtime/core/check.hpp"

namespace espalier {
namespace {

constexpr uint32_t kFramesInFlight = 2;

Result<Owned<VkSemaphore>> makeSemaphore(Device& device, std::string_view name) {
    VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore handle = VK_NULL_HANDLE;
    if (!ESPALIER_VK(device, name, device.vk().vkCreateSemaphore(device.handle(), &info, nullptr, &handle)))
        return gpuFailure(device, name, "making a semaphore");
    device.setName(VK_OBJECT_TYPE_SEMAPHORE, uint64_t(handle), name);
    return Owned(device, handle);
}

VkPresentModeKHR choosePresentMode(const Device& device, VkSurfaceKHR surface, bool vsync) {
    if (vsync) return VK_PRESENT_MODE_FIFO_KHR;
    uint32_t count = 0;
    const auto get = device.vkInstance().vkGetPhysicalDeviceSurfacePresentModesKHR;
    if (get(device.physicalDevice(), surface, &count, nullptr) < 0) return VK_PRESENT_MODE_FIFO_KHR;
    std::vector<VkPresentModeKHR> modes(count);
    if (get(device.physicalDevice(), surface, &count, modes.data()) < 0) return VK_PRESENT_MODE_FIFO_KHR;
    for (VkPresentModeKHR mode : {VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR})
        if (std::ranges::count(modes, mode)) return mode;
    return VK_PRESENT_MODE_FIFO_KHR;
}

VkFormat chooseFormat(const Device& device, VkSurfaceKHR surface) {
    uint32_t count = 0;
    const auto get = device.vkInstance().vkGetPhysicalDeviceSurfaceFormatsKHR;
    if (get(device.physicalDevice(), surface, &count, nullptr) < 0) return VK_FORMAT_UNDEFINED;
    std::vector<VkSurfaceFormatKHR> formats(count);
    if (get(device.physicalDevice(), surface, &count, formats.data()) < 0) return VK_FORMAT_UNDEFINED;
    for (VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
        if (std::ranges::count(formats, wanted, &VkSurfaceFormatKHR::format)) return wanted;
    return VK_FORMAT_UNDEFINED;
}

}  // namespace

Result<Swapchain> Swapchain::create(Device& device, VkSurfaceKHR surface, VkExtent2D extent, bool vsync) {
    require(device.vk().vkCreateSwapchainKHR && device.vkInstance().vkGetPhysicalDeviceSurfaceCapabilitiesKHR,
            "Swapchain: the device was made without surface extensions");
    VkBool32 supported = VK_FALSE;
    const VkResult known = device.vkInstance().vkGetPhysicalDeviceSurfaceSupportKHR(
        device.physicalDevice(), device.info().queueFamily, surface, &supported);
    if (known < 0 || !supported) return Failure("window", "the GPU cannot show images in this window");
    Swapchain s;
    s.device_ = &device;
    s.surface_ = surface;
    s.vsync_ = vsync;
    s.format_ = chooseFormat(device, surface);
    if (s.format_ == VK_FORMAT_UNDEFINED) return Failure("window", "the window offers no 8-bit colour format");
    s.frameValues_.resize(kFramesInFlight, 0);
    for (uint32_t i = 0; i < kFramesInFlight; ++i) {
        Result<Owned<VkSemaphore>> acquired = makeSemaphore(device, "image acquired");
        if (!acquired) return acquired.failure();
        s.acquired_.push_back(std::move(*acquired));
    }
    if (Status status = s.build(extent); !status) return status.failure();
    return s;
}

Swapchain::~Swapchain() {
    if (!device_) return;
    // Presentation has no timeline: an idle queue is the only sign that the window system is done with semaphores.
    device_->vk().vkQueueWaitIdle(device_->queue());
}

Swapchain::Swapchain(Swapchain&& other) noexcept
    : device_(std::exchange(other.device_, nullptr)),
      surface_(other.surface_),
      vsync_(other.vsync_),
      stale_(other.stale_),
      format_(other.format_),
      extent_(other.extent_),
      swapchain_(std::move(other.swapchain_)),
      images_(std::move(other.images_)),
      drawn_(std::move(other.drawn_)),
      acquired_(std::move(other.acquired_)),
      frameValues_(std::move(other.frameValues_)),
      frame_(other.frame_),
      image_(other.image_) {}

Status Swapchain::build(VkExtent2D wanted) {
    Device& device = *device_;
    device.vk().vkQueueWaitIdle(device.queue());
    VkSurfaceCapabilitiesKHR can{};
    if (device.vkInstance().vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physicalDevice(), surface_, &can) < 0)
        return Failure("window", "its surface is lost");
    extent_ = can.currentExtent;
    if (extent_.width == 0xFFFFFFFFu)
        extent_ = {std::clamp(wanted.width, can.minImageExtent.width, can.maxImageExtent.width),
                   std::clamp(wanted.height, can.minImageExtent.height, can.maxImageExtent.height)};
    stale_ = true;
    images_.clear();
    drawn_.clear();
    if (extent_.width == 0 || extent_.height == 0) return Done{};

    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface_;
    info.minImageCount = can.maxImageCount ? std::min(can.minImageCount + 1, can.maxImageCount) : can.minImageCount + 1;
    info.imageFormat = format_;
    info.imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    info.imageExtent = extent_;
    info.imageArrayLayers = 1;
    info.imageUsage =
        (VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT) &
        can.supportedUsageFlags;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    if (!(can.supportedCompositeAlpha & info.compositeAlpha)) info.compositeAlpha = VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = choosePresentMode(device, surface_, vsync_);
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain_.get();
    VkSwapchainKHR handle = VK_NULL_HANDLE;
    if (!ESPALIER_VK(device, "swapchain", device.vk().vkCreateSwapchainKHR(device.handle(), &info, nullptr, &handle)))
        return gpuFailure(device, "swapchain", "making it");
    swapchain_ = Owned(device, handle);

    uint32_t count = 0;
    device.vk().vkGetSwapchainImagesKHR(device.handle(), handle, &count, nullptr);
    std::vector<VkImage> images(count);
    if (!ESPALIER_VK(device, "swapchain",
                     device.vk().vkGetSwapchainImagesKHR(device.handle(), handle, &count, images.data())))
        return gpuFailure(device, "swapchain", "asking for its images");
    for (VkImage image : images) {
        ImageDesc desc;
        desc.name = "window image";
        desc.format = format_;
        desc.width = extent_.width;
        desc.height = extent_.height;
        Result<Image> wrapped = Image::wrap(device, desc, image);
        if (!wrapped) return wrapped.failure();
        images_.push_back(std::move(*wrapped));
        Result<Owned<VkSemaphore>> drawn = makeSemaphore(device, "image drawn");
        if (!drawn) return drawn.failure();
        drawn_.push_back(std::move(*drawn));
    }
    stale_ = false;
    return Done{};
}

Result<Image*> Swapchain::acquire(VkExtent2D windowExtent) {
    Device& device = *device_;
    if (windowExtent.width == 0 || windowExtent.height == 0) return static_cast<Image*>(nullptr);
    const bool resized = windowExtent.width != extent_.width || windowExtent.height != extent_.height;
    if (stale_ || resized)
        if (Status status = build(windowExtent); !status) return status.failure();
    if (stale_) return static_cast<Image*>(nullptr);
    if (Status free = device.wait(frameValues_[frame_]); !free) return free.failure();
    const VkResult result = device.vk().vkAcquireNextImageKHR(device.handle(), swapchain_.get(), UINT64_MAX,
                                                              acquired_[frame_].get(), VK_NULL_HANDLE, &image_);
    if (result == VK_ERROR_OUT_OF_DATE_KHR) {
        stale_ = true;
        return static_cast<Image*>(nullptr);
    }
    if (result == VK_ERROR_SURFACE_LOST_KHR) return Failure("window", "its surface is lost");
    if (!device.succeeded(result, "vkAcquireNextImageKHR", "swapchain"))
        return gpuFailure(device, "swapchain", "acquiring an image");
    images_[image_].state = ImageState::undefined;
    return &images_[image_];
}

Status Swapchain::present(Commands& commands) {
    Device& device = *device_;
    commands.transition(images_[image_], ImageState::present);
    const VkSemaphore drawn = drawn_[image_].get();
    Result<uint64_t> value = commands.submit({acquired_[frame_].get(), drawn});
    if (!value) return value.failure();
    frameValues_[frame_] = *value;
    frame_ = (frame_ + 1) % kFramesInFlight;
    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &drawn;
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain_.get();
    info.pImageIndices = &image_;
    const VkResult result = device.vk().vkQueuePresentKHR(device.queue(), &info);
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
        stale_ = true;
        return Done{};
    }
    if (result == VK_ERROR_SURFACE_LOST_KHR) return Failure("window", "its surface is lost");
    if (!device.succeeded(result, "vkQueuePresentKHR", "swapchain"))
        return gpuFailure(device, "swapchain", "presenting");
    return Done{};
}

}  // namespace espalier
