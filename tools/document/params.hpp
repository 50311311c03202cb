#pragma once

#include <string>

#include "tools/document/action.hpp"
#include "tools/scene/scene.hpp"

namespace espalier::document {

// Values of parameters, as actions and as scenes have them.
Param paramOf(const scene::ParamValue& value);
scene::ParamValue valueOf(const Param& param);
// Whether the grammar has a parameter of the value's name and kind.
bool takesParam(const EspContext* context, EspGrammar grammar, const scene::ParamValue& value);

}  // namespace espalier::document
