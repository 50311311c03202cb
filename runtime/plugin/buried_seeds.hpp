#pragma once

#include "runtime/plugin/context.hpp"

namespace espalier {

// Does another surface hide a seed's ground, within a solid body or beneath a face that lies on it? Such seeds wait. As
// surfaces stood at the last refreshContacts; costs microseconds where bodies are near, else next to nothing.
bool buriedByOthers(const EspContext& context, const PlantedSeed& seed);

}  // namespace espalier
