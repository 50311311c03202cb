#pragma once

// What is painted on the ruin's walls. p: metres, (along, y) of their elevation.

#include "tools/content/masonry.hpp"

namespace espalier::content {

inline constexpr glm::vec2 kTondo{-1.62f, 2.05f};  // its middle

// The painted path: up the wall beside the arch, over its voussoirs, down on the other side; a second one to the crest.
float mainMask(glm::vec2 p, const Elevation& wall);

// Where the sample wants ivy on the front: none round the tondo, plenty over the arch.
float frontIvy(glm::vec2 p, const Elevation& wall);

// On the back it keeps to tongues: one that winds up to the crest, one by the corner, those beside the arch. They thin
// out towards ragged borders.
float backIvy(glm::vec2 p);

// Outside the return wall: a curtain that parts towards the corner. p.x: towards the court's open side.
float outerIvy(glm::vec2 p);

}  // namespace espalier::content
