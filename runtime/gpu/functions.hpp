#pragma once

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan.h>

#include <string>

namespace espalier {

// The Vulkan functions in use, as members of a table that every Device has for itself: two devices, or a host with
// its own loader, share no state. (volk's tables are filled through global pointers.) A name added here is
// callable as device.vk().vkName. Functions in the OPTIONAL lists are null where their extension is missing.
// clang-format off
#define ESPALIER_INSTANCE_FUNCTIONS(F) \
    F(vkDestroyInstance) F(vkEnumeratePhysicalDevices) F(vkGetPhysicalDeviceProperties2) \
    F(vkGetPhysicalDeviceFeatures2) F(vkGetPhysicalDeviceMemoryProperties) \
    F(vkGetPhysicalDeviceQueueFamilyProperties) F(vkEnumerateDeviceExtensionProperties) F(vkCreateDevice) \
    F(vkGetDeviceProcAddr)
#define ESPALIER_INSTANCE_FUNCTIONS_OPTIONAL(F) \
    F(vkCreateDebugUtilsMessengerEXT) F(vkDestroyDebugUtilsMessengerEXT)
#define ESPALIER_DEVICE_FUNCTIONS(F) \
    F(vkDestroyDevice) F(vkGetDeviceQueue) F(vkDeviceWaitIdle) F(vkQueueSubmit2) F(vkAllocateMemory) \
    F(vkFreeMemory) F(vkMapMemory) F(vkUnmapMemory) F(vkCreateBuffer) F(vkDestroyBuffer) F(vkGetBufferMemoryRequirements) \
    F(vkBindBufferMemory) F(vkGetBufferDeviceAddress) F(vkCreateImage) F(vkDestroyImage) \
    F(vkGetImageMemoryRequirements) F(vkBindImageMemory) F(vkCreateImageView) F(vkDestroyImageView) \
    F(vkCreateBufferView) F(vkDestroyBufferView) F(vkCreateSampler) F(vkDestroySampler) F(vkCreateShaderModule) \
    F(vkDestroyShaderModule) F(vkCreateDescriptorSetLayout) F(vkDestroyDescriptorSetLayout) \
    F(vkCreatePipelineLayout) F(vkDestroyPipelineLayout) F(vkCreateComputePipelines) \
    F(vkCreateGraphicsPipelines) F(vkDestroyPipeline) F(vkCreateSemaphore) F(vkDestroySemaphore) \
    F(vkWaitSemaphores) F(vkGetSemaphoreCounterValue) F(vkCreateCommandPool) F(vkDestroyCommandPool) \
    F(vkResetCommandPool) F(vkAllocateCommandBuffers) F(vkBeginCommandBuffer) F(vkEndCommandBuffer) \
    F(vkCreateQueryPool) F(vkDestroyQueryPool) F(vkResetQueryPool) F(vkGetQueryPoolResults) \
    F(vkCmdResetQueryPool) F(vkCmdWriteTimestamp2) F(vkCmdPipelineBarrier2) F(vkCmdBindPipeline) F(vkCmdPushConstants) F(vkCmdDispatch) \
    F(vkCmdDispatchIndirect) F(vkCmdFillBuffer) F(vkCmdUpdateBuffer) F(vkCmdCopyBuffer) \
    F(vkCmdCopyBufferToImage) F(vkCmdCopyImageToBuffer) F(vkCmdBlitImage) F(vkCmdBeginRendering) \
    F(vkCmdEndRendering) F(vkCmdSetViewport) F(vkCmdSetScissor) F(vkCmdSetCullMode) F(vkCmdSetFrontFace) F(vkCmdBindIndexBuffer) F(vkCmdBindVertexBuffers) F(vkCmdDraw) \
    F(vkCmdDrawIndexed) F(vkCmdDrawIndirect) F(vkCmdDrawIndexedIndirect) \
    F(vkCmdPushDescriptorSetKHR)
#define ESPALIER_DEVICE_FUNCTIONS_OPTIONAL(F) \
    F(vkSetDebugUtilsObjectNameEXT) F(vkCmdBeginDebugUtilsLabelEXT) F(vkCmdEndDebugUtilsLabelEXT)
// clang-format on

#define ESPALIER_MEMBER(name) PFN_##name name = nullptr;
struct InstanceFunctions {
    ESPALIER_INSTANCE_FUNCTIONS(ESPALIER_MEMBER)
    ESPALIER_INSTANCE_FUNCTIONS_OPTIONAL(ESPALIER_MEMBER)
};
struct DeviceFunctions {
    ESPALIER_DEVICE_FUNCTIONS(ESPALIER_MEMBER)
    ESPALIER_DEVICE_FUNCTIONS_OPTIONAL(ESPALIER_MEMBER)
};
#undef ESPALIER_MEMBER

// Fill a table. Return the name of the first function that is missing and not optional, or an empty string.
std::string loadInstanceFunctions(InstanceFunctions& table, PFN_vkGetInstanceProcAddr get, VkInstance instance);
std::string loadDeviceFunctions(DeviceFunctions& table, PFN_vkGetDeviceProcAddr get, VkDevice device);

}  // namespace espalier
