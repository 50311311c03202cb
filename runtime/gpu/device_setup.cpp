// Makes a Device: from options (loader, instance, messenger, the best physical device, queue), or around a host's.
// Every way to fail ends in a message that says what is missing.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <span>

#include "runtime/core/hash.hpp"
#include "runtime/core/platform.hpp"
#include "runtime/gpu/command_pools.hpp"
#include "runtime/gpu/device.hpp"
#include "runtime/gpu/features.hpp"
#include "runtime/gpu/known_faults.hpp"
#include "runtime/gpu/limits.hpp"
#include "runtime/gpu/retire.hpp"
#include "runtime/gpu/timer.hpp"
#include "runtime/gpu/validation.hpp"

namespace espalier {
namespace {

constexpr const char* kLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::string_view kPlace = "Vulkan";
constexpr float kMostAnisotropy = 16;

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

// What the environment tells the loader about drivers, since it is a common cause of finding none.
std::string driverHint() {
    for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"})
        if (const char* value = std::getenv(name)) return std::string(" (") + name + " is set to \"" + value + "\")";
    return " (is a driver installed, such as mesa-vulkan-drivers?)";
}

bool hasExtension(const std::vector<VkExtensionProperties>& have, std::string_view name) {
    return std::ranges::any_of(have, [&](const VkExtensionProperties& e) { return name == e.extensionName; });
}

std::vector<VkExtensionProperties> deviceExtensions(const InstanceFunctions& vk, VkPhysicalDevice device) {
    uint32_t count = 0;
    vk.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> all(count);
    if (vk.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, all.data()) < 0) count = 0;
    all.resize(count);
    return all;
}

std::vector<VkQueueFamilyProperties> queueFamilies(const InstanceFunctions& vk, VkPhysicalDevice device) {
    uint32_t count = 0;
    vk.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> all(count);
    vk.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, all.data());
    return all;
}

int graphicsFamily(const InstanceFunctions& vk, VkPhysicalDevice device) {
    constexpr VkQueueFlags need = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    const auto families = queueFamilies(vk, device);
    auto it = std::ranges::find_if(families, [&](const auto& f) { return (f.queueFlags & need) == need; });
    return it == families.end() ? -1 : int(it - families.begin());
}

// What marching and roofs ask of subgroups: no feature says so.
bool sharesInSubgroups(const InstanceFunctions& vk, VkPhysicalDevice device) {
    constexpr VkSubgroupFeatureFlags need =
        VK_SUBGROUP_FEATURE_VOTE_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT;
    VkPhysicalDeviceVulkan11Properties v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
    VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v11, {}};
    vk.vkGetPhysicalDeviceProperties2(device, &all);
    return (v11.subgroupSupportedOperations & need) == need &&
           (v11.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT);
}

struct Candidate {
    VkPhysicalDevice device = VK_NULL_HANDLE;
    std::string name;
    std::string unfit;  // why it won't do, or empty
    bool discrete = false;
    bool cpu = false;
};

Candidate examine(const InstanceFunctions& vk, VkPhysicalDevice device) {
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    vk.vkGetPhysicalDeviceProperties2(device, &properties);
    Candidate c{device, properties.properties.deviceName, {}, false, false};
    c.discrete = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    c.cpu = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    std::vector<std::string> missing;
    if (properties.properties.apiVersion < VK_API_VERSION_1_3) {
        missing.push_back("Vulkan 1.3");
    } else {
        Features have;
        vk.vkGetPhysicalDeviceFeatures2(device, &have.core);
        missing = missingFeatures(have);
        if (properties.properties.limits.maxUniformBufferRange < kUniformBytes)
            missing.push_back("uniform blocks of " + std::to_string(kUniformBytes) + " bytes");
        if (!sharesInSubgroups(vk, device)) missing.push_back("votes, ballots and arithmetic of subgroups in compute");
    }
    if (!hasExtension(deviceExtensions(vk, device), VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME))
        missing.push_back(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    if (graphicsFamily(vk, device) < 0) missing.push_back("a queue for graphics and compute");
    c.unfit = missing.empty() ? knownFault(vk, device) : "lacks " + joined(missing);
    return c;
}

}  // namespace

// The steps of Device::create and adopt, with access to the members that they fill.
struct DeviceSetup {
    Device& d;

    Status openLoader() {
        d.loader_ = platform::openLibrary(platform::kVulkanLoader);
        if (!d.loader_)
            return Failure(kPlace, std::string("no Vulkan loader (") + platform::kVulkanLoader + ") on this machine");
        d.getInstanceProcAddr_ =
            reinterpret_cast<PFN_vkGetInstanceProcAddr>(platform::functionOf(d.loader_, "vkGetInstanceProcAddr"));
        if (!d.getInstanceProcAddr_) return Failure(kPlace, "the Vulkan loader has no vkGetInstanceProcAddr");
        return Done{};
    }

