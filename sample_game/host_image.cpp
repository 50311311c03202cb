// Images that the sample owns: what the scene is drawn into, and pictures that panels show.
#include "sample_game/host_image.hpp"

#include <cstring>

#include "sample_game/mapped_buffer.hpp"

namespace sample {

bool HostImage::check(VkResult result, const char* what) {
    if (result == VK_SUCCESS) return true;
    error_ = std::string(what) + " an image failed (VkResult " + std::to_string(int(result)) + ")";
    return false;
}

bool HostImage::make(VkFormat format, uint32_t width, uint32_t height, VkImageUsageFlags usage) {
    if (view_ && format_ == format && size_.width == width && size_.height == height) return true;
    drop();
    const VkDevice device = host_.device();
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {width, height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    if (!check(vkCreateImage(device, &info, nullptr, &image_), "making")) return false;
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, image_, &needs);
    VkMemoryAllocateInfo memory{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    memory.allocationSize = needs.size;
    if (!host_.findMemory(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, memory.memoryTypeIndex))
        return check(VK_ERROR_OUT_OF_DEVICE_MEMORY, "allocating");
    if (!check(vkAllocateMemory(device, &memory, nullptr, &memory_), "allocating") ||
        !check(vkBindImageMemory(device, image_, memory_, 0), "allocating"))
        return false;
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = image_;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    format_ = format;
    size_ = {width, height};
    return check(vkCreateImageView(device, &view, nullptr, &view_), "viewing");
}

bool HostImage::show(const unsigned char* rgba, uint32_t width, uint32_t height) {
    host_.waitIdle();  // a frame may still show what it was
    if (!make(VK_FORMAT_R8G8B8A8_UNORM, width, height, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT))
        return false;
    MappedBuffer staging(host_);
    const VkDeviceSize size = VkDeviceSize(width) * height * 4;
    if (!staging.reserve(size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT)) return check(staging.result(), "uploading");
    std::memcpy(staging.bytes(), rgba, size);
    return copy(staging.buffer());
}

bool HostImage::copy(VkBuffer from) {
    VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    poolInfo.queueFamilyIndex = host_.queueFamily();
    VkCommandPool pool = VK_NULL_HANDLE;
    if (!check(vkCreateCommandPool(host_.device(), &poolInfo, nullptr, &pool), "uploading")) return false;
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = pool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    bool good = check(vkAllocateCommandBuffers(host_.device(), &allocate, &commands), "uploading");
    if (good) {
        record(commands, from);
        VkCommandBufferSubmitInfo one{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
        one.commandBuffer = commands;
        VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
        submit.commandBufferInfoCount = 1;
        submit.pCommandBufferInfos = &one;
        good = check(vkQueueSubmit2(host_.queue(), 1, &submit, VK_NULL_HANDLE), "uploading");
        host_.waitIdle();
    }
    vkDestroyCommandPool(host_.device(), pool, nullptr);
    return good;
}

void HostImage::record(VkCommandBuffer commands, VkBuffer from) const {
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    vkBeginCommandBuffer(commands, &begin);
    imageBarrier(commands, image_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {size_.width, size_.height, 1};
    vkCmdCopyBufferToImage(commands, from, image_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    imageBarrier(commands, image_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    vkEndCommandBuffer(commands);
}

void HostImage::drop() {
    if (!image_) return;
    host_.waitIdle();
    vkDestroyImageView(host_.device(), view_, nullptr);
    vkDestroyImage(host_.device(), image_, nullptr);
    vkFreeMemory(host_.device(), memory_, nullptr);
    view_ = VK_NULL_HANDLE;
    image_ = VK_NULL_HANDLE;
    memory_ = VK_NULL_HANDLE;
}

HostImage::~HostImage() {
    drop();
}

}  // namespace sample
