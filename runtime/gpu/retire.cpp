// Deferred destruction, see retire.hpp, and what destroys each kind of handle.
#include "runtime/gpu/retire.hpp"

#include <algorithm>

#include "runtime/core/check.hpp"
#include "runtime/gpu/device.hpp"
#include "runtime/gpu/owned.hpp"

namespace espalier {

uint64_t RetireQueue::beginRecording() {
    recordings_.push_back({.serial = ++lastSerial_, .stage = Recording::open, .value = 0});
    return lastSerial_;
}

RetireQueue::Recording& RetireQueue::find(uint64_t serial) {
    auto it = std::ranges::find(recordings_, serial, &Recording::serial);
    require(it != recordings_.end(), "a recording is used after its end");
    return *it;
}

void RetireQueue::recordingSubmitted(uint64_t serial, uint64_t timelineValue) {
    find(serial) = {.serial = serial, .stage = Recording::submitted, .value = timelineValue};
}

void RetireQueue::recordingIntoHost(uint64_t serial, uint64_t frame) {
    find(serial) = {.serial = serial, .stage = Recording::host, .value = frame};
    knowsHost_ = true;
}

void RetireQueue::recordingDiscarded(uint64_t serial) {
    std::erase_if(recordings_, [&](const Recording& r) { return r.serial == serial; });
}

void RetireQueue::hostSubmitted(uint64_t timelineValue) {
    for (Recording& r : recordings_)
        if (r.stage == Recording::host) r.following = std::min(r.following, timelineValue);
}

void RetireQueue::collect(uint64_t timelineValue, uint64_t hostFrame) {
    std::erase_if(recordings_, [&](const Recording& r) {
        return (r.stage == Recording::submitted && r.value <= timelineValue) ||
               (r.stage == Recording::host && (r.value <= hostFrame || r.following <= timelineValue));
    });
    const uint64_t oldest = oldestPending();
    while (!entries_.empty() && entries_.front().serial < oldest) {
        entries_.front().destroy();
        entries_.pop_front();
    }
}

void RetireQueue::flush() {
    recordings_.clear();
    for (Entry& entry : entries_) entry.destroy();
    entries_.clear();
}

#define ESPALIER_RETIRE(Handle, destroyFunction)                                                   \
    void retire(Device& device, Handle handle) {                                                   \
        device.retireQueue().add(                                                                  \
            [&device, handle] { device.vk().destroyFunction(device.handle(), handle, nullptr); }); \
    }
ESPALIER_RETIRE(VkBuffer, vkDestroyBuffer)
ESPALIER_RETIRE(VkImage, vkDestroyImage)
ESPALIER_RETIRE(VkImageView, vkDestroyImageView)
ESPALIER_RETIRE(VkSampler, vkDestroySampler)
ESPALIER_RETIRE(VkBufferView, vkDestroyBufferView)
ESPALIER_RETIRE(VkPipeline, vkDestroyPipeline)
ESPALIER_RETIRE(VkPipelineLayout, vkDestroyPipelineLayout)
ESPALIER_RETIRE(VkDescriptorSetLayout, vkDestroyDescriptorSetLayout)

void retire(Device& device, const MemoryBlock& block) {
    device.retireQueue().add([&device, block] { device.memory().free(block); });
}

}  // namespace espalier
