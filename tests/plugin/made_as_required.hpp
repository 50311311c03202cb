#pragma once

#include <vulkan/vulkan.h>

#include "plugin_api/espalier.h"
#include "runtime/gpu/device.hpp"

namespace espalier {

// What a host's device was made with that has what Espalier requires, and no more.
inline const VkDeviceCreateInfo& madeAsRequired() {
    static const VkDeviceCreateInfo made = [] {
        VkDeviceCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
        info.pNext = espRequiredFeatures();
        info.ppEnabledExtensionNames = espRequiredExtensions(&info.enabledExtensionCount);
        return info;
    }();
    return made;
}

// A device of a test's own as a host hands it in.
inline EspHostDevice hostDeviceOf(const Device& device) {
    EspHostDevice host{};
    host.getInstanceProcAddr = reinterpret_cast<void*>(device.getInstanceProcAddr());
    host.instance = device.instance();
    host.physicalDevice = device.physicalDevice();
    host.device = device.handle();
    host.queue = device.queue();
    host.queueFamily = device.info().queueFamily;
    host.deviceInfo = &madeAsRequired();
    return host;
}

}  // namespace espalier
