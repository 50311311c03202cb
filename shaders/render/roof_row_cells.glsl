// What becomes of a row's cells; counting and writing go through the same decisions.
#ifndef ESPALIER_ROOF_ROW_CELLS_GLSL
#define ESPALIER_ROOF_ROW_CELLS_GLSL
#include "shaders/emit/sight.h"
#include "shaders/render/roof_clarity.glsl"
#include "shaders/shared/roof_cells.h"

// A cell outside of its row's run of whole ones. `whole`: nothing cuts it after all. Otherwise rectangleCuts are what the
// grid's rectangle takes, to be joined to what each part takes; parts: how many of its region's it reaches.
struct CellFate {
    bool whole;
    uint rectangleCuts, parts;
};
CellFate cellFate(RoofDrawEnv env, RoofGrid g, CellSpace space, RoofMesh mesh, uint column, uint row) {
    CellBox box = cellBox(g, mesh, column, row);
    CellFate fate = {};
    fate.rectangleCuts = 0u;
    fate.parts = 0u;
    if ((g.mesh & kGridRect) != 0u) {
        if (box.low.x < -kCellSlack) fate.rectangleCuts |= kCutLeft;
        if (box.high.x > g.extent.x + kCellSlack) fate.rectangleCuts |= kCutRight;
        if (box.high.y > g.extent.y + kCellSlack) fate.rectangleCuts |= kCutUpper;
    }
    fate.whole = fate.rectangleCuts == 0u;
    if (g.region == kNoIndex) return fate;
    uint first = env.roofs.regions.v[g.region].firstPart;
    uint count = env.roofs.regions.v[g.region].partCount;
    for (uint i = 0u; i < count; ++i) {
        RoofPart part = env.roofs.parts.v[first + i];
        uint cuts = partCuts(env.roofs, space, part, box);
        if (cuts == kPartMissed) continue;
        fate.parts += 1u;
        if ((cuts & ((1u << ((part.counts >> 8u) & 255u)) - 1u)) != 0u) fate.whole = false;
    }
    fate.whole = fate.whole && fate.parts != 0u;
    return fate;
}

// Gone by a layer, or left to the pattern below.
bool cellHidden(RoofDrawEnv env, RoofGrid g, float share, uint column, uint row) {
    if (share < 1.0 && float(roofCellHash(g.key, column, row) >> 16u) * (1.0 / 65536.0) >= share) return true;
    return mayDrop(env.roofs, g) && cellDropped(env.roofs, g, column, row);
}

RoofRun runOf(RoofDrawEnv env, RoofGrid g, uint row) {
    if (g.firstRow != kNoIndex) return env.roofs.runs.v[g.firstRow + row];
    RoofRun run = {};
    run.touched = 1u << 16u;
    run.whole = g.region == kNoIndex ? 1u << 16u : 0u;
    return run;
}
#endif
