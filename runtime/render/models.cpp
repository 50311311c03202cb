// Enters: decoded meshes with materials. Leaves: their buffers and textures.
#include "runtime/render/models.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "runtime/gpu/color_texture.hpp"
#include "runtime/render/solid.hpp"

namespace espalier {
namespace {

size_t addNormals(Upload& upload, std::string name, uint32_t width, uint32_t height, std::span<const uint8_t> rgba,
                  bool) {
    const auto bytes = std::as_bytes(rgba);
    return upload.addImage(std::move(name), VK_FORMAT_R8G8B8A8_UNORM, width, height,
                           std::vector<std::byte>(bytes.begin(), bytes.end()));
}

}  // namespace

void takeModelVertices(GraphicsDesc& desc, bool mapped) {
    desc.vertexBytes = sizeof(DrawVertex);
    desc.inputs = {{0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(DrawVertex, position)},
                   {1, VK_FORMAT_R32G32B32_SFLOAT, offsetof(DrawVertex, normal)},
                   {2, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(DrawVertex, tangent)},
                   {3, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(DrawVertex, uv)},  // and walkUv
                   {5, VK_FORMAT_R16G16B16A16_UNORM, offsetof(DrawVertex, colour)}};
    if (mapped) desc.inputs.push_back({4, VK_FORMAT_R32G32_SFLOAT, offsetof(DrawVertex, otherUv)});
}

void takeModelPositions(GraphicsDesc& desc, bool pictured) {
    takeModelVertices(desc, pictured);
    // What is cut out depends on the picture's and the vertices' alpha.
    std::erase_if(desc.inputs,
                  [&](const VertexInput& input) { return input.location != 0 && !(pictured && input.location >= 3); });
}

Result<Models> Models::create(Device& device) {
    Models models;
    const uint8_t white[4] = {255, 255, 255, 255}, flat[4] = {128, 128, 255, 255};
    Upload upload;
    const size_t whites = addColorTexture(upload, "white", 1, 1, white, holdsRoots(device));
    const size_t flats = addNormals(upload, "flat normal", 1, 1, flat, false);
    if (Status made = upload.run(device); !made) return made.failure();
    models.white_ = upload.takeImage(whites);
    models.flat_ = upload.takeImage(flats);
    if (Status made = models.makeSamplers(device); !made) return made.failure();
    return models;
}

Status Models::makeSamplers(Device& device) {
    constexpr VkSamplerAddressMode kModes[kWraps] = {
        VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT};
    for (uint32_t i = 0; i < kWraps * kWraps; ++i) {
        const SamplerDesc wraps{
            .name = "model textures", .address = kModes[i % kWraps], .addressV = kModes[i / kWraps]};
        SamplerDesc fine = wraps, quick = wraps;
        fine.anisotropy = device.info().traits.anisotropy;
        quick.blendMips = false;
        if (Status made = assign(samplers_[i], Sampler::create(device, fine)); !made) return made;
        if (Status made = assign(quickSamplers_[i], Sampler::create(device, quick)); !made) return made;
    }
    return Done{};
}

const Sampler& Models::samplerOf(const Material& material, bool quick) const {
    const size_t wraps = size_t(material.wrapU) + kWraps * size_t(material.wrapV);
    return quick ? quickSamplers_[wraps] : samplers_[wraps];
}

// Which way is up, and how high storeys are.
void Models::raise(const SurfaceData& data, const glm::mat4& toWorld, Shape& shape) {
    shape.up = glm::vec3(toWorld[0].y, toWorld[1].y, toWorld[2].y);
    float highest = -1e30f;
    shape.lowest = 1e30f;
    for (const DrawVertex& v : data.vertices) {
        shape.lowest = std::min(shape.lowest, glm::dot(shape.up, v.position));
        highest = std::max(highest, glm::dot(shape.up, v.position));
    }
    shape.storey = std::max((highest - shape.lowest) / kStoreys, 1e-12f);
}

// Within a storey triangles keep their order, which vertex caches like.
Models::Storeys Models::intoStoreys(const Shape& shape, std::span<const DrawVertex> vertices,
                                    std::span<uint32_t> indices) {
    std::array<std::vector<uint32_t>, kStoreys> storeys;
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        float lowest = 1e30f;
        for (size_t c = i; c < i + 3; ++c) lowest = std::min(lowest, glm::dot(shape.up, vertices[indices[c]].position));
        const float at = std::clamp((lowest - shape.lowest) / shape.storey, 0.0f, float(kStoreys - 1));
        auto& storey = storeys[size_t(at)];
        storey.insert(storey.end(), &indices[i], &indices[i] + 3);
    }
    Storeys ends{};
    uint32_t end = 0;
    for (uint32_t s = 0; s < kStoreys; ++s) {
        std::copy(storeys[s].begin(), storeys[s].end(), indices.begin() + end);
        ends[s] = end += uint32_t(storeys[s].size());
    }
    return ends;
}

