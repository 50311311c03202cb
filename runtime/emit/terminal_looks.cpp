// Enters: the shipped terminal meshes, and how grammars want theirs. Leaves: both together, each look a kind of its
// own. A look shares what it doesn't change: without a mesh of its own it is the shipped triangles with another
// material.
#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/emit/terminals.hpp"
#include "shaders/shared/exact.h"

namespace espalier {
namespace {

constexpr uint32_t kMostOwnLods = 4, kMostOwnVariants = 4;  // of one look: kernels' table is small
constexpr float kOwnCutoff = 0.5f;
const glm::vec3 kGreyWeights(0.3f, 0.6f, 0.1f);

float linearOf(uint8_t stored) {
    const float s = float(stored) / 255;
    return s <= .04045f ? s / 12.92f : std::pow((s + .055f) / 1.055f, 2.4f);
}
uint8_t storedOf(float linear) {
    const float c = std::clamp(linear, 0.0f, 1.0f);
    return uint8_t((c <= .0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - .055f) * 255 + .5f);
}

bool hasHoles(const TerminalPicture& picture) {
    for (size_t i = 3; i < picture.rgba.size(); i += 4)
        if (picture.rgba[i] < 128) return true;
    return false;
}

// With another hue: as bright as before against its mean, which gets the colour.
TerminalPicture tintedOf(const TerminalPicture& from, glm::vec3 colour) {
    float table[256];
    for (int i = 0; i < 256; ++i) table[i] = linearOf(uint8_t(i));
    const auto brightness = [&](size_t i) {
        return glm::dot(kGreyWeights, glm::vec3(table[from.rgba[i]], table[from.rgba[i + 1]], table[from.rgba[i + 2]]));
    };
    double sum = 0, count = 0;
    for (size_t i = 0; i + 3 < from.rgba.size(); i += 4)
        if (from.rgba[i + 3] >= 128) sum += brightness(i), ++count;
    const float scale = count > 0 ? 1 / std::max(float(sum / count), 1e-3f) : 1;
    TerminalPicture out = from;
    for (size_t i = 0; i + 3 < out.rgba.size(); i += 4) {
        const glm::vec3 texel = colour * (brightness(i) * scale);
        for (int c = 0; c < 3; ++c) out.rgba[i + size_t(c)] = storedOf(texel[c]);
    }
    return out;
}

// The picture as upper side, and below it the same as back.
TerminalPicture withBack(const TerminalPicture& front) {
    TerminalPicture out{front.width, 2 * front.height, front.rgba};
    out.rgba.insert(out.rgba.end(), front.rgba.begin(), front.rgba.end());
    return out;
}

// Rows of a card from its foot up: bent backwards towards the tip, its middle lower than its sides.
void addCard(TerminalData& data, TerminalLod& lod, uint32_t rows, uint32_t columns, float width, glm::vec3 across) {
    const uint32_t first = uint32_t(data.vertices.size()) - lod.firstVertex;
    const glm::vec3 face = glm::cross(across, glm::vec3(0, 1, 0));
    for (uint32_t r = 0; r <= rows; ++r)
        for (uint32_t c = 0; c <= columns; ++c) {
            const float v = float(r) / float(rows), u = float(c) / float(columns), side = 2 * u - 1;
            const float bend = rows > 1 ? 0.10f * std::abs(side) * std::sin(3.14159f * v) - 0.12f * v * v : 0;
            const glm::vec3 normal =
                face - across * (rows > 1 ? 0.25f * side : 0) + glm::vec3(0, rows > 1 ? 0.2f * v : 0, 0);
            data.vertices.push_back({across * (side * width / 2) + glm::vec3(0, v, 0) + face * bend,
                                     packOct(glm::normalize(normal)),
                                     {u, 1 - v}});
        }
    const uint32_t row = columns + 1;
    for (uint32_t r = 0; r < rows; ++r)
        for (uint32_t c = 0; c < columns; ++c) {
            const uint32_t a = first + r * row + c;
            for (uint32_t i : {a, a + 1, a + row, a + 1, a + row + 1, a + row}) data.indices.push_back(i);
        }
    lod.vertexCount = uint32_t(data.vertices.size()) - lod.firstVertex;
    lod.indexCount = uint32_t(data.indices.size()) - lod.firstIndex;
}

// A picture as a leaf, of its own proportions, 1 long; of what stands in tufts two that cross.
TerminalData cardOf(const TerminalPicture& picture, bool crossed) {
    TerminalData data;
    TerminalVariant& variant = data.variants.emplace_back(TerminalVariant{"card", 0, {}});
    TerminalMaterial& material = data.materials.emplace_back();
    material.name = "card";
    material.roughness = 0.6f;
    const float width = std::clamp(float(picture.width) / float(std::max(picture.height, 1u)), 0.05f, 4.0f);
    for (const uint32_t detail : {2u, 1u}) {
        TerminalLod lod;
        lod.firstVertex = uint32_t(data.vertices.size());
        lod.firstIndex = uint32_t(data.indices.size());
        addCard(data, lod, detail == 1 ? 1 : 4, detail == 1 ? 1 : 2, width, {1, 0, 0});
        if (crossed) addCard(data, lod, detail == 1 ? 1 : 4, detail == 1 ? 1 : 2, width, {0, 0, 1});
        variant.lods.push_back(lod);
    }
    data.pictures.push_back(picture);
    material.baseColorPicture = 0;
    if (hasHoles(picture)) material.alphaCutoff = kOwnCutoff;
    measureTerminalErrors(data);
    return data;
}

// What has been added for one look: materials and pictures by those that they stand for.
class LookMaker {
  public:
    LookMaker(TerminalData& out, const TerminalLook& look) : out_(out), look_(look) {}

