// A host's device in, frames to record into out: the swapchain, frames in flight, and pictures read back.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "sample_game/vulkan_host.hpp"

namespace sample {
namespace {

// What copies have written is to be read on the CPU.
void copiedToHost(VkCommandBuffer commands) {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace

void imageBarrier(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

void clear(const Frame& frame, const VkClearColorValue& colour) {
    imageBarrier(frame.commands, frame.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(frame.commands, frame.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &colour, 1, &all);
    imageBarrier(frame.commands, frame.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
}

bool VulkanHost::makeFrames() {
    for (Slot& slot : slots_) {
        VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
        pool.queueFamilyIndex = queueFamily_;
        if (!check(vkCreateCommandPool(device_, &pool, nullptr, &slot.pool), "making a command pool")) return false;
        VkCommandBufferAllocateInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
        buffer.commandPool = slot.pool;
        buffer.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        buffer.commandBufferCount = 1;
        if (!check(vkAllocateCommandBuffers(device_, &buffer, &slot.commands), "making a command buffer")) return false;
        VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
        if (!check(vkCreateFence(device_, &fence, nullptr, &slot.done), "making a fence")) return false;
        VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
        if (!check(vkCreateSemaphore(device_, &semaphore, nullptr, &slot.acquired), "making a semaphore")) return false;
    }
    return true;
}

bool VulkanHost::makeSwapchain() {
    VkSurfaceCapabilitiesKHR can;
    if (!check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physicalDevice_, surface_, &can), "asking the window"))
        return false;
    VkExtent2D extent = can.currentExtent;
    if (extent.width == UINT32_MAX) {  // the surface takes any size: that of the window
        int width = 0, height = 0;
        glfwGetFramebufferSize(window_, &width, &height);
        extent = {std::clamp(uint32_t(width), can.minImageExtent.width, can.maxImageExtent.width),
                  std::clamp(uint32_t(height), can.minImageExtent.height, can.maxImageExtent.height)};
    }
    if (extent.width == 0 || extent.height == 0) {
        stale_ = true;
        return true;  // minimised
    }
    uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(physicalDevice_, surface_, &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkGetPhysicalDeviceSurfaceFormatsKHR(physicalDevice_, surface_, &count, formats.data());
    const auto usable = std::find_if(formats.begin(), formats.end(), [](const VkSurfaceFormatKHR& f) {
        return f.format == VK_FORMAT_B8G8R8A8_UNORM || f.format == VK_FORMAT_R8G8B8A8_UNORM;
    });
    if (usable == formats.end()) {
        error_ = "the window has no 8-bit UNORM format";
        return false;
    }
    vkDeviceWaitIdle(device_);
    held_.reset();
    if (!(can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT)) {
        error_ = "pictures can't be copied into the window";
        return false;
    }
    canCopy_ = can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    const VkSwapchainKHR old = swapchain_;
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface_;
    info.minImageCount = std::max(3u, can.minImageCount + 1);  // one is held back while another is drawn
    if (can.maxImageCount) info.minImageCount = std::min(info.minImageCount, can.maxImageCount);
    info.imageFormat = usable->format;
    info.imageColorSpace = usable->colorSpace;
    info.imageExtent = extent;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                      (canCopy_ ? VK_IMAGE_USAGE_TRANSFER_SRC_BIT : 0);
    info.preTransform = can.currentTransform;
    info.compositeAlpha = can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    info.oldSwapchain = old;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    if (!check(vkCreateSwapchainKHR(device_, &info, nullptr, &made), "making the swapchain")) return false;
    dropSwapchain();
    swapchain_ = made;
    format_ = usable->format;
    extent_ = extent;
    vkGetSwapchainImagesKHR(device_, swapchain_, &count, nullptr);
    std::vector<VkImage> images(count);
    vkGetSwapchainImagesKHR(device_, swapchain_, &count, images.data());
    for (VkImage image : images) {
        Target& target = targets_.emplace_back();
        target.image = image;
        VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
        view.image = image;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = format_;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        if (!check(vkCreateImageView(device_, &view, nullptr, &target.view), "making a view")) return false;
        VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
        if (!check(vkCreateSemaphore(device_, &semaphore, nullptr, &target.drawn), "making a semaphore")) return false;
    }
    stale_ = false;
    return true;
}

void VulkanHost::dropSwapchain() {
    for (Target& target : targets_) {
        vkDestroyImageView(device_, target.view, nullptr);
        vkDestroySemaphore(device_, target.drawn, nullptr);
    }
    targets_.clear();
    vkDestroySwapchainKHR(device_, swapchain_, nullptr);
    swapchain_ = VK_NULL_HANDLE;
}

std::optional<Frame> VulkanHost::begin(bool overlaps) {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    if (uint32_t(width) != extent_.width || uint32_t(height) != extent_.height) stale_ = true;
    if (stale_ && !makeSwapchain()) return std::nullopt;
    if (stale_) return std::nullopt;
    overlaps = overlaps && !overlaps_;
    if (!overlaps && held_ && !show(*std::exchange(held_, {}))) return std::nullopt;
    Slot& slot = slots_[(frameNumber_ + 1) % kFramesInFlight];
    const Slot& awaited = overlaps_ || overlaps ? slot : slots_[frameNumber_ % kFramesInFlight];
    if (!check(vkWaitForFences(device_, 1, &awaited.done, VK_TRUE, UINT64_MAX), "waiting for the GPU"))
        return std::nullopt;
    finished_ = std::max(finished_, awaited.number);
    const VkResult acquired =
        vkAcquireNextImageKHR(device_, swapchain_, UINT64_MAX, slot.acquired, VK_NULL_HANDLE, &target_);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR) {
        stale_ = true;
        return std::nullopt;
    }
    if (acquired == VK_SUBOPTIMAL_KHR)
        stale_ = true;  // show this one, then make it anew
    else if (!check(acquired, "taking an image of the window"))
        return std::nullopt;
    vkResetCommandPool(device_, slot.pool, 0);
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    if (!check(vkBeginCommandBuffer(slot.commands, &info), "recording")) return std::nullopt;
    Frame frame;
    frame.number = ++frameNumber_;
    frame.slot = uint32_t(frameNumber_ % kFramesInFlight);
    frame.commands = slot.commands;
    frame.image = targets_[target_].image;
    frame.view = targets_[target_].view;
    frame.extent = extent_;
    frame.finished = finished_;
    frame.overlaps = overlaps;
    return frame;
}

bool VulkanHost::copyPicture(const Frame& frame) {
    if (!canCopy_) {
        error_ = "the window's images can't be copied here";
        return false;
    }
    VkBufferCreateInfo buffer{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    buffer.size = VkDeviceSize(frame.extent.width) * frame.extent.height * 4;
    buffer.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (!check(vkCreateBuffer(device_, &buffer, nullptr, &pictureBuffer_), "taking a picture")) return false;
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_, pictureBuffer_, &needs);
    VkMemoryAllocateInfo memory{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    memory.allocationSize = needs.size;
    if (!findMemory(needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                    memory.memoryTypeIndex) ||
        !check(vkAllocateMemory(device_, &memory, nullptr, &pictureMemory_), "taking a picture") ||
        !check(vkBindBufferMemory(device_, pictureBuffer_, pictureMemory_, 0), "taking a picture") ||
        !check(vkMapMemory(device_, pictureMemory_, 0, VK_WHOLE_SIZE, 0, &pictureBytes_), "taking a picture"))
        return false;
    imageBarrier(frame.commands, frame.image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {frame.extent.width, frame.extent.height, 1};
    vkCmdCopyImageToBuffer(frame.commands, frame.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pictureBuffer_, 1,
                           &region);
    copiedToHost(frame.commands);
    imageBarrier(frame.commands, frame.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    return true;
}

bool VulkanHost::end(const Frame& frame, const TakePicture& picture) {
    const bool copies = picture && copyPicture(frame);
    const std::string uncopied = copies ? "" : std::exchange(error_, {});  // the frame itself is whole
    if (!copies)
        imageBarrier(frame.commands, frame.image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                     VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    if (!check(vkEndCommandBuffer(frame.commands), "ending a recording")) return false;
    if (held_ && !show(*std::exchange(held_, {}))) return false;
    if (!submit(frame)) return false;
    if (frame.overlaps && !copies)
        held_ = target_;
    else if (!show(target_))
        return false;
    if (copies) {
        waitIdle();
        std::vector<uint8_t> rgba(size_t(frame.extent.width) * frame.extent.height * 4);
        std::memcpy(rgba.data(), pictureBytes_, rgba.size());
        for (size_t i = 0; i < rgba.size(); i += 4) {
            if (format_ == VK_FORMAT_B8G8R8A8_UNORM) std::swap(rgba[i], rgba[i + 2]);
            rgba[i + 3] = 255;
        }
        picture(std::move(rgba), frame.extent.width, frame.extent.height, {});
    } else if (picture) {
        picture({}, 0, 0, uncopied);
    }
    vkDestroyBuffer(device_, pictureBuffer_, nullptr);
    vkFreeMemory(device_, pictureMemory_, nullptr);
    pictureBuffer_ = VK_NULL_HANDLE;
    pictureMemory_ = VK_NULL_HANDLE;
    return true;
}

bool VulkanHost::submit(const Frame& frame) {
    Slot& slot = slots_[frame.slot];
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = frame.commands;
    VkSemaphoreSubmitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO}, signal = wait;
    wait.semaphore = slot.acquired;
    wait.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    signal.semaphore = targets_[target_].drawn;
    signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.waitSemaphoreInfoCount = submit.signalSemaphoreInfoCount = submit.commandBufferInfoCount = 1;
    submit.pWaitSemaphoreInfos = &wait;
    submit.pSignalSemaphoreInfos = &signal;
    submit.pCommandBufferInfos = &commands;
    vkResetFences(device_, 1, &slot.done);
    if (!check(vkQueueSubmit2(queue_, 1, &submit, slot.done), "submitting a frame")) return false;
    slot.number = frame.number;
    return true;
}

bool VulkanHost::show(uint32_t target) {
    VkPresentInfoKHR present{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    present.waitSemaphoreCount = present.swapchainCount = 1;
    present.pWaitSemaphores = &targets_[target].drawn;
    present.pSwapchains = &swapchain_;
    present.pImageIndices = &target;
    const VkResult shown = vkQueuePresentKHR(queue_, &present);
    if (shown == VK_SUBOPTIMAL_KHR || shown == VK_ERROR_OUT_OF_DATE_KHR)
        stale_ = true;
    else if (!check(shown, "showing a frame"))
        return false;
    return true;
}

}  // namespace sample
