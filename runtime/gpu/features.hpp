#pragma once

#include <string>
#include <vector>

#include "runtime/gpu/functions.hpp"

namespace espalier {

// The core feature structs of Vulkan 1.3, chained. Not copyable: the chain points into it.
struct Features {
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};

    Features() {
        core.pNext = &v11;
        v11.pNext = &v12;
        v12.pNext = &v13;
    }
    Features(const Features&) = delete;
    Features& operator=(const Features&) = delete;
};

// VK_KHR_shader_maximal_reconvergence, which the headers of older systems lack.
constexpr const char* kReconvergenceExtension = "VK_KHR_shader_maximal_reconvergence";
struct ReconvergenceFeature {
    VkStructureType sType = VkStructureType(1000434000);
    void* pNext = nullptr;
    VkBool32 shaderMaximalReconvergence = VK_FALSE;
};

// Names of the required features that `have` lacks.
std::vector<std::string> missingFeatures(const Features& have);
// What a device was made with, by any of the structs that say so.
void readFeatures(const VkDeviceCreateInfo& made, Features& out);
// Whether it was made with maximal reconvergence.
bool hasReconvergence(const VkDeviceCreateInfo& made);
// Sets in `enable` what is required, and anisotropic filtering where it is there.
void chooseFeatures(const Features& have, Features& enable);

}  // namespace espalier
