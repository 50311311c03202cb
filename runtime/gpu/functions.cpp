// Loads the function tables from a loader's entry point.
#include "runtime/gpu/functions.hpp"

namespace espalier {

#define ESPALIER_LOAD(name) table.name = reinterpret_cast<PFN_##name>(get(owner, #name));
#define ESPALIER_CHECK(name) \
    if (!table.name) return #name;

std::string loadInstanceFunctions(InstanceFunctions& table, PFN_vkGetInstanceProcAddr get, VkInstance owner) {
    ESPALIER_INSTANCE_FUNCTIONS(ESPALIER_LOAD)
    ESPALIER_INSTANCE_FUNCTIONS_OPTIONAL(ESPALIER_LOAD)
    ESPALIER_INSTANCE_FUNCTIONS(ESPALIER_CHECK)
    return {};
}

std::string loadDeviceFunctions(DeviceFunctions& table, PFN_vkGetDeviceProcAddr get, VkDevice owner) {
    ESPALIER_DEVICE_FUNCTIONS(ESPALIER_LOAD)
    ESPALIER_DEVICE_FUNCTIONS_OPTIONAL(ESPALIER_LOAD)
    ESPALIER_DEVICE_FUNCTIONS(ESPALIER_CHECK)
    return {};
}

}  // namespace espalier
