// Enters: growth's records, surfaces, camera, look. Leaves: a picture. A frame is: shadow map if something that casts
// shadows has changed (renderer_shadows.cpp), cull, scene (in four samples, on a CPU in one), ambient occlusion at half
// size, samples or smoothed edges to pixels.
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "runtime/core/check.hpp"
#include "runtime/render/host_formats.hpp"
#include "runtime/render/renderer.hpp"
#include "shaders/shared/random.h"

namespace espalier {
namespace {

// Errors of models with growth on them, so that bark that is seen isn't buried: pixels, and in moving pictures times
// what they allow elsewhere.
constexpr float kGrownPixels = 0.25f, kQuickGrown = 0.75f;

DrawTargets onto(VkExtent2D extent, VkImageView view) {
    DrawTargets targets;
    targets.extent = extent;
    targets.colors.emplace_back();
    targets.colors[0].view = view;
    return targets;
}

// Rows of pixels from the top that lie above all hills. Both ends of a row above the horizon are lower than what is
// between them.
uint32_t rowsAboveHills(const FrameRecord& frame, uint32_t height) {
    constexpr float kMargin = 1e-3f;
    const auto lowest = [&](uint32_t row) {
        const glm::vec3 middle = frame.rayForward - frame.rayUp * (2 * (float(row) + 0.5f) / float(height) - 1);
        return std::min(glm::normalize(middle - frame.rayRight).y, glm::normalize(middle + frame.rayRight).y);
    };
    uint32_t rows = 0;
    while (rows < height && lowest(rows) > kHighestHill + kMargin) ++rows;
    return rows;
}

}  // namespace

// Views of the walk's UV square want the mesh that has it everywhere; a layer while all moves does with less.
float allowedModelError(const Look& look, bool grows) {
    if (look.view == ViewMode::charts || (look.view == ViewMode::layer && !look.quick)) return 0;
    const float grown = look.quick ? kQuickGrown * look.lodPixels : kGrownPixels;
    return grows ? std::min(look.lodPixels, grown) : look.lodPixels;
}

Result<std::vector<RoofMesh>> Renderer::loadRoofMeshes(TerminalData meshes) {
    auto made = RoofDraw::create(device_, std::move(meshes));
    if (!made) return made.failure();
    roofs_ = std::move(*made);
    return roofs_->bounds();
}

Status Renderer::upload(Commands& commands, const FrameRecord& frame) {
    now_.frame = &frames_[frameSlot_++ % kFrameSlots];
    commands.barrier(Use::vertex | Use::fragment, Use::transfer);
    if (Status s = commands.upload(*now_.frame, std::as_bytes(std::span(&frame, 1))); !s) return s;
    commands.barrier(Use::transfer, Use::vertex | Use::fragment);
    return Done{};
}

Status Renderer::setProps(TerminalData models, std::vector<PropPlace> places) {
    Result<Props> made = Props::create(device_, std::move(models), kSceneFormat, kDepthFormat, targets_.samples);
    if (!made) return made.failure();
    if (Status s = made->place(device_, std::move(places)); !s) return s;
    props_ = std::make_unique<Props>(std::move(*made));
    ++propsRevision_;
    return Done{};
}

Status Renderer::removeProps() {
    props_.reset();
    ++propsRevision_;
    return Done{};
}

Status Renderer::loadPieces(TerminalData meshes) {
    auto made = PieceDraw::create(device_, std::move(meshes));
    if (!made) return made.failure();
    pieces_ = std::move(*made);
    return Done{};
}

Status Renderer::placePieces(std::vector<PatternPiece> pieces) {
    unprepare();
    require(pieces_ || pieces.empty(), "pieces have meshes");
    return pieces_ ? pieces_->place(std::move(pieces)) : Status(Done{});
}

Status Renderer::placeGraph(Geometry parts, std::span<const NodeBox> boxes) {
    unprepare();
    if (!graph_ && parts.empty()) return Done{};
    if (!graph_)
        if (Status made = assign(graph_, GraphDraw::create(device_)); !made) return made;
    return graph_->place(std::move(parts), boxes);
}

Models::Drawn Renderer::modelsDrawn() const {
    return {{&now_.scene->model, &now_.scene->modelFoot},
            {&now_.scene->modelMapped, &now_.scene->modelMappedFoot},
            *now_.frame,
            {shadowMap_, shadowSampler_},
            ground_,
            now_.shading,
            now_.walkData,
            !now_.onGround,
            now_.glass,
            now_.meadowLevel,
            now_.unit};
}

// All that growth stands among. Of a moving picture a software device begins with what comes before a time stamp, in
// all threads, while one sets up the rest.
void Renderer::drawSurroundings(DrawPass& pass, const PostPush& post) {
    std::optional<Pass> part;
    const auto begin = [&](const char* name) {
        if (isQuick(now_.shading)) part.emplace(pass.commands(), name);
    };
    begin("draw models");
    models_.draw(pass, modelsDrawn());
    if (now_.furnished) {
        begin("draw props");
        props_->draw(pass, *now_.frame, {shadowMap_, shadowSampler_},
                     now_.plain ? plainOf(now_.shading) : now_.shading);
    }
    begin("draw ground");
    if (now_.ground == GroundKind::meadow)
        ground_.draw(pass, post, *now_.frame, shadowMap_, shadowSampler_, now_.shading);
    else if (now_.ground == GroundKind::studio)
        pass.draw(now_.scene->studio, 3, 1, post, {{shadowMap_, shadowSampler_}, *now_.frame});
}

// What hides growth. Where the picture is ours and shaded, that is depths only: what growth hides isn't shaded at all.
Status Renderer::drawModels(Commands& commands, const DrawInputs& inputs, const DrawTarget& target,
                            const PostPush& post) {
    now_.ahead = !now_.hosted && now_.shading != Shading::counting;
    if (now_.ahead) {
        DrawTargets depths;
        depths.extent = {targets_.width, targets_.height};
        depths.depth = DepthTarget{.view = targets_.depth.view(), .clear = 0.0f};
        commands.transition(targets_.depth, ImageState::depthTarget, true);
        DrawPass pass(commands, "draw ahead", depths);
        models_.drawAhead(pass, modelAhead_, modelAheadFading_, *now_.frame, now_.glass);
        return Done{};
    }
    DrawTargets targets = onto({targets_.width, targets_.height}, targets_.color.view());
    targets.depth = DepthTarget{.view = targets_.depth.view(), .clear = {}};
    if (now_.hosted) {
        const float nearPlane = std::max(inputs.camera.nearPlane, kLeastNearPlane);
        if (Status s = merge_->begin(commands, target, targets_, *now_.frame, nearPlane); !s) return s;
    } else {
        targets.colors[0].clear = std::array<float, 4>{0, 0, 0, 0};
        targets.depth->clear = 0.0f;
    }
    commands.transition(targets_.color, ImageState::colorTarget, !now_.hosted);
    commands.transition(targets_.depth, ImageState::depthTarget, !now_.hosted);
    DrawPass pass(commands, "draw scene", targets);
    if (!now_.hosted || target.host.models) drawSurroundings(pass, post);
    return Done{};
}

EmitInputs Renderer::emitInputs(const DrawInputs& inputs) const {
    EmitInputs given{inputs.growth, inputs.surfaces, inputs.placed};
    if (const auto box = models_.carrierBounds(inputs.placed)) {
        given.low = (*box)[0];
        given.high = (*box)[1];
    }
    return given;
}

// Of what hides growth: another one where tiles may say something else. A host's scene or a level that fades hides
// something else in each frame.
uint64_t Renderer::sceneOf(const DrawInputs& inputs) {
    ++sceneNumber_;
    if (now_.hosted || models_.fading() > 0) return sceneNumber_ << 32;
    const Look& look = inputs.look;
    const uint64_t ground =
        inputs.ground.kind != GroundKind::none ? std::bit_cast<uint32_t>(inputs.ground.height) : 1ull << 32;
    return combineKeys(mix64(standing()), ground + (uint64_t(look.view) << 40) + (uint64_t(look.quick) << 33));
}

Status Renderer::cullGrowth(Commands& commands, const DrawInputs& inputs, const FrameRecord& frame) {
    EmitView view = perspectiveView(frame.viewProjection, frame.eye, frame.pixelScale, inputs.look.lodPixels);
    view.viewProjection = frame.viewProjection;
    view.width = targets_.width;
    view.height = targets_.height;
    view.tilePixels = kDepthTile;
    const uint64_t models = now_.hosted ? 0 : models_.revision();
    if (Status s = depthTiles_.find(commands, targets_.depth, pointSampler_, models, view); !s) return s;
    if (inputs.look.quick && device_.info().traits.quickPictures) view.flags |= kStretches;
    if (isQuick(now_.shading) && !now_.hosted) depthTiles_.lookBack(device_, models, view);
    return cullGrowth(commands, inputs, view);
}

Status Renderer::cullGrowth(Commands& commands, const DrawInputs& inputs, EmitView view) {
    thinOut(view, inputs.look.leafPixels);
    if (view.tiles.v != nullptr) view.scene = sceneOf(inputs);
    if (now_.roofed)
        if (Status s = roofs_->cull(commands, *inputs.roofs, view, false, "emit"); !s) return s;
    if (!now_.grows) return Done{};
    return emit_.cull(commands, emitInputs(inputs), view, "emit", true);
}

void Renderer::aimStudio(const DrawInputs& inputs, FrameRecord& frame) const {
    constexpr float kReach = 3.2f;  // of the floor, in half the size of what stands on it
    glm::vec3 low, high;
    models_.bounds(low, high);
    if (now_.roofed) {
        low = models_.empty() ? inputs.roofs->low : glm::min(low, inputs.roofs->low);
        high = models_.empty() ? inputs.roofs->high : glm::max(high, inputs.roofs->high);
    }
    frame.studioAt = 0.5f * glm::vec2(low.x + high.x, low.z + high.z);
    frame.studioRadius = kReach * std::max(0.5f * glm::length(high - low), 1e-3f);
}

// Hills only where they may be: software devices look for them at each pixel.
void Renderer::drawSky(DrawPass& pass, const FrameRecord& frame, const PostPush& post) {
    const uint32_t width = targets_.width, height = targets_.height;
    const uint32_t above = now_.ground == GroundKind::meadow ? rowsAboveHills(frame, height) : height;
    for (const bool hills : {false, true}) {
        const uint32_t first = hills ? above : 0, end = hills ? height : above;
        if (first == end) continue;
        pass.setScissor(0, int32_t(first), width, end - first);
        pass.draw(sky_[hills], 3, 1, post, {ground_.noiseBinding(true), ground_.skylineBinding(), *now_.frame});
    }
    pass.setScissor(0, 0, width, height);
}

void Renderer::drawGrowth(Commands& commands, const FrameRecord& frame, const PostPush& post) {
    commands.transition(targets_.color, ImageState::colorTarget, now_.ahead);
    commands.transition(targets_.depth, ImageState::depthTarget);
    DrawTargets targets = onto({targets_.width, targets_.height}, targets_.color.view());
    targets.depth = DepthTarget{};
    targets.depth->view = targets_.depth.view();
    if (now_.ahead) targets.colors[0].clear = std::array<float, 4>{0, 0, 0, 0};
    DrawPass pass(commands, "draw scene", targets);
    const Binding shadow{shadowMap_, shadowSampler_};
    if (now_.grows) drawTerminals(pass, false);
    if (now_.roofed) {
        std::optional<Pass> part;
        if (isQuick(now_.shading)) part.emplace(commands, "draw roofs");
        roofs_->draw(pass, *now_.frame, now_.scene->roof, &shadow);
    }
    if (now_.patterned) {
        std::optional<Pass> part;
        if (isQuick(now_.shading)) part.emplace(commands, "draw patterns");
        pieces_->draw(pass, *now_.frame, now_.scene->piece, &shadow);
    }
    if (now_.graphed) {
        std::optional<Pass> part;
        if (isQuick(now_.shading)) part.emplace(commands, "draw graph");
        graph_->draw(pass, *now_.frame, now_.scene->graph, &shadow);
    }
    if (now_.ahead) drawSurroundings(pass, post);
    if (!now_.hosted) drawSky(pass, frame, post);
    if (now_.grows) drawFaint(pass);
    if (now_.glass) {
        std::optional<Pass> part;
        if (isQuick(now_.shading)) part.emplace(commands, "draw glass");
        models_.drawGlass(pass, modelsDrawn(), {now_.scene->tint, now_.scene->glass}, frame.rayForward);
    }
}

void Renderer::drawOcclusion(Commands& commands, const PostPush& push) {
    const VkExtent2D extent = targets_.distance.extent();
    commands.transition(targets_.depth, ImageState::sampled);
    commands.transition(targets_.distance, ImageState::colorTarget, true);
    {
        DrawPass pass(commands, "draw occlusion", onto(extent, targets_.distance.view()));
        pass.draw(distance_, 3, 1, push, {{targets_.depth, pointSampler_}, *now_.frame});
    }
    commands.transition(targets_.distance, ImageState::sampled);
    commands.transition(targets_.open, ImageState::colorTarget, true);
    {
        DrawPass pass(commands, "draw occlusion", onto(extent, targets_.open.view()));
        pass.draw(occlusion_, 3, 1, push, {{targets_.distance, pointSampler_}, *now_.frame});
    }
    commands.transition(targets_.open, ImageState::sampled);
}

Status Renderer::resolve(Commands& commands, const DrawTarget& target, PostPush push) {
    const bool intoOwn = !target.image || now_.hosted;
    const VkFormat format = intoOwn ? kOwnFormat : target.format;
    push.encode = takesLinear(format) ? 0 : 1;
    Result<const Program*> program = resolveProgram(format);
    if (!program) return program.failure();
    Image host;
    VkImageView view = target.view;
    if (!intoOwn) {
        ImageDesc desc{.name = "host picture", .format = format, .width = target.width, .height = target.height};
        desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        if (Status made = assign(host, Image::wrap(device_, desc, target.image)); !made) return made.failure();
        if (!view) view = host.view();
    } else {
        if (Status s = targets_.makeOwn(device_); !s) return s;
        view = targets_.own.view();
    }
    commands.transition(intoOwn ? targets_.own : host, ImageState::colorTarget, true);
    {
        DrawPass pass(commands, "draw resolve", onto({target.width, target.height}, view));
        pass.draw(**program, 3, 1, push,
                  {{targets_.color, plainSampler_}, {targets_.open, plainSampler_}, *now_.frame});
    }
    return now_.hosted ? merge_->end(commands, targets_) : Status(Done{});
}

Status Renderer::draw(Commands& commands, const DrawInputs& inputs, const DrawTarget& target) {
    Status drawn = drawFrame(commands, inputs, target);
    if (!drawn) forget();
    return drawn;
}

// Nor are images where the recording would have left them.
void Renderer::forget() {
    unprepare();
    emit_.forget();
    if (props_) props_->forget();
    if (pieces_) pieces_->forget();
    merge_.reset();
    depthTiles_.forget();
    targets_.color = Image();
    shadowMap_.state = standing_.state = ImageState::undefined;
    near_.clear();
    wide_.clear();
}

void Renderer::begin(const DrawInputs& inputs, PassFormat pass) {
    now_ = {};
    now_.pass = std::move(pass);
    now_.pass.windy = inputs.look.wind != glm::vec3(0);
    now_.grows = inputs.growth.nodeCount > 0 && inputs.surfaces.v != nullptr;
    now_.roofed = roofs_ && inputs.roofs && inputs.roofs->gridCount > 0;
    now_.patterned = pieces_ && !pieces_->empty() && inputs.look.pieces;
    now_.graphed = graph_ && !graph_->empty();
    now_.walkData = inputs.surfaces.v != nullptr;
    now_.onGround = inputs.look.view == ViewMode::charts || inputs.look.view == ViewMode::layer;
}

Status Renderer::drawFrame(Commands& commands, const DrawInputs& inputs, const DrawTarget& target) {
    require(target.width > 0 && target.height > 0 && target.width <= kMaxFrameSide && target.height <= kMaxFrameSide,
            "a picture is 1 to 16384 pixels wide and high");
    begin(inputs, scenePass(targets_.samples));
    if (Status s = targets_.resize(device_, target.width, target.height); !s) return s;
    now_.hosted = target.image && target.host.depth;
    now_.furnished = props_ && !props_->empty() && !now_.hosted;
    now_.ground = now_.hosted ? GroundKind::none : inputs.ground.kind;
    if (Status s = pickDepths(shadowPass()); !s) return s;
    if (Status s = pickScene(shownView(inputs), inputs.look.quick); !s) return s;
    if (now_.hosted && !merge_) {
        auto made = HostMerge::create(device_, targets_.samples);
        if (!made) return made.failure();
        merge_ = std::move(*made);
    }

    FrameRecord frame = makeFrame(inputs, target.width, target.height);
    if (Status s = keepShadows(commands, inputs, frame); !s) return s;
    if (now_.ground == GroundKind::studio) aimStudio(inputs, frame);
    now_.meadowLevel = now_.ground == GroundKind::meadow && inputs.ground.overgrows ? frame.groundLevel : kNoGround;
    now_.unit = frame.unit;
    ground_.describe(frame);
    if (Status s = upload(commands, frame); !s) return s;
    if (now_.furnished)
        if (Status s = props_->choose(commands, frame); !s) return s;
    if (now_.patterned)
        if (Status s = pieces_->choose(commands, frame, inputs.look.lodPixels); !s) return s;
    PostPush push{};
    push.rcpSize = {1.0f / float(target.width), 1.0f / float(target.height)};
    // Some devices do a pass' work when the next one needs it: only the whole is a true time.
    Pass whole(commands, "draw");
    // While all moves, and where that begins or ends, nobody sees one mesh replace another: two at a time would cost
    // such a picture half as much again.
    models_.choose(frame, allowedModelError(inputs.look, now_.grows), inputs.look.quick || quickBefore_);
    quickBefore_ = inputs.look.quick;
    if (Status s = drawModels(commands, inputs, target, push); !s) return s;
    if (now_.grows || now_.roofed)
        if (Status s = cullGrowth(commands, inputs, frame); !s) return s;
    if (now_.grows)
        if (Status s = lightTerminals(commands); !s) return s;
    drawGrowth(commands, frame, push);
    commands.transition(targets_.color, ImageState::sampled);
    drawOcclusion(commands, push);
    return resolve(commands, target, push);
}

Result<std::vector<uint8_t>> Renderer::readPixels() {
    if (!targets_.own) return Failure("picture", "nothing has been drawn into the renderer's own image yet");
    Result<std::vector<std::byte>> bytes = readImage(device_, targets_.own);
    if (!bytes) return bytes.failure();
    const auto* first = reinterpret_cast<const uint8_t*>(bytes->data());
    return std::vector<uint8_t>(first, first + bytes->size());
}

RenderStats Renderer::stats() const {
    RenderStats stats;
    if (now_.grows) stats.emit = emit_.stats();
    if (now_.roofed) stats.roofs = roofs_->stats();
    stats.modelTriangles = models_.triangles();
    stats.modelsFading = models_.fading();
    stats.shadowsWhole = near_.timesWhole();
    stats.shadowsPartly = near_.timesPartly();
    stats.shadowsTaken = near_.timesTaken();
    stats.shadowsBehind = now_.shadowsBehind;
    stats.emitMs = device_.milliseconds("emit");
    stats.drawMs = std::max(0.0, device_.milliseconds("draw") - stats.emitMs);
    return stats;
}

}  // namespace espalier
