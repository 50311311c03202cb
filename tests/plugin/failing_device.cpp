// A driver between Espalier and the real one. There is one at a time: Vulkan's functions carry no pointer of ours.
#include "tests/plugin/failing_device.hpp"

#include <doctest/doctest.h>
#include <vulkan/vulkan.h>

#include <cstring>
#include <vector>

#include "tests/plugin/made_as_required.hpp"

namespace espalier {
namespace {

struct Handles {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    VkDevice old = VK_NULL_HANDLE;
} handles;

struct Plan {
    bool armed = false, lost = false, submitsOnly = false;
    FailingDevice::Failure how = FailingDevice::Failure::OutOfMemory;
    uint32_t at = 0, calls = 0;
    const char* failed = "";
    const char* oddFunction = "";
    VkResult oddResult = VK_SUCCESS;
} plan;
bool finishesAtOnce = false;

// What this call gives instead of the driver's answer, or VK_SUCCESS.
VkResult verdict(const char* name, FailingDevice::Failure kind) {
    if (plan.how == FailingDevice::Failure::Full && plan.armed) {
        if (std::strcmp(name, "vkAllocateMemory")) return VK_SUCCESS;
        plan.calls += 1;
        plan.failed = name;
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    if (plan.how == FailingDevice::Failure::Odd) {
        if (std::strcmp(name, plan.oddFunction) || plan.calls++ != plan.at || !plan.armed) return VK_SUCCESS;
        plan.failed = name;
        return plan.oddResult;
    }
    if (plan.lost && kind == FailingDevice::Failure::Lost) return VK_ERROR_DEVICE_LOST;
    if (kind != plan.how || (plan.submitsOnly && std::strcmp(name, "vkQueueSubmit2"))) return VK_SUCCESS;
    if (plan.calls++ != plan.at || !plan.armed) return VK_SUCCESS;
    plan.failed = name;
    plan.lost = kind == FailingDevice::Failure::Lost;
    if (!plan.lost) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    vkDeviceWaitIdle(handles.device);  // a lost device runs nothing any more: what it used may be destroyed
    return VK_ERROR_DEVICE_LOST;
}

template <size_t Number, class Function>
struct Hook;
template <size_t Number, class... Arguments>
struct Hook<Number, VkResult(VKAPI_PTR*)(Arguments...)> {
    static inline VkResult(VKAPI_PTR* real)(Arguments...) = nullptr;
    static inline const char* name = nullptr;
    static inline FailingDevice::Failure kind{};

    static VKAPI_ATTR VkResult VKAPI_CALL call(Arguments... arguments) {
        const VkResult failure = verdict(name, kind);
        if (failure != VK_SUCCESS) return failure;
        const VkResult result = real(arguments...);
        if (finishesAtOnce && !std::strcmp(name, "vkQueueSubmit2")) vkDeviceWaitIdle(handles.device);
        return result;
    }
    static PFN_vkVoidFunction over(PFN_vkVoidFunction driver, const char* functionName, FailingDevice::Failure how) {
        real = reinterpret_cast<VkResult(VKAPI_PTR*)(Arguments...)>(driver);
        name = functionName;
        kind = how;
        return reinterpret_cast<PFN_vkVoidFunction>(&call);
    }
};

// clang-format off
#define HOOKED(F) \
    F(vkQueueSubmit2, Lost) F(vkWaitSemaphores, Lost) F(vkGetSemaphoreCounterValue, Lost) F(vkDeviceWaitIdle, Lost) \
    F(vkGetQueryPoolResults, Lost) F(vkAllocateMemory, OutOfMemory) F(vkMapMemory, OutOfMemory) \
    F(vkCreateBuffer, OutOfMemory) F(vkBindBufferMemory, OutOfMemory) F(vkCreateBufferView, OutOfMemory) \
    F(vkCreateImage, OutOfMemory) F(vkBindImageMemory, OutOfMemory) F(vkCreateImageView, OutOfMemory) \
    F(vkCreateSampler, OutOfMemory) F(vkCreateShaderModule, OutOfMemory) \
    F(vkCreateDescriptorSetLayout, OutOfMemory) F(vkCreatePipelineLayout, OutOfMemory) \
    F(vkCreateComputePipelines, OutOfMemory) F(vkCreateGraphicsPipelines, OutOfMemory) \
    F(vkCreateSemaphore, OutOfMemory) F(vkCreateCommandPool, OutOfMemory) F(vkResetCommandPool, OutOfMemory) \
    F(vkAllocateCommandBuffers, OutOfMemory) F(vkBeginCommandBuffer, OutOfMemory) \
    F(vkEndCommandBuffer, OutOfMemory) F(vkCreateQueryPool, OutOfMemory)
// clang-format on

enum class HookNumber {
#define NUMBER(function, kind) function,
    HOOKED(NUMBER)
#undef NUMBER
};

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name) {
    const PFN_vkVoidFunction driver = vkGetDeviceProcAddr(device, name);
    if (!driver) return nullptr;
#define HOOK(function, kind)                                                               \
    if (!std::strcmp(name, #function))                                                     \
        return Hook<size_t(HookNumber::function), PFN_##function>::over(driver, #function, \
                                                                        FailingDevice::Failure::kind);
    HOOKED(HOOK)
#undef HOOK
    return driver;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance instance, const char* name) {
    if (!std::strcmp(name, "vkGetDeviceProcAddr")) return reinterpret_cast<PFN_vkVoidFunction>(&deviceFunction);
    return vkGetInstanceProcAddr(instance, name);
}

}  // namespace

FailingDevice::FailingDevice() {
    REQUIRE(handles.instance == VK_NULL_HANDLE);
    plan = {};
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo instanceInfo{};
    instanceInfo.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    instanceInfo.pApplicationInfo = &application;
    REQUIRE(vkCreateInstance(&instanceInfo, nullptr, &handles.instance) == VK_SUCCESS);
    uint32_t count = 1;
    REQUIRE(vkEnumeratePhysicalDevices(handles.instance, &count, &handles.physical) >= 0);
    REQUIRE(count == 1);

    makeDevice();
}

void FailingDevice::renew() {
    REQUIRE(handles.old == VK_NULL_HANDLE);
    handles.old = handles.device;
    plan = {};
    makeDevice();
}

void FailingDevice::dropOld() {
    vkDestroyDevice(handles.old, nullptr);
    handles.old = VK_NULL_HANDLE;
}

void FailingDevice::makeDevice() {
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info = madeAsRequired();
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    REQUIRE(vkCreateDevice(handles.physical, &info, nullptr, &handles.device) == VK_SUCCESS);
    vkGetDeviceQueue(handles.device, 0, 0, &handles.queue);
}

FailingDevice::~FailingDevice() {
    dropOld();
    vkDestroyDevice(handles.device, nullptr);
    vkDestroyInstance(handles.instance, nullptr);
    handles = {};
    finishesAtOnce = false;
}

EspHostDevice FailingDevice::host() const {
    EspHostDevice host{};
    host.getInstanceProcAddr = reinterpret_cast<void*>(&instanceFunction);
    host.instance = handles.instance;
    host.physicalDevice = handles.physical;
    host.device = handles.device;
    host.queue = handles.queue;
    host.deviceInfo = &madeAsRequired();
    return host;
}

void FailingDevice::failAt(uint32_t at, Failure how) {
    plan = {};
    plan.armed = true;
    plan.at = at;
    plan.submitsOnly = how == Failure::LostAtSubmit;
    plan.how = plan.submitsOnly ? Failure::Lost : how;
}

void FailingDevice::answerOddly(const char* function, uint32_t at, int result) {
    failAt(at, Failure::Odd);
    plan.oddFunction = function;
    plan.oddResult = VkResult(result);
}

std::vector<const char*> FailingDevice::functions() {
#define NAME(function, kind) #function,
    return {HOOKED(NAME)};
#undef NAME
}

void FailingDevice::heal() {
    plan.armed = plan.lost = false;
    plan.calls = 0;
    plan.failed = "";
}

void FailingDevice::finishAtOnce(bool does) {
    finishesAtOnce = does;
}

uint32_t FailingDevice::calls() const {
    return plan.calls;
}

std::string FailingDevice::failed() const {
    return plan.failed;
}

}  // namespace espalier
