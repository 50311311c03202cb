#pragma once

// Roofs as triangles in memory, for those who ask: export, physics, ray tracing.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/emit/terminals.hpp"
#include "runtime/roof_growth/roof_data.hpp"

namespace espalier {

struct RoofTriangles {
    // Whole cells, where they are wanted apart: the mesh goes there by these columns. Those that taper never are.
    struct Cell {
        glm::vec3 x, y, z, origin;
    };
    bool cellsApart = false;
    std::vector<Cell> cells;
    std::vector<glm::vec3> positions, normals;  // world, metres
    std::vector<uint32_t> colours;              // 0xAABBGGRR, linear
    std::vector<uint32_t> indices;              // counterclockwise from outside

    size_t bytes() const { return positions.size() * 28 + indices.size() * 4; }
};

// Bounds of meshes by kind, of their finest level.
std::vector<RoofMesh> terminalBounds(const TerminalData& data);

// All cells of a grid that no layer takes away (Buron 2013 §3.3): those that an outline crosses are cut by exact
// polygon clipping, part by part. env: of the records, as drawing reads them; meshes by the numbers that the grammar
// was compiled with, of which the finest level is written. False: it has stopped, since `out` is more than `most`
// bytes.
bool appendGrid(const RoofEnv& env, const RoofGrid& grid, const TerminalData& meshes, RoofTriangles& out,
                size_t most = SIZE_MAX);

}  // namespace espalier
