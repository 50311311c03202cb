// Buffers over the device's memory source; loading and reading back outside of frames.
#include "runtime/gpu/buffer.hpp"

#include <algorithm>

#include "runtime/core/check.hpp"
#include "runtime/gpu/commands.hpp"

namespace espalier {
namespace {

constexpr uint64_t kLeastBytes = 16;  // Vulkan has no empty buffers

// Dropped objects may still hold the memory that is missing: wait for the GPU and try once more.
Result<MemoryBlock> allocate(Device& device, const MemoryRequest& request) {
    Result<MemoryBlock> block = device.memory().allocate(request);
    if (block || device.retiredCount() == 0) return block;
    if (Status idle = device.waitIdle(); !idle) return idle.failure();
    return device.memory().allocate(request);
}

}  // namespace

Result<Buffer> Buffer::create(Device& device, std::string_view name, uint64_t sizeBytes, BufferUse use) {
    Buffer b;
    b.name_ = name;
    b.size_ = sizeBytes;
    const uint64_t limit = device.info().maxBufferBytes;
    if (sizeBytes > limit)
        return deviceFailure(name, "out of GPU memory: " + std::to_string(sizeBytes) +
                                       " bytes asked for, a buffer holds " + std::to_string(limit));
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = std::max(sizeBytes, kLeastBytes);
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                 VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                 VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VkBuffer handle = VK_NULL_HANDLE;
    if (!device.succeeded(device.vk().vkCreateBuffer(device.handle(), &info, nullptr, &handle)))
        return gpuFailure(device, name, "making a buffer");
    b.buffer_ = Owned(device, handle);
    device.setName(VK_OBJECT_TYPE_BUFFER, uint64_t(handle), name);

    MemoryRequest request{{}, use, false, b.name_.c_str()};
    device.vk().vkGetBufferMemoryRequirements(device.handle(), handle, &request.requirements);
    Result<MemoryBlock> block = allocate(device, request);
    if (!block) return block.failure();
    b.memory_ = Owned(device, *block);
    if (!device.succeeded(device.vk().vkBindBufferMemory(device.handle(), handle, block->memory, block->offset)))
        return gpuFailure(device, name, "binding its memory");
    b.mapped_ = block->mapped;
    VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr, handle};
    b.address_ = device.vk().vkGetBufferDeviceAddress(device.handle(), &address);
    return b;
}

Result<TexelView> TexelView::create(Device& device, const Buffer& buffer, VkFormat format) {
    const uint64_t texels = buffer.size() / texelBytes(format), most = device.info().limits.maxTexelBufferElements;
    if (texels > most)
        return deviceFailure(
            buffer.name(),
            std::to_string(texels) + " texels are more than the GPU reads of a buffer (" + std::to_string(most) + ")");
    VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    info.buffer = buffer.handle();
    info.format = format;
    info.range = VK_WHOLE_SIZE;
    VkBufferView handle = VK_NULL_HANDLE;
    if (!device.succeeded(device.vk().vkCreateBufferView(device.handle(), &info, nullptr, &handle)))
        return gpuFailure(device, buffer.name(), "making a texel view");
    TexelView view;
    view.view_ = Owned(device, handle);
    return view;
}

Status makeAtLeast(Device& device, Buffer& buffer, std::string_view name, uint64_t sizeBytes, BufferUse use) {
    if (buffer && buffer.size() >= sizeBytes) return Done{};
    return assign(buffer, Buffer::create(device, name, sizeBytes, use));
}

Status makeTexels(Device& device, std::string_view name, uint64_t sizeBytes, VkFormat format, Buffer& buffer,
                  TexelView& texels) {
    Result<Buffer> made = Buffer::create(device, name, sizeBytes);
    if (!made) return made.failure();
    Result<TexelView> view = TexelView::create(device, *made, format);
    if (!view) return view.failure();
    texels = std::move(*view);  // first: no view outlives its buffer
    buffer = std::move(*made);
    return Done{};
}

Result<Buffer> makeBuffer(Device& device, std::string_view name, std::span<const std::byte> bytes) {
    Result<Buffer> buffer = Buffer::create(device, name, bytes.size());
    if (!buffer || bytes.empty()) return buffer;
    if (buffer->mapped()) {
        std::memcpy(buffer->mapped(), bytes.data(), bytes.size());
        return buffer;
    }
    Result<Commands> commands = Commands::begin(device, name);
    if (!commands) return commands.failure();
    Status status = commands->upload(*buffer, bytes);
    if (status) status = commands->finish();
    if (!status) return status.failure();
    return buffer;
}

Result<std::vector<std::byte>> readBuffer(Device& device, const Buffer& buffer, uint64_t offset, uint64_t sizeBytes) {
    require(offset <= buffer.size() && sizeBytes <= buffer.size() - offset, "readBuffer: past the buffer's end");
    if (Status idle = device.waitIdle(); !idle) return idle.failure();
    std::vector<std::byte> bytes(sizeBytes);
    if (bytes.empty()) return bytes;
    if (buffer.mapped()) {
        std::memcpy(bytes.data(), buffer.mapped() + offset, sizeBytes);
        return bytes;
    }
    Result<Buffer> staging = Buffer::create(device, "read back", sizeBytes, BufferUse::readback);
    if (!staging) return staging.failure();
    Result<Commands> commands = Commands::begin(device, "read back");
    if (!commands) return commands.failure();
    commands->copy(buffer, *staging, sizeBytes, offset, 0);
    if (Status done = commands->finish(); !done) return done.failure();
    std::memcpy(bytes.data(), staging->mapped(), sizeBytes);
    return bytes;
}

}  // namespace espalier
