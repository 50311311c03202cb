// The device's daily work: timeline, deferred destruction, names, errors. device_setup.cpp makes it.
#include "runtime/gpu/device.hpp"

#include <algorithm>
#include <new>

#include "runtime/core/platform.hpp"
#include "runtime/gpu/command_pools.hpp"
#include "runtime/gpu/results.hpp"
#include "runtime/gpu/retire.hpp"
#include "runtime/gpu/timer.hpp"
#include "runtime/gpu/validation.hpp"

namespace espalier {
namespace {

constexpr int kMostWaits = 100;

}  // namespace

Device::Device() = default;

Device::~Device() {
    if (device_) {
        if (vk_.vkDeviceWaitIdle && ownsDevice_) vk_.vkDeviceWaitIdle(device_);
        waitForHost();
        if (retireQueue_) retireQueue_->flush();
        timers_.reset();
        commandPools_.reset();
        if (memory_ && memory_ == ownMemory_.get() && memory_->bytesUsed() > 0)
            log_(Severity::error, "GPU objects outlive their device");
        ownMemory_.reset();
        if (timeline_) vk_.vkDestroySemaphore(device_, timeline_, nullptr);
        if (ownsDevice_) vk_.vkDestroyDevice(device_, nullptr);
    }
    if (messenger_) vkInstance_.vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
    if (ownsInstance_) vkInstance_.vkDestroyInstance(instance_, nullptr);
    if (loader_) platform::closeLibrary(loader_);
}

// Nothing leaves a destructor: where there is no memory for a message, none is made.
void Device::waitForHost() noexcept {
    if (!timeline_ || ownsDevice_ || lost_) return;
    try {
        (void)wait(submitted_);
    } catch (const std::bad_alloc&) {
    }
}

uint64_t Device::completed() {
    uint64_t value = 0;
    if (succeeded(vk_.vkGetSemaphoreCounterValue(device_, timeline_, &value)))
        completed_ = value;
    else if (lost_)
        completed_ = submitted_;  // it runs nothing any more
    return completed_;
}

Status Device::wait(uint64_t value) {
    VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    info.semaphoreCount = 1;
    info.pSemaphores = &timeline_;
    info.pValues = &value;
    // Without a limit no wait should time out; some drivers' waits do, and the GPU is at work all the same.
    VkResult waited = VK_TIMEOUT;
    for (int i = 0; i < kMostWaits && waited == VK_TIMEOUT; ++i)
        waited = vk_.vkWaitSemaphores(device_, &info, UINT64_MAX);
    if (!succeeded(waited)) return gpuFailure(*this, "timeline", "waiting for the GPU");
    collect();
    return Done{};
}

Status Device::waitIdle() {
    return wait(submitted_);
}

void Device::collect() {
    retireQueue_->collect(completed(), hostFrame_);
    timers_->collect(retireQueue_->oldestPending());
}

void Device::hostFrameDone(uint64_t frame) {
    hostFrame_ = std::max(hostFrame_, frame);
    collect();
}

void Device::hostSubmitted() {
    retireQueue_->hostSubmitted(submitted_ + 1);
}

bool Device::finished(uint64_t recording) const {
    return recording < retireQueue_->oldestPending();
}

size_t Device::retiredCount() const {
    return retireQueue_->size();
}

const std::vector<PassTime>& Device::timings() const {
    return timers_->times();
}

double Device::milliseconds(std::string_view passName) const {
    auto it = std::ranges::find(timings(), passName, &PassTime::name);
    return it == timings().end() ? 0 : it->milliseconds;
}

uint32_t Device::validationMessages() const {
    return validation_ ? validation_->count() : 0;
}

std::vector<std::string> Device::validationTexts() const {
    return validation_ ? validation_->texts() : std::vector<std::string>();
}

void Device::setName(VkObjectType type, uint64_t handle, std::string_view name) const {
    if (!debugUtils_ || !vk_.vkSetDebugUtilsObjectNameEXT) return;
    const std::string text(name);
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = text.c_str();
    vk_.vkSetDebugUtilsObjectNameEXT(device_, &info);
}

Failure Device::fault(std::string_view what) const {
    return deviceFailure(info_.name + " (" + info_.driver + ")",
                         std::string(what) + ": this driver doesn't run Espalier's kernels as they are written",
                         Failure::Cause::fault);
}

bool Device::succeeded(VkResult result) {
    if (result == VK_SUCCESS) return true;
    failedResult_ = result;
    lost_ = lost_ || result == VK_ERROR_DEVICE_LOST;
    return false;
}

Failure gpuFailure(const Device& device, std::string_view object, std::string_view what) {
    return resultFailure(device.lost() ? VK_ERROR_DEVICE_LOST : device.failedResult(), object, what);
}

}  // namespace espalier
