#pragma once

#include <string>

namespace espalier::scene {

// Where programs keep what belongs to the user and not to a project: settings in $XDG_CONFIG_HOME/espalier, what can be
// made again in $XDG_CACHE_HOME/espalier, or the like below $HOME. Empty where the system names no such place; nothing
// is kept then.
std::string configFolder();
std::string cacheFolder();

}  // namespace espalier::scene
