// Enters: what casts shadows, the sun, what is looked at. Leaves: the map of shadows, its near half with growth and its
// wide half with all else that stands, redrawn when what it shows has changed; the frame's record says where they are.
#include <algorithm>
#include <cmath>

#include "runtime/render/renderer.hpp"

namespace espalier {
namespace {

constexpr float kShadowLodPixels = 1.2f;
constexpr float kStrokeLeafTexels = 16;                      // as Look::leafPixels, of shadows while a stroke goes on
constexpr float kStrokeError = 3;                            // times the errors that are allowed otherwise, then
constexpr uint32_t kShadowTile = 32;                         // texels along a side of what is redrawn after edits
constexpr uint32_t kShadowRows = kShadowSize / kShadowTile;  // of tiles
constexpr float kFineRadius = 24;                            // metres: a texel is 2.3 cm then
constexpr uint32_t kStrokeTiles = 8;                         // so many are redrawn at once while a stroke goes on
constexpr float kWideBias = 0.12f;  // metres that what lies far away is moved towards the sun when it is compared
constexpr float kReachSteps = 8;    // until the map reaches twice as far: nobody sees its texels grow by so little
constexpr float kShadowModelTexels = 0.5f;  // error of models' casters: less than what lookups are moved by

// Bark and leaves as the near map has them.
EmitView grownShadows(const SunView& sun, float error) {
    EmitView view = parallelView(sun.toClip, kShadowSize / sun.width, error * kShadowLodPixels);
    view.leastPixels = 0.35f;
    view.viewProjection = sun.toClip;
    view.width = view.height = kShadowSize;
    view.tilePixels = kShadowTile;
    return view;
}

// Seen from the sun, so far away that all looks the same way.
FrameRecord shadowFrame(const DrawInputs& inputs, const SunView& sun) {
    FrameRecord frame = makeFrame(inputs, kShadowSize, kShadowSize);
    frame.viewProjection = sun.toClip;
    frame.eye = 1e6f * sun.width * frame.sunDirection;
    return frame;
}

}  // namespace

Status Renderer::makeStanding() {
    if (standing_) return Done{};
    ImageDesc desc{
        .name = "shadows without growth", .format = kDepthFormat, .width = kShadowSize, .height = kShadowSize};
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    return assign(standing_, Image::create(device_, desc));
}

// error: times what is allowed otherwise.
void Renderer::drawStanding(DrawPass& pass, const SunView& sun, float error) {
    models_.drawDepth(pass, now_.depths->model, now_.depths->modelCut, *now_.frame,
                      error * kShadowModelTexels * sun.width / kShadowSize);
    if (now_.roofed) roofs_->draw(pass, *now_.frame, now_.depths->roof, nullptr);
    if (now_.furnished) props_->drawDepth(pass, *now_.frame);
    if (now_.patterned) pieces_->drawCasters(pass, *now_.frame, now_.depths->piece);
    if (now_.graphed) graph_->draw(pass, *now_.frame, now_.depths->graph, nullptr);
}

Status Renderer::drawShadows(Commands& commands, const DrawInputs& inputs, const SunView& sun) {
    near_.clear();
    const bool coarse = near_.coarse();
    if (Status s = upload(commands, shadowFrame(inputs, sun)); !s) return s;
    const float error = coarse ? kStrokeError : 1;
    EmitView grown = grownShadows(sun, error);
    if (coarse) thinOut(grown, kStrokeLeafTexels);
    if (now_.grows)
        if (Status s = emit_.cull(commands, emitInputs(inputs), grown, "shadow emit", false); !s) return s;
    const EmitView view = parallelView(sun.toClip, kShadowSize / sun.width, error * kShadowLodPixels);
    if (now_.roofed)
        if (Status s = roofs_->cull(commands, *inputs.roofs, view, true, "shadow emit"); !s) return s;
    if (now_.furnished)
        if (Status s = props_->chooseCasters(commands, sun.toClip); !s) return s;
    if (now_.patterned)
        if (Status s = pieces_->chooseCasters(commands, sun.toClip, kShadowSize / sun.width); !s) return s;
    const auto draw = [&](Image& image, bool growth) {
        commands.transition(image, ImageState::depthTarget, !growth || !wide_.drawn());  // the map's other half stays
        DrawTargets targets;
        targets.extent = {kShadowSize, kShadowSize};
        targets.depth = DepthTarget{.view = image.view(), .clear = 1.0f};
        DrawPass pass(commands, "shadow draw", targets);
        drawStanding(pass, sun, error);
        if (growth && now_.grows) drawTerminals(pass, true);
    };
    draw(shadowMap_, true);
    commands.transition(shadowMap_, ImageState::sampled);
    const bool kept = now_.grows && !coarse;
    if (kept) {
        if (Status s = makeStanding(); !s) return s;
        draw(standing_, false);
        commands.transition(standing_, ImageState::sampled);
        if (Status s = emit_.watch(commands, grown); !s) return s;
    }
    near_.drewWhole(kept, emit_.wholeBindings());
    return Done{};
}

// What reaches tiles that haven't changed leaves there the depths that it left before.
Status Renderer::redrawShadows(Commands& commands, const DrawInputs& inputs, const SunView& sun, uint32_t mostTiles) {
    if (Status s = upload(commands, shadowFrame(inputs, sun)); !s) return s;
    const EmitView changes = emit_.takeChanges(commands, emitInputs(inputs), mostTiles);
    if (Status s = emit_.cull(commands, emitInputs(inputs), changes, "shadow emit", false); !s) return s;
    commands.transition(shadowMap_, ImageState::depthTarget);
    {
        DrawTargets targets;
        targets.extent = {kShadowSize, kShadowSize};
        targets.depth = DepthTarget{.view = shadowMap_.view(), .clear = {}};
        DrawPass pass(commands, "shadow draw", targets);
        pass.draw(shadowRestore_, 4, kShadowRows * kShadowRows, RestorePush{changes.tiles, kShadowRows, 0},
                  {{standing_, pointSampler_}});
        drawTerminals(pass, true);
    }
    commands.transition(shadowMap_, ImageState::sampled);
    return Done{};
}

Status Renderer::drawWideShadows(Commands& commands, const DrawInputs& inputs, const SunView& sun) {
    if (Status s = upload(commands, shadowFrame(inputs, sun)); !s) return s;
    const EmitView view = parallelView(sun.toClip, kShadowSize / sun.width, kShadowLodPixels);
    if (now_.roofed)
        if (Status s = roofs_->cull(commands, *inputs.roofs, view, true, "shadow emit"); !s) return s;
    if (now_.furnished)
        if (Status s = props_->chooseCasters(commands, sun.toClip); !s) return s;
    if (now_.patterned)
        if (Status s = pieces_->chooseCasters(commands, sun.toClip, kShadowSize / sun.width); !s) return s;
    commands.transition(shadowMap_, ImageState::depthTarget, true);
    {
        DrawTargets targets;
        targets.extent = {2 * kShadowSize, kShadowSize};
        targets.depth = DepthTarget{.view = shadowMap_.view(), .clear = 1.0f};
        DrawPass pass(commands, "shadow draw", targets);
        pass.setViewport({float(kShadowSize), 0, float(kShadowSize), float(kShadowSize), 0, 1});
        pass.setScissor(kShadowSize, 0, kShadowSize, kShadowSize);
        drawStanding(pass, sun, 1);
    }
    commands.transition(shadowMap_, ImageState::sampled);
    return Done{};
}

ShadowScene Renderer::shadowScene(const DrawInputs& inputs, glm::vec3 sun, glm::vec4 sphere) const {
    const GrowthView& growth = inputs.growth;
    return {growth.revision,  standing(), now_.roofed ? inputs.roofs->revision : 0, sun, growth.nodeCount,
            growth.leafCount, sphere};
}

Status Renderer::aimWideShadows(Commands& commands, const DrawInputs& inputs, const SunView& near, glm::vec3 center,
                                float radius, FrameRecord& frame) {
    ShadowScene now = shadowScene(inputs, frame.sunDirection, glm::vec4(center, radius));
    now.growth = now.nodes = now.leaves = 0;  // none of it is in there
    if (wide_.begin(now, inputs.look.shadowsLag)) {
        const SunView wide = makeSunView(now.sun, center, radius);
        near_.clear();  // the whole map is cleared
        if (Status s = drawWideShadows(commands, inputs, wide); !s) return s;
        wide_.drew(now, wide.toTexture);
    }
    now_.shadowsBehind = wide_.behind();
    // Both look along the sun: one's coordinates are the other's, scaled and moved.
    const float wide = 2 * wide_.radius();
    const glm::vec4 origin(0, 0, 0, 1);
    frame.wideScale = glm::vec3(near.width, near.width, near.depth) / wide;
    frame.wideOffset = glm::vec3(wide_.toTexture() * origin) - frame.wideScale * glm::vec3(near.toTexture * origin);
    frame.wideOffset.z -= kWideBias / wide;
    return Done{};
}

Status Renderer::keepShadows(Commands& commands, const DrawInputs& inputs, FrameRecord& frame) {
    glm::vec3 low, high;
    models_.bounds(low, high);
    if (now_.roofed) {
        low = models_.empty() ? inputs.roofs->low : glm::min(low, inputs.roofs->low);
        high = models_.empty() ? inputs.roofs->high : glm::max(high, inputs.roofs->high);
    }
    if (now_.graphed) {
        if (models_.empty() && !now_.roofed) low = glm::vec3(1e30f), high = -low;
        graph_->bounds(low, high);
    }
    float radius = std::max(glm::length(high - low) * 0.5f, 1e-3f) * 1.06f;
    glm::vec3 center = (low + high) * 0.5f;
    // A town, or a wide scene, is larger than a map of shadows can resolve: it covers what is looked at.
    if (now_.roofed || radius > kFineRadius) {
        const float wanted = 1.6f * glm::length(inputs.camera.target - inputs.camera.eye);
        const float reach = std::exp2(std::ceil(kReachSteps * std::log2(wanted)) / kReachSteps);
        if (reach < radius) {
            radius = std::max(reach, 8.0f);
            center = glm::round(inputs.camera.target / (0.125f * radius)) * (0.125f * radius);
        }
    }
    frame.unit = now_.roofed ? 1.0f : models_.lengthUnit();
    anchorLook(frame, inputs.origin);
    if (now_.furnished) props_->bounds(low, high);
    const glm::vec3 wideCenter = (low + high) * 0.5f;
    const float wideRadius = std::max(glm::length(high - low) * 0.5f, 1e-3f) * 1.02f;
    // What casts stands within the wide sphere.
    const SunView sun =
        makeSunView(frame.sunDirection, center, radius, glm::dot(wideCenter - center, frame.sunDirection) + wideRadius);
    frame.shadowMatrix = sun.toTexture;
    frame.shadowTexel = 1.0f / kShadowSize;
    frame.shadowOffset = 1.2f * sun.width / kShadowSize;
    const ShadowScene now = shadowScene(inputs, frame.sunDirection, glm::vec4(center, radius));
    if (frame.shadows && wideRadius > 1.1f * radius)
        if (Status s = aimWideShadows(commands, inputs, sun, wideCenter, wideRadius, frame); !s) return s;
    return updateNearShadows(commands, inputs, sun, now);
}

Status Renderer::updateNearShadows(Commands& commands, const DrawInputs& inputs, const SunView& sun,
                                   const ShadowScene& now) {
    const Look& look = inputs.look;
    if (!near_.begin(now, {look.shadows, look.shadowsLag, look.quick})) {
        now_.shadowsBehind |= near_.behind();
        if (!near_.drawn() && !wide_.drawn())
            commands.transition(shadowMap_, ImageState::sampled, true);  // bound, though not read
        return Done{};
    }
    if (now_.grows)
        if (Status s = emit_.bind(commands, emitInputs(inputs)); !s) return s;
    const NearShadows::Redraw redraw = near_.redraw(now_.grows, emit_.wholeBindings());
    if (redraw == NearShadows::Redraw::whole) {
        if (Status s = drawShadows(commands, inputs, sun); !s) return s;
    } else if (redraw != NearShadows::Redraw::nothing) {
        const bool all = redraw == NearShadows::Redraw::allTiles;
        if (Status s = redrawShadows(commands, inputs, sun, all ? ~0u : kStrokeTiles); !s) {
            near_.clear();
            return s;
        }
        all ? near_.drewAllTiles() : near_.drewFewTiles();
    }
    now_.shadowsBehind |= near_.behind();
    return Done{};
}

}  // namespace espalier
