// Enters: growth's records, surfaces, camera, look. Leaves: a picture. A frame is: shadow map if something that casts
// shadows has changed, cull, scene (in four samples, on a CPU in one), ambient occlusion at half size,
// samples or smoothed edges to pixels.
#include "runtime/render/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/core/check.hpp"
#include "runtime/render/frame.hpp"
#include "runtime/render/models.hpp"
#include "runtime/render/targets.hpp"

namespace espalier {
namespace {

constexpr uint32_t kFrameSlots = 8;  // frame records that recordings in flight may still read
constexpr float kShadowLodPixels = 1.2f;

GraphicsDesc fullscreen(const char* name, const char* fragment, VkFormat format) {
    GraphicsDesc desc;
    desc.name = name;
    desc.vertex = "render/fullscreen.vert";
    desc.fragment = fragment;
    desc.colors = {format};
    desc.depthTest = desc.depthWrite = false;
    return desc;
}

DrawTargets onto(VkExtent2D extent, VkImageView view) {
    DrawTargets targets;
    targets.extent = extent;
    targets.colors.emplace_back();
    targets.colors[0].view = view;
    return targets;
}

// Metres, unless the models are far too small or too large for that: then their longest side counts as six.
float lengthUnit(glm::vec3 size) {
    const float side = std::max({size.x, size.y, size.z});
    return side > 1.0f && side < 200.0f ? 1.0f : std::max(side, 1e-6f) / 6;
}

class RendererImpl final : public Renderer {
  public:
    explicit RendererImpl(Device& device) : device_(device) {}

    Status setUp(TerminalData data);
    Status setSurface(uint32_t index, const SurfaceData& data, const glm::mat4& toWorld) override {
        return models_.set(device_, index, data, toWorld);
    }
    void removeSurface(uint32_t index) override { models_.remove(index); }
    Result<std::vector<RoofMesh>> loadRoofMeshes(TerminalData meshes) override;
    Status draw(Commands& commands, const DrawInputs& inputs, const DrawTarget& target) override;
    Result<std::vector<uint8_t>> readPixels() override;
    RenderStats stats() const override;
    Result<EmittedTriangles> materialise(const EmitInputs& inputs) override { return emit_.materialise(inputs); }

  private:
    struct ShadowKey {
        uint64_t growth = 0, models = 0;
        glm::vec3 sun{0};
        uint32_t nodes = 0, leaves = 0;
        uint64_t roofs = 0;
        glm::vec4 sphere{0};
        bool operator==(const ShadowKey&) const = default;
    };

    Status makePrograms();
    Result<const Program*> resolveProgram(VkFormat format);
    // Uploads the record and returns its address.
    Result<uint64_t> upload(Commands& commands, const FrameRecord& frame);
    Status drawShadows(Commands& commands, const DrawInputs& inputs, const SunView& sun, float lodPixels);
    void drawModels(Commands& commands, const DrawInputs& inputs, const PostPush& post);
    Status cullGrowth(Commands& commands, const DrawInputs& inputs, const FrameRecord& frame);
    void drawGrowth(Commands& commands, const PostPush& post);
    void drawTerminals(DrawPass& pass, uint64_t frame, bool depthOnly);
    void drawOcclusion(Commands& commands, const PostPush& push);
    Status resolve(Commands& commands, const DrawTarget& target, PostPush push);

