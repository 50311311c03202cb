// Drivers that were found to miscompile our kernels. A row is added when a self-check (runtime/plugin/self_check.hpp)
// or a user's report has shown a fault; the self-check finds those that nobody has reported yet.
#include "runtime/gpu/known_faults.hpp"

#include <cstdlib>

namespace espalier {
namespace {

struct Driver {
    VkDriverId id;
    uint32_t subgroupSize;
};
struct KnownFault {
    bool (*applies)(const Driver&);
    const char* why;
    const char* variable;  // of the environment, which may have brought it about; null: none
};

// Lavapipe's subgroups are as wide as its vectors: 8 lanes of 32 bits are 256 bits. At other widths Mesa 22.3.6 and
// 25.0.7 crash in kernels with 64-bit integers, or run them without any effect.
bool isNarrowOrWideLavapipe(const Driver& driver) {
    return driver.id == VK_DRIVER_ID_MESA_LLVMPIPE && driver.subgroupSize != 8;
}

constexpr KnownFault kFaults[] = {
    {isNarrowOrWideLavapipe,
     "is known to miscompile Espalier's kernels unless its vectors have 256 bits, as they have by default on "
     "processors "
     "with AVX",
     "LP_NATIVE_VECTOR_WIDTH"},
};

}  // namespace

std::string knownFault(const InstanceFunctions& vk, VkPhysicalDevice device) {
    VkPhysicalDeviceVulkan11Properties v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
    VkPhysicalDeviceVulkan12Properties v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES, &v11};
    VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v12, {}};
    vk.vkGetPhysicalDeviceProperties2(device, &all);
    for (const KnownFault& fault : kFaults) {
        if (!fault.applies({v12.driverID, v11.subgroupSize})) continue;
        std::string text = std::string("(") + v12.driverName + " " + v12.driverInfo + ") " + fault.why;
        if (const char* value = fault.variable ? std::getenv(fault.variable) : nullptr)
            text += std::string("; the environment variable ") + fault.variable + " is set to \"" + value + "\"";
        return text;
    }
    return "";
}

}  // namespace espalier
