// In: a context. Out: copies of its parts.
#include "tools/export/export.hpp"

namespace espalier::exporting {
namespace {

bool copyPart(EspContext* context, uint32_t index, bool levels, ExportPart& out) {
    EspPartInfo info;
    if (espPartInfo(context, index, &info) != ESP_OK) return false;
    out.kind = info.kind;
    out.name = info.name;
    out.material = info.material;
    out.house = info.house;
    out.seed = info.seed.id;
    for (uint32_t i = 0; i < (levels ? info.levels : 1); ++i) {
        EspPartLevel level;
        if (espPartLevel(context, index, i, &level) != ESP_OK) return false;
        if (level.indexCount == 0) break;  // too thin to be seen where this level is
        out.levels.push_back({{level.vertices, level.vertices + level.vertexCount},
                              {level.indices, level.indices + level.indexCount},
                              level.error});
    }
    const EspPartInstance* instances = nullptr;
    if (espPartInstances(context, index, &instances) != ESP_OK) return false;
    out.instances.assign(instances, instances + info.instances);
    return true;
}

bool copyAll(EspContext* context, const EspPartsInfo& info, bool levels, Gathered& out) {
    for (uint32_t i = 0; i < info.parts; ++i)
        if (!copyPart(context, i, levels, out.parts.emplace_back())) return false;
    for (uint32_t i = 0; i < info.materials; ++i) {
        EspPartMaterial& material = out.materials.emplace_back();
        if (espPartMaterial(context, i, &material) != ESP_OK) return false;
        out.materialNames.push_back(material.name);
    }
    for (uint32_t i = 0; i < info.pictures; ++i) {
        EspPartPicture picture;
        if (espPartPicture(context, i, &picture) != ESP_OK) return false;
        const size_t size = size_t(picture.width) * picture.height * 4;
        out.pictures.push_back({picture.width, picture.height, {picture.rgba, picture.rgba + size}});
    }
    out.triangles = info.triangles;
    return true;
}

}  // namespace

bool gather(EspContext* context, const Options& options, Gathered& out, std::string& error) {
    EspPartsDef def = esp::defaults<EspPartsDef>();
    def.kinds = 0;
    if (options.ivy) def.kinds |= 1u << ESP_PART_STEMS | 1u << ESP_PART_LEAF;
    if (options.roofs) def.kinds |= 1u << ESP_PART_TILE | 1u << ESP_PART_HOUSE;
    if (options.patterns) def.kinds |= 1u << ESP_PART_PIECE;
    def.stemError = options.stemError;
    const bool levels = options.lods || options.collision;
    if (!levels) def.stemLevels = 1;
    EspPartsInfo info;
    if (espReadParts(context, &def, &info) != ESP_OK || !copyAll(context, info, levels, out)) {
        error = espLastError(context);
        return false;
    }
    if (out.parts.empty()) error = "nothing has grown that could be exported";
    return !out.parts.empty();
}

}  // namespace espalier::exporting
