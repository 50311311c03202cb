#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>

#include "plugin_api/espalier.h"

namespace espalier::exporting {

// A place as glTF has it.
struct Placing {
    glm::vec3 move, scale;
    glm::quat turn;
};
Placing placingOf(const EspTransform& transform);

// What a node says of its place; empty: nothing, it is the identity.
std::string placeText(const EspTransform& transform);

}  // namespace espalier::exporting
