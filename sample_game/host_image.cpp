// Enters: format, size, use. Leaves: an image, its memory and a view of it.
#include "sample_game/host_image.hpp"

namespace sample {

VkResult HostImage::make(VkFormat format, VkExtent2D size, VkImageUsageFlags usage) {
    drop();
    size_ = size;
    const VkResult result = fill(format, usage);
    if (result != VK_SUCCESS) drop();
    return result;
}

VkResult HostImage::fill(VkFormat format, VkImageUsageFlags usage) {
    const VkDevice device = host_.device();
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {size_.width, size_.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    if (const VkResult r = vkCreateImage(device, &info, nullptr, &image_); r != VK_SUCCESS) return r;
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, image_, &needs);
    VkMemoryAllocateInfo memory{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    memory.allocationSize = needs.size;
    if (!host_.findMemory(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, memory.memoryTypeIndex))
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (const VkResult r = vkAllocateMemory(device, &memory, nullptr, &memory_); r != VK_SUCCESS) return r;
    if (const VkResult r = vkBindImageMemory(device, image_, memory_, 0); r != VK_SUCCESS) return r;
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = image_;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    return vkCreateImageView(device, &view, nullptr, &view_);
}

void HostImage::drop() {
    if (!host_.device()) return;
    vkDestroyImageView(host_.device(), view_, nullptr);
    vkDestroyImage(host_.device(), image_, nullptr);
    vkFreeMemory(host_.device(), memory_, nullptr);
    view_ = VK_NULL_HANDLE;
    image_ = VK_NULL_HANDLE;
    memory_ = VK_NULL_HANDLE;
    size_ = {};
}

}  // namespace sample
