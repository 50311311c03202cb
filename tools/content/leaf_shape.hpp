#pragma once

// The outline and veins of an ivy leaf laid flat, shared by its mesh and its texture.

#include <glm/glm.hpp>
#include <vector>

namespace espalier::content {

// Flat leaf coordinates: the stalk starts at (0, 0), the blade begins at (0, base), the tip is at (0, 1).
struct LeafShape {
    float base = 0.28f;
    std::vector<glm::vec2> outline;             // of the blade, counter-clockwise, closed, fine
    std::vector<std::vector<glm::vec2>> veins;  // main veins from the blade's base to the lobes' tips
    std::vector<std::vector<glm::vec2>> ribs;   // side veins
    float halfWidth = 0.55f;                    // bound of |x|
};
LeafShape leafShape(int variant);

// Signed distance to the blade or stalk, positive inside.
float leafDistance(const LeafShape& shape, glm::vec2 p);

inline constexpr float kStalkHalfWidth = 0.012f;

// The part of the atlas that a variant's upper side fills; the back is half the atlas lower.
glm::vec2 leafUv(int variant, glm::vec2 p);
glm::vec2 leafPoint(int variant, glm::vec2 uv);

}  // namespace espalier::content
