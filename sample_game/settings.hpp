#pragma once

#include <string>
#include <vector>

#include "sample_game/workspace.hpp"

namespace sample {

// Where the editor keeps what belongs to the user and not to a project: $XDG_CONFIG_HOME/espalier, or the like below
// $HOME. Empty where the system names no such place; nothing is remembered then.
std::string configFolder();
std::string cacheFolder();

// What doesn't exist or can't be read leaves the layout as it is.
void readLayout(Layout& layout, Brush& brush);
void writeLayout(const Layout& layout, const Brush& brush);

// Values of a grammar's parameters under a name.
std::vector<std::string> presetNames(const std::string& grammar);
bool readPreset(const std::string& grammar, const std::string& name, std::vector<espalier::document::Param>& params,
                std::string& error);
bool writePreset(const std::string& grammar, const std::string& name,
                 const std::vector<espalier::document::Param>& params, std::string& error);

}  // namespace sample
