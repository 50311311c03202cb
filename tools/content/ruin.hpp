#pragma once

// The sample model: a ruined courtyard. One connected surface: ground, walls with an arch, columns, an urn,
// fallen stones; open only at the rim of the ground.

#include "tools/content/model.hpp"

namespace espalier::content {

struct Ruin {
    std::vector<Chart> charts;
    Assembly assembly;
    Painted painted;
};

// textureSize: of colour and normals, a power of two; the layers have half of it.
Ruin makeRuin(int textureSize);

// Height of the ground at (x, z) of the block-out, metres, without its relief.
float groundHeight(glm::vec2 xz);

// Metres from (x, z) to what stands on the ground, roughly, and how much of it the court's paving and grass cover
// there.
float footDistance(glm::vec2 xz);
float pavedShare(glm::vec2 xz);
float grassShare(glm::vec2 xz);

// From the block-out to where it stands: leaning walls, ground that rises to their foot.
glm::vec3 settle(glm::vec3 block);

// The parts, appended to `charts`. Footprints are the loops that each leaves in the ground, in (x, z), with
// exactly the points of its foot.
using Loop = std::vector<glm::vec2>;
void addWalls(std::vector<Chart>& charts, std::vector<Loop>& footprints);
void addColumns(std::vector<Chart>& charts, std::vector<Loop>& footprints);
void addGround(std::vector<Chart>& charts, const std::vector<Loop>& footprints);

}  // namespace espalier::content
