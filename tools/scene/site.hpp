#pragma once

#include <string>

#include "plugin_api/espalier.h"

namespace espalier::scene {

// Furnishes a scene by a site's file (docs/scene_format.md): props, and what lies on the ground. `error` tells file,
// place and cause.
bool furnish(EspContext* context, const std::string& file, std::string& error);

}  // namespace espalier::scene
