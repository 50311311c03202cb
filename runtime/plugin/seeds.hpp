#pragma once

// Seeds (api_seeds.cpp), their plants (api_plants.cpp) and the grammars that these grow by (grammar_variants.cpp).

#include <span>

#include "runtime/plugin/context.hpp"

namespace espalier {

// The root of a seed's derivation path. Doesn't depend on other seeds or grammars.
uint64_t seedKey(const PlantedSeed& seed);
// Takes a seed out, and all notes of it.
void removeSeed(EspContext& context, uint32_t id);
// Whether a streamed surface is away that the seed, or its frozen plant, stands on. Then it waits.
bool isAway(const EspContext& context, const PlantedSeed& seed);
// The plants as last grown, read back if that is still to do. `out` belongs to the context.
EspResult readPlants(EspContext& context, const Plants*& out);
// Makes the variants that seeds ask for, and brings up to date those whose grammar has changed.
Status refreshVariants(EspContext& context);
// Notes for the next growth what grows otherwise by these rules than by those that stood in their place. index: among
// growth's grammars.
struct BoundRules {
    const RuleMap& map;
    std::span<const uint32_t> layerOf;  // scene layer of each of the map's contexts
};
void noteRules(EspContext& context, uint32_t index, const BoundRules& before, const BoundRules& now);

}  // namespace espalier
