// Draw into an image of our own, then blit it into the window's.
#include "sample_game/scene_image.hpp"

#include <algorithm>

namespace sample {

bool SceneImage::check(VkResult result, const char* what) {
    if (result == VK_SUCCESS) return true;
    error_ = std::string("the scene's image: ") + what + " failed (VkResult " + std::to_string(int(result)) + ")";
    return false;
}

bool SceneImage::make(uint32_t width, uint32_t height) {
    if (size_.width == width && size_.height == height) return true;
    host_.waitIdle();
    drop();
    const VkDevice device = host_.device();
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = host_.format();
    info.extent = {width, height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    if (!check(vkCreateImage(device, &info, nullptr, &image_), "making it")) return false;
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, image_, &needs);
    VkMemoryAllocateInfo memory{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    memory.allocationSize = needs.size;
    if (!host_.findMemory(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, memory.memoryTypeIndex))
        return check(VK_ERROR_OUT_OF_DEVICE_MEMORY, "finding memory");
    if (!check(vkAllocateMemory(device, &memory, nullptr, &memory_), "allocating") ||
        !check(vkBindImageMemory(device, image_, memory_, 0), "allocating"))
        return false;
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = image_;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = info.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    size_ = {width, height};
    return check(vkCreateImageView(device, &view, nullptr, &view_), "making its view");
}

bool SceneImage::show(EspContext* context, const Frame& frame, EspDrawDef draw, float scale, bool redraw) {
    const bool sameWindow = window_.width == frame.extent.width && window_.height == frame.extent.height;
    drew_ = redraw || !sameWindow || drawn_.width == 0;
    if (drew_) {
        if (!make(frame.extent.width, frame.extent.height)) return false;
        window_ = frame.extent;
        // A smaller picture takes the image's corner.
        drawn_.width = std::max(1u, uint32_t(float(frame.extent.width) * scale + .5f));
        drawn_.height = std::max(1u, uint32_t(float(frame.extent.height) * scale + .5f));
        draw.width = drawn_.width;
        draw.height = drawn_.height;
        draw.commandBuffer = frame.commands;
        draw.colourImage = reinterpret_cast<void*>(image_);
        draw.colourView = reinterpret_cast<void*>(view_);
        draw.colourFormat = host_.format();
        draw.frame = frame.number;
        draw.framesDone = frame.finished;
        if (espDraw(context, &draw) != ESP_OK) {
            error_ = espLastError(context);
            return false;
        }
        imageBarrier(frame.commands, image_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                     VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    }
    imageBarrier(frame.commands, frame.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[1] = {int32_t(drawn_.width), int32_t(drawn_.height), 1};
    region.dstOffsets[1] = {int32_t(frame.extent.width), int32_t(frame.extent.height), 1};
    vkCmdBlitImage(frame.commands, image_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, frame.image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_LINEAR);
    imageBarrier(frame.commands, frame.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    return true;
}

void SceneImage::drop() {
    vkDestroyImageView(host_.device(), view_, nullptr);
    vkDestroyImage(host_.device(), image_, nullptr);
    vkFreeMemory(host_.device(), memory_, nullptr);
    view_ = VK_NULL_HANDLE;
    image_ = VK_NULL_HANDLE;
    memory_ = VK_NULL_HANDLE;
    size_ = drawn_ = window_ = {};
}

SceneImage::~SceneImage() {
    if (!host_.device()) return;
    host_.waitIdle();
    drop();
}

}  // namespace sample