    // Their vertices are copied, since the backs of leaves lie lower in the picture.
    void addMeshes(const TerminalData& from) {
        uint32_t variants = 0;
        for (const TerminalVariant& variant : from.variants) {
            if (variants++ == kMostOwnVariants) break;
            TerminalVariant& own = out_.variants.emplace_back(TerminalVariant{variant.name, look_.kind, {}});
            for (const TerminalLod& lod : variant.lods)
                if (own.lods.size() < kMostOwnLods) own.lods.push_back(copy(from, lod));
        }
    }
    // The shipped meshes of the kind with materials of their own.
    void shareMeshes(const TerminalData& shipped) {
        for (const TerminalVariant& variant : shipped.variants) {
            if (variant.kind != shippedMesh(look_.kind)) continue;
            TerminalVariant own = variant;
            own.kind = look_.kind;
            for (TerminalLod& lod : own.lods) lod.material = shippedMaterial(shipped, lod.material);
            out_.variants.push_back(std::move(own));
        }
    }

  private:
    bool backs() const { return showsBack(look_.kind) && shippedMesh(look_.kind) != kMeshBark; }

    TerminalLod copy(const TerminalData& from, TerminalLod lod) {
        const auto vertices = from.vertices.begin() + lod.firstVertex;
        const auto indices = from.indices.begin() + lod.firstIndex;
        lod.firstVertex = uint32_t(out_.vertices.size());
        lod.firstIndex = uint32_t(out_.indices.size());
        const TerminalMaterial& before = from.materials[lod.material];
        lod.material = ownMaterial(from, lod.material);
        const bool halved = backs() && (look_.picture || before.baseColorPicture >= 0);
        for (uint32_t i = 0; i < lod.vertexCount; ++i) {
            TerminalVertex vertex = vertices[i];
            // The half's edges stay clear of the other half.
            if (halved) vertex.uv.y = 0.5f * std::clamp(vertex.uv.y, 0.004f, 0.996f);
            out_.vertices.push_back(vertex);
        }
        out_.indices.insert(out_.indices.end(), indices, indices + lod.indexCount);
        return lod;
    }

    uint32_t ownMaterial(const TerminalData& from, uint32_t index) {
        if (const auto known = materials_.find(index); known != materials_.end()) return known->second;
        TerminalMaterial material = from.materials[index];
        material.normalPicture = -1;
        if (look_.picture) {
            material.baseColor = glm::vec4(1);
            material.baseColorPicture = addPicture(*look_.picture);
            material.alphaCutoff = hasHoles(*look_.picture) ? kOwnCutoff : 0;
        } else if (material.baseColorPicture >= 0) {
            material.baseColorPicture = addPicture(from.pictures[size_t(material.baseColorPicture)]);
        }
        if (look_.colour) material.baseColor *= glm::vec4(*look_.colour, 1);
        return add(index, std::move(material));
    }
    uint32_t shippedMaterial(const TerminalData& shipped, uint32_t index) {
        if (const auto known = materials_.find(index); known != materials_.end()) return known->second;
        TerminalMaterial material = shipped.materials[index];
        if (look_.picture) {
            material.baseColor = glm::vec4(1);
            material.normalPicture = -1;
            material.baseColorPicture = store(*look_.picture);
        }
        if (look_.colour && !look_.picture && material.baseColorPicture >= 0) {
            material.baseColorPicture =
                store(tintedOf(shipped.pictures[size_t(material.baseColorPicture)], *look_.colour));
            material.baseColor = glm::vec4(1);
        } else if (look_.colour) {
            material.baseColor *= glm::vec4(*look_.colour, 1);
        }
        return add(index, std::move(material));
    }
    uint32_t add(uint32_t index, TerminalMaterial material) {
        out_.materials.push_back(std::move(material));
        return materials_[index] = uint32_t(out_.materials.size()) - 1;
    }
    int addPicture(const TerminalPicture& picture) { return store(backs() ? withBack(picture) : picture); }
    int store(TerminalPicture picture) {
        out_.pictures.push_back(std::move(picture));
        return int(out_.pictures.size()) - 1;
    }

    TerminalData& out_;
    const TerminalLook& look_;
    std::map<uint32_t, uint32_t> materials_;
};

}  // namespace

TerminalData withLooks(const TerminalData& shipped, std::span<const TerminalLook> looks) {
    TerminalData out = shipped;
    out.kinds.resize(kMaxTerminalKinds);
    for (const TerminalLook& look : looks) {
        const uint32_t stands = shippedMesh(look.kind);
        out.kinds[look.kind] = shipped.kinds[stands];
        LookMaker maker(out, look);
        const bool tiles = stands == kMeshBark || stands == kMeshPebble;
        if (look.mesh)
            maker.addMeshes(*look.mesh);
        else if (look.picture && !tiles)
            maker.addMeshes(cardOf(*look.picture, stands == kMeshTuft));
        else
            maker.shareMeshes(shipped);
    }
    return out;
}

}  // namespace espalier
