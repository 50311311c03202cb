#pragma once

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <array>

namespace espalier {

// Pictures of a host that frames are drawn into. What growth covers is within [0, 1] in all of them.
constexpr std::array kLinearFormats{VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R16G16B16A16_SFLOAT,
                                    VK_FORMAT_B10G11R11_UFLOAT_PACK32};
constexpr std::array kEncodedFormats{VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM,
                                     VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_FORMAT_A2R10G10B10_UNORM_PACK32};

// Shaders write and read linear colours; otherwise they see them sRGB encoded.
inline bool takesLinear(VkFormat format) {
    return std::ranges::find(kLinearFormats, format) != kLinearFormats.end();
}
inline bool isHostPicture(VkFormat format) {
    return takesLinear(format) || std::ranges::find(kEncodedFormats, format) != kEncodedFormats.end();
}

}  // namespace espalier