void Models::planMeshes(const SurfaceData& data, const glm::mat4& toWorld, Plan& plan, Upload& upload) {
    Shape& shape = plan.shape;
    std::vector<DrawVertex> vertices = data.vertices;
    std::vector<uint32_t> indices = data.indices;
    shape.meshes.push_back({.ranges = data.ranges});
    for (const CoarserMesh& mesh : data.coarser) {
        shape.meshes.push_back({.firstVertex = int32_t(vertices.size()), .ranges = mesh.ranges, .error = mesh.error});
        for (DrawRange& range : shape.meshes.back().ranges) range.firstIndex += uint32_t(indices.size());
        vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
        indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
    }
    raise(data, toWorld, shape);
    for (Mesh& mesh : shape.meshes) {
        const auto from = std::span(vertices).subspan(size_t(mesh.firstVertex));
        std::vector<uint32_t> opaque;
        for (const DrawRange& range : mesh.ranges) {
            const auto corners = std::span(indices).subspan(range.firstIndex, range.indexCount);
            mesh.storeys.push_back(intoStoreys(shape, from, corners));
            const Material& material = shape.materialOf(range);
            if (material.alphaCutoff == 0 && !material.blended)
                opaque.insert(opaque.end(), corners.begin(), corners.end());
        }
        mesh.solidAbove = solidAbove(from, opaque, shape.up);
        for (const DrawRange& range : mesh.ranges)
            mesh.panes.push_back(shape.materialOf(range).blended ? intoPanes(from, range, indices) : Panes{});
    }
    plan.vertices = upload.addBuffer("model vertices", vertices);
    plan.indices = upload.addBuffer("model indices", indices);
}

void Models::planPictures(const SurfaceData& data, bool roots, Plan& plan, Upload& upload) {
    plan.colors.assign(data.images.size(), Plan::kNone);
    plan.normals.assign(data.images.size(), Plan::kNone);
    for (const Material& material : plan.shape.materials) {
        const struct {
            int index;
            std::vector<size_t>& images;
            size_t (*add)(Upload&, std::string, uint32_t, uint32_t, std::span<const uint8_t>, bool roots);
            const char* name;
        } uses[] = {{material.baseColorImage, plan.colors, addColorTexture, "model colour"},
                    {material.emissiveImage, plan.colors, addColorTexture, "model emission"},
                    {material.normalImage, plan.normals, addNormals, "model normals"},
                    {material.roughnessImage, plan.normals, addNormals, "model roughness"}};
        for (const auto& use : uses) {
            if (use.index < 0 || size_t(use.index) >= data.images.size()) continue;
            size_t& image = use.images[size_t(use.index)];
            const Picture& picture = data.images[size_t(use.index)];
            if (image != Plan::kNone || picture.width == 0) continue;
            if (picture.rgba.size() != size_t(picture.width) * picture.height * 4) continue;
            image = use.add(upload, use.name, picture.width, picture.height, picture.rgba, roots);
        }
    }
}

void Models::Model::place(const glm::mat4& to) {
    toWorld = to;
    scale = glm::length(glm::vec3(to[0]));
    mirrored = glm::determinant(glm::mat3(to)) < 0;
    low = glm::vec3(1e30f);
    high = glm::vec3(-1e30f);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 at((corner & 1) ? shape->high.x : shape->low.x, (corner & 2) ? shape->high.y : shape->low.y,
                           (corner & 4) ? shape->high.z : shape->low.z);
        const glm::vec3 world(toWorld * glm::vec4(at, 1));
        low = glm::min(low, world);
        high = glm::max(high, world);
    }
}

