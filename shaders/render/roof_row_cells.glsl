// What becomes of a row's cells; counting and writing go through the same decisions.
#ifndef ESPALIER_ROOF_ROW_CELLS_GLSL
#define ESPALIER_ROOF_ROW_CELLS_GLSL
#include "shaders/emit/sight.h"
#include "shaders/render/roof_clarity.glsl"
#include "shaders/shared/roof_cells.h"

// A cell outside of its row's run of whole ones. `whole`: nothing cuts it after all. Otherwise rectangleCuts are what the
// grid's rectangle takes, to be joined to what each part takes.
struct CellFate {
    bool whole;
    uint rectangleCuts;
};
CellFate cellFate(RoofDrawEnv env, RoofGrid g, RoofMesh mesh, uint column, uint row) {
    CellBox box = cellBox(g, mesh, column, row);
    CellFate fate = {};
    fate.rectangleCuts = 0u;
    if ((g.mesh & kGridRect) != 0u) {
        if (box.low.x < -kCellSlack) fate.rectangleCuts |= kCutLeft;
        if (box.high.x > g.extent.x + kCellSlack) fate.rectangleCuts |= kCutRight;
        if (box.high.y > g.extent.y + kCellSlack) fate.rectangleCuts |= kCutUpper;
    }
    fate.whole = fate.rectangleCuts == 0u;
    if (g.region == kNoIndex) return fate;
    RoofRegion r = env.roofs.regions.v[g.region];
    bool met = false;
    for (uint i = 0u; i < r.partCount; ++i) {
        RoofPart part = env.roofs.parts.v[r.firstPart + i];
        uint cuts = partCuts(env.roofs, g, r, part, box);
        if (cuts == kPartMissed) continue;
        met = true;
        if ((cuts & ((1u << ((part.counts >> 8u) & 255u)) - 1u)) != 0u) fate.whole = false;
    }
    fate.whole = fate.whole && met;
    return fate;
}
// The planes that part i takes off a cell; kPartMissed if there is nothing of it.
uint partPlanes(RoofDrawEnv env, RoofGrid g, RoofRegion r, uint i, CellBox box) {
    return partCuts(env.roofs, g, r, env.roofs.parts.v[r.firstPart + i], box);
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
