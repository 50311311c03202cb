#pragma once

// A town as triangles in memory: its walls and roof planes, or every tile that a grammar has made.

#include <vector>

#include "runtime/emit/terminals.hpp"
#include "runtime/roof/roof_growth.hpp"

namespace espalier {

struct TownMesh {
    std::vector<glm::vec3> positions, normals;  // world, metres
    std::vector<uint32_t> colours;              // 0xAABBGGRR, linear
    std::vector<uint32_t> indices;              // counterclockwise from outside
};

// Walls and roof planes of one house, watertight but for its foot.
void appendMassing(const RoofStructure& structure, uint32_t house, TownMesh& out);

// All cells of a grid (Buron 2013 §3.3): those that an outline crosses are cut by exact polygon clipping, part by part.
// env: of the records, as drawing reads them; meshes by the numbers that the grammar was compiled with, of which the
// finest level is written.
void appendGrid(const RoofEnv& env, const RoofGrid& grid, const TerminalData& meshes, TownMesh& out);

}  // namespace espalier
