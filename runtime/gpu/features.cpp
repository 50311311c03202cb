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
// clang-format on

namespace espalier {

std::vector<std::string> missingFeatures(const Features& have) {
    std::vector<std::string> missing;
#define ESPALIER_MISSING(group, name) \
    if (!have.group.name) missing.push_back(#name);
    ESPALIER_REQUIRED(ESPALIER_MISSING)
    return missing;
}

void chooseFeatures(const Features& have, Features& enable) {
#define ESPALIER_ENABLE(group, name) enable.group.name = VK_TRUE;
    ESPALIER_REQUIRED(ESPALIER_ENABLE)
    enable.core.features.samplerAnisotropy = have.core.features.samplerAnisotropy;
}

}  // namespace espalier
