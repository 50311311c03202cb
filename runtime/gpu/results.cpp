// In: a VkResult, also one that no specification lists for its call. Out: what a host is told.
#include "runtime/gpu/results.hpp"

#include <string>

namespace espalier {
namespace {

using Cause = Failure::Cause;

Cause causeOf(VkResult result) {
    switch (result) {
        case VK_ERROR_DEVICE_LOST:
            return Cause::lost;
        case VK_ERROR_OUT_OF_HOST_MEMORY:
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        case VK_ERROR_OUT_OF_POOL_MEMORY:
        case VK_ERROR_FRAGMENTED_POOL:
        case VK_ERROR_FRAGMENTATION:
        case VK_ERROR_TOO_MANY_OBJECTS:
            return Cause::memory;
        default:
            return Cause::driver;
    }
}

std::string nameOf(VkResult result) {
    switch (result) {
#define NAMED(name) \
    case name:      \
        return #name;
        NAMED(VK_NOT_READY)
        NAMED(VK_TIMEOUT)
        NAMED(VK_INCOMPLETE)
        NAMED(VK_PIPELINE_COMPILE_REQUIRED)
        NAMED(VK_ERROR_UNKNOWN)
        NAMED(VK_ERROR_INITIALIZATION_FAILED)
        NAMED(VK_ERROR_MEMORY_MAP_FAILED)
        NAMED(VK_ERROR_LAYER_NOT_PRESENT)
        NAMED(VK_ERROR_EXTENSION_NOT_PRESENT)
        NAMED(VK_ERROR_FEATURE_NOT_PRESENT)
        NAMED(VK_ERROR_INCOMPATIBLE_DRIVER)
        NAMED(VK_ERROR_FORMAT_NOT_SUPPORTED)
        NAMED(VK_ERROR_INVALID_EXTERNAL_HANDLE)
        NAMED(VK_ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS)
        NAMED(VK_ERROR_INVALID_SHADER_NV)
        NAMED(VK_ERROR_VALIDATION_FAILED_EXT)
#undef NAMED
        default:
            return "VkResult " + std::to_string(int(result));
    }
}

}  // namespace

Failure resultFailure(VkResult result, std::string_view object, std::string_view what) {
    const Cause cause = causeOf(result);
    std::string why = "out of GPU memory";
    if (cause == Cause::lost) why = "the GPU was lost";
    if (cause == Cause::driver) why = "the GPU's driver failed (" + nameOf(result) + ")";
    return deviceFailure(object, why + " while " + std::string(what), cause);
}

}  // namespace espalier