    template <class Function>
    Function global(const char* name) {
        return reinterpret_cast<Function>(d.getInstanceProcAddr_(nullptr, name));
    }

    bool layerInstalled() {
        auto enumerate = global<PFN_vkEnumerateInstanceLayerProperties>("vkEnumerateInstanceLayerProperties");
        uint32_t count = 0;
        if (!enumerate || enumerate(&count, nullptr) < 0) return false;
        std::vector<VkLayerProperties> layers(count);
        if (enumerate(&count, layers.data()) < 0) return false;
        return std::ranges::any_of(layers, [](const auto& l) { return !std::strcmp(l.layerName, kLayer); });
    }

    std::vector<VkExtensionProperties> instanceExtensions() {
        auto enumerate = global<PFN_vkEnumerateInstanceExtensionProperties>("vkEnumerateInstanceExtensionProperties");
        uint32_t count = 0;
        if (!enumerate || enumerate(nullptr, &count, nullptr) < 0) return {};
        std::vector<VkExtensionProperties> all(count);
        if (enumerate(nullptr, &count, all.data()) < 0) return {};
        all.resize(count);
        return all;
    }

    Status makeInstance(const DeviceOptions& options) {
        const auto available = instanceExtensions();
        std::vector<const char*> extensions;
        if (options.validation && !layerInstalled())
            return Failure(kPlace, std::string("the layer ") + kLayer + " is not installed");
        // The loader offers debug utils without a layer too; they name objects for capture tools.
        d.debugUtils_ = options.validation || hasExtension(available, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
        if (d.debugUtils_) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

        VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
        application.pApplicationName = options.applicationName.c_str();
        application.pEngineName = "espalier";
        application.apiVersion = VK_API_VERSION_1_3;
        VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
        info.pApplicationInfo = &application;
        info.enabledLayerCount = options.validation ? 1 : 0;
        info.ppEnabledLayerNames = &kLayer;
        info.enabledExtensionCount = uint32_t(extensions.size());
        info.ppEnabledExtensionNames = extensions.data();
        VkDebugUtilsMessengerCreateInfoEXT messenger{};
        const VkValidationFeatureEnableEXT more = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
        VkValidationFeaturesEXT checks{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
        checks.enabledValidationFeatureCount = 1;
        checks.pEnabledValidationFeatures = &more;
        if (options.validation) {
            d.validation_ = std::make_unique<ValidationLog>(options.log);
            messenger = d.validation_->messengerInfo();
            if (options.synchronizationValidation) messenger.pNext = &checks;
            info.pNext = &messenger;
        }
        auto create = global<PFN_vkCreateInstance>("vkCreateInstance");
        const VkResult result = create ? create(&info, nullptr, &d.instance_) : VK_ERROR_INITIALIZATION_FAILED;
        if (result == VK_ERROR_INCOMPATIBLE_DRIVER) return Failure(kPlace, "no Vulkan driver found" + driverHint());
        if (result != VK_SUCCESS)
            return Failure(kPlace, "no instance could be made (VkResult " + std::to_string(int(result)) + ")");
        d.ownsInstance_ = true;
        if (auto missing = loadInstanceFunctions(d.vkInstance_, d.getInstanceProcAddr_, d.instance_); !missing.empty())
            return Failure(kPlace, "the loader lacks " + missing);
        messenger.pNext = nullptr;
        if (options.validation &&
            d.vkInstance_.vkCreateDebugUtilsMessengerEXT(d.instance_, &messenger, nullptr, &d.messenger_) < 0)
            return Failure(kPlace, "the validation messages cannot be received");
        return Done{};
    }

    Status choosePhysicalDevice(const DeviceOptions& options) {
        uint32_t count = 0;
        VkResult result = d.vkInstance_.vkEnumeratePhysicalDevices(d.instance_, &count, nullptr);
        std::vector<VkPhysicalDevice> devices(count);
        if (result >= 0) result = d.vkInstance_.vkEnumeratePhysicalDevices(d.instance_, &count, devices.data());
        if (result < 0 || count == 0) return Failure(kPlace, "no Vulkan device found" + driverHint());
        std::vector<Candidate> fit;
        std::string unfit;
        for (VkPhysicalDevice device : devices) {
            Candidate c = examine(d.vkInstance_, device);
            if (c.name.find(options.deviceName) == std::string::npos) c.unfit = "is not the one asked for";
            if (c.unfit.empty())
                fit.push_back(c);
            else
                unfit += "; " + c.name + " " + c.unfit;
        }
        if (fit.empty()) return Failure(kPlace, "no Vulkan device will do" + unfit);
        std::ranges::stable_sort(fit, {}, [](const Candidate& c) { return c.discrete ? 0 : c.cpu ? 2 : 1; });
        d.physicalDevice_ = fit.front().device;
        return Done{};
    }

    // Asked for only where the extension is there: others needn't know the structure.
    bool offersReconvergence() {
        if (!hasExtension(deviceExtensions(d.vkInstance_, d.physicalDevice_), kReconvergenceExtension)) return false;
        ReconvergenceFeature reconvergence;
        VkPhysicalDeviceFeatures2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &reconvergence, {}};
        d.vkInstance_.vkGetPhysicalDeviceFeatures2(d.physicalDevice_, &all);
        return reconvergence.shaderMaximalReconvergence == VK_TRUE;
    }

    Status makeDevice() {
        std::vector<const char*> extensions = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
        Features have, enable;
        d.vkInstance_.vkGetPhysicalDeviceFeatures2(d.physicalDevice_, &have.core);
        chooseFeatures(have, enable);
        ReconvergenceFeature reconvergence;
        reconvergence.shaderMaximalReconvergence = offersReconvergence() ? VK_TRUE : VK_FALSE;
        d.info_.maximalReconvergence = reconvergence.shaderMaximalReconvergence == VK_TRUE;
        if (d.info_.maximalReconvergence) {
            extensions.push_back(kReconvergenceExtension);
            enable.v13.pNext = &reconvergence;
        }
        d.info_.queueFamily = uint32_t(graphicsFamily(d.vkInstance_, d.physicalDevice_));
        const float priority = 1;
        VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
        queue.queueFamilyIndex = d.info_.queueFamily;
        queue.queueCount = 1;
        queue.pQueuePriorities = &priority;
        VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
        info.pNext = &enable.core;
        info.queueCreateInfoCount = 1;
        info.pQueueCreateInfos = &queue;
        info.enabledExtensionCount = uint32_t(extensions.size());
        info.ppEnabledExtensionNames = extensions.data();
        const VkResult result = d.vkInstance_.vkCreateDevice(d.physicalDevice_, &info, nullptr, &d.device_);
        if (result != VK_SUCCESS)
            return Failure(kPlace, "the device could not be opened (VkResult " + std::to_string(int(result)) + ")");
        d.ownsDevice_ = true;
        d.info_.maxAnisotropy = have.core.features.samplerAnisotropy ? kMostAnisotropy : 1;
        return Done{};
    }

    Status finish(MemorySource* hostMemory) {
        if (auto missing = loadDeviceFunctions(d.vk_, d.vkInstance_.vkGetDeviceProcAddr, d.device_); !missing.empty())
            return Failure(kPlace, whyMissing(missing));
        if (!d.debugUtils_) {  // some loaders hand the functions out all the same
            d.vk_.vkSetDebugUtilsObjectNameEXT = nullptr;
            d.vk_.vkCmdBeginDebugUtilsLabelEXT = nullptr;
            d.vk_.vkCmdEndDebugUtilsLabelEXT = nullptr;
        }
        if (!d.queue_) d.vk_.vkGetDeviceQueue(d.device_, d.info_.queueFamily, 0, &d.queue_);
        describe();
        VkPhysicalDeviceMemoryProperties memory{};
        d.vkInstance_.vkGetPhysicalDeviceMemoryProperties(d.physicalDevice_, &memory);
        // A graphics card's memory is shared with a game.
        const uint64_t keepBytes = d.info_.cpu ? 1ull << 30 : 1ull << 28;
        if (!hostMemory) d.ownMemory_ = makePooledMemory(d.vk_, d.device_, memory, d.info_.cpu, keepBytes);
        d.memory_ = hostMemory ? hostMemory : d.ownMemory_.get();
        d.retireQueue_ = std::make_unique<RetireQueue>();
        d.timers_ = std::make_unique<TimerRing>(d);
        d.commandPools_ = std::make_unique<CommandPools>(d);

        VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
        type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
        VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type, 0};
        if (!d.succeeded(d.vk_.vkCreateSemaphore(d.device_, &info, nullptr, &d.timeline_)))
            return gpuFailure(d, "timeline", "making it");
        d.setName(VK_OBJECT_TYPE_SEMAPHORE, uint64_t(d.timeline_), "timeline");
        d.setName(VK_OBJECT_TYPE_QUEUE, uint64_t(d.queue_), "queue");
        return Done{};
    }

