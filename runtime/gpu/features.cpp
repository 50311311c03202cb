// Which Vulkan features we need. Nothing may be required that Debian 12's software
// device lacks.
#include "runtime/gpu/features.hpp"

// A line each.
// clang-format off
#define ESPALIER_REQUIRED(F) \
    F(core.features, multiDrawIndirect) \
    F(core.features, drawIndirectFirstInstance) \
    F(core.features, shaderInt64) \
    F(core.features, shaderInt16) \
    F(core.features, shaderClipDistance) \
    F(v11, shaderDrawParameters) \
    F(v11, storageBuffer16BitAccess) \
    F(v12, storageBuffer8BitAccess) \
    F(v12, shaderInt8) \
    F(v12, bufferDeviceAddress) \
    F(v12, scalarBlockLayout) \
    F(v12, timelineSemaphore) \
    F(v12, hostQueryReset) \
    F(v13, synchronization2) \
    F(v13, dynamicRendering) \
    F(v13, shaderDemoteToHelperInvocation) \
    F(v13, shaderTerminateInvocation) \
    F(v13, maintenance4)
// Those of them that a struct of their own says, too.
#define ESPALIER_SINGLES(F) \
    F(SHADER_DRAW_PARAMETERS, ShaderDrawParameters, v11, shaderDrawParameters) \
    F(16BIT_STORAGE, 16BitStorage, v11, storageBuffer16BitAccess) \
    F(8BIT_STORAGE, 8BitStorage, v12, storageBuffer8BitAccess) \
    F(SHADER_FLOAT16_INT8, ShaderFloat16Int8, v12, shaderInt8) \
    F(BUFFER_DEVICE_ADDRESS, BufferDeviceAddress, v12, bufferDeviceAddress) \
    F(SCALAR_BLOCK_LAYOUT, ScalarBlockLayout, v12, scalarBlockLayout) \
    F(TIMELINE_SEMAPHORE, TimelineSemaphore, v12, timelineSemaphore) \
    F(HOST_QUERY_RESET, HostQueryReset, v12, hostQueryReset) \
    F(SYNCHRONIZATION_2, Synchronization2, v13, synchronization2) \
    F(DYNAMIC_RENDERING, DynamicRendering, v13, dynamicRendering) \
    F(SHADER_DEMOTE_TO_HELPER_INVOCATION, ShaderDemoteToHelperInvocation, v13, shaderDemoteToHelperInvocation) \
    F(SHADER_TERMINATE_INVOCATION, ShaderTerminateInvocation, v13, shaderTerminateInvocation) \
    F(MAINTENANCE_4, Maintenance4, v13, maintenance4)
// clang-format on

namespace espalier {

std::vector<std::string> missingFeatures(const Features& have) {
    std::vector<std::string> missing;
#define ESPALIER_MISSING(group, name) \
    if (!have.group.name) missing.push_back(#name);
    ESPALIER_REQUIRED(ESPALIER_MISSING)
    return missing;
}

namespace {

template <class Struct>
const Struct& as(const VkBaseInStructure* link) {
    return *reinterpret_cast<const Struct*>(link);
}

// Takes the features in, but for the chain.
template <class Struct>
void take(Struct& to, const VkBaseInStructure* link) {
    void* const next = to.pNext;
    to = as<Struct>(link);
    to.pNext = next;
}

}  // namespace

bool hasReconvergence(const VkDeviceCreateInfo& made) {
    for (auto link = static_cast<const VkBaseInStructure*>(made.pNext); link; link = link->pNext)
        if (link->sType == ReconvergenceFeature{}.sType)
            return as<ReconvergenceFeature>(link).shaderMaximalReconvergence == VK_TRUE;
    return false;
}

void readFeatures(const VkDeviceCreateInfo& made, Features& out) {
    if (made.pEnabledFeatures) out.core.features = *made.pEnabledFeatures;
    for (auto link = static_cast<const VkBaseInStructure*>(made.pNext); link; link = link->pNext) {
        switch (link->sType) {
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2:
                take(out.core, link);
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES:
                take(out.v11, link);
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES:
                take(out.v12, link);
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES:
                take(out.v13, link);
                break;
#define ESPALIER_SINGLE(type, Struct, group, name)                          \
    case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_##type##_FEATURES:               \
        out.group.name = as<VkPhysicalDevice##Struct##Features>(link).name; \
        break;
                ESPALIER_SINGLES(ESPALIER_SINGLE)
            default:
                break;
        }
    }
}

void chooseFeatures(const Features& have, Features& enable) {
#define ESPALIER_ENABLE(group, name) enable.group.name = VK_TRUE;
    ESPALIER_REQUIRED(ESPALIER_ENABLE)
    enable.core.features.samplerAnisotropy = have.core.features.samplerAnisotropy;
}

}  // namespace espalier
