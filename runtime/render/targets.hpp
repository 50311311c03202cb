#pragma once

#include "runtime/gpu/image.hpp"

namespace espalier {

constexpr uint32_t kShadowSize = 2048;
constexpr VkFormat kSceneFormat = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr VkFormat kDistanceFormat = VK_FORMAT_R32_SFLOAT;
constexpr VkFormat kOpenFormat = VK_FORMAT_R8G8B8A8_UNORM;  // a word a texel: what software devices filter fastest
constexpr VkFormat kOwnFormat = VK_FORMAT_R8G8B8A8_UNORM;

// The images that a frame of one size is drawn in.
struct Targets {
    Image color, depth;    // of `samples` a pixel; colour: as tone.glsl's stored()
    Image distance, open;  // a quarter of the pixels: distance along the view, ambient visibility
    Image own;             // 8 bit, sRGB encoded; made only if asked for
    uint32_t width = 0, height = 0;
    uint32_t samples = 4;  // 4, or 1 where samples cost more than smoothing edges afterwards; set before resize()

    Status resize(Device& device, uint32_t newWidth, uint32_t newHeight);
    Status makeOwn(Device& device);
};

}  // namespace espalier
