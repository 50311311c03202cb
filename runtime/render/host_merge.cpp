// Enters: a host's picture and depth. Leaves: both with growth in them. Depths are compared as ours, which the host's
// are turned into first; what growth hasn't touched isn't written, so that a host's pixels stay as they are to the bit.
#include "runtime/render/host_merge.hpp"

#include "runtime/render/host_formats.hpp"
#include "runtime/render/shading.hpp"

namespace espalier {
namespace {

constexpr VkFormat kNearFormat = VK_FORMAT_R32_SFLOAT;

DrawTargets onto(const Image& image) {
    DrawTargets targets;
    targets.extent = image.extent();
    if (isDepthFormat(image.format()))
        targets.depth = DepthTarget{.view = image.view(), .clear = {}};
    else
        targets.colors.push_back({.view = image.view(), .clear = {}});
    return targets;
}

}  // namespace

Result<std::unique_ptr<HostMerge>> HostMerge::create(Device& device, uint32_t samples) {
    std::unique_ptr<HostMerge> merge(new HostMerge(device));
    GraphicsDesc near = fullscreen("render/host_near.frag");
    near.colors = {kNearFormat};
    GraphicsDesc begin = fullscreen("render/host_begin.frag");
    begin.colors = {kSceneFormat};
    begin.depth = kDepthFormat;
    begin.samples = samples;
    GraphicsDesc grown = fullscreen(samples == 1 ? "render/host_grown_single.frag" : "render/host_grown.frag");
    grown.colors = {kNearFormat};
    const struct {
        Program& program;
        const GraphicsDesc& desc;
    } rows[] = {{merge->near_, near}, {merge->begin_, begin}, {merge->grown_, grown}};
    for (const auto& row : rows) {
        if (Status made = assign(row.program, Program::graphics(device, row.desc)); !made) return made.failure();
    }
    Result<Sampler> sampler = Sampler::create(device, {.name = "host's picture",
                                                       .filter = VK_FILTER_NEAREST,
                                                       .address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                                       .mips = false});
    if (!sampler) return sampler.failure();
    merge->sampler_ = std::move(*sampler);
    merge->push_.reach = samples == 1 ? 1 : 0;
    return merge;
}

Status HostMerge::makeImages(uint32_t width, uint32_t height) {
    if (grownNear_ && grownNear_.extent().width == width && grownNear_.extent().height == height) return Done{};
    for (Image* image : {&hostNear_, &grownNear_}) {
        ImageDesc desc{.name = "host's depth", .format = kNearFormat, .width = width, .height = height};
        desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
        if (Status made = assign(*image, Image::create(device_, desc)); !made) return made.failure();
    }
    return Done{};
}

Result<const Program*> HostMerge::output(const char* fragment, VkFormat color, VkFormat depth) {
    Program& program = outputs_[{color, depth}];
    if (program) return &program;
    GraphicsDesc desc = fullscreen(fragment);
    if (color != VK_FORMAT_UNDEFINED) desc.colors = {color};
    desc.depth = depth;
    if (Status made = assign(program, Program::graphics(device_, desc)); !made) return made.failure();
    return &program;
}

Status HostMerge::begin(Commands& commands, const DrawTarget& target, Targets& targets, const Buffer& frame,
                        float nearPlane) {
    if (Status s = makeImages(target.width, target.height); !s) return s;
    ImageDesc desc{.name = "host's picture", .format = target.format, .width = target.width, .height = target.height};
    Result<Image> color = Image::wrap(device_, desc, target.image);
    desc.name = "host's depth";
    desc.format = target.host.depthFormat;
    Result<Image> depth = Image::wrap(device_, desc, target.host.depth);
    if (!color || !depth) return color ? depth.failure() : color.failure();
    hostColor_ = std::move(*color);
    hostDepth_ = std::move(*depth);
    hostColor_.state = ImageState::colorTarget;
    hostDepth_.state = ImageState::depthTarget;
    push_.atInfinity = target.host.atInfinity;
    push_.perNearness = target.host.perNearness;
    push_.nearPlane = nearPlane;
    push_.encoded = takesLinear(target.format) ? 0 : 1;

    commands.transition(hostColor_, ImageState::sampled);
    commands.transition(hostDepth_, ImageState::sampled);
    commands.transition(hostNear_, ImageState::colorTarget, true);
    {
        DrawPass pass(commands, "draw host", onto(hostNear_));
        pass.draw(near_, 3, 1, push_, {{hostDepth_, sampler_}});
    }
    commands.transition(hostNear_, ImageState::sampled);
    commands.transition(targets.color, ImageState::colorTarget, true);
    commands.transition(targets.depth, ImageState::depthTarget, true);
    DrawTargets scene = onto(targets.color);
    scene.depth = onto(targets.depth).depth;
    DrawPass pass(commands, "draw host", scene);
    pass.draw(begin_, 3, 1, push_, {{hostColor_, sampler_}, {hostNear_, sampler_}, frame});
    return Done{};
}

Status HostMerge::end(Commands& commands, Targets& targets) {
    Result<const Program*> intoColor = output("render/host_color.frag", hostColor_.format(), VK_FORMAT_UNDEFINED);
    if (!intoColor) return intoColor.failure();
    Result<const Program*> intoDepth = output("render/host_depth.frag", VK_FORMAT_UNDEFINED, hostDepth_.format());
    if (!intoDepth) return intoDepth.failure();
    commands.transition(targets.own, ImageState::sampled);
    commands.transition(grownNear_, ImageState::colorTarget, true);
    {
        DrawPass pass(commands, "draw host", onto(grownNear_));
        pass.draw(grown_, 3, 1, {}, {{targets.depth, sampler_}, {hostNear_, sampler_}});
    }
    commands.transition(grownNear_, ImageState::sampled);
    commands.transition(hostColor_, ImageState::colorTarget);
    commands.transition(hostDepth_, ImageState::depthTarget);
    {
        DrawPass pass(commands, "draw host", onto(hostColor_));
        pass.draw(**intoColor, 3, 1, push_, {{targets.own, sampler_}, {grownNear_, sampler_}});
    }
    DrawPass pass(commands, "draw host", onto(hostDepth_));
    pass.draw(**intoDepth, 3, 1, push_, {{grownNear_, sampler_}});
    return Done{};
}

}  // namespace espalier
