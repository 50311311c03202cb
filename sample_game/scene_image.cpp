// Draw into an image of our own, then blit it into the window's; while nothing changes, average more pictures with it.
#include "sample_game/scene_image.hpp"

#include <algorithm>

#include "plugin_api/espalier.hpp"
#include "tools/scene/jitter.hpp"

namespace sample {
namespace {

constexpr VkFormat kMeanFormat = VK_FORMAT_R16G16B16A16_SFLOAT;  // means of sixteen pictures are exact enough in it

VkImageBlit stretched(VkExtent2D from, VkOffset3D low, VkOffset3D high) {
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[1] = {int32_t(from.width), int32_t(from.height), 1};
    region.dstOffsets[0] = low;
    region.dstOffsets[1] = high;
    return region;
}

}  // namespace

bool SceneImage::fail(const std::string& message) {
    error_ = message;
    return false;
}

bool SceneImage::show(EspContext* context, const Frame& frame, esp::DrawDef draw, const Wish& wish) {
    refinement_.begin(wish.now);
    drew_ = wish.redraw || !fits(frame, wish.margins);
    if (drew_) {
        if (!drawAnew(context, frame, draw, wish)) return false;
    } else if (wish.refines && refinement_.due()) {
        if (!refine(context, frame, draw)) return false;
    } else {
        (void)espFramesDone(context, frame.finished);
    }
    copy(frame, wish.margins);
    if (const float share = refinement_.before(wish.now); share > 0) layBefore(frame, wish.margins, share);
    return true;
}

void SceneImage::showAgain(const Frame& frame, Margins margins) {
    drew_ = false;
    fits(frame, margins) ? copy(frame, margins) : clear(frame, {{0, 0, 0, 1}});
}

bool SceneImage::drawAnew(EspContext* context, const Frame& frame, const esp::DrawDef& draw, const Wish& wish) {
    const VkExtent2D room = roomOf(frame, wish.margins);
    const bool fades = wish.fades && fits(frame, wish.margins);
    if (fades && refinement_.coarse() && !wish.coarse && !keepBefore(frame)) return false;
    if (!image_.make(
            host_.format(), frame.extent.width, frame.extent.height,
            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT))
        return fail("the scene's image: " + image_.error());
    shown_ = room;
    // A smaller picture takes the image's corner.
    drawn_.width = std::max(1u, uint32_t(float(room.width) * wish.scale + .5f));
    drawn_.height = std::max(1u, uint32_t(float(room.height) * wish.scale + .5f));
    if (!this->draw(context, frame, draw)) return false;
    refinement_.drew(wish.coarse);
    if (!fades) refinement_.cut();
    return true;
}

bool SceneImage::draw(EspContext* context, const Frame& frame, esp::DrawDef draw) {
    draw.width = drawn_.width;
    draw.height = drawn_.height;
    draw.commandBuffer = frame.commands;
    draw.colourImage = reinterpret_cast<void*>(image_.image());
    draw.colourView = reinterpret_cast<void*>(image_.view());
    draw.colourFormat = host_.format();
    draw.frame = frame.number;
    draw.framesDone = frame.finished;
    if (espDraw(context, &draw) != ESP_OK) return fail(espLastError(context));
    imageBarrier(frame.commands, image_.image(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    return true;
}

bool SceneImage::refine(EspContext* context, const Frame& frame, const esp::DrawDef& whole) {
    if (!average_.made() && !average_.create(kMeanFormat)) return fail(average_.error());
    if (!mean_.make(
            kMeanFormat, frame.extent.width, frame.extent.height,
            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT))
        return fail("the scene's smooth image: " + mean_.error());
    const uint32_t which = refinement_.pictures();
    const bool first = which == 1;
    if (first) {
        // Whatever it held might be no number, which no share makes 0.
        imageBarrier(frame.commands, mean_.image(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        const VkClearColorValue black{};
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdClearColorImage(frame.commands, mean_.image(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1, &all);
    }
    imageBarrier(frame.commands, mean_.image(),
                 first ? VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    if (first) average(frame, 1);
    esp::DrawDef beside = whole;
    beside.camera = espalier::scene::jittered(whole.camera, which, drawn_.width, drawn_.height);
    if (!draw(context, frame, beside)) return false;
    average(frame, 1 / float(which + 1));
    imageBarrier(frame.commands, mean_.image(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    refinement_.refined();
    return true;
}

// The latest picture becomes a share of the mean.
void SceneImage::average(const Frame& frame, float share) {
    imageBarrier(frame.commands, image_.image(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    average_.lay(frame.commands, image_, mean_.view(), {{0, 0}, frame.extent}, share);
    imageBarrier(frame.commands, image_.image(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

// What was shown last, as large as it was shown.
bool SceneImage::keepBefore(const Frame& frame) {
    if (!fade_.made() && !fade_.create(host_.format())) return fail(fade_.error());
    if (!before_.make(host_.format(), shown_.width, shown_.height,
                      VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT))
        return fail("the image of what was shown before: " + before_.error());
    imageBarrier(frame.commands, before_.image(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkImageBlit region = stretched(drawn_, {0, 0, 0}, {int32_t(shown_.width), int32_t(shown_.height), 1});
    vkCmdBlitImage(frame.commands, image_.image(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, before_.image(),
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_LINEAR);
    imageBarrier(frame.commands, before_.image(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    return true;
}

void SceneImage::layBefore(const Frame& frame, Margins margins, float share) {
    fade_.lay(frame.commands, before_, frame.view, {{int32_t(margins.left), 0}, roomOf(frame, margins)}, share);
}

void SceneImage::copy(const Frame& frame, Margins margins) const {
    imageBarrier(frame.commands, frame.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkImageBlit region =
        stretched(drawn_, {int32_t(margins.left), 0, 0},
                  {int32_t(frame.extent.width), int32_t(frame.extent.height - margins.below), 1});
    const HostImage& from = refinement_.pictures() > 1 ? mean_ : image_;
    vkCmdBlitImage(frame.commands, from.image(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, frame.image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_LINEAR);
    imageBarrier(frame.commands, frame.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
}

}  // namespace sample
