#pragma once

#include <string>

#include "tools/document/action.hpp"
#include "tools/scene/scene.hpp"

namespace espalier::document {

// Values of parameters, as actions and as scenes have them.
Param paramOf(const scene::ParamValue& value);
scene::ParamValue valueOf(const Param& param);
bool hasParam(const EspContext* context, EspGrammar grammar, const std::string& name);

}  // namespace espalier::document