    // All but one of the functions are Vulkan 1.3's own, which the physical device has: examine() has asked for it.
    static std::string whyMissing(const std::string& function) {
        if (function == "vkCmdPushDescriptorSetKHR")
            return "the device has no " + function + ": " + VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME + " isn't enabled";
        return "the device has no " + function +
               ", although its driver has Vulkan 1.3: the instance was made for an earlier version. "
               "VkApplicationInfo::apiVersion has to be VK_API_VERSION_1_3 or later";
    }

    void describe() {
        VkPhysicalDeviceVulkan11Properties v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
        VkPhysicalDeviceVulkan12Properties v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES, &v11};
        VkPhysicalDeviceVulkan13Properties v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES, &v12};
        VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v13};
        d.vkInstance_.vkGetPhysicalDeviceProperties2(d.physicalDevice_, &all);
        DeviceInfo& info = d.info_;
        info.name = all.properties.deviceName;
        info.driver = std::string(v12.driverName) + " " + v12.driverInfo;
        info.cpu = all.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
        info.traits = traitsOf(info.cpu);
        info.subgroupSize = v11.subgroupSize;
        info.identity = hashValues<uint8_t>(v11.deviceUUID, hashValues<uint8_t>(v11.driverUUID));
        info.identity = hashValues<uint8_t>(all.properties.pipelineCacheUUID, info.identity);
        const uint32_t numbers[] = {all.properties.vendorID, all.properties.deviceID, all.properties.driverVersion,
                                    v11.subgroupSize};
        info.identity = hashValues<uint32_t>(numbers, hashText(info.name + info.driver, info.identity));
        info.limits = all.properties.limits;
        info.maxBufferBytes = v13.maxBufferSize;
        info.maxAnisotropy = std::min(info.maxAnisotropy, info.limits.maxSamplerAnisotropy);
        const auto families = queueFamilies(d.vkInstance_, d.physicalDevice_);
        const bool stamps = families[info.queueFamily].timestampValidBits > 0;
        info.timestampNanoseconds = stamps ? info.limits.timestampPeriod : 0;
    }
};

