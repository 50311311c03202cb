// In: the town's grids, as they were grown. Out: triangles, cut exactly, behind those of the plants.
#include <cstring>

#include "runtime/emit/roof_triangles.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/town_growth.hpp"

namespace espalier {
namespace {

constexpr size_t kMostBytes = size_t(1) << 31;

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
    const size_t at = bytes.size();
    bytes.resize(at + sizeof value);
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

}  // namespace

TownRoofs::TownRoofs(EspContext& context, RoofRecords& given) : records(given) {
    const std::vector<ContextInfo>& contexts = context.town->contexts;
    for (size_t i = 0; i < std::min<size_t>(contexts.size(), kRoofLayers); ++i) {
        layers[i].fill = contexts[i].fill;
        const PlanLayer* layer = context.town->layers.find(contexts[i].name);
        if (layer) layers[i].texels.v = const_cast<float*>(layer->texels.data());
    }
    env.grids.v = given.grids.data();
    env.runs.v = given.runs.data();
    env.regions.v = given.regions.data();
    env.parts.v = given.parts.data();
    env.planes.v = given.planes.data();
    env.meshes.v = context.roofBounds.data();
    env.layers.v = layers;
    env.plots.v = given.plots.data();
    env.site = context.town->layers.site();
}

bool TownRoofs::stands(const RoofGrid& grid) const {
    return records.plots[grid.house & 0xFFFFFFu].generation == grid.house >> 24;
}

EspResult materialiseTown(EspContext& context, std::vector<std::byte>& vertices, std::vector<std::byte>& indices) {
    if (!context.town || !context.roofs || context.town->view.gridCount == 0) return ESP_OK;
    if (!townGrammar(context)) return ESP_OK;  // destroyed: the roofs go with the next espUpdate
    Result<RoofRecords> records = context.roofs->read();
    if (!records) return failGpu(&context, records.failure());
    const TownRoofs roofs(context, *records);
    const size_t plants = vertices.size() + indices.size();
    RoofTriangles part;
    for (const RoofGrid& grid : records->grids) {
        if (!roofs.stands(grid)) continue;
        part.positions.clear();
        part.normals.clear();
        part.colours.clear();
        part.indices.clear();
        const bool all = appendGrid(roofs.env, grid, *context.roofMeshes, part, 2 * kMostBytes);
        if (!all || vertices.size() + indices.size() - plants + part.positions.size() * 16 + part.indices.size() * 4 >
                        kMostBytes)
            return fail(&context, ESP_OUT_OF_MEMORY, "espMaterialise: the town's triangles are more than 2 GiB");
        const uint32_t first = uint32_t(vertices.size() / sizeof(TriangleVertex));
        for (size_t i = 0; i < part.positions.size(); ++i)
            append(vertices, TriangleVertex{part.positions[i], packOct(part.normals[i])});
        for (uint32_t index : part.indices) append(indices, first + index);
    }
    return ESP_OK;
}

}  // namespace espalier