    Device& device_;
    Terminals terminals_;
    Emit emit_;
    std::unique_ptr<RoofDraw> roofs_;
    Models models_;
    Ground ground_;
    Targets targets_;
    Image shadowMap_;
    Sampler shadowSampler_, textureSampler_, plainSampler_, pointSampler_;
    Program model_, bark_, leaf_, modelDepth_, barkDepth_, leafDepth_, leafCutDepth_, distance_, occlusion_, sky_,
        depthTiles_;
    std::map<VkFormat, Program> resolves_;
    Buffer frames_, tiles_;
    uint32_t frameSlot_ = 0;
    ShadowKey shadowKey_;
    bool grows_ = false, roofed_ = false, shadowDrawn_ = false;
};

Status RendererImpl::makePrograms() {
    const bool one = targets_.samples == 1;
    auto graphics = [&](Program& program, const char* name, const char* vertex, const char* fragment,
                        bool shadow) -> Status {
        GraphicsDesc desc;
        desc.name = name;
        desc.vertex = vertex;
        desc.fragment = fragment;
        desc.depth = kDepthFormat;
        if (shadow) {
            desc.depthBiasConstant = 2;
            desc.depthBiasSlope = 1.8f;
        } else {
            desc.colors = {kSceneFormat};
            desc.samples = targets_.samples;
            desc.depthCompare = VK_COMPARE_OP_GREATER_OR_EQUAL;
        }
        Result<Program> made = Program::graphics(device_, desc);
        if (!made) return made.failure();
        program = std::move(*made);
        return Done{};
    };
    GraphicsDesc skyDesc = fullscreen("sky", "render/sky.frag", kSceneFormat);
    skyDesc.samples = targets_.samples;
    skyDesc.depth = kDepthFormat;  // it lies at depth 0, infinitely far
    skyDesc.depthTest = true;
    skyDesc.depthCompare = VK_COMPARE_OP_GREATER_OR_EQUAL;
    Result<Program> sky = Program::graphics(device_, skyDesc);
    if (!sky) return sky.failure();
    sky_ = std::move(*sky);
    Result<Program> depthTiles = Program::compute(device_, one ? "render/tiles_single.comp" : "render/tiles.comp");
    if (!depthTiles) return depthTiles.failure();
    depthTiles_ = std::move(*depthTiles);
    auto post = [&](Program& program, const char* name, const char* fragment, VkFormat format) -> Status {
        Result<Program> made = Program::graphics(device_, fullscreen(name, fragment, format));
        if (!made) return made.failure();
        program = std::move(*made);
        return Done{};
    };
    const Status all[] = {
        graphics(model_, "model", "render/model.vert", "render/model.frag", false),
        graphics(bark_, "bark", "render/bark.vert", one ? "render/bark_single.frag" : "render/bark.frag", false),
        graphics(leaf_, "leaf", "render/leaf.vert", one ? "render/leaf_single.frag" : "render/leaf.frag", false),
        graphics(modelDepth_, "model shadow", "render/model.vert", "", true),
        graphics(barkDepth_, "bark shadow", "render/bark.vert", "", true),
        graphics(leafDepth_, "leaf shadow", "render/leaf.vert", "", true),
        graphics(leafCutDepth_, "cut leaf shadow", "render/leaf.vert", "render/leaf_shadow.frag", true),
        post(distance_, "distance", one ? "render/depth_single.frag" : "render/depth.frag", kDistanceFormat),
        post(occlusion_, "occlusion", "render/occlusion.frag", kOpenFormat)};
    for (const Status& s : all)
        if (!s) return s;
    return Done{};
}

Result<const Program*> RendererImpl::resolveProgram(VkFormat format) {
    if (auto it = resolves_.find(format); it != resolves_.end()) return &it->second;
    const char* fragment = targets_.samples == 1 ? "render/resolve_single.frag" : "render/resolve.frag";
    Result<Program> made = Program::graphics(device_, fullscreen("resolve", fragment, format));
    if (!made) return made.failure();
    return &(resolves_[format] = std::move(*made));
}

Status RendererImpl::setUp(TerminalData data) {
    // Four samples make a frame three times as dear on a CPU; there edges are smoothed when all is drawn.
    targets_.samples = device_.info().cpu ? 1 : 4;
    Result<Terminals> terminals = Terminals::create(device_, std::move(data));
    if (!terminals) return terminals.failure();
    terminals_ = std::move(*terminals);
    Result<Emit> emit = Emit::create(device_, terminals_);
    if (!emit) return emit.failure();
    emit_ = std::move(*emit);
    Result<Models> models = Models::create(device_);
    if (!models) return models.failure();
    models_ = std::move(*models);
    Result<Ground> ground = Ground::create(device_, kSceneFormat, kDepthFormat, targets_.samples);
    if (!ground) return ground.failure();
    ground_ = std::move(*ground);
    ImageDesc shadow{.name = "shadow map", .format = kDepthFormat, .width = kShadowSize, .height = kShadowSize};
    shadow.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    Result<Image> map = Image::create(device_, shadow);
    if (!map) return map.failure();
    shadowMap_ = std::move(*map);
    const float anisotropy = device_.info().cpu ? 1.0f : 8.0f;
    const struct {
        Sampler& sampler;
        SamplerDesc desc;
    } samplers[] = {
        {shadowSampler_,
         {.name = "shadow map",
          .address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
          .mips = false,
          .shadowCompare = true}},
        {textureSampler_, {.name = "terminal textures", .anisotropy = anisotropy}},
        {pointSampler_,
         {.name = "point",
          .filter = VK_FILTER_NEAREST,
          .address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
          .mips = false}},
        {plainSampler_, {.name = "plain", .address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, .mips = false}}};
    for (const auto& s : samplers) {
        Result<Sampler> made = Sampler::create(device_, s.desc);
        if (!made) return made.failure();
        s.sampler = std::move(*made);
    }
    Result<Buffer> frames = Buffer::create(device_, "frames", kFrameSlots * sizeof(FrameRecord));
    if (!frames) return frames.failure();
    frames_ = std::move(*frames);
    return makePrograms();
}

Result<std::vector<RoofMesh>> RendererImpl::loadRoofMeshes(TerminalData meshes) {
    auto made = RoofDraw::create(device_, std::move(meshes), kSceneFormat, kDepthFormat, targets_.samples);
    if (!made) return made.failure();
    roofs_ = std::move(*made);
    return roofs_->bounds();
}

Result<uint64_t> RendererImpl::upload(Commands& commands, const FrameRecord& frame) {
    const uint64_t offset = frameSlot_++ % kFrameSlots * sizeof(FrameRecord);
    commands.barrier(Use::vertex | Use::fragment, Use::transfer);
    if (Status s = commands.upload(frames_, std::as_bytes(std::span(&frame, 1)), offset); !s) return s.failure();
    commands.barrier(Use::transfer, Use::vertex | Use::fragment);
    return frames_.address() + offset;
}

void RendererImpl::drawTerminals(DrawPass& pass, uint64_t frame, bool depthOnly) {
    const EmitTable& table = terminals_.table();
    pass.setIndices(terminals_.batches());
    for (uint32_t b = 0; b < table.bucketCount; ++b) {
        const BucketRecord& bucket = table.buckets[b];
        const TerminalMaterial& material = terminals_.data().materials[bucket.material];
        TerminalPush push{};
        push.frame.v = reinterpret_cast<FrameRecord*>(frame);
        push.state.v = reinterpret_cast<EmitState*>(emit_.state().address());
        push.spans.v = reinterpret_cast<SpanInstance*>(emit_.spanInstances().address());
        push.leaves.v = reinterpret_cast<LeafInstance*>(emit_.leafInstances().address());
        push.vertices.v = reinterpret_cast<TerminalVertex*>(terminals_.vertices().address());
        push.bucket = b;
        push.firstVertex = bucket.firstVertex;
        push.vertexCount = bucket.vertexCount;
        push.batch = bucket.batch;
        push.baseColor = material.baseColor;
        push.roughness = material.roughness;
        push.alphaCutoff = material.alphaCutoff;
        const uint64_t offset = offsetof(EmitState, draws) + 2ull * b * sizeof(DrawCommand);
        const Binding color{terminals_.baseColor(bucket.material), textureSampler_};
        const Binding normal{terminals_.normalMap(bucket.material), textureSampler_};
        const Binding shadow{shadowMap_, shadowSampler_};
        const bool bark = b < table.barkBuckets;
        if (!depthOnly && bark)
            pass.drawIndexedIndirect(bark_, emit_.state(), offset, 2, push, {color, shadow});
        else if (!depthOnly)
            pass.drawIndexedIndirect(leaf_, emit_.state(), offset, 2, push, {color, normal, shadow});
        else if (bark)
            pass.drawIndexedIndirect(barkDepth_, emit_.state(), offset, 2, push);
        else if (material.alphaCutoff > 0)
            pass.drawIndexedIndirect(leafCutDepth_, emit_.state(), offset, 2, push, {color});
        else
            pass.drawIndexedIndirect(leafDepth_, emit_.state(), offset, 2, push);
    }
}

Status RendererImpl::drawShadows(Commands& commands, const DrawInputs& inputs, const SunView& sun, float lodPixels) {
    FrameRecord frame = makeFrame(inputs, kShadowSize, kShadowSize);
    frame.viewProjection = sun.toClip;
    Result<uint64_t> address = upload(commands, frame);
    if (!address) return address.failure();
    if (grows_) {
        EmitView view = parallelView(sun.toClip, kShadowSize / sun.width, lodPixels);
        view.leastPixels = 0.35f;
        if (Status s = emit_.cull(commands, {inputs.growth, inputs.surfaces}, view, "shadow emit", false); !s) return s;
    }
    if (roofed_) {
        const EmitView view = parallelView(sun.toClip, kShadowSize / sun.width, lodPixels);
        if (Status s = roofs_->cull(commands, *inputs.roofs, view, true, "shadow emit"); !s) return s;
    }
    commands.transition(shadowMap_, ImageState::depthTarget, true);
    {
        DrawTargets targets;
        targets.extent = {kShadowSize, kShadowSize};
        targets.depth = DepthTarget{.view = shadowMap_.view(), .clear = 1.0f};
        DrawPass pass(commands, "shadow draw", targets);
        models_.drawDepth(pass, modelDepth_, *address);
        if (grows_) drawTerminals(pass, *address, true);
        if (roofed_) roofs_->draw(pass, *address, nullptr, nullptr);
    }
    commands.transition(shadowMap_, ImageState::sampled);
    return Done{};
}

void RendererImpl::drawModels(Commands& commands, const DrawInputs& inputs, const PostPush& post) {
    commands.transition(targets_.color, ImageState::colorTarget, true);
    commands.transition(targets_.depth, ImageState::depthTarget, true);
    DrawTargets targets = onto({targets_.width, targets_.height}, targets_.color.view());
    targets.colors[0].clear = std::array<float, 4>{0, 0, 0, 0};
    targets.depth = DepthTarget{.view = targets_.depth.view(), .clear = 0.0f};
    DrawPass pass(commands, "draw scene", targets);
    models_.draw(pass, model_, reinterpret_cast<uint64_t>(post.frame.v), shadowMap_, shadowSampler_,
                 inputs.surfaces.v != nullptr);
    if (post.ground != 0) ground_.draw(pass, post, shadowMap_, shadowSampler_);
}

Status RendererImpl::cullGrowth(Commands& commands, const DrawInputs& inputs, const FrameRecord& frame) {
    const uint32_t tiles =
        ((targets_.width + kDepthTile - 1) / kDepthTile) * ((targets_.height + kDepthTile - 1) / kDepthTile);
    if (!tiles_ || tiles_.size() < tiles * sizeof(float)) {
        Result<Buffer> made = Buffer::create(device_, "depth tiles", tiles * sizeof(float));
        if (!made) return made.failure();
        tiles_ = std::move(*made);
    }
    TilesPush push{};
    push.tiles.v = reinterpret_cast<float*>(tiles_.address());
    commands.transition(targets_.depth, ImageState::sampled);
    {
        Pass pass(commands, "emit");
        pass.dispatchItems(depthTiles_, tiles, push, {{targets_.depth, pointSampler_}});
        pass.barrier(Use::compute, Use::compute);
    }
    EmitView view = perspectiveView(frame.viewProjection, frame.eye, frame.pixelScale, inputs.look.lodPixels);
    view.viewProjection = frame.viewProjection;
    view.tiles = push.tiles;
    view.width = targets_.width;
    view.height = targets_.height;
    if (roofed_)
        if (Status s = roofs_->cull(commands, *inputs.roofs, view, false, "emit"); !s) return s;
    if (!grows_) return Done{};
    return emit_.cull(commands, {inputs.growth, inputs.surfaces}, view, "emit", true);
}

void RendererImpl::drawGrowth(Commands& commands, const PostPush& post) {
    commands.transition(targets_.color, ImageState::colorTarget);
    commands.transition(targets_.depth, ImageState::depthTarget);
    DrawTargets targets = onto({targets_.width, targets_.height}, targets_.color.view());
    targets.depth = DepthTarget{};
    targets.depth->view = targets_.depth.view();
    DrawPass pass(commands, "draw scene", targets);
    if (grows_) drawTerminals(pass, reinterpret_cast<uint64_t>(post.frame.v), false);
    if (roofed_) roofs_->draw(pass, reinterpret_cast<uint64_t>(post.frame.v), &shadowMap_, &shadowSampler_);
    pass.draw(sky_, 3, 1, post, {{ground_.noise(), ground_.sampler()}});
}

void RendererImpl::drawOcclusion(Commands& commands, const PostPush& push) {
    const VkExtent2D extent = targets_.distance.extent();
    commands.transition(targets_.depth, ImageState::sampled);
    commands.transition(targets_.distance, ImageState::colorTarget, true);
    {
        DrawPass pass(commands, "draw occlusion", onto(extent, targets_.distance.view()));
        pass.draw(distance_, 3, 1, push, {{targets_.depth, pointSampler_}});
    }
    commands.transition(targets_.distance, ImageState::sampled);
    commands.transition(targets_.open, ImageState::colorTarget, true);
    {
        DrawPass pass(commands, "draw occlusion", onto(extent, targets_.open.view()));
        pass.draw(occlusion_, 3, 1, push, {{targets_.distance, pointSampler_}});
    }
    commands.transition(targets_.open, ImageState::sampled);
}

Status RendererImpl::resolve(Commands& commands, const DrawTarget& target, PostPush push) {
    const VkFormat format = target.image ? target.format : kOwnFormat;
    push.encode = format == VK_FORMAT_R8G8B8A8_SRGB || format == VK_FORMAT_B8G8R8A8_SRGB ? 0 : 1;
    Result<const Program*> program = resolveProgram(format);
    if (!program) return program.failure();
    Image host;
    VkImageView view = target.view;
    if (target.image) {
        ImageDesc desc{.name = "host picture", .format = format, .width = target.width, .height = target.height};
        desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        Result<Image> wrapped = Image::wrap(device_, desc, target.image);
        if (!wrapped) return wrapped.failure();
        host = std::move(*wrapped);
        if (!view) view = host.view();
    } else {
        if (Status s = targets_.makeOwn(device_); !s) return s;
        view = targets_.own.view();
    }
    commands.transition(target.image ? host : targets_.own, ImageState::colorTarget, true);
    DrawPass pass(commands, "draw resolve", onto({target.width, target.height}, view));
    pass.draw(**program, 3, 1, push, {{targets_.color, plainSampler_}, {targets_.open, plainSampler_}});
    return Done{};
}

Status RendererImpl::draw(Commands& commands, const DrawInputs& inputs, const DrawTarget& target) {
    require(target.width > 0 && target.height > 0 && target.width <= 16384 && target.height <= 16384,
            "a picture is 1 to 16384 pixels wide and high");
    if (Status s = targets_.resize(device_, target.width, target.height); !s) return s;
    const GrowthView& growth = inputs.growth;
    grows_ = growth.nodeCount > 0 && inputs.surfaces.v != nullptr;
    roofed_ = roofs_ && inputs.roofs && inputs.roofs->gridCount > 0;

    glm::vec3 low, high;
    models_.bounds(low, high);
    if (roofed_) {
        low = models_.empty() ? inputs.roofs->low : glm::min(low, inputs.roofs->low);
        high = models_.empty() ? inputs.roofs->high : glm::max(high, inputs.roofs->high);
    }
    float radius = std::max(glm::length(high - low) * 0.5f, 1e-3f) * 1.06f;
    glm::vec3 center = (low + high) * 0.5f;
    FrameRecord frame = makeFrame(inputs, target.width, target.height);
    // A town is larger than a map of shadows can resolve: it covers what is looked at.
    if (roofed_) {
        const float reach =
            std::exp2(std::ceil(std::log2(1.6f * glm::length(inputs.camera.target - inputs.camera.eye))));
        if (reach < radius) {
            radius = std::max(reach, 8.0f);
            center = glm::round(inputs.camera.target / (0.125f * radius)) * (0.125f * radius);
        }
    }
    const SunView sun = makeSunView(frame.sunDirection, center, radius);
    frame.shadowMatrix = sun.toTexture;
    frame.shadowTexel = 1.0f / kShadowSize;
    frame.unit = roofed_ ? 1.0f : lengthUnit(high - low);
    frame.shadowOffset = 1.2f * sun.width / kShadowSize;
    const ShadowKey key{growth.revision,          models_.revision(), frame.sunDirection,
                        growth.nodeCount,         growth.leafCount,   roofed_ ? inputs.roofs->revision : 0,
                        glm::vec4(center, radius)};
    if (frame.shadows && (!shadowDrawn_ || key != shadowKey_)) {
        if (Status s = drawShadows(commands, inputs, sun, kShadowLodPixels); !s) return s;
        shadowKey_ = key;
        shadowDrawn_ = true;
    } else if (!shadowDrawn_) {
        commands.transition(shadowMap_, ImageState::sampled, true);  // bound, though not read
    }

    Result<uint64_t> address = upload(commands, frame);
    if (!address) return address.failure();
    PostPush push{};
    push.frame.v = reinterpret_cast<FrameRecord*>(*address);
    push.rcpSize = {1.0f / float(target.width), 1.0f / float(target.height)};
    push.ground = inputs.ground.drawn ? 1 : 0;
    push.groundColor = inputs.ground.colour;
    // Some devices do a pass' work when the next one needs it: only the whole is a true time.
    Pass whole(commands, "draw");
    drawModels(commands, inputs, push);
    if (grows_ || roofed_)
        if (Status s = cullGrowth(commands, inputs, frame); !s) return s;
    drawGrowth(commands, push);
    commands.transition(targets_.color, ImageState::sampled);
    drawOcclusion(commands, push);
    return resolve(commands, target, push);
}

Result<std::vector<uint8_t>> RendererImpl::readPixels() {
    if (!targets_.own) return Failure("picture", "nothing has been drawn into the renderer's own image yet");
    Result<std::vector<std::byte>> bytes = readImage(device_, targets_.own);
    if (!bytes) return bytes.failure();
    const auto* first = reinterpret_cast<const uint8_t*>(bytes->data());
    return std::vector<uint8_t>(first, first + bytes->size());
}

RenderStats RendererImpl::stats() const {
    RenderStats stats;
    if (grows_) stats.emit = emit_.stats();
    if (roofed_) stats.roofs = roofs_->stats();
    stats.modelTriangles = models_.triangles();
    stats.emitMs = device_.milliseconds("emit");
    stats.drawMs = std::max(0.0, device_.milliseconds("draw") - stats.emitMs);
    stats.shadowMs = device_.milliseconds("shadow emit") + device_.milliseconds("shadow draw");
    return stats;
}

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::create(Device& device, TerminalData terminals) {
    auto renderer = std::make_unique<RendererImpl>(device);
    if (Status s = renderer->setUp(std::move(terminals)); !s) return s.failure();
    return std::unique_ptr<Renderer>(std::move(renderer));
}

Result<std::unique_ptr<Renderer>> Renderer::create(Device& device, const std::filesystem::path& terminals) {
    Result<TerminalData> data = readTerminals(terminals);
    if (!data) return data.failure();
    return create(device, std::move(*data));
}

}  // namespace espalier
