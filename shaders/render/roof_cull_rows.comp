#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A row of cells each: its bucket, and how many whole and cut cells it adds to that.
#include "shaders/render/roof_place.glsl"
#include "shaders/render/roof_row_cells.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { RoofCullPush push; };

void main() {
    RoofDrawEnv env = push.env.v[0];
    uint i = gl_GlobalInvocationID.x;
    if (i >= min(env.state.v[0].rows, env.rowRoom)) return;
    RoofRow item = env.rows.v[i];
    RoofGrid g = env.roofs.grids.v[item.grid];
    RoofRun run = runOf(env, g, item.row);
    env.rows.v[i].bucket = kNoBucket;
    if (runCount(run.touched) == 0u) return;
    EmitView view = env.view.v[0];
    vec3 from = inWorld(env, g, g.origin + g.axisY * (float(item.row) * g.step.y) + g.axisX * (float(runFirst(run.touched)) * g.step.x));
    vec3 along = g.axisX * (float(runCount(run.touched)) * g.step.x);
    float reach = 0.5 * length(along) + max(g.size.x, g.size.y) + g.thickness;
    vec3 center = from + 0.5 * along;
    if (outside(view, center, reach)) return;
    // The nearest point of the row decides the level of detail of all its cells.
    float t = clamp(dot(view.eye - from, along) / max(dot(along, along), 1e-9), 0.0, 1.0);
    float far = view.parallel != 0u ? 1.0 : max(distance(view.eye, from + along * t) - max(g.size.x, g.size.y), 0.05);
    float pixels = view.pixelScale / far * max(g.size.x, g.size.y);
    VariantRecord variant = env.table.v[0].variants[env.table.v[0].kinds[g.mesh & 255u].firstVariant];
    uint lod = variant.lodCount - 1u;
    while (lod > 0u && variant.error[lod] * pixels > view.lodPixels) --lod;
    uint bucket = variant.firstBucket + lod;
    float share = 1.0;
    if (g.firstRow != kNoIndex) {
        float away = view.parallel != 0u ? 1.0 : max(distance(view.eye, center), 0.05);
        share = clamp((cellClarity(env, view, g, center, away) - 1.0) / (kFadeEnd - 1.0), 0.0, 1.0);
    }
    env.rows.v[i].share = share;
    bool drops = share < 1.0 || mayDrop(env.roofs, g);
    uint whole = drops ? 0u : runCount(run.whole);
    uint cut = 0u;
    RoofMesh mesh = env.roofs.meshes.v[g.mesh & 255u];
    CellSpace space = spaceOf(env.roofs, g);
    for (uint k = 0u; k < runCount(run.touched); ++k) {
        uint column = runFirst(run.touched) + k;
        if (drops && cellHidden(env, g, share, column, item.row)) continue;
        if (column - runFirst(run.whole) < runCount(run.whole)) {
            whole += drops ? 1u : 0u;
            continue;
        }
        CellFate fate = cellFate(env, g, space, mesh, column, item.row);
        whole += fate.whole ? 1u : 0u;
        cut += fate.whole ? 0u : g.region == kNoIndex ? 1u : fate.parts;
    }
    env.rows.v[i].bucket = bucket;
    env.rows.v[i].wholePlace = whole > 0u ? atomicAdd(env.state.v[0].whole[bucket], whole) : 0u;
    env.rows.v[i].cutPlace = cut > 0u ? atomicAdd(env.state.v[0].cut[bucket], cut) : 0u;
}
