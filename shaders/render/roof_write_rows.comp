#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// The seen rows' cells as instances, each bucket's together.
#include "shaders/render/roof_row_cells.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { RoofCullPush push; };

void main() {
    RoofDrawEnv env = push.env.v[0];
    uint i = gl_GlobalInvocationID.x;
    if (i >= min(env.state.v[0].rows, env.rowRoom)) return;
    RoofRow item = env.rows.v[i];
    if (item.bucket == kNoBucket) return;
    RoofGrid g = env.roofs.grids.v[item.grid];
    RoofMesh mesh = env.roofs.meshes.v[g.mesh & 255u];
    RoofRun run = runOf(env, g, item.row);
    uint whole = env.state.v[0].wholeStarts[item.bucket] + item.wholePlace;
    uint cut = env.state.v[0].cutStarts[item.bucket] + item.cutPlace;
    bool drops = item.share < 1.0 || mayDrop(env.roofs, g);
    CellSpace space = spaceOf(env.roofs, g);
    for (uint k = 0u; k < runCount(run.touched); ++k) {
        uint column = runFirst(run.touched) + k;
        if (drops && cellHidden(env, g, item.share, column, item.row)) continue;
        uint cell = column | (item.row << 16u);
        CellFate fate = {};
        fate.whole = column - runFirst(run.whole) < runCount(run.whole);
        if (!fate.whole) fate = cellFate(env, g, space, mesh, column, item.row);
        if (fate.whole) {
            if (whole < env.tileRoom) env.tiles.v[whole] = RoofTile(item.grid, cell);
            whole += 1u;
        } else if (g.region == kNoIndex) {
            if (cut < env.cutRoom) env.cuts.v[cut] = RoofCutTile(item.grid, cell, kNoIndex, fate.rectangleCuts);
            cut += 1u;
        } else {
            uint first = env.roofs.regions.v[g.region].firstPart;
            uint end = first + env.roofs.regions.v[g.region].partCount;
            CellBox box = cellBox(g, mesh, column, item.row);
            for (uint p = first; p < end; ++p) {
                uint planes = partCuts(env.roofs, space, env.roofs.parts.v[p], box);
                if (planes == kPartMissed) continue;
                if (cut < env.cutRoom)
                    env.cuts.v[cut] = RoofCutTile(item.grid, cell, p, planes | fate.rectangleCuts);
                cut += 1u;
            }
        }
    }
}
