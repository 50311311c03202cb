// Draw into an image of our own, then blit it into the window's.
#include "sample_game/scene_image.hpp"

#include <algorithm>

#include "plugin_api/espalier.hpp"

namespace sample {

bool SceneImage::show(EspContext* context, const Frame& frame, esp::DrawDef draw, uint32_t left, float scale,
                      bool redraw) {
    const VkExtent2D room{frame.extent.width - left, frame.extent.height};
    drew_ = redraw || !fits(frame, left);
    if (drew_) {
        if (!image_.make(host_.format(), frame.extent.width, frame.extent.height,
                         VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT)) {
            error_ = "the scene's image: " + image_.error();
            return false;
        }
        shown_ = room;
        // A smaller picture takes the image's corner.
        drawn_.width = std::max(1u, uint32_t(float(room.width) * scale + .5f));
        drawn_.height = std::max(1u, uint32_t(float(room.height) * scale + .5f));
        draw.width = drawn_.width;
        draw.height = drawn_.height;
        draw.commandBuffer = frame.commands;
        draw.colourImage = reinterpret_cast<void*>(image_.image());
        draw.colourView = reinterpret_cast<void*>(image_.view());
        draw.colourFormat = host_.format();
        draw.frame = frame.number;
        draw.framesDone = frame.finished;
        if (espDraw(context, &draw) != ESP_OK) {
            error_ = espLastError(context);
            return false;
        }
        imageBarrier(frame.commands, image_.image(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                     VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    } else {
        (void)espFramesDone(context, frame.finished);
    }
    copy(frame, left);
    return true;
}

void SceneImage::showAgain(const Frame& frame, uint32_t left) {
    drew_ = false;
    fits(frame, left) ? copy(frame, left) : clear(frame, {{0, 0, 0, 1}});
}

void SceneImage::copy(const Frame& frame, uint32_t left) const {
    imageBarrier(frame.commands, frame.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[1] = {int32_t(drawn_.width), int32_t(drawn_.height), 1};
    region.dstOffsets[0] = {int32_t(left), 0, 0};
    region.dstOffsets[1] = {int32_t(frame.extent.width), int32_t(frame.extent.height), 1};
    vkCmdBlitImage(frame.commands, image_.image(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, frame.image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_LINEAR);
    imageBarrier(frame.commands, frame.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
}

}  // namespace sample
