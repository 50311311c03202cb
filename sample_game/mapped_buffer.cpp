// Memory that both sides see.
#include "sample_game/mapped_buffer.hpp"

namespace sample {

bool MappedBuffer::reserve(VkDeviceSize bytes, VkBufferUsageFlags usage) {
    if (size_ >= bytes) return true;
    drop();
    const VkDevice device = host_.device();
    const auto good = [&](VkResult result) { return (result_ = result) == VK_SUCCESS; };
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes + bytes / 2;  // so that a growing panel doesn't allocate each frame
    info.usage = usage;
    if (!good(vkCreateBuffer(device, &info, nullptr, &buffer_))) return false;
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, buffer_, &needs);
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = needs.size;
    if (!host_.findMemory(needs.memoryTypeBits,
                          VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                          allocate.memoryTypeIndex))
        return good(VK_ERROR_OUT_OF_HOST_MEMORY);
    if (!good(vkAllocateMemory(device, &allocate, nullptr, &memory_)) ||
        !good(vkBindBufferMemory(device, buffer_, memory_, 0)) ||
        !good(vkMapMemory(device, memory_, 0, VK_WHOLE_SIZE, 0, &bytes_)))
        return false;
    size_ = info.size;
    return true;
}

void MappedBuffer::drop() {
    if (!buffer_) return;
    vkDestroyBuffer(host_.device(), buffer_, nullptr);
    vkFreeMemory(host_.device(), memory_, nullptr);
    buffer_ = VK_NULL_HANDLE;
    memory_ = VK_NULL_HANDLE;
    bytes_ = nullptr;
    size_ = 0;
}

}  // namespace sample
