#pragma once

// The roofs of the town (api_roof.cpp), their layers (town_layers.cpp) and triangles (town_triangles.cpp).

#include <cstddef>
#include <string>
#include <vector>

#include "runtime/plugin/context.hpp"

namespace espalier {

// Names of the meshes that grammars of roofs may ask for; reads their file the first time. Where that fails (IO_FAILED,
// INVALID_CONTENT) `why` says why, and nothing is logged.
EspResult knowRoofMeshes(EspContext& context, std::string& why);
// Grows what has changed of the town; on failure the last roofs stand, and what changed waits.
EspResult updateTown(EspContext& context);
// Null: there is no town, or none that it grows by.
const LoadedGrammar* townGrammar(const EspContext& context);
// What the town's roofs read where nothing of the layer is painted.
float fillOverTown(const EspContext& context, const std::string& name);
// Gives roofs the town's layers, and adds to LoadedTown::changed the houses that have read what was painted since.
void bindTownLayers(EspContext& context, RoofInputs& inputs);
// What grids are cut by, of the town as it stands. Refers to `records` and to the context.
struct TownRoofs {
    TownRoofs(EspContext& context, RoofRecords& records);
    TownRoofs(const TownRoofs&) = delete;
    TownRoofs& operator=(const TownRoofs&) = delete;
    bool stands(const RoofGrid& grid) const;  // else its house has grown anew since

    const RoofRecords& records;
    RoofLayer layers[kRoofLayers] = {};
    RoofEnv env{};
};
// Adds the town's roofs to what espMaterialise gives: TriangleVertex, uint32_t.
EspResult materialiseTown(EspContext& context, std::vector<std::byte>& vertices, std::vector<std::byte>& indices);
// The number by which the town's grammar knows the layer; kNoIndex.
uint32_t shownTownLayer(const EspContext& context, const std::string& name);

}  // namespace espalier
