#pragma once

#include <string>

namespace espalier::scene {

// What the label of a grammar's parameter says: "Leaves / Spacing. Less is denser" is the slider "Spacing" of the group
// "Leaves", and tells "Less is denser". Group and tip may be missing.
struct ParamWords {
    std::string group, name, tip;
};
ParamWords paramWords(const std::string& label);

// Whether all of the words that `wanted` has are in the text, in whatever case of ASCII's letters. Of "": yes.
bool holdsWords(const std::string& text, const std::string& wanted);

}  // namespace espalier::scene
