#pragma once

// Building blocks of props: flat-shaded boxes and turned bodies whose texture coordinates pick colours of the palette.

#include <span>

#include "tools/content/props.hpp"

namespace espalier::content {

class Builder {
  public:
    Mesh mesh;

    // Counterclockwise from outside.
    void quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, Paint paint, float bright);
    void triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c, Paint paint, float bright);
    // A box whose upper side is drawn in by `taper`.
    void box(glm::vec3 low, glm::vec3 high, Paint paint, float bright, float taper = 0);

    // A turned body's axis; side: where its first corner lies, across `along`; both unit.
    struct Axis {
        glm::vec3 foot, along{0, 1, 0}, side{1, 0, 0};
    };
    struct Ring {
        float radius, height;
    };
    // Rings from the foot up, round about and creased where rings meet; a ring without radius closes an end. Staves
    // differ in brightness by as much as `uneven` says, a share.
    void turn(const Axis& axis, std::span<const Ring> rings, int sides, Paint paint, float bright, float uneven = 0);
    void turn(const Axis& axis, std::initializer_list<Ring> rings, int sides, Paint paint, float bright,
              float uneven = 0) {
        turn(axis, std::span(rings.begin(), rings.size()), sides, paint, bright, uneven);
    }
    // A pole between two points.
    void pole(glm::vec3 from, glm::vec3 to, float radius, int sides, Paint paint, float bright);
};

}  // namespace espalier::content
