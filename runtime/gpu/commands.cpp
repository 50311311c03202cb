// Recording, submission, barriers and copies.
#include "runtime/gpu/commands.hpp"

#include <algorithm>

#include "runtime/core/check.hpp"
#include "runtime/gpu/command_pools.hpp"
#include "runtime/gpu/retire.hpp"

namespace espalier {
namespace {

constexpr uint64_t kInlineBytes = 4096;  // uploads up to this go through the command buffer
// Reads of uniform blocks aren't among SHADER_READ.
constexpr VkAccessFlags2 kShaderReads = VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT;

struct Access {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 reads = 0;
    VkAccessFlags2 writes = 0;
};

Access accessOf(Use use) {
    Access a;
    auto add = [&](Use bit, VkPipelineStageFlags2 stages, VkAccessFlags2 reads, VkAccessFlags2 writes) {
        if (!(uint32_t(use) & uint32_t(bit))) return;
        a.stages |= stages, a.reads |= reads, a.writes |= writes;
    };
    add(Use::host, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, 0);
    add(Use::transfer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
        VK_ACCESS_2_TRANSFER_WRITE_BIT);
    add(Use::compute, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, kShaderReads, VK_ACCESS_2_SHADER_WRITE_BIT);
    add(Use::indirect, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, 0);
    add(Use::vertex,
        VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT |
            VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT,
        kShaderReads | VK_ACCESS_2_INDEX_READ_BIT | VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT, 0);
    add(Use::fragment, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, kShaderReads, 0);
    add(Use::all, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT);
    return a;
}

struct LayoutUse {
    VkImageLayout layout;
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 reads;
    VkAccessFlags2 writes;
};

LayoutUse layoutUse(ImageState state) {
    constexpr VkPipelineStageFlags2 shaders = VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
                                              VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
                                              VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    constexpr VkPipelineStageFlags2 depth =
        VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
    switch (state) {
        case ImageState::undefined:
            return {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_ACCESS_2_MEMORY_WRITE_BIT};
        case ImageState::sampled:
            return {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, shaders, VK_ACCESS_2_SHADER_READ_BIT, 0};
        case ImageState::storage:
            return {VK_IMAGE_LAYOUT_GENERAL, shaders, VK_ACCESS_2_SHADER_READ_BIT, VK_ACCESS_2_SHADER_WRITE_BIT};
        case ImageState::colorTarget:
            return {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
        case ImageState::depthTarget:
            return {VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, depth,
                    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
        case ImageState::copySource:
            return {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                    VK_ACCESS_2_TRANSFER_READ_BIT, 0};
        case ImageState::copyTarget:
            return {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, 0,
                    VK_ACCESS_2_TRANSFER_WRITE_BIT};
    }
    fatal("no such image state");
}

VkImageAspectFlags aspectOf(const Image& image) {
    return isDepthFormat(image.format()) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

VkImageMemoryBarrier2 imageBarrier(const Image& image, ImageState before, ImageState after, uint32_t firstLevel,
                                   uint32_t levels) {
    const LayoutUse from = layoutUse(before), to = layoutUse(after);
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = from.stages;
    barrier.srcAccessMask = from.writes;
    barrier.dstStageMask = to.stages;
    barrier.dstAccessMask = to.reads | to.writes;
    barrier.oldLayout = from.layout;
    barrier.newLayout = to.layout;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle();
    barrier.subresourceRange = {aspectOf(image), firstLevel, levels, 0, image.layers()};
    if (hasStencil(image.format())) barrier.subresourceRange.aspectMask |= VK_IMAGE_ASPECT_STENCIL_BIT;
    return barrier;
}

void recordBarrier(const DeviceFunctions& vk, VkCommandBuffer commands, const VkImageMemoryBarrier2& barrier) {
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    vk.vkCmdPipelineBarrier2(commands, &info);
}

VkBufferImageCopy wholeLevel(const Image& image, uint64_t offset, uint32_t level, uint32_t layer) {
    VkBufferImageCopy region{};
    region.bufferOffset = offset;
    region.imageSubresource = {aspectOf(image), level, layer, 1};
    region.imageExtent = {std::max(1u, image.extent().width >> level), std::max(1u, image.extent().height >> level), 1};
    return region;
}

void requireInside(const Buffer& buffer, uint64_t offset, uint64_t size) {
    require(offset <= buffer.size() && size <= buffer.size() - offset, "past the end of buffer " + buffer.name());
}

}  // namespace

Result<Commands> Commands::begin(Device& device, std::string_view name) {
    device.collect();
    Commands c;
    c.device_ = &device;
    c.ours_ = true;
    c.serial_ = device.retireQueue().beginRecording();
    Result<uint32_t> slot = device.commandPools().acquire(c.serial_);
    if (!slot) return slot.failure();
    c.handle_ = device.commandPools().slot(*slot).commands;
    device.setName(VK_OBJECT_TYPE_COMMAND_BUFFER, uint64_t(c.handle_), name);
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    if (!device.succeeded(device.vk().vkBeginCommandBuffer(c.handle_, &info)))
        return gpuFailure(device, name, "beginning to record");
    // Ours end with a barrier, a host's don't: what its last frame still reads, this one may write.
    if (device.retireQueue().knowsHost()) c.barrier(Use::all, Use::all);
    return c;
}

Commands Commands::into(Device& device, VkCommandBuffer hostCommands, uint64_t frame, bool within) {
    Commands c;
    c.within_ = within;
    c.device_ = &device;
    c.handle_ = hostCommands;
    c.serial_ = device.retireQueue().beginRecording();
    device.retireQueue().recordingIntoHost(c.serial_, frame);
    return c;
}

Commands::Commands(Commands&& other) noexcept
    : device_(std::exchange(other.device_, nullptr)),
      handle_(other.handle_),
      serial_(other.serial_),
      ours_(std::exchange(other.ours_, false)),
      within_(other.within_) {}

Commands::~Commands() {
    if (device_ && ours_) device_->retireQueue().recordingDiscarded(serial_);
}

Result<uint64_t> Commands::submit() {
    require(device_ && ours_, "submit: not a recording of ours, or submitted before");
    Device& device = *device_;
    barrier(Use::all, Use::all | Use::host);  // recordings see what earlier ones did, and so does the CPU
    ours_ = false;
    auto failed = [&](std::string_view what) {
        device.retireQueue().recordingDiscarded(serial_);
        return gpuFailure(device, "commands", what);
    };
    if (!device.succeeded(device.vk().vkEndCommandBuffer(handle_))) return failed("recording");

    const uint64_t value = device.nextSubmission();
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = handle_;
    VkSemaphoreSubmitInfo signal{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    signal.semaphore = device.timeline();
    signal.value = value;
    signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &commands;
    info.signalSemaphoreInfoCount = 1;
    info.pSignalSemaphoreInfos = &signal;
    if (!device.succeeded(device.vk().vkQueueSubmit2(device.queue(), 1, &info, VK_NULL_HANDLE))) {
        device.submissionFailed();
        return failed("submitting");
    }
    device.retireQueue().recordingSubmitted(serial_, value);
    device.collect();
    return value;
}

Status Commands::finish() {
    Result<uint64_t> value = submit();
    if (!value) return value.failure();
    return device_->wait(*value);
}

void Commands::barrier(Use before, Use after) {
    const Access from = accessOf(before), to = accessOf(after);
    VkMemoryBarrier2 memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    memory.srcStageMask = from.stages;
    memory.srcAccessMask = from.writes;
    memory.dstStageMask = to.stages;
    memory.dstAccessMask = to.reads | to.writes;
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &memory;
    device_->vk().vkCmdPipelineBarrier2(handle_, &info);
}

void Commands::transition(Image& image, ImageState state, bool discard) {
    if (state == ImageState::undefined) return;  // nothing goes there on purpose
    VkImageMemoryBarrier2 barrier = imageBarrier(image, image.state, state, 0, image.levels());
    if (discard) barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    const bool readsAlready = image.state == state && !discard && layoutUse(state).writes == 0;
    if (!readsAlready) recordBarrier(device_->vk(), handle_, barrier);
    image.state = state;
}

void Commands::fill(const Buffer& buffer, uint32_t word, uint64_t offset, uint64_t size) {
    if (size == ~0ull) size = buffer.size() < offset ? 0 : (buffer.size() - offset) / 4 * 4;
    requireInside(buffer, offset, size);
    if (size) device_->vk().vkCmdFillBuffer(handle_, buffer.handle(), offset, size, word);
}

void Commands::copy(const Buffer& from, const Buffer& to, uint64_t size, uint64_t fromOffset, uint64_t toOffset) {
    requireInside(from, fromOffset, size);
    requireInside(to, toOffset, size);
    const VkBufferCopy region{fromOffset, toOffset, size};
    if (size) device_->vk().vkCmdCopyBuffer(handle_, from.handle(), to.handle(), 1, &region);
}

Status Commands::upload(const Buffer& buffer, std::span<const std::byte> bytes, uint64_t offset) {
    requireInside(buffer, offset, bytes.size());
    if (bytes.empty()) return Done{};
    if (bytes.size() <= kInlineBytes && bytes.size() % 4 == 0 && offset % 4 == 0) {
        device_->vk().vkCmdUpdateBuffer(handle_, buffer.handle(), offset, bytes.size(), bytes.data());
        return Done{};
    }
    Result<Buffer> staging = Buffer::create(*device_, "upload", bytes.size(), BufferUse::upload);
    if (!staging) return staging.failure();
    std::memcpy(staging->mapped(), bytes.data(), bytes.size());
    copy(*staging, buffer, bytes.size(), 0, offset);
    return Done{};  // the staging buffer is retired, and lives until this recording has finished
}

void Commands::copyToImage(const Buffer& from, uint64_t offset, Image& image, uint32_t level, uint32_t layer) {
    const VkBufferImageCopy region = wholeLevel(image, offset, level, layer);
    device_->vk().vkCmdCopyBufferToImage(handle_, from.handle(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                         1, &region);
}

void Commands::copyFromImage(Image& image, const Buffer& to, uint64_t offset, uint32_t level, uint32_t layer) {
    const VkBufferImageCopy region = wholeLevel(image, offset, level, layer);
    device_->vk().vkCmdCopyImageToBuffer(handle_, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(), 1,
                                         &region);
}

void Commands::makeMips(Image& image) {
    const DeviceFunctions& vk = device_->vk();
    transition(image, ImageState::copyTarget);
    for (uint32_t level = 1; level < image.levels(); ++level) {
        recordBarrier(vk, handle_, imageBarrier(image, ImageState::copyTarget, ImageState::copySource, level - 1, 1));
        VkImageBlit blit{};
        const auto corner = [&](uint32_t l) {
            return VkOffset3D{int32_t(std::max(1u, image.extent().width >> l)),
                              int32_t(std::max(1u, image.extent().height >> l)), 1};
        };
        blit.srcSubresource = {aspectOf(image), level - 1, 0, image.layers()};
        blit.dstSubresource = {aspectOf(image), level, 0, image.layers()};
        blit.srcOffsets[1] = corner(level - 1);
        blit.dstOffsets[1] = corner(level);
        vk.vkCmdBlitImage(handle_, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image.handle(),
                          VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
    }
    // All levels but the last are copy sources now.
    if (image.levels() > 1)
        recordBarrier(vk, handle_,
                      imageBarrier(image, ImageState::copySource, ImageState::sampled, 0, image.levels() - 1));
    recordBarrier(vk, handle_, imageBarrier(image, ImageState::copyTarget, ImageState::sampled, image.levels() - 1, 1));
    image.state = ImageState::sampled;
}

}  // namespace espalier
