#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace espalier {

struct PlanBox {
    glm::vec2 low{0}, high{0};  // metres
};

// Which of a town's houses an overview shows: those in the square where most houses stand close together, at most two
// kilometres wide. A town that has no far-off houses is shown whole; so is one house. Returns indices in rising order.
std::vector<size_t> densePart(std::span<const PlanBox> houses);

}  // namespace espalier
