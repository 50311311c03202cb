// Puts the ruin together. In: nothing but the texture size. Out: charts, mesh, atlas and painted textures.

#include "tools/content/ruin.hpp"

namespace espalier::content {

Ruin makeRuin(int textureSize) {
    Ruin ruin;
    std::vector<Loop> footprints;
    addWalls(ruin.charts, footprints);
    addColumns(ruin.charts, footprints);
    addGround(ruin.charts, footprints);
    ruin.assembly = assemble(ruin.charts, settle, 1.0f / 72);
    ruin.painted = paint(ruin.charts, ruin.assembly, textureSize, textureSize / 2);
    return ruin;
}

}  // namespace espalier::content
