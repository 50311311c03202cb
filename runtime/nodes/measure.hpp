#pragma once

#include <array>

#include "runtime/nodes/machine.hpp"

namespace espalier {

struct NodeBox {
    glm::vec3 low{0}, high{0};
};

// A box around each part as its program leaves it. Of instances it may be a little too small where steps behind them
// bend them.
Result<std::vector<NodeBox>> measure(NodeMachine& machine, const Geometry& parts);

}  // namespace espalier
