// Enters: models' buffers and textures, a frame. Leaves: their levels of detail, and draws, one a material range.
#include <algorithm>
#include <limits>
#include <utility>

#include "runtime/render/models.hpp"
#include "runtime/render/view_sides.hpp"

namespace espalier {
namespace {

// Nothing real is wholly black or wholly white, yet converters leave zero where they lost the material (FBX's Lambert)
// and a file without materials means one. Such a surface is drawn as plaster, so that light and shadow show on it. What
// shines by itself is black on purpose, and a mirror white.
glm::vec4 shownColor(const Material& material) {
    const glm::vec4 c = material.baseColor;
    const bool mirrors = material.metallic > 0 && (material.roughness < 1 || material.roughnessImage >= 0);
    const bool lost = material.baseColorImage < 0 && !material.coloured && material.emissive == glm::vec3(0) &&
                      !mirrors && (std::max({c.x, c.y, c.z}) < 1e-4f || std::min({c.x, c.y, c.z}) > 0.999f);
    return lost ? glm::vec4(0.30f, 0.285f, 0.26f, c.w) : c;
}

constexpr float kBlendCutoff = 0.5f;     // of what is blended: where it is denser it casts shadow
constexpr float kJump = 0.3f;            // of its distance from a model: an eye that moves by more looks from elsewhere
constexpr float kMeadowReach = 0.0895f;  // units above the ground to which model.frag's addMeadow() has an effect

// Where it is cut out when it is drawn as opaque.
float cutoffOf(const Material& m) {
    const bool picture = m.blended && m.transmission == 0 && m.baseColorImage >= 0 && m.baseColor.a >= 0.5f;
    return picture ? kBlendCutoff : m.alphaCutoff;
}

}  // namespace

// Its up is as it was when triangles were put in order.
bool Models::standsAs(const Model& model) {
    const glm::vec3 up(model.toWorld[0].y, model.toWorld[1].y, model.toWorld[2].y);
    return glm::length(up - model.shape->up) <= 1e-5f * glm::length(up);
}

uint32_t Models::footOf(const Model& model, const Mesh& mesh, size_t range, float groundLevel, float unit) {
    const uint32_t all = mesh.ranges[range].indexCount;
    if (!standsAs(model)) return all;
    const float reach = groundLevel + kMeadowReach * unit - model.toWorld[3].y;
    const float storeys = std::floor((reach - model.shape->lowest) / model.shape->storey + 0.01f);
    if (storeys < 0) return 0;
    return storeys < float(kStoreys) ? mesh.storeys[range][size_t(storeys)] : all;
}

bool Models::showsBacks(const Model& model, const Mesh& mesh, const Material& material) const {
    if (material.alphaCutoff > 0) return true;
    // Who means them to be seen has the eye inside.
    if (material.doubleSided && glm::clamp(eye_, model.low, model.high) == eye_) return true;
    if (mesh.solidAbove < -std::numeric_limits<float>::max()) return false;
    return !standsAs(model) || eye_.y <= groundLevel_ || mesh.solidAbove >= groundLevel_ - model.toWorld[3].y;
}

void Models::endModels(DrawPass& pass) {
    pass.drawBacks(true);
    pass.mirrorPlaced(false);
}

void Models::useBuffersOf(DrawPass& pass, const Model& model) {
    pass.mirrorPlaced(model.mirrored);
    pass.setVertices(model.shape->vertices);
    pass.setIndices(model.shape->indices);
}

uint32_t Models::simplest(const Model& model, float error) {
    uint32_t mesh = 0;
    const std::vector<Mesh>& meshes = model.shape->meshes;
    while (mesh + 1 < meshes.size() && meshes[mesh + 1].error * model.scale <= error) ++mesh;
    return mesh;
}

void Models::choose(const FrameRecord& frame, float pixels, bool atOnce) {
    const float moved = glm::length(frame.eye - eye_);
    eye_ = frame.eye;
    groundLevel_ = frame.groundLevel;
    const ViewSides sides(frame.viewProjection);
    for (auto& [index, model] : models_) {
        model.seen = !model.hidden && !sides.misses(model.low, model.high);
        if (model.groundOnly) {
            model.step = kFadeFrames;
            continue;
        }
        const float distance = glm::length(eye_ - glm::clamp(eye_, model.low, model.high));
        const uint32_t wanted = simplest(model, pixels * distance / frame.pixelScale);
        const bool otherView = moved > kJump * (distance + frame.unit);  // a cut, or another of several cameras
        if (model.step == 0 || !model.seen || atOnce || otherView) {     // where nothing was seen before, too
            model.shown = wanted;
            model.step = kFadeFrames;
        } else if (model.step < kFadeFrames && wanted == model.before) {
            std::swap(model.shown, model.before);
            model.step = kFadeFrames - model.step + 1;
        } else if (model.step == kFadeFrames && wanted != model.shown) {
            model.before = std::exchange(model.shown, wanted);
            model.step = 1;
        } else {
            model.step = std::min(model.step + 1, kFadeFrames);
        }
    }
}

ModelPush Models::pushOf(const Model& model, uint32_t mesh, const Material& material, uint32_t surface) const {
    ModelPush push{};
    for (int r = 0; r < 3; ++r)
        push.toWorld[r] = {model.toWorld[0][r], model.toWorld[1][r], model.toWorld[2][r], model.toWorld[3][r]};
    push.baseColor = shownColor(material);
    push.normalScale = material.normalImage >= 0 ? material.normalScale : 0;
    push.roughness = material.roughness;
    push.alphaCutoff = material.alphaCutoff;
    push.surface = surface;
    push.lod = mesh;
    push.fade = 1;
    push.colorOther = material.baseColorMap.set;
    push.mirrored = model.mirrored ? 1 : 0;
    const auto rows = rowsOf(material.baseColorMap);
    push.colorU = rows[0];
    push.colorV = rows[1];
    return push;
}

void Models::draw(DrawPass& pass, const Drawn& with) const {
    const bool quick = isQuick(with.shading);
    for (const auto& entry : models_) {
        const uint32_t index = entry.first;  // clang 14 hands no structured binding to a lambda
        const Model& model = entry.second;
        if (!model.seen || (with.drawnOnly && model.groundOnly)) continue;
        useBuffersOf(pass, model);
        const auto drawMesh = [&](uint32_t which, float fade) {
            const Mesh& mesh = model.shape->meshes[which];
            for (size_t r = 0; r < mesh.ranges.size(); ++r) {
                const DrawRange& range = mesh.ranges[r];
                const Material& material = model.shape->materialOf(range);
                if (material.blended && with.glassApart) continue;
                ModelPush push = pushOf(model, which, material, with.walkData ? index : kNoIndex);
                push.fade = fade;
                push.alphaCutoff = cutoffOf(material);
                pass.drawBacks(showsBacks(model, mesh, material));
                const Sampler& sampler = samplerOf(material, quick);
                const uint32_t foot = footOf(model, mesh, r, with.meadowLevel, with.unit);
                const auto drawPart = [&](bool isFoot, uint32_t first, uint32_t count) {
                    if (count == 0) return;
                    const Programs& programs = isMapped(material) ? with.mapped : with.plain;
                    const Program& program = isFoot ? *programs.foot : *programs.program;
                    const DrawPass::IndexRange indices{count, range.firstIndex + first, mesh.firstVertex};
                    if (isMapped(material)) return drawMapped(pass, program, with, model, range, indices, push);
                    pass.drawIndexed(program, indices, push,
                                     {{pictureOr(model.shape->colors, material.baseColorImage, white_), sampler},
                                      {pictureOr(model.shape->normals, material.normalImage, flat_), sampler},
                                      with.shadow,
                                      with.ground.noiseBinding(quick),
                                      with.ground.siteBinding(quick),
                                      with.ground.pavingBinding(quick),
                                      with.frame});
                };
                drawPart(true, 0, foot);
                drawPart(false, foot, range.indexCount - foot);
            }
        };
        overShown(model, drawMesh);
    }
    endModels(pass);
}

void Models::drawAhead(DrawPass& pass, const Program& whole, const Program& fading, const Buffer& frame,
                       bool glassApart) const {
    for (const auto& entry : models_) {
        const uint32_t index = entry.first;  // clang 14 hands no structured binding to a lambda
        const Model& model = entry.second;
        if (!model.seen || model.groundOnly) continue;
        useBuffersOf(pass, model);
        overShown(model, [&](uint32_t which, float fade) {
            const Mesh& mesh = model.shape->meshes[which];
            for (const DrawRange& range : mesh.ranges) {
                const Material& material = model.shape->materialOf(range);
                if (cutoffOf(material) > 0 || (material.blended && glassApart)) continue;
                ModelPush push = pushOf(model, which, material, index);
                push.fade = fade;
                pass.drawBacks(showsBacks(model, mesh, material));
                pass.drawIndexed(fade < 1 ? fading : whole, {range.indexCount, range.firstIndex, mesh.firstVertex},
                                 push, {frame});
            }
        });
    }
    endModels(pass);
}

void Models::drawDepth(DrawPass& pass, const Program& whole, const Program& cut, const Buffer& frame,
                       float error) const {
    for (const auto& [index, model] : models_) {
        if (model.groundOnly || model.hidden) continue;
        useBuffersOf(pass, model);
        const uint32_t mesh = simplest(model, error);
        for (const DrawRange& range : model.shape->meshes[mesh].ranges) {
            const Material& material = model.shape->materialOf(range);
            if (material.transmission > 0) continue;  // glass lets the sun through
            const DrawPass::IndexRange draw{range.indexCount, range.firstIndex, model.shape->meshes[mesh].firstVertex};
            ModelPush push = pushOf(model, mesh, material, index);
            if (material.blended) push.alphaCutoff = kBlendCutoff;
            if (push.alphaCutoff > 0)
                pass.drawIndexed(
                    cut, draw, push,
                    {{pictureOr(model.shape->colors, material.baseColorImage, white_), samplerOf(material, false)},
                     frame});
            else
                pass.drawIndexed(whole, draw, push, {frame});
        }
    }
    endModels(pass);
}

uint64_t Models::triangles() const {
    uint64_t sum = 0;
    const auto add = [&](const Mesh& mesh) {
        for (const DrawRange& range : mesh.ranges) sum += range.indexCount / 3;
    };
    for (const auto& [index, model] : models_) {
        if (!model.seen || model.groundOnly) continue;
        add(model.shape->meshes[model.shown]);
        if (model.step < kFadeFrames) add(model.shape->meshes[model.before]);
    }
    return sum;
}

uint32_t Models::fading() const {
    uint32_t count = 0;
    for (const auto& [index, model] : models_) count += model.step < kFadeFrames ? 1 : 0;
    return count;
}

}  // namespace espalier
