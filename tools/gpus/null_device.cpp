// Opens RADV's null device and asks it what compute pipelines cost.
#include "tools/gpus/null_device.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include "runtime/gpu/features.hpp"

namespace espalier {
namespace {

constexpr std::string_view kPlace = "RADV";

Failure told(std::string_view place, const char* what, VkResult result) {
    return Failure(std::string(place), std::string(what) + " (VkResult " + std::to_string(int(result)) + ")");
}

VkPhysicalDeviceVulkan12Properties driverOf(VkPhysicalDevice device, VkPhysicalDeviceProperties2& all) {
    VkPhysicalDeviceVulkan12Properties v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES};
    all = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v12, {}};
    vkGetPhysicalDeviceProperties2(device, &all);
    return v12;
}

// A compute pipeline with what it is made of, for as long as its cost is asked.
struct Compiled {
    VkDevice device;
    VkShaderModule module = VK_NULL_HANDLE;
    VkDescriptorSetLayout set = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;

    explicit Compiled(VkDevice on) : device(on) {}
    Compiled(const Compiled&) = delete;
    ~Compiled() {
        vkDestroyPipeline(device, pipeline, nullptr);
        vkDestroyPipelineLayout(device, layout, nullptr);
        vkDestroyDescriptorSetLayout(device, set, nullptr);
        vkDestroyShaderModule(device, module, nullptr);
    }
    VkResult makeLayout(const ShaderInterface& shape) {
        std::vector<VkDescriptorSetLayoutBinding> bindings;
        for (const ShaderInterface::Slot& slot : shape.slots)
            bindings.push_back({slot.binding, slot.type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
        VkDescriptorSetLayoutCreateInfo sets{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
        sets.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
        sets.bindingCount = uint32_t(bindings.size());
        sets.pBindings = bindings.data();
        if (VkResult r = vkCreateDescriptorSetLayout(device, &sets, nullptr, &set); r != VK_SUCCESS) return r;
        const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, (shape.pushBytes + 3) / 4 * 4};
        VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
        info.setLayoutCount = 1;
        info.pSetLayouts = &set;
        info.pushConstantRangeCount = push.size != 0 ? 1 : 0;
        info.pPushConstantRanges = &push;
        return vkCreatePipelineLayout(device, &info, nullptr, &layout);
    }
    VkResult makePipeline(const ShaderInterface& shape, std::span<const uint32_t> code) {
        VkShaderModuleCreateInfo words{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
        words.codeSize = code.size_bytes();
        words.pCode = code.data();
        if (VkResult r = vkCreateShaderModule(device, &words, nullptr, &module); r != VK_SUCCESS) return r;
        VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
        info.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
        info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        info.stage.module = module;
        info.stage.pName = shape.entryPoint.c_str();
        info.layout = layout;
        return vkCreateComputePipelines(device, nullptr, 1, &info, nullptr, &pipeline);
    }
};

}  // namespace

NullDevice::NullDevice(NullDevice&& other) noexcept
    : instance_(std::exchange(other.instance_, nullptr)),
      physical_(other.physical_),
      device_(std::exchange(other.device_, nullptr)),
      name_(std::move(other.name_)),
      driver_(std::move(other.driver_)) {}

NullDevice::~NullDevice() {
    if (device_) vkDestroyDevice(device_, nullptr);
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

Result<NullDevice> NullDevice::open(const std::string& chip) {
    ::setenv("RADV_FORCE_FAMILY", chip.c_str(), 1);
    NullDevice null;
    if (Status s = null.openInstance(); !s) return s.failure();
    if (Status s = null.openDevice(chip); !s) return s.failure();
    return null;
}

Status NullDevice::openInstance() {
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
    return result == VK_SUCCESS ? Status(Done{}) : Status(told(kPlace, "no instance could be made", result));
}

Status NullDevice::openDevice(const std::string& chip) {
    uint32_t count = 0;
    vkEnumeratePhysicalDevices(instance_, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    if (vkEnumeratePhysicalDevices(instance_, &count, devices.data()) < 0) devices.clear();
    const auto radv = std::ranges::find_if(devices, [](VkPhysicalDevice device) {
        VkPhysicalDeviceProperties2 all;
        return driverOf(device, all).driverID == VK_DRIVER_ID_MESA_RADV;
    });
    if (radv == devices.end())
        return Failure(std::string(kPlace), "there is no null device for the chip " + chip +
                                                " (is mesa-vulkan-drivers installed, and does it know the chip?)");
    physical_ = *radv;
    VkPhysicalDeviceProperties2 all;
    driver_ = driverOf(physical_, all).driverInfo;
    name_ = all.properties.deviceName;

    Features features;  // all that there are: kernels ask for fewer
    vkGetPhysicalDeviceFeatures2(physical_, &features.core);
    features.core.features.robustBufferAccess = VK_FALSE;  // as the runtime asks for it
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR, &features.core, VK_TRUE};
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    constexpr const char* kExtensions[] = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME,
                                           VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME};
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &statistics};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = uint32_t(std::size(kExtensions));
    info.ppEnabledExtensionNames = kExtensions;
    const VkResult result = vkCreateDevice(physical_, &info, nullptr, &device_);
    return result == VK_SUCCESS ? Status(Done{}) : Status(told(kPlace, "the null device could not be opened", result));
}

Result<KernelCost> NullDevice::compile(std::string_view name, std::span<const uint32_t> code) const {
    Result<ShaderInterface> shape = reflect(name, code, {});
    if (!shape) return shape.failure();
    Compiled made(device_);
    const std::vector<uint32_t> exact = withoutContraction(code);  // as the runtime loads kernels of growth
    if (VkResult r = made.makeLayout(*shape); r != VK_SUCCESS) return told(name, "its layout could not be made", r);
    if (VkResult r = made.makePipeline(*shape, exact); r != VK_SUCCESS) return told(name, "it doesn't compile", r);
    return costOf(name, made.pipeline);
}

Result<KernelCost> NullDevice::costOf(std::string_view name, VkPipeline pipeline) const {
    const auto properties = reinterpret_cast<PFN_vkGetPipelineExecutablePropertiesKHR>(
        vkGetDeviceProcAddr(device_, "vkGetPipelineExecutablePropertiesKHR"));
    const auto statistics = reinterpret_cast<PFN_vkGetPipelineExecutableStatisticsKHR>(
        vkGetDeviceProcAddr(device_, "vkGetPipelineExecutableStatisticsKHR"));
    VkPipelineInfoKHR which{VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, nullptr, pipeline};
    uint32_t one = 1;
    VkPipelineExecutablePropertiesKHR executable{};
    executable.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
    if (!properties || !statistics || properties(device_, &which, &one, &executable) < 0 || one != 1)
        return Failure(std::string(name), "the driver tells nothing of its pipeline");
    VkPipelineExecutableInfoKHR first{VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, nullptr, pipeline, 0};
    uint32_t count = 0;
    statistics(device_, &first, &count, nullptr);
    VkPipelineExecutableStatisticKHR empty{};
    empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
    std::vector<VkPipelineExecutableStatisticKHR> all(count, empty);
    statistics(device_, &first, &count, all.data());

    KernelCost cost;
    cost.lanes = executable.subgroupSize;
    uint32_t scratch = 0;
    const std::pair<std::string_view, uint32_t*> rows[] = {{"VGPRs", &cost.vectorRegisters},
                                                           {"SGPRs", &cost.scalarRegisters},
                                                           {"Spilled VGPRs", &cost.spilledVector},
                                                           {"Spilled SGPRs", &cost.spilledScalar},
                                                           {"Scratch size", &scratch},
                                                           {"Subgroups per SIMD", &cost.subgroups},
                                                           {"Instructions", &cost.instructions},
                                                           {"Code size", &cost.codeBytes}};
    for (const auto& [title, value] : rows) {
        const auto row = std::ranges::find_if(all, [&](const auto& s) { return title == s.name; });
        if (row == all.end())
            return Failure(std::string(name), "the driver doesn't tell \"" + std::string(title) + "\"");
        *value = uint32_t(row->value.u64);
    }
    if (cost.lanes == 0) return Failure(std::string(name), "the driver doesn't tell the size of subgroups");
    cost.scratchBytes = scratch / cost.lanes;
    return cost;
}

}  // namespace espalier
