#pragma once

#include <glm/glm.hpp>

namespace espalier {

// What a float leaves out of a position: an origin that goes far away and comes back finds the position as it was.
struct Remainder {
    glm::vec3 of{0};  // the position that it belongs to: none, if that has been set since
    glm::dvec3 rest{0};
};

// The position as the world's origin has moved by so much.
inline void shift(glm::vec3& position, Remainder& remainder, const glm::dvec3& by) {
    const bool known = remainder.of == position;
    for (int k = 0; k < 3; ++k) {
        const double exact = double(position[k]) + (known ? remainder.rest[k] : 0) - by[k];
        const volatile float rounded = float(exact);  // GCC 12, where it makes vectors of this, leaves the rounding out
        remainder.of[k] = rounded;
        remainder.rest[k] = exact - double(remainder.of[k]);
    }
    position = remainder.of;
}

}  // namespace espalier