Result<std::unique_ptr<Device>> Device::create(const DeviceOptions& options) {
    std::unique_ptr<Device> device(new Device);
    device->log_ = options.log;
    DeviceSetup setup{*device};
    Status status = setup.openLoader();
    if (status) status = setup.makeInstance(options);
    if (status) status = setup.choosePhysicalDevice(options);
    if (status) status = setup.makeDevice();
    if (status) status = setup.finish(nullptr);
    if (!status) return status.failure();
    return device;
}

namespace {

// What a host's device was made without; empty: nothing that is required.
std::string leftOut(const VkDeviceCreateInfo& made, const Features& enabled) {
    std::vector<std::string> missing = missingFeatures(enabled);
    const auto named = [](const char* name) { return name == std::string_view(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME); };
    const std::span extensions(made.ppEnabledExtensionNames, made.enabledExtensionCount);
    if (std::ranges::none_of(extensions, named)) missing.push_back(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    return joined(missing);
}

}  // namespace

Result<std::unique_ptr<Device>> Device::adopt(const HostDevice& host) {
    if (!host.getInstanceProcAddr || !host.instance || !host.physicalDevice || !host.device || !host.queue)
        return Failure(kPlace, "the host's device is incomplete: a handle or vkGetInstanceProcAddr is null");
    std::unique_ptr<Device> device(new Device);
    Device& d = *device;
    d.log_ = host.log;
    d.getInstanceProcAddr_ = host.getInstanceProcAddr;
    d.instance_ = host.instance;
    d.physicalDevice_ = host.physicalDevice;
    d.queue_ = host.queue;
    d.info_.queueFamily = host.queueFamily;
    d.debugUtils_ = host.debugUtils;
    d.pipelineCache_ = host.pipelineCache;
    Features enabled;
    if (host.made) readFeatures(*host.made, enabled);
    d.info_.maxAnisotropy = enabled.core.features.samplerAnisotropy ? kMostAnisotropy : 1;
    d.info_.maximalReconvergence = host.made && hasReconvergence(*host.made);
    if (auto missing = loadInstanceFunctions(d.vkInstance_, host.getInstanceProcAddr, host.instance); !missing.empty())
        return Failure(kPlace, "the host's instance lacks " + missing);
    if (Candidate c = examine(d.vkInstance_, host.physicalDevice); !c.unfit.empty())
        return Failure(kPlace, "the host's device " + c.name + " " + c.unfit);
    if (const std::string missing = host.made ? leftOut(*host.made, enabled) : ""; !missing.empty())
        return Failure(kPlace, "the host's device was made without " + missing + " (VkDeviceCreateInfo)");
    const auto families = queueFamilies(d.vkInstance_, host.physicalDevice);
    constexpr VkQueueFlags need = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    if (host.queueFamily >= families.size() || (families[host.queueFamily].queueFlags & need) != need)
        return Failure(
            kPlace, "the host's queue family " + std::to_string(host.queueFamily) + " cannot do graphics and compute");
    d.device_ = host.device;
    if (Status status = DeviceSetup{d}.finish(host.memory); !status) return status.failure();
    return device;
}

}  // namespace espalier
