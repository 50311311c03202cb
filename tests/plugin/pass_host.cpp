#include "tests/plugin/pass_host.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "tests/plugin/made_as_required.hpp"

namespace espalier {
namespace {

struct BoxPush {
    glm::mat4 viewProjection;
    glm::vec3 low, high, tint;
};

template <class T>
T must(Result<T> made) {
    REQUIRE_MESSAGE(made, (made ? "" : made.failure().text()));
    return std::move(*made);
}

Image makeImage(Device& device, VkFormat format, uint32_t samples) {
    const bool depth = isDepthFormat(format);
    ImageDesc desc{.name = "host's", .format = format, .width = PassHost::kWidth, .height = PassHost::kHeight};
    desc.samples = samples;
    desc.usage = depth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    return must(Image::create(device, desc));
}

std::vector<glm::vec4> coloursOf(const std::vector<std::byte>& bytes, VkFormat format) {
    std::vector<glm::vec4> colours(size_t(PassHost::kWidth) * PassHost::kHeight);
    for (size_t i = 0; i < colours.size(); ++i)
        for (int c = 0; c < 4; ++c) {
            if (format == VK_FORMAT_R16G16B16A16_SFLOAT) {
                uint16_t half;
                std::memcpy(&half, &bytes[8 * i + 2 * size_t(c)], 2);
                colours[i][c] = glm::unpackHalf1x16(half);
            } else {
                colours[i][c] = float(bytes[4 * i + size_t(c)]) / 255;
            }
        }
    return colours;
}

}  // namespace

// The images of a frame, and its pass.
struct PassHost::Pass {
    Device& device;
    Kind kind;
    Image colour, depth, flatColour, flatDepth;  // flat: resolved
    VkRenderPass renderPass = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;

    Pass(Device& of, const Kind& wanted) : device(of), kind(wanted) {
        if (kind.colour != VK_FORMAT_UNDEFINED) colour = makeImage(device, kind.colour, kind.samples);
        depth = makeImage(device, kind.depth, kind.samples);
        if (kind.samples > 1) {
            if (colour) flatColour = makeImage(device, kind.colour, 1);
            flatDepth = makeImage(device, kind.depth, 1);
        }
        if (kind.renderPass) makeRenderPass();
    }
    ~Pass() {
        if (!renderPass) return;
        call<PFN_vkDestroyFramebuffer>("vkDestroyFramebuffer")(device.handle(), framebuffer, nullptr);
        call<PFN_vkDestroyRenderPass>("vkDestroyRenderPass")(device.handle(), renderPass, nullptr);
    }
    Pass(const Pass&) = delete;

    template <class F>
    F call(const char* name) const {
        const auto ask = reinterpret_cast<PFN_vkGetDeviceProcAddr>(
            device.getInstanceProcAddr()(device.instance(), "vkGetDeviceProcAddr"));
        return reinterpret_cast<F>(ask(device.handle(), name));
    }

