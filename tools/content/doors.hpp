#pragma once

// Where a town's grammar puts doors, so that a site can lead paths to them.

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "runtime/core/result.hpp"

namespace espalier::content {

struct Door {
    glm::vec2 at;   // its sill's middle, world x and z, metres
    glm::vec2 out;  // away from the wall, unit
};

// town: a file of footprints; grammar: of roofs, with `door` among its terminals. Upper storeys have none.
Result<std::vector<Door>> findDoors(const std::string& town, const std::string& grammar);

}  // namespace espalier::content
