#pragma once

#include "runtime/plugin/context.hpp"

namespace espalier {

// Gives a renderer that is new the props and the map of the site.
EspResult furnishAgain(EspContext& context);

}  // namespace espalier
