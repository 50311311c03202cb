#pragma once

// Where surfaces touch, and what that means for plants.

#include <vector>

#include "runtime/plugin/context.hpp"

namespace espalier {

// Lets frozen plants grow again that have grown on a surface instance; with `across` only those that stand on others
// too.
void thawPlantsOn(EspContext& context, uint32_t instance, bool across);
// Adds the surfaces that plants on these may get to, over any number of contacts: [instance].
void addReached(const EspContext& context, std::vector<bool>& instances);
// Finds contacts between surfaces that came, went or moved, and gives them to the surfaces' GPU data.
Status refreshContacts(EspContext& context);
// Does another surface hide a seed's ground, within a solid body or beneath a face that lies on it? Such seeds wait. As
// surfaces stood at the last refreshContacts; costs microseconds where bodies are near, else next to nothing.
bool buriedByOthers(const EspContext& context, const PlantedSeed& seed);

}  // namespace espalier
