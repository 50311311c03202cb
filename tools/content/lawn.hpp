#pragma once

// What the lawn about the court is made of: no gardener tends it evenly.

#include <glm/glm.hpp>

namespace espalier::content {

// Shares at a place, x and z in metres.
struct Lawn {
    float bare;    // scraped to the earth
    float clover;  // which keeps grass low
    float tall;    // left to grow
};
Lawn lawnAt(glm::vec2 p);

}  // namespace espalier::content
