// Enters: models with materials that aren't plain: textures by UVs of their own, light, metal, glass. Leaves: their
// records, and draws. Glass is sorted when a model is set, once for each of a few directions: so it costs no time in a
// frame, and is the same in every run. Panes that cross each other, and long ones that lie aslant, may be drawn in the
// wrong order.
#include <algorithm>
#include <array>
#include <numeric>

#include "runtime/render/models.hpp"

namespace espalier {
namespace {

constexpr float kShiny = 0.4f;  // what is less rough than that mirrors what is around it

// The corners, edges and sides of a cube.
constexpr size_t kDirections = 26;
std::array<glm::vec3, kDirections> makeDirections() {
    std::array<glm::vec3, kDirections> all;
    size_t count = 0;
    for (int i = 0; i < 27; ++i)
        if (i != 13) all[count++] = glm::normalize(glm::vec3(float(i % 3 - 1), float(i / 3 % 3 - 1), float(i / 9 - 1)));
    return all;
}
const std::array<glm::vec3, kDirections> kSortedAlong = makeDirections();

size_t nearestDirection(glm::vec3 along) {
    const auto less = [&](glm::vec3 a, glm::vec3 b) { return glm::dot(a, along) < glm::dot(b, along); };
    return size_t(std::ranges::max_element(kSortedAlong, less) - kSortedAlong.begin());
}

}  // namespace

bool Models::isMapped(const Material& m) {
    return m.blended || m.emissive != glm::vec3(0) || m.baseColorMap != TextureMap() || m.normalMap != TextureMap() ||
           m.metallic > 0 || m.roughnessImage >= 0 || m.roughness < kShiny;
}

bool Models::anyMapped() const {
    return std::ranges::any_of(models_,
                               [](const auto& m) { return std::ranges::any_of(m.second.shape->materials, isMapped); });
}

bool Models::anyGlass() const {
    return std::ranges::any_of(
        models_, [](const auto& m) { return std::ranges::any_of(m.second.shape->materials, &Material::blended); });
}

void Models::planRecords(Plan& plan, Upload& upload) {
    plan.records.assign(plan.shape.materials.size(), Plan::kNone);
    for (size_t i = 0; i < plan.records.size(); ++i) {
        const Material& m = plan.shape.materials[i];
        if (!isMapped(m)) continue;
        const auto normal = rowsOf(m.normalMap), emissive = rowsOf(m.emissiveMap), rough = rowsOf(m.roughnessMap);
        const MaterialRecord record{normal[0],  normal[1],       emissive[0],        emissive[1],
                                    m.emissive, m.normalMap.set, m.emissiveMap.set,  m.transmission,
                                    rough[0],   rough[1],        m.roughnessMap.set, m.metallic};
        plan.records[i] = upload.addBuffer("material", std::vector{record});
    }
}

Models::Panes Models::intoPanes(std::span<const DrawVertex> vertices, const DrawRange& range,
                                std::vector<uint32_t>& indices) {
    const uint32_t count = range.indexCount / 3;
    std::vector<glm::vec3> middles(count, glm::vec3(0));
    Panes panes{uint32_t(indices.size()), glm::vec3(0)};
    for (uint32_t t = 0; t < count; ++t) {
        for (uint32_t k = 0; k < 3; ++k) middles[t] += vertices[indices[range.firstIndex + t * 3 + k]].position / 3.0f;
        panes.middle += middles[t] / float(count);
    }
    std::vector<uint32_t> order(count);
    for (const glm::vec3& along : kSortedAlong) {
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
            return glm::dot(middles[a], along) > glm::dot(middles[b], along);
        });
        for (uint32_t t : order)
            for (uint32_t k = 0; k < 3; ++k) indices.push_back(indices[range.firstIndex + t * 3 + k]);
    }
    return panes;
}

void Models::drawMapped(DrawPass& pass, const Program& program, const Drawn& with, const Model& model,
                        const DrawRange& range, const DrawPass::IndexRange& indices, const ModelPush& push) const {
    const Material& material = model.shape->materialOf(range);
    const bool quick = isQuick(with.shading);
    const Sampler& sampler = samplerOf(material, quick);
    const size_t record = std::min<size_t>(range.material, model.shape->records.size() - 1);
    pass.drawIndexed(program, indices, push,
                     {{pictureOr(model.shape->colors, material.baseColorImage, white_), sampler},
                      {pictureOr(model.shape->normals, material.normalImage, flat_), sampler},
                      with.shadow,
                      with.ground.noiseBinding(quick),
                      with.ground.siteBinding(quick),
                      with.ground.pavingBinding(quick),
                      {pictureOr(model.shape->colors, material.emissiveImage, white_), sampler},
                      {pictureOr(model.shape->normals, material.roughnessImage, white_), sampler},
                      with.frame,
                      model.shape->records[record]});
}

void Models::drawGlass(DrawPass& pass, const Drawn& with, const GlassPrograms& programs, glm::vec3 forward) const {
    struct Range {
        float depth;
        uint32_t index;
        const Model* model;
        uint32_t mesh;
        size_t range;
        float fade;
    };
    std::vector<Range> ranges;
    for (const auto& [index, model] : models_) {
        if (!model.seen || (with.drawnOnly && model.groundOnly)) continue;
        overShown(model, [&, &m = model, i = index](uint32_t which, float fade) {
            const Mesh& mesh = m.shape->meshes[which];
            for (size_t r = 0; r < mesh.ranges.size(); ++r)
                if (m.shape->materialOf(mesh.ranges[r]).blended)
                    ranges.push_back({glm::dot(forward, glm::vec3(m.toWorld * glm::vec4(mesh.panes[r].middle, 1))), i,
                                      &m, which, r, fade});
        });
    }
    std::ranges::stable_sort(ranges, [](const Range& a, const Range& b) { return a.depth > b.depth; });
    for (const Range& r : ranges) {
        const Mesh& mesh = r.model->shape->meshes[r.mesh];
        const DrawRange& range = mesh.ranges[r.range];
        const Material& material = r.model->shape->materialOf(range);
        const size_t order = nearestDirection(glm::transpose(glm::mat3(r.model->toWorld)) * forward);
        ModelPush push = pushOf(*r.model, r.mesh, material, with.walkData ? r.index : kNoIndex);
        push.baseColor = material.baseColor;
        push.fade = r.fade;
        useBuffersOf(pass, *r.model);
        pass.drawBacks(material.doubleSided);
        const DrawPass::IndexRange indices{
            range.indexCount, mesh.panes[r.range].firstIndex + uint32_t(order) * range.indexCount, mesh.firstVertex};
        if (material.transmission > 0 &&
            (material.baseColorImage >= 0 || glm::vec3(material.baseColor) != glm::vec3(1)))
            pass.drawIndexed(
                programs.tint, indices, push,
                {{pictureOr(r.model->shape->colors, material.baseColorImage, white_),
                  samplerOf(material, isQuick(with.shading))},
                 with.frame,
                 r.model->shape->records[std::min<size_t>(range.material, r.model->shape->records.size() - 1)]});
        drawMapped(pass, programs.glass, with, *r.model, range, indices, push);
    }
    endModels(pass);
}

}  // namespace espalier
