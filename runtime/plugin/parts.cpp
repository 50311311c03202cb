// In: meshes of terminals, and parts that are added one after another. Out: parts with names and materials of their
// own.
#include "runtime/plugin/parts.hpp"

#include <algorithm>

#include "runtime/core/jobs.hpp"
#include "runtime/plugin/given.hpp"
#include "shaders/shared/exact.h"

namespace espalier {
namespace {

// How a leaf bends: from its stalk, where y is 0, to its tip.
float bendAt(const TerminalData& data, const TerminalLod& lod, float y) {
    float tip = 1e-6f;
    for (uint32_t i = 0; i < lod.vertexCount; ++i) tip = std::max(tip, data.vertices[lod.firstVertex + i].position.y);
    return std::clamp(y / tip, 0.0f, 1.0f);
}

PartLevel levelOf(const TerminalData& data, const TerminalLod& lod, bool textured, bool bends) {
    PartLevel level;
    level.error = lod.error;
    level.indices.assign(data.indices.begin() + lod.firstIndex, data.indices.begin() + lod.firstIndex + lod.indexCount);
    for (uint32_t i = 0; i < lod.vertexCount; ++i) {
        const TerminalVertex& from = data.vertices[lod.firstVertex + i];
        EspPartVertex v{};
        put(v.position, from.position);
        put(v.normal, unpackOct(from.normal));
        v.uv[0] = from.uv.x;
        v.uv[1] = from.uv.y;
        // A mesh without pictures keeps its shade where others have their u.
        put(v.colour, glm::vec3(textured ? 1.0f : from.uv.x));
        v.wind = bends ? bendAt(data, lod, from.position.y) : 0;
        level.vertices.push_back(v);
    }
    return level;
}

}  // namespace

uint32_t PartsWriter::material(const TerminalData& data, uint32_t material, bool twoSided) {
    for (const Known& known : known_)
        if (known.data == &data && known.of == material) return known.number;
    TerminalMaterial added = data.materials[material];
    for (int* number : {&added.baseColorPicture, &added.normalPicture})
        if (*number >= 0) *number = picture(data, *number);
    const uint32_t number = uint32_t(out_.materials.size());
    out_.materials.push_back(std::move(added));
    out_.twoSided.push_back(twoSided);
    known_.push_back({&data, material, number});
    return number;
}

int PartsWriter::picture(const TerminalData& data, int number) {
    for (const Known& known : knownPictures_)
        if (known.data == &data && known.of == uint32_t(number)) return int(known.number);
    out_.pictures.push_back(data.pictures[size_t(number)]);
    knownPictures_.push_back({&data, uint32_t(number), uint32_t(out_.pictures.size()) - 1});
    return int(knownPictures_.back().number);
}

std::string PartsWriter::unlikeOthers(const std::string& name) const {
    std::string tried = name;
    for (uint32_t i = 2; std::ranges::find(out_.parts, tried, &Part::name) != out_.parts.end(); ++i)
        tried = name + "_" + std::to_string(i);
    return tried;
}

Part& PartsWriter::single(EspPartKind kind, const std::string& name, uint32_t material) {
    Part& part = out_.parts.emplace_back();
    part.kind = kind;
    part.name = name;
    part.material = material;
    EspPartInstance instance{};
    instance.place = espIdentity();
    put(instance.colour, glm::vec3(1));
    part.instances.push_back(instance);
    return part;
}

uint32_t PartsWriter::variant(EspPartKind kind, const std::string& name, const TerminalData& data,
                              const TerminalVariant& variant, bool twoSided) {
    const std::string own = unlikeOthers(name);
    Part& part = out_.parts.emplace_back();
    part.kind = kind;
    part.name = own;
    part.material = material(data, variant.lods.front().material, twoSided);
    const bool textured = out_.materials[part.material].baseColorPicture >= 0;
    for (const TerminalLod& lod : variant.lods)
        part.levels.push_back(levelOf(data, lod, textured, kind == ESP_PART_LEAF && variant.kind == 1));
    return uint32_t(out_.parts.size()) - 1;
}

StandingParts PartsWriter::finish() {
    std::erase_if(out_.parts, [](const Part& part) {
        return part.instances.empty() || part.levels.empty() || part.levels.front().indices.empty();
    });
    // Stems have been laid out by who made them.
    parallelFor(out_.parts.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            Part& part = out_.parts[i];
            const bool textured = out_.materials[part.material].baseColorPicture >= 0;
            for (PartLevel& level : part.levels)
                if (part.kind != ESP_PART_STEMS) unwrap(level, textured);
        }
    });
    return std::move(out_);
}

}  // namespace espalier