Models::Plan Models::plan(const SurfaceData& data, const glm::mat4& toWorld, bool groundOnly, bool roots,
                          Upload& upload) {
    Plan plan;
    plan.model.groundOnly = groundOnly;
    plan.model.toWorld = toWorld;
    Shape& shape = plan.shape;
    shape.low = data.boundsMin;
    shape.high = data.boundsMax;
    shape.materials = data.materials;
    if (shape.materials.empty()) shape.materials.emplace_back();
    planMeshes(data, toWorld, plan, upload);
    planPictures(data, roots, plan, upload);
    planRecords(plan, upload);
    return plan;
}

void Models::set(uint32_t index, Plan plan, Upload& upload) {
    Shape& shape = plan.shape;
    const auto take = [&](const std::vector<size_t>& planned, auto& into, auto taken) {
        into.resize(planned.size());
        for (size_t i = 0; i < planned.size(); ++i)
            if (planned[i] != Plan::kNone) into[i] = (upload.*taken)(planned[i]);
    };
    shape.vertices = upload.takeBuffer(plan.vertices);
    shape.indices = upload.takeBuffer(plan.indices);
    take(plan.colors, shape.colors, &Upload::takeImage);
    take(plan.normals, shape.normals, &Upload::takeImage);
    take(plan.records, shape.records, &Upload::takeBuffer);
    Model& model = plan.model;
    model.shape = std::make_shared<const Shape>(std::move(shape));
    model.place(model.toWorld);
    models_.insert_or_assign(index, std::move(model));
    ++revision_;
}

void Models::setLike(uint32_t index, uint32_t like, const glm::mat4& toWorld) {
    Model model;
    model.shape = models_.at(like).shape;
    model.groundOnly = models_.at(like).groundOnly;
    model.place(toWorld);
    models_.insert_or_assign(index, std::move(model));
    ++revision_;
}

Status Models::set(Device& device, uint32_t index, const SurfaceData& data, const glm::mat4& toWorld, bool groundOnly) {
    Upload upload;
    Plan planned = plan(data, toWorld, groundOnly, holdsRoots(device), upload);
    if (Status done = upload.run(device); !done) return done;
    set(index, std::move(planned), upload);
    return Done{};
}

void Models::remove(uint32_t index) {
    models_.erase(index);
    ++revision_;
}

void Models::place(uint32_t index, const glm::mat4& toWorld) {
    const auto found = models_.find(index);
    if (found == models_.end()) return;
    found->second.place(toWorld);
    ++revision_;
}

void Models::hide(uint32_t index, bool hidden) {
    const auto found = models_.find(index);
    if (found == models_.end() || found->second.hidden == hidden) return;
    found->second.hidden = hidden;
    ++revision_;
}

void Models::bounds(glm::vec3& low, glm::vec3& high) const {
    low = glm::vec3(models_.empty() ? -0.5f : 1e30f);
    high = -low;
    for (const auto& [index, model] : models_) {
        low = glm::min(low, model.low);
        high = glm::max(high, model.high);
    }
}

std::optional<std::array<glm::vec3, 2>> Models::carrierBounds(std::span<const Version> placed) const {
    std::optional<std::array<glm::vec3, 2>> box;
    for (const auto& [instance, model] : models_) {
        if (!placed.empty() && (instance >= placed.size() || placed[instance] == 0)) continue;
        if (!box) box = {model.low, model.high};
        box = {glm::min((*box)[0], model.low), glm::max((*box)[1], model.high)};
    }
    return box;
}

float Models::lengthUnit() const {
    float least = std::numeric_limits<float>::max(), most = 0;
    for (const auto& [index, model] : models_) {
        const glm::vec3 size = model.high - model.low;
        const float side = std::max({size.x, size.y, size.z});
        least = std::min(least, side);
        most = std::max(most, side);
    }
    return models_.empty() ? 1.0f : espalier::lengthUnit(least, most);
}

}  // namespace espalier