    void makeRenderPass() {
        VkAttachmentDescription attachments[2]{};
        for (VkAttachmentDescription& a : attachments) {
            a.samples = VK_SAMPLE_COUNT_1_BIT;
            a.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
            a.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
            a.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
            a.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
        }
        attachments[0].format = kind.colour;
        attachments[0].initialLayout = attachments[0].finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        attachments[1].format = kind.depth;
        attachments[1].initialLayout = attachments[1].finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
        const VkAttachmentReference first{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
            second{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
        VkSubpassDescription subpass{};
        subpass.colorAttachmentCount = 1;
        subpass.pColorAttachments = &first;
        subpass.pDepthStencilAttachment = &second;
        VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
        info.attachmentCount = 2;
        info.pAttachments = attachments;
        info.subpassCount = 1;
        info.pSubpasses = &subpass;
        REQUIRE(call<PFN_vkCreateRenderPass>("vkCreateRenderPass")(device.handle(), &info, nullptr, &renderPass) == 0);
        const VkImageView views[2] = {colour.view(), depth.view()};
        VkFramebufferCreateInfo frame{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
        frame.renderPass = renderPass;
        frame.attachmentCount = 2;
        frame.pAttachments = views;
        frame.width = kWidth;
        frame.height = kHeight;
        frame.layers = 1;
        REQUIRE(call<PFN_vkCreateFramebuffer>("vkCreateFramebuffer")(device.handle(), &frame, nullptr, &framebuffer) ==
                0);
    }

    VkClearValue clearColour() const {
        VkClearValue value{};
        value.color = {{.2f, .3f, .5f, 1}};
        return value;
    }
    VkClearValue clearDepth() const {
        VkClearValue value{};
        value.depthStencil = {kind.reversed ? 0.0f : 1.0f, 0};
        return value;
    }

    void begin(Commands& commands) {
        for (Image* image : {&colour, &flatColour})
            if (*image) commands.transition(*image, ImageState::colorTarget, true);
        for (Image* image : {&depth, &flatDepth})
            if (*image) commands.transition(*image, ImageState::depthTarget, true);
        const VkRect2D all{{0, 0}, {kWidth, kHeight}};
        if (renderPass) {
            const VkClearValue values[2] = {clearColour(), clearDepth()};
            VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
            info.renderPass = renderPass;
            info.framebuffer = framebuffer;
            info.renderArea = all;
            info.clearValueCount = 2;
            info.pClearValues = values;
            return call<PFN_vkCmdBeginRenderPass>("vkCmdBeginRenderPass")(commands.handle(), &info,
                                                                          VK_SUBPASS_CONTENTS_INLINE);
        }
        const auto attach = [](const Image& image, const Image& flat, VkImageLayout layout, VkResolveModeFlagBits mode,
                               VkClearValue clear) {
            VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
            info.imageView = image.view();
            info.imageLayout = info.resolveImageLayout = layout;
            info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
            info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
            info.clearValue = clear;
            if (!flat) return info;
            info.resolveMode = mode;
            info.resolveImageView = flat.view();
            return info;
        };
        VkRenderingAttachmentInfo first{};
        if (colour)
            first = attach(colour, flatColour, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_RESOLVE_MODE_AVERAGE_BIT,
                           clearColour());
        const VkRenderingAttachmentInfo second =
            attach(depth, flatDepth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT,
                   clearDepth());
        VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
        info.renderArea = all;
        info.layerCount = 1;
        info.colorAttachmentCount = colour ? 1 : 0;
        info.pColorAttachments = &first;
        info.pDepthAttachment = &second;
        device.vk().vkCmdBeginRendering(commands.handle(), &info);
    }
    void end(Commands& commands) {
        if (renderPass)
            call<PFN_vkCmdEndRenderPass>("vkCmdEndRenderPass")(commands.handle());
        else
            device.vk().vkCmdEndRendering(commands.handle());
    }

    Picture read() {
        Picture picture;
        Image& seen = flatColour ? flatColour : colour;
        if (seen) picture.colour = coloursOf(must(readImage(device, seen)), kind.colour);
        const std::vector<std::byte> depths = must(readImage(device, flatDepth ? flatDepth : depth));
        picture.depth.resize(size_t(kWidth) * kHeight);
        std::memcpy(picture.depth.data(), depths.data(), picture.depth.size() * 4);
        return picture;
    }
};

PassHost::PassHost() {
    DeviceOptions options;
    options.validation = true;
    device_ = must(Device::create(options));
}

PassHost::~PassHost() {
    for (const std::string& text : device_->validationTexts()) MESSAGE(text);
    CHECK(device_->validationMessages() == 0);
}

EspHostDevice PassHost::device() const {
    return hostDeviceOf(*device_);
}

uint32_t PassHost::sampleCounts() const {
    VkPhysicalDeviceProperties properties{};
    reinterpret_cast<PFN_vkGetPhysicalDeviceProperties>(device_->getInstanceProcAddr()(
        device_->instance(), "vkGetPhysicalDeviceProperties"))(device_->physicalDevice(), &properties);
    return properties.limits.framebufferColorSampleCounts & properties.limits.framebufferDepthSampleCounts;
}

PassHost::Picture PassHost::draw(const Kind& kind, const View& view, const std::vector<Box>& boxes, EspContext* context,
                                 bool surfaces) {
    Pass pass(*device_, kind);
    GraphicsDesc desc;
    desc.name = "host's box";
    desc.vertex = "tests/box.vert";
    if (pass.colour) {
        desc.fragment = "tests/triangle.frag";
        desc.colors = {kind.colour};
    }
    desc.depth = kind.depth;
    desc.samples = kind.samples;
    desc.depthCompare = kind.reversed ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS;
    desc.renderPass = pass.renderPass;
    const Program box = must(Program::graphics(*device_, desc));
    const VkViewport viewport =
        view.upwards ? VkViewport{0, kHeight, kWidth, -float(kHeight), 0, 1} : VkViewport{0, 0, kWidth, kHeight, 0, 1};

    Commands commands = must(Commands::begin(*device_, "host's frame"));
    if (context) {
        EspPassFormat format = esp::defaults<EspPassFormat>();
        const uint32_t colour = uint32_t(kind.colour);
        format.colourFormats = &colour;
        format.colourCount = pass.colour ? 1 : 0;
        format.depthFormat = uint32_t(kind.depth);
        format.samples = kind.samples;
        format.depthReversed = kind.reversed;
        format.output = kind.output;
        format.renderPass = pass.renderPass;
        EspPassDef def = esp::defaults<EspPassDef>();
        def.format = &format;
        const float numbers[4] = {viewport.x, viewport.y, viewport.width, viewport.height};
        std::memcpy(def.viewport, numbers, sizeof numbers);
        std::memcpy(def.view, glm::value_ptr(view.view), sizeof def.view);
        std::memcpy(def.projection, glm::value_ptr(view.projection), sizeof def.projection);
        EspLook look = esp::defaults<EspLook>();
        look.exposure = kind.exposure;
        def.look = &look;
        def.surfaces = surfaces;
        def.commandBuffer = commands.handle();
        def.frame = ++frame_;
        def.framesDone = frame_ - 1;
        REQUIRE_MESSAGE(espPrepare(context, &def) == ESP_OK, espLastError(context));
    }
    pass.begin(commands);
    {
        DrawPass drawn(commands, "host", viewport);
        for (const Box& b : boxes) drawn.draw(box, 36, 1, BoxPush{view.projection * view.view, b.low, b.high, b.tint});
    }
    if (context) REQUIRE_MESSAGE(espRecord(context, commands.handle()) == ESP_OK, espLastError(context));
    pass.end(commands);
    REQUIRE(commands.finish());
    if (context) REQUIRE(espFramesDone(context, frame_) == ESP_OK);
    return pass.read();
}

}  // namespace espalier
