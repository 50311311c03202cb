#pragma once

#include <string>
#include <vector>

#include "tools/scene/scene.hpp"

namespace sample {

// What the compiler says of a grammar's text.
struct Remark {
    int line = 0;  // of the text, from 1; 0: of the whole or of a file that it includes
    bool warning = false;
    std::string text;  // a line
};

// Mistakes first, then warnings, each in the order of the compiler.
std::vector<Remark> remarksOf(const espalier::scene::LoadedGrammar& grammar);

}  // namespace sample
