// A window in, a device that can show pictures in it out: of a small engine, whose frames are in vulkan_frames.cpp.
// The device is the first, discrete ones before others, that has what the plugin asks for and can show pictures.
#define GLFW_INCLUDE_NONE
#include "sample_game/vulkan_host.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace sample {
namespace {

const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

bool layerInstalled(const char* name) {
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(layers.begin(), layers.end(),
                       [&](const VkLayerProperties& layer) { return !std::strcmp(layer.layerName, name); });
}

constexpr int kSoftware = 3;

int preference(VkPhysicalDevice device) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(device, &properties);
    switch (properties.deviceType) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 0;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 1;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 2;
        default:
            return kSoftware;
    }
}

}  // namespace

VKAPI_ATTR VkBool32 VKAPI_CALL VulkanHost::onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                     VkDebugUtilsMessageTypeFlagsEXT,
                                                     const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) {
    ++static_cast<VulkanHost*>(self)->validationMessages_;
    std::fprintf(stderr, "espalier-sample: validation: %s\n", data->pMessage);
    return VK_FALSE;
}

bool VulkanHost::check(VkResult result, const char* what) {
    if (result == VK_SUCCESS) return true;
    error_ = std::string(what) + " failed (VkResult " + std::to_string(int(result)) + ")";
    return false;
}

bool VulkanHost::create(GLFWwindow* window, bool validation, const void* features, const char* const* extensions,
                        uint32_t extensionCount) {
    window_ = window;
    return makeInstance(validation) &&
           check(glfwCreateWindowSurface(instance_, window_, nullptr, &surface_), "making the window's surface") &&
           makeDevice(features, extensions, extensionCount) && makeFrames() && makeSwapchain();
}

bool VulkanHost::makeInstance(bool validation) {
    if (volkInitialize() != VK_SUCCESS) {
        error_ = "there is no Vulkan on this machine (libvulkan.so.1 is missing)";
        return false;
    }
    uint32_t count = 0;
    const char** needed = glfwGetRequiredInstanceExtensions(&count);
    if (!needed) {
        error_ = "no Vulkan driver here can show a window";
        return false;
    }
    std::vector<const char*> extensions(needed, needed + count);
    std::vector<const char*> layers;
    if (validation) {
        if (!layerInstalled(kValidationLayer)) {
            error_ = "the validation layer isn't installed";
            return false;
        }
        layers.push_back(kValidationLayer);
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "espalier-sample";
    application.apiVersion = VK_API_VERSION_1_3;
    VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messenger.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
    messenger.pfnUserCallback = onMessage;
    messenger.pUserData = this;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pNext = validation ? &messenger : nullptr;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = uint32_t(layers.size());
    info.ppEnabledLayerNames = layers.data();
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    if (!check(vkCreateInstance(&info, nullptr, &instance_), "making a Vulkan instance")) return false;
    volkLoadInstance(instance_);
    return !validation || check(vkCreateDebugUtilsMessengerEXT(instance_, &messenger, nullptr, &messenger_),
                                "listening to the validation layer");
}

bool VulkanHost::makeDevice(const void* features, const char* const* extensions, uint32_t extensionCount) {
    uint32_t count = 0;
    vkEnumeratePhysicalDevices(instance_, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    vkEnumeratePhysicalDevices(instance_, &count, devices.data());
    std::stable_sort(devices.begin(), devices.end(),
                     [](VkPhysicalDevice a, VkPhysicalDevice b) { return preference(a) < preference(b); });
    extensions_.assign(extensions, extensions + extensionCount);
    extensions_.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    for (VkPhysicalDevice candidate : devices) {
        uint32_t families = 0;
        vkGetPhysicalDeviceQueueFamilyProperties(candidate, &families, nullptr);
        std::vector<VkQueueFamilyProperties> properties(families);
        vkGetPhysicalDeviceQueueFamilyProperties(candidate, &families, properties.data());
        for (uint32_t family = 0; family < families; ++family) {
            const VkQueueFlags works = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
            VkBool32 shows = VK_FALSE;
            vkGetPhysicalDeviceSurfaceSupportKHR(candidate, family, surface_, &shows);
            if ((properties[family].queueFlags & works) != works || !shows) continue;
            const float priority = 1;
            VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
            queue.queueFamilyIndex = family;
            queue.queueCount = 1;
            queue.pQueuePriorities = &priority;
            VkPhysicalDeviceFeatures have;
            vkGetPhysicalDeviceFeatures(candidate, &have);
            features_ = *static_cast<const VkPhysicalDeviceFeatures2*>(features);
            features_.features.samplerAnisotropy = have.samplerAnisotropy;
            deviceInfo_ = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
            deviceInfo_.pNext = &features_;
            deviceInfo_.enabledExtensionCount = uint32_t(extensions_.size());
            deviceInfo_.ppEnabledExtensionNames = extensions_.data();
            VkDeviceCreateInfo info = deviceInfo_;
            info.queueCreateInfoCount = 1;
            info.pQueueCreateInfos = &queue;
            // A device that lacks something says so, and the next one is tried.
            if (vkCreateDevice(candidate, &info, nullptr, &device_) != VK_SUCCESS) break;
            physicalDevice_ = candidate;
            overlaps_ = preference(candidate) < kSoftware;
            queueFamily_ = family;
            volkLoadDevice(device_);
            vkGetDeviceQueue(device_, family, 0, &queue_);
            vkGetPhysicalDeviceMemoryProperties(candidate, &memory_);
            return true;
        }
    }
    error_ = devices.empty() ? "there is no Vulkan device" : "no Vulkan device here has what Espalier needs";
    return false;
}

void VulkanHost::waitIdle() const {
    if (device_) vkDeviceWaitIdle(device_);
}

bool VulkanHost::findMemory(uint32_t allowedTypes, VkMemoryPropertyFlags wanted, uint32_t& type) const {
    for (type = 0; type < memory_.memoryTypeCount; ++type)
        if ((allowedTypes >> type & 1) && (memory_.memoryTypes[type].propertyFlags & wanted) == wanted) return true;
    return false;
}

VulkanHost::~VulkanHost() {
    if (device_) {
        vkDeviceWaitIdle(device_);
        vkDestroyBuffer(device_, pictureBuffer_, nullptr);
        vkFreeMemory(device_, pictureMemory_, nullptr);
        dropSwapchain();
        for (Slot& slot : slots_) {
            vkDestroySemaphore(device_, slot.acquired, nullptr);
            vkDestroyFence(device_, slot.done, nullptr);
            vkDestroyCommandPool(device_, slot.pool, nullptr);
        }
        vkDestroyDevice(device_, nullptr);
    }
    if (instance_) {
        vkDestroySurfaceKHR(instance_, surface_, nullptr);
        if (messenger_) vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
        vkDestroyInstance(instance_, nullptr);
    }
}

}  // namespace sample
