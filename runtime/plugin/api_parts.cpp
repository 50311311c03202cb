// What stands, as parts: gathered when a host asks, told part by part.
#include <cmath>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/parts.hpp"

namespace espalier {

constexpr uint32_t kMostStemLevels = 4;

void setDefaults(EspPartsDef& def) {
    def.kinds = ~0u;
    def.stemError = .2f;
    def.stemLevels = 3;
}

namespace {

EspPartsInfo told(const StandingParts& all) {
    EspPartsInfo info{};
    info.parts = uint32_t(all.parts.size());
    info.materials = uint32_t(all.materials.size());
    info.pictures = uint32_t(all.pictures.size());
    for (const Part& part : all.parts) {
        info.instances += part.instances.size();
        info.triangles += part.instances.size() * (part.levels.front().indices.size() / 3);
    }
    return info;
}

EspResult readParts(EspContext& context, const EspPartsDef& def, StandingParts& out) {
    PartsWriter writer(def);
    if (const EspResult failed = gatherPlants(context, writer)) return failed;
    if (const EspResult failed = gatherTown(context, writer)) return failed;
    gatherPieces(context, writer);
    out = writer.finish();
    return ESP_OK;
}

// The one of this number in `list`, or a refusal.
template <class T>
const T& among(const char* call, const std::vector<T>& list, uint32_t index) {
    if (index < list.size()) return list[index];
    throw Refusal{std::string(call) + ": there is no number " + std::to_string(index) + " among " +
                  std::to_string(list.size())};
}

}  // namespace
}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espDefaultPartsDef(EspPartsDef* out) {
    return giveDefaults("espDefaultPartsDef", out);
}

EspResult espReadParts(EspContext* context, const EspPartsDef* def, EspPartsInfo* out) {
    return guarded(context, [&] {
        const EspPartsDef asked = taken("espReadParts", def);
        give("espReadParts", out, EspPartsInfo{});
        if (!std::isfinite(asked.stemError) || asked.stemError < 0 || asked.stemLevels < 1 ||
            asked.stemLevels > kMostStemLevels)
            return fail(
                context, ESP_INVALID_ARGUMENT,
                "espReadParts: stemError has to be 0 or more, stemLevels 1 to " + std::to_string(kMostStemLevels));
        StandingParts made;
        if (const EspResult failed = grownOr(*context, [&] { return readParts(*context, asked, made); })) return failed;
        context->parts = std::move(made);
        give("espReadParts", out, told(context->parts));
        return ESP_OK;
    });
}

EspResult espPartInfo(const EspContext* context, uint32_t index, EspPartInfo* out) {
    return guarded(context, [&] {
        const Part& part = among("espPartInfo", context->parts.parts, index);
        EspPartInfo info{};
        info.kind = part.kind;
        info.name = part.name.c_str();
        info.material = part.material;
        info.levels = uint32_t(part.levels.size());
        info.instances = uint32_t(part.instances.size());
        info.seed = part.seed;
        info.house = part.house;
        give("espPartInfo", out, info);
        return ESP_OK;
    });
}

EspResult espPartLevel(const EspContext* context, uint32_t index, uint32_t level, EspPartLevel* out) {
    return guarded(context, [&] {
        const PartLevel& of = among("espPartLevel", among("espPartLevel", context->parts.parts, index).levels, level);
        EspPartLevel info{};
        info.vertexCount = uint32_t(of.vertices.size());
        info.indexCount = uint32_t(of.indices.size());
        info.vertices = of.vertices.data();
        info.indices = of.indices.data();
        info.error = of.error;
        give("espPartLevel", out, info);
        return ESP_OK;
    });
}

EspResult espPartInstances(const EspContext* context, uint32_t index, const EspPartInstance** instances) {
    return guarded(context, [&] {
        if (!instances) return fail(context, ESP_INVALID_ARGUMENT, "espPartInstances: null pointer");
        *instances = among("espPartInstances", context->parts.parts, index).instances.data();
        return ESP_OK;
    });
}

EspResult espPartMaterial(const EspContext* context, uint32_t index, EspPartMaterial* out) {
    return guarded(context, [&] {
        const TerminalMaterial& of = among("espPartMaterial", context->parts.materials, index);
        EspPartMaterial info{};
        info.name = of.name.c_str();
        put(info.colour, glm::vec3(of.baseColor));
        info.roughness = of.roughness;
        info.alphaCutoff = of.alphaCutoff;
        info.twoSided = context->parts.twoSided[index];
        info.colourPicture = of.baseColorPicture;
        info.normalPicture = of.normalPicture;
        give("espPartMaterial", out, info);
        return ESP_OK;
    });
}

EspResult espPartPicture(const EspContext* context, uint32_t index, EspPartPicture* out) {
    return guarded(context, [&] {
        const TerminalPicture& of = among("espPartPicture", context->parts.pictures, index);
        EspPartPicture info{};
        info.width = of.width;
        info.height = of.height;
        info.rgba = of.rgba.data();
        give("espPartPicture", out, info);
        return ESP_OK;
    });
}

}  // extern "C"
