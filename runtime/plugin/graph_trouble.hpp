#pragma once

#include <string>

#include "runtime/nodes/evaluation.hpp"

struct EspContext;

namespace espalier {

// What a node asks for in vain.
struct GraphTrouble {
    std::string node;
    std::string why;
};

}  // namespace espalier
