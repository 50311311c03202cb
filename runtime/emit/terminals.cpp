// Enters: terminal meshes on the CPU. Leaves: their buffers, batched index patterns, textures and the table that
// culling picks LODs from.
#include "runtime/emit/terminals.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "runtime/core/check.hpp"
#include "runtime/gpu/color_texture.hpp"
#include "shaders/shared/exact.h"

namespace espalier {
namespace {

// Enough vertices a draw instance that the fixed cost of one doesn't show; a mesh has no more than six indices for
// each.
constexpr uint32_t kBatchVertices = 4096, kBatchIndices = 6 * kBatchVertices;
// Of a ribbon against a tube, in radii: bark of less than two and a half pixels of radius may be one.
constexpr float kRibbonError = 0.4f;

// Where the CPU picks, all kinds but the first are names in a file.
bool isBark(uint32_t kind, TerminalChoice choice) {
    return choice == TerminalChoice::kernels ? shippedMesh(kind) == kMeshBark : kind == kMeshBark;
}

// Pieces along z.
float barkSegments(const TerminalData& data, const TerminalLod& lod) {
    std::set<int> levels;
    for (uint32_t i = 0; i < lod.vertexCount; ++i)
        levels.insert(int(std::lround(data.vertices[lod.firstVertex + i].position.z * 1000)));
    return float(std::max<size_t>(levels.size(), 2) - 1);
}

// Kernels' table has room for so many.
Status checkRoom(const TerminalData& data) {
    size_t levels = 0;
    for (const TerminalVariant& variant : data.variants) levels += std::min<size_t>(variant.lods.size(), kMaxLods);
    if (data.kinds.size() <= kMaxTerminalKinds && data.variants.size() <= kMaxVariants && levels <= kMaxBuckets)
        return Done{};
    return Failure("terminals", "more than " + std::to_string(kMaxTerminalKinds) + " kinds, " +
                                    std::to_string(kMaxVariants) + " variants or " + std::to_string(kMaxBuckets) +
                                    " levels of detail of terminal meshes");
}

}  // namespace

// Far bark is a ribbon that the vertex shader turns to the eye: two triangles a span. A look of bark that shares the
// shipped meshes has one already.
void addRibbons(TerminalData& data, TerminalChoice choice) {
    for (TerminalVariant& variant : data.variants) {
        if (!isBark(variant.kind, choice) || variant.lods.empty() || variant.lods.size() >= kMaxLods ||
            variant.lods.back().vertexCount == kRibbonVertices)
            continue;
        TerminalLod lod;
        lod.firstVertex = uint32_t(data.vertices.size());
        lod.vertexCount = 4;
        lod.firstIndex = uint32_t(data.indices.size());
        lod.indexCount = 6;
        lod.material = variant.lods[0].material;
        lod.error = std::max(kRibbonError, variant.lods.back().error * 1.01f);
        for (uint32_t i = 0; i < 4; ++i) {
            const float x = i & 1 ? 1.0f : -1.0f, z = i & 2 ? 1.0f : 0.0f;
            data.vertices.push_back({{x, 0, z}, packOct({0, 1, 0}), {0.25f + 0.25f * x, 1 - z}});
        }
        for (uint32_t i : {0u, 1u, 2u, 1u, 3u, 2u}) data.indices.push_back(i);
        variant.lods.push_back(lod);
    }
}

Result<Terminals> Terminals::create(Device& device, TerminalData data, TerminalChoice choice) {
    Terminals terminals;
    terminals.data_ = std::move(data);
    addRibbons(terminals.data_, choice);
    const bool kernels = choice == TerminalChoice::kernels;
    if (kernels)
        if (Status s = checkRoom(terminals.data_); !s) return s.failure();
    if (Status s = terminals.makeTable(device, choice); !s) return s.failure();
    if (kernels)
        if (Status s = terminals.makeKernelTable(device); !s) return s.failure();
    if (Status s = terminals.makePictures(device); !s) return s.failure();
    return terminals;
}

Status Terminals::makeTable(Device& device, TerminalChoice choice) {
    const bool repeats = choice == TerminalChoice::kernels;
    std::ranges::stable_sort(data_.variants, {}, [&](const TerminalVariant& variant) {
        return std::pair(!isBark(variant.kind, choice), variant.kind);
    });
    table_.kinds.resize(data_.kinds.size());
    std::vector<uint32_t> batches;
    for (const TerminalVariant& variant : data_.variants) {
        require(variant.kind < data_.kinds.size() && !variant.lods.empty(), "a terminal variant has a kind and a LOD");
        KindRecord& kind = table_.kinds[variant.kind];
        if (kind.variantCount++ == 0) kind.firstVariant = uint32_t(table_.variants.size());
        kind.bark = isBark(variant.kind, choice);
        VariantRecord& record = table_.variants.emplace_back();
        record.firstBucket = uint32_t(table_.buckets.size());
        record.lodCount = uint32_t(std::min<size_t>(variant.lods.size(), kMaxLods));
        for (uint32_t l = 0; l < record.lodCount; ++l) {
            const TerminalLod& lod = variant.lods[l];
            record.error[l] = lod.error;
            record.segments[l] = kind.bark ? barkSegments(data_, lod) : 1;
            for (uint32_t i = 0; i < lod.vertexCount; ++i)
                record.extent = std::max(record.extent, glm::length(data_.vertices[lod.firstVertex + i].position));
            const uint32_t most =
                std::min(kBatchVertices / lod.vertexCount, kBatchIndices / std::max(lod.indexCount, 1u));
            const uint32_t batch = repeats ? std::max(1u, most) : 1;
            table_.buckets.push_back(
                {lod.firstVertex, lod.vertexCount, lod.indexCount, batch, uint32_t(batches.size()), lod.material});
            for (uint32_t b = 0; b < batch; ++b)
                for (uint32_t i = 0; i < lod.indexCount; ++i)
                    batches.push_back(b * lod.vertexCount + data_.indices[lod.firstIndex + i]);
        }
        if (kind.bark) table_.barkBuckets = uint32_t(table_.buckets.size());
    }
    if (repeats) fillOwnKinds();

    auto make = [&](Buffer& buffer, const char* name, const auto& values) -> Status {
        auto made = makeBuffer(device, name, values);
        if (!made) return made.failure();
        buffer = std::move(*made);
        return Done{};
    };
    if (Status s = make(vertices_, "terminal vertices", data_.vertices); !s) return s;
    if (!data_.vertices.empty()) {
        if (Status made = assign(vertexTexels_, TexelView::create(device, vertices_, VK_FORMAT_R32G32_UINT)); !made)
            return made.failure();
    }
    if (Status s = make(indices_, "terminal indices", data_.indices); !s) return s;
    return make(batches_, "terminal batches", batches);
}

// What has grown with a look that is there no more is drawn as shipped until it grows anew, or for as long as it is
// frozen.
void Terminals::fillOwnKinds() {
    table_.kinds.resize(kMaxTerminalKinds);
    for (uint32_t kind = kOwnMeshes; kind < kMaxTerminalKinds; ++kind)
        if (table_.kinds[kind].variantCount == 0) table_.kinds[kind] = table_.kinds[shippedMesh(kind)];
}

Status Terminals::makeKernelTable(Device& device) {
    std::ranges::copy(table_.kinds, kernelTable_.kinds);
    std::ranges::copy(table_.variants, kernelTable_.variants);
    std::ranges::copy(table_.buckets, kernelTable_.buckets);
    kernelTable_.kindCount = uint32_t(table_.kinds.size());
    kernelTable_.variantCount = uint32_t(table_.variants.size());
    kernelTable_.bucketCount = uint32_t(table_.buckets.size());
    kernelTable_.barkBuckets = table_.barkBuckets;
    return assign(tableBuffer_, makeBuffer(device, "terminal table", std::vector<EmitTable>{kernelTable_}));
}

Status Terminals::makePictures(Device& device) {
    auto make = [&](Image& image, const char* name, VkFormat format, uint32_t width, uint32_t height,
                    std::span<const uint8_t> rgba) -> Status {
        ImageDesc desc{.name = name, .format = format, .width = width, .height = height};
        desc.levels = 0;
        if (Status made = assign(image, Image::create(device, desc)); !made) return made.failure();
        return fillImage(device, image, std::as_bytes(rgba));
    };
    const uint8_t white[4] = {255, 255, 255, 255}, flat[4] = {128, 128, 255, 255};
    auto makeColor = [&](Image& image, const char* name, uint32_t width, uint32_t height,
                         std::span<const uint8_t> rgba) -> Status {
        return assign(image, makeColorTexture(device, name, width, height, rgba));
    };
    if (Status s = makeColor(white_, "white", 1, 1, white); !s) return s;
    if (Status s = make(flat_, "flat normal", VK_FORMAT_R8G8B8A8_UNORM, 1, 1, flat); !s) return s;
    colors_.resize(data_.pictures.size());
    normals_.resize(data_.pictures.size());
    for (const TerminalMaterial& material : data_.materials) {
        if (const int i = material.baseColorPicture; i >= 0 && !colors_[i]) {
            const TerminalPicture& p = data_.pictures[i];
            if (Status s = makeColor(colors_[i], "terminal colour", p.width, p.height, p.rgba); !s) return s;
        }
        if (const int i = material.normalPicture; i >= 0 && !normals_[i]) {
            const TerminalPicture& p = data_.pictures[i];
            if (Status s = make(normals_[i], "terminal normals", VK_FORMAT_R8G8B8A8_UNORM, p.width, p.height, p.rgba);
                !s)
                return s;
        }
    }
    return Done{};
}

const TerminalLod& Terminals::lodOfBucket(uint32_t bucket) const {
    for (size_t v = 0; v < table_.variants.size(); ++v) {
        const VariantRecord& record = table_.variants[v];
        if (bucket >= record.firstBucket && bucket < record.firstBucket + record.lodCount)
            return data_.variants[v].lods[bucket - record.firstBucket];
    }
    fatal("there is no such bucket");
}

const Image& Terminals::baseColor(uint32_t material) const {
    const int i = data_.materials[material].baseColorPicture;
    return i >= 0 ? colors_[i] : white_;
}
const Image& Terminals::normalMap(uint32_t material) const {
    const int i = data_.materials[material].normalPicture;
    return i >= 0 ? normals_[i] : flat_;
}

}  // namespace espalier
