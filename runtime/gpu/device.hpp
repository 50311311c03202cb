#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/core/log.hpp"
#include "runtime/core/result.hpp"
#include "runtime/gpu/device_traits.hpp"
#include "runtime/gpu/functions.hpp"
#include "runtime/gpu/memory.hpp"

namespace espalier {

class RetireQueue;
class TimerRing;
class CommandPools;
class ValidationLog;

struct DeviceOptions {
    std::string applicationName = "espalier";
    bool validation = false;  // the Khronos validation layer; it is an error if it isn't installed
    bool synchronizationValidation =
        false;               // with validation: look for missing barriers too; sees no buffers by address
    std::string deviceName;  // if not empty: only a device whose name contains this
    Log log = logToStderr();
};

// A device that a host already has. All handles stay the host's and must outlive the Device. The VkDevice must
// have been created with Vulkan 1.3, VK_KHR_push_descriptor and the features of chooseFeatures() (features.hpp). The
// queue must do graphics and compute; the host doesn't use it while a call into Espalier runs. Before the Device goes,
// the GPU must be done with what was recorded into the host's command buffers.
struct HostDevice {
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    uint32_t queueFamily = 0;
    bool debugUtils = false;  // VK_EXT_debug_utils is enabled on the instance: name objects, label passes
    // What the device was made with, read while it is adopted; null: it has all that is required, and no anisotropy.
    const VkDeviceCreateInfo* made = nullptr;
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;  // what pipelines are looked for in, and added to; null: none
    MemorySource* memory = nullptr;                  // null: our own pools
    Log log = logToStderr();
};

struct DeviceInfo {
    std::string name;
    std::string driver;
    uint64_t identity = 0;  // of device, driver and the width of its subgroups: another one where any of them differs
    bool cpu = false;       // a software device; see `traits` for what follows
    DeviceTraits traits;
    uint32_t subgroupSize = 0;
    uint32_t queueFamily = 0;
    float timestampNanoseconds = 0;     // 0: no timestamps
    float maxAnisotropy = 1;            // 1: none
    bool maximalReconvergence = false;  // modules may be loaded with that mode
    uint64_t maxBufferBytes = 0;
    VkPhysicalDeviceLimits limits{};
};

// The milliseconds that a pass took when it last finished; passes of one name in one submission are summed.
struct PassTime {
    std::string name;
    double milliseconds = 0;
    uint64_t submission = 0;  // Commands::serial() of the recording it was in
};

// A Vulkan 1.3 device with one queue: the root of all GPU objects. It is used by one thread at a time.
// No result of a Vulkan call ends the program: all but VK_SUCCESS come back as failures (see gpuFailure).
class Device {
  public:
    // Fails with a message that names what is missing: the loader, a device, the layer, features.
    static Result<std::unique_ptr<Device>> create(const DeviceOptions& options = {});
    static Result<std::unique_ptr<Device>> adopt(const HostDevice& host);
    // Waits for the GPU. All objects of the device must be gone.
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceFunctions& vk() const { return vk_; }
    PFN_vkGetInstanceProcAddr getInstanceProcAddr() const { return getInstanceProcAddr_; }
    VkInstance instance() const { return instance_; }
    VkPhysicalDevice physicalDevice() const { return physicalDevice_; }
    VkDevice handle() const { return device_; }
    VkQueue queue() const { return queue_; }
    VkPipelineCache pipelineCache() const { return pipelineCache_; }  // a host's; null: there is none
    const DeviceInfo& info() const { return info_; }
    const Log& log() const { return log_; }
    MemorySource& memory() { return *memory_; }

    // The timeline: Commands::submit returns a value, which completed() reaches when that work is done.
    uint64_t submitted() const { return submitted_; }
    uint64_t completed();
    Status wait(uint64_t value);
    Status waitIdle();

    // Destroys what the GPU has finished with and takes in finished timings. Call once a frame; submit does too.
    void collect();
    // The host's GPU work up to this frame number is done (see Commands::into).
    void hostFrameDone(uint64_t frame);
    uint64_t hostFrame() const { return hostFrame_; }  // that is done, with all before it
    // The host has submitted all its recordings to our queue: they are done when our next submission is, even if it
    // says no more of its frames.
    void hostSubmitted();
    // Whether the recording of this number (Commands::serial()), and all before it, are known to have finished.
    bool finished(uint64_t recording) const;
    // Objects dropped, but still waiting for the GPU.
    size_t retiredCount() const;

    // In the order in which the names first appeared.
    const std::vector<PassTime>& timings() const;
    // 0 if no pass of that name has finished yet.
    double milliseconds(std::string_view passName) const;

    // Warnings and errors of the validation layer so far, and the first few texts. 0 without validation.
    uint32_t validationMessages() const;
    std::vector<std::string> validationTexts() const;

    bool lost() const { return lost_; }
    // Of the latest call for which succeeded() said false.
    VkResult failedResult() const { return failedResult_; }
    // That the driver has run kernels otherwise than they are written, with its and the device's name. what: the effect
    // that was seen.
    Failure fault(std::string_view what) const;

    // For other files of gpu/.
    void setName(VkObjectType type, uint64_t handle, std::string_view name) const;
    // Whether a call's result is VK_SUCCESS. Another is kept for gpuFailure.
    bool succeeded(VkResult result);
    RetireQueue& retireQueue() { return *retireQueue_; }
    TimerRing& timers() { return *timers_; }
    CommandPools& commandPools() { return *commandPools_; }
    VkSemaphore timeline() const { return timeline_; }
    uint64_t nextSubmission() { return ++submitted_; }
    void submissionFailed() { --submitted_; }

  private:
    Device();
    void waitForHost() noexcept;
    friend struct DeviceSetup;

    bool ownsInstance_ = false;
    bool ownsDevice_ = false;
    bool debugUtils_ = false;
    bool lost_ = false;
    VkResult failedResult_ = VK_SUCCESS;
    Log log_;
    void* loader_ = nullptr;
    PFN_vkGetInstanceProcAddr getInstanceProcAddr_ = nullptr;
    InstanceFunctions vkInstance_;
    DeviceFunctions vk_;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    VkPipelineCache pipelineCache_ = VK_NULL_HANDLE;
    VkSemaphore timeline_ = VK_NULL_HANDLE;
    uint64_t submitted_ = 0;
    uint64_t completed_ = 0;  // as last known
    uint64_t hostFrame_ = 0;
    DeviceInfo info_;
    std::unique_ptr<ValidationLog> validation_;
    std::unique_ptr<MemorySource> ownMemory_;
    MemorySource* memory_ = nullptr;
    std::unique_ptr<RetireQueue> retireQueue_;
    std::unique_ptr<TimerRing> timers_;
    std::unique_ptr<CommandPools> commandPools_;
};

// The failure for a call that succeeded() has answered with false. what: what the call was for.
Failure gpuFailure(const Device& device, std::string_view object, std::string_view what);

}  // namespace espalier
