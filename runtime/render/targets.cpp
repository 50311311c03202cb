// Enters: a size. Leaves: the images of a frame.
#include "runtime/render/targets.hpp"

namespace espalier {

Status Targets::resize(Device& device, uint32_t newWidth, uint32_t newHeight) {
    if (color && width == newWidth && height == newHeight) return Done{};
    const uint32_t halfWidth = (newWidth + 1) / 2, halfHeight = (newHeight + 1) / 2;
    const struct {
        Image& image;
        ImageDesc desc;
    } images[] = {
        {color,
         {.name = "scene colour", .format = kSceneFormat, .width = newWidth, .height = newHeight, .samples = samples}},
        {depth,
         {.name = "scene depth", .format = kDepthFormat, .width = newWidth, .height = newHeight, .samples = samples}},
        {distance, {.name = "distance", .format = kDistanceFormat, .width = halfWidth, .height = halfHeight}},
        {open, {.name = "ambient visibility", .format = kOpenFormat, .width = halfWidth, .height = halfHeight}}};
    if (width != newWidth || height != newHeight) own = Image();
    color = Image();  // so that a failure half way leaves a size that matches nothing
    for (const auto& i : images) {
        ImageDesc desc = i.desc;
        desc.usage =
            VK_IMAGE_USAGE_SAMPLED_BIT | (isDepthFormat(desc.format) ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                                                     : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        Result<Image> made = Image::create(device, desc);
        if (!made) {
            color = Image();
            return made.failure();
        }
        i.image = std::move(*made);
    }
    width = newWidth;
    height = newHeight;
    return Done{};
}

Status Targets::makeOwn(Device& device) {
    if (own) return Done{};
    ImageDesc desc{.name = "picture", .format = kOwnFormat, .width = width, .height = height};
    desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    return assign(own, Image::create(device, desc));
}

}  // namespace espalier
