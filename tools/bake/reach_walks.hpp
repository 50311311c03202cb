#pragma once

// What walks meet on a finished surface: an area that is one by all crossings may still have borders that lead nowhere.

#include <span>
#include <vector>

#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {

// Where a walk begins, and which piece it counts for.
struct WalkStart {
    glm::vec2 uv;
    uint32_t chart, piece;
};

// Of each piece the walks that began there, and those that ended farther than three texels from any
// border of the model: an edge of one triangle alone that nothing else touches, or of bare ground.
struct WalkEnds {
    uint32_t walks = 0, ended = 0;
};
std::vector<WalkEnds> walkAbout(const BakeMesh& mesh, const SurfaceData& surface, std::span<const WalkStart> starts,
                                uint32_t pieces);

}  // namespace espalier::bakery
