#pragma once

#include <vulkan/vulkan.h>

#include "plugin_api/espalier.h"

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

}  // namespace espalier
