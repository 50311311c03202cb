#pragma once

#include <cstdint>

#include "plugin_api/espalier.h"
#include "runtime/grammar/grammar.hpp"

struct EspContext;

namespace espalier {

// Gives a renderer that is new the meshes of all looks.
EspResult drawLooksAgain(EspContext& context);
// Has a map that was just compiled draw what its grammar's looks say.
void takeLooks(const EspContext& context, uint32_t grammar, RuleMap& map);

}  // namespace espalier
