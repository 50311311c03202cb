#pragma once

#include <string>
#include <vector>

#include "sample_game/workspace.hpp"

namespace sample {

// What doesn't exist or can't be read leaves the layout as it is. What is damaged is told in `error`, and kept beside
// the file, since writeLayout() takes its place.
void readLayout(Layout& layout, Brush& brush, std::string& error);
void writeLayout(const Layout& layout, const Brush& brush);

// Values of a grammar's parameters under a name, for all grammars whose files have the same one.
std::string presetsOf(const std::string& grammarFile);
std::vector<std::string> presetNames(const std::string& grammar);
std::string presetCalled(std::string wanted);  // what it is called in the end, for it is a file's name, too
bool readPreset(const std::string& grammar, const std::string& name, std::vector<espalier::document::Param>& params,
                std::string& error);
// Those that come with a grammar, in presets/NAME/ beside NAME.grammar.
std::vector<std::string> shippedPresets(const std::string& grammarFile);
bool readShippedPreset(const std::string& grammarFile, const std::string& name,
                       std::vector<espalier::document::Param>& params, std::string& error);
// Where their pictures are, whether there are any or not.
std::string presetPicture(const std::string& grammar, const std::string& name);
std::string shippedPresetPicture(const std::string& grammarFile, const std::string& name);
// Takes the place of one of the same name, whose picture goes.
bool writePreset(const std::string& grammar, const std::string& name,
                 const std::vector<espalier::document::Param>& params, std::string& error);
// A name that another one has is refused.
bool renamePreset(const std::string& grammar, const std::string& name, const std::string& wanted, std::string& error);
// The one that was removed last is kept aside: what it was called, empty if there is none, and its way back.
bool removePreset(const std::string& grammar, const std::string& name, std::string& error);
std::string removedPreset(const std::string& grammar);
bool restorePreset(const std::string& grammar, std::string& error);

}  // namespace sample
