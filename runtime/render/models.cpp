// Enters: decoded meshes with materials. Leaves: their buffers and textures, for each frame the level of detail, and
// draws, one a material range.
#include "runtime/render/models.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "runtime/gpu/color_texture.hpp"
#include "runtime/render/solid.hpp"
#include "runtime/render/view_sides.hpp"

namespace espalier {
namespace {

Result<Image> makeNormals(Device& device, std::string_view name, uint32_t width, uint32_t height,
                          std::span<const uint8_t> rgba) {
    ImageDesc desc{.name = name, .width = width, .height = height};
    desc.levels = 0;
    Result<Image> image = Image::create(device, desc);
    if (!image) return image;
    if (Status s = fillImage(device, *image, std::as_bytes(rgba)); !s) return s.failure();
    return image;
}

const Image& pictureOr(const std::vector<Image>& images, int index, const Image& other) {
    return index >= 0 && size_t(index) < images.size() && images[size_t(index)] ? images[size_t(index)] : other;
}

// Nothing real is wholly black or wholly white, yet converters leave zero where they lost the material (FBX's Lambert)
// and a file without materials means one. Such a surface is drawn as plaster, so that light and shadow show on it.
glm::vec4 shownColor(const Material& material) {
    const glm::vec4 c = material.baseColor;
    const bool lost =
        material.baseColorImage < 0 && (std::max({c.x, c.y, c.z}) < 1e-4f || std::min({c.x, c.y, c.z}) > 0.999f);
    return lost ? glm::vec4(0.30f, 0.285f, 0.26f, c.w) : c;
}

const Material& materialOf(const std::vector<Material>& materials, const DrawRange& range) {
    return materials[std::min<size_t>(range.material, materials.size() - 1)];
}

constexpr float kMeadowReach = 0.0895f;  // units above the ground to which model.frag's addMeadow() has an effect

}  // namespace

void takeModelVertices(GraphicsDesc& desc) {
    desc.vertexBytes = sizeof(DrawVertex);
    desc.inputs = {{0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(DrawVertex, position)},
                   {1, VK_FORMAT_R32G32B32_SFLOAT, offsetof(DrawVertex, normal)},
                   {2, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(DrawVertex, tangent)},
                   {3, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(DrawVertex, uv)}};  // and walkUv
}

void takeModelPositions(GraphicsDesc& desc) {
    takeModelVertices(desc);
    desc.inputs.resize(1);
}

Result<Models> Models::create(Device& device) {
    Models models;
    const uint8_t white[4] = {255, 255, 255, 255}, flat[4] = {128, 128, 255, 255};
    Result<Image> whiteImage = makeColorTexture(device, "white", 1, 1, white);
    if (!whiteImage) return whiteImage.failure();
    models.white_ = std::move(*whiteImage);
    Result<Image> flatImage = makeNormals(device, "flat normal", 1, 1, flat);
    if (!flatImage) return flatImage.failure();
    models.flat_ = std::move(*flatImage);
    Result<Sampler> sampler =
        Sampler::create(device, {.name = "model textures", .anisotropy = device.info().cpu ? 1.0f : 8.0f});
    if (!sampler) return sampler.failure();
    models.sampler_ = std::move(*sampler);
    Result<Sampler> quick = Sampler::create(device, {.name = "model textures, quick", .blendMips = false});
    if (!quick) return quick.failure();
    models.quickSampler_ = std::move(*quick);
    return models;
}

// Which way is up, and how high storeys are.
void Models::raise(const SurfaceData& data, Model& model) {
    model.up = glm::vec3(model.toWorld[0].y, model.toWorld[1].y, model.toWorld[2].y);
    float highest = -1e30f;
    model.lowest = 1e30f;
    for (const DrawVertex& v : data.vertices) {
        model.lowest = std::min(model.lowest, glm::dot(model.up, v.position));
        highest = std::max(highest, glm::dot(model.up, v.position));
    }
    model.storey = std::max((highest - model.lowest) / kStoreys, 1e-12f);
}

// Within a storey triangles keep their order, which vertex caches like.
Models::Storeys Models::intoStoreys(const Model& model, std::span<const DrawVertex> vertices,
                                    std::span<uint32_t> indices) {
    std::array<std::vector<uint32_t>, kStoreys> storeys;
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        float lowest = 1e30f;
        for (size_t c = i; c < i + 3; ++c) lowest = std::min(lowest, glm::dot(model.up, vertices[indices[c]].position));
        const float at = std::clamp((lowest - model.lowest) / model.storey, 0.0f, float(kStoreys - 1));
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

// Its up is as it was when triangles were put in order.
bool Models::standsAs(const Model& model) {
    const glm::vec3 up(model.toWorld[0].y, model.toWorld[1].y, model.toWorld[2].y);
    return glm::length(up - model.up) <= 1e-5f * glm::length(up);
}

uint32_t Models::footOf(const Model& model, const Mesh& mesh, size_t range, float groundLevel, float unit) {
    const uint32_t all = mesh.ranges[range].indexCount;
    if (!standsAs(model)) return all;
    const float reach = groundLevel + kMeadowReach * unit - model.toWorld[3].y;
    const float storeys = std::floor((reach - model.lowest) / model.storey + 0.01f);
    if (storeys < 0) return 0;
    return storeys < float(kStoreys) ? mesh.storeys[range][size_t(storeys)] : all;
}

Status Models::uploadMeshes(Device& device, const SurfaceData& data, Model& model) {
    std::vector<DrawVertex> vertices = data.vertices;
    std::vector<uint32_t> indices = data.indices;
    model.meshes.push_back({0, data.ranges, {}, 0});
    const float scale = glm::length(glm::vec3(model.toWorld[0]));
    for (const CoarserMesh& mesh : data.coarser) {
        model.meshes.push_back({int32_t(vertices.size()), mesh.ranges, {}, mesh.error * scale});
        for (DrawRange& range : model.meshes.back().ranges) range.firstIndex += uint32_t(indices.size());
        vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
        indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
    }
    raise(data, model);
    for (Mesh& mesh : model.meshes) {
        const auto from = std::span(vertices).subspan(size_t(mesh.firstVertex));
        std::vector<uint32_t> opaque;
        for (const DrawRange& range : mesh.ranges) {
            const auto corners = std::span(indices).subspan(range.firstIndex, range.indexCount);
            mesh.storeys.push_back(intoStoreys(model, from, corners));
            if (materialOf(model.materials, range).alphaCutoff == 0)
                opaque.insert(opaque.end(), corners.begin(), corners.end());
        }
        mesh.solidAbove = solidAbove(from, opaque, model.up);
    }
    Result<Buffer> vertexBuffer = makeBuffer(device, "model vertices", vertices);
    if (!vertexBuffer) return vertexBuffer.failure();
    model.vertices = std::move(*vertexBuffer);
    Result<Buffer> indexBuffer = makeBuffer(device, "model indices", indices);
    if (!indexBuffer) return indexBuffer.failure();
    model.indices = std::move(*indexBuffer);
    return Done{};
}

Status Models::uploadPictures(Device& device, const SurfaceData& data, Model& model) {
    model.colors.resize(data.images.size());
    model.normals.resize(data.images.size());
    for (const Material& material : model.materials) {
        const struct {
            int index;
            std::vector<Image>& images;
            Result<Image> (*make)(Device&, std::string_view, uint32_t, uint32_t, std::span<const uint8_t>);
            const char* name;
        } uses[] = {{material.baseColorImage, model.colors, makeColorTexture, "model colour"},
                    {material.normalImage, model.normals, makeNormals, "model normals"}};
        for (const auto& use : uses) {
            if (use.index < 0 || size_t(use.index) >= data.images.size() || use.images[size_t(use.index)]) continue;
            const Picture& picture = data.images[size_t(use.index)];
            if (picture.width == 0 || picture.rgba.size() != size_t(picture.width) * picture.height * 4) continue;
            Result<Image> image = use.make(device, use.name, picture.width, picture.height, picture.rgba);
            if (!image) return image.failure();
            use.images[size_t(use.index)] = std::move(*image);
        }
    }
    return Done{};
}

void Models::Model::place(const glm::mat4& to) {
    toWorld = to;
    low = glm::vec3(1e30f);
    high = glm::vec3(-1e30f);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 at((corner & 1) ? objectHigh.x : objectLow.x, (corner & 2) ? objectHigh.y : objectLow.y,
                           (corner & 4) ? objectHigh.z : objectLow.z);
        const glm::vec3 world(toWorld * glm::vec4(at, 1));
        low = glm::min(low, world);
        high = glm::max(high, world);
    }
}

Status Models::set(Device& device, uint32_t index, const SurfaceData& data, const glm::mat4& toWorld, bool groundOnly) {
    Model model;
    model.groundOnly = groundOnly;
    model.objectLow = data.boundsMin;
    model.objectHigh = data.boundsMax;
    model.place(toWorld);
    model.materials = data.materials;
    if (model.materials.empty()) model.materials.emplace_back();
    if (Status s = uploadMeshes(device, data, model); !s) return s;
    if (Status s = uploadPictures(device, data, model); !s) return s;
    models_.insert_or_assign(index, std::move(model));
    ++revision_;
    return Done{};
}

void Models::remove(uint32_t index) {
    models_.erase(index);
    ++revision_;
}

void Models::place(uint32_t index, const glm::mat4& toWorld) {
    const auto found = models_.find(index);
    if (found == models_.end()) return;
    Model& model = found->second;
    const float grows = glm::length(glm::vec3(toWorld[0])) / glm::length(glm::vec3(model.toWorld[0]));
    for (auto& mesh : model.meshes) mesh.error *= grows;
    model.place(toWorld);
    ++revision_;
}

bool Models::showsBacks(const Model& model, const Mesh& mesh, const Material& material) const {
    if (material.alphaCutoff > 0 || glm::determinant(glm::mat3(model.toWorld)) <= 0) return true;
    // Who means them to be seen has the eye inside.
    if (material.doubleSided && glm::clamp(eye_, model.low, model.high) == eye_) return true;
    if (mesh.solidAbove < -std::numeric_limits<float>::max()) return false;
    return !standsAs(model) || eye_.y <= groundLevel_ || mesh.solidAbove >= groundLevel_ - model.toWorld[3].y;
}

uint32_t Models::simplest(const Model& model, float error) {
    uint32_t mesh = 0;
    while (mesh + 1 < model.meshes.size() && model.meshes[mesh + 1].error <= error) ++mesh;
    return mesh;
}

void Models::choose(const FrameRecord& frame, float pixels, bool atOnce) {
    eye_ = frame.eye;
    groundLevel_ = frame.groundLevel;
    const ViewSides sides(frame.viewProjection);
    for (auto& [index, model] : models_) {
        model.seen = !sides.misses(model.low, model.high);
        if (model.groundOnly) {
            model.step = kFadeFrames;
            continue;
        }
        const float distance = glm::length(eye_ - glm::clamp(eye_, model.low, model.high));
        const uint32_t wanted = simplest(model, pixels * distance / frame.pixelScale);
        if (model.step == 0 || !model.seen || atOnce) {  // where nothing was seen before, too
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
    return push;
}

// each(mesh, fade): the mesh that is drawn, or the two that share the picture.
template <class Each>
void Models::overShown(const Model& model, const Each& each) {
    if (model.step == kFadeFrames) return each(model.shown, 1.0f);
    // Pixels go to the coarser one in one order and come back in the same.
    const float share = float(model.step) / kFadeFrames, coarser = model.shown > model.before ? share : 1 - share;
    each(std::max(model.shown, model.before), coarser);
    each(std::min(model.shown, model.before), -coarser);
}

void Models::draw(DrawPass& pass, const Drawn& with) const {
    const bool quick = with.shading == Shading::quick;
    const Sampler& sampler = quick ? quickSampler_ : sampler_;
    for (const auto& [index, model] : models_) {
        if (!model.seen || (with.drawnOnly && model.groundOnly)) continue;
        pass.setVertices(model.vertices);
        pass.setIndices(model.indices);
        const auto drawMesh = [&](uint32_t which, float fade) {
            const Mesh& mesh = model.meshes[which];
            for (size_t r = 0; r < mesh.ranges.size(); ++r) {
                const DrawRange& range = mesh.ranges[r];
                const Material& material = materialOf(model.materials, range);
                ModelPush push = pushOf(model, which, material, with.walkData ? index : kNoIndex);
                push.fade = fade;
                pass.drawBacks(showsBacks(model, mesh, material));
                const uint32_t foot = footOf(model, mesh, r, with.groundLevel, with.unit);
                const auto drawPart = [&](const Program& program, uint32_t first, uint32_t count) {
                    if (count == 0) return;
                    pass.drawIndexed(program, {count, range.firstIndex + first, mesh.firstVertex}, push,
                                     {{pictureOr(model.colors, material.baseColorImage, white_), sampler},
                                      {pictureOr(model.normals, material.normalImage, flat_), sampler},
                                      with.shadow,
                                      with.ground.noiseBinding(quick),
                                      with.ground.siteBinding(quick),
                                      with.ground.pavingBinding(quick),
                                      with.frame});
                };
                drawPart(with.foot, 0, foot);
                drawPart(with.program, foot, range.indexCount - foot);
            }
        };
        overShown(model, drawMesh);
    }
    pass.drawBacks(true);
}

void Models::drawAhead(DrawPass& pass, const Program& whole, const Program& fading, const Buffer& frame) const {
    for (const auto& [index, model] : models_) {
        if (!model.seen || model.groundOnly) continue;
        pass.setVertices(model.vertices);
        pass.setIndices(model.indices);
        overShown(model, [&](uint32_t which, float fade) {
            const Mesh& mesh = model.meshes[which];
            for (const DrawRange& range : mesh.ranges) {
                const Material& material = materialOf(model.materials, range);
                if (material.alphaCutoff > 0) continue;
                ModelPush push = pushOf(model, which, material, index);
                push.fade = fade;
                pass.drawBacks(showsBacks(model, mesh, material));
                pass.drawIndexed(fade < 1 ? fading : whole, {range.indexCount, range.firstIndex, mesh.firstVertex},
                                 push, {frame});
            }
        });
    }
    pass.drawBacks(true);
}

void Models::drawDepth(DrawPass& pass, const Program& program, const Buffer& frame, float error) const {
    for (const auto& [index, model] : models_) {
        if (model.groundOnly) continue;
        pass.setVertices(model.vertices);
        pass.setIndices(model.indices);
        const uint32_t mesh = simplest(model, error);
        for (const DrawRange& range : model.meshes[mesh].ranges) {
            const Material& material = materialOf(model.materials, range);
            pass.drawIndexed(program, {range.indexCount, range.firstIndex, model.meshes[mesh].firstVertex},
                             pushOf(model, mesh, material, index), {frame});
        }
    }
}

uint64_t Models::triangles() const {
    uint64_t sum = 0;
    const auto add = [&](const Mesh& mesh) {
        for (const DrawRange& range : mesh.ranges) sum += range.indexCount / 3;
    };
    for (const auto& [index, model] : models_) {
        if (!model.seen || model.groundOnly) continue;
        add(model.meshes[model.shown]);
        if (model.step < kFadeFrames) add(model.meshes[model.before]);
    }
    return sum;
}

uint32_t Models::fading() const {
    uint32_t count = 0;
    for (const auto& [index, model] : models_) count += model.step < kFadeFrames ? 1 : 0;
    return count;
}

void Models::bounds(glm::vec3& low, glm::vec3& high) const {
    low = glm::vec3(models_.empty() ? -0.5f : 1e30f);
    high = -low;
    for (const auto& [index, model] : models_) {
        low = glm::min(low, model.low);
        high = glm::max(high, model.high);
    }
}

}  // namespace espalier
