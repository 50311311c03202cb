#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A grid each: is it seen, and as cells or as a pattern? Cells' rows are listed for cull_rows.
#include "shaders/emit/sight.h"
#include "shaders/render/roof_clarity.glsl"
#include "shaders/render/roof_place.glsl"
#include "shaders/shared/dispatch.glsl"

const float kLeastCaster = 0.25;   // metres: what stands out of its wall or roof by less casts no shadow worth a mesh

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { RoofCullPush push; };

void main() {
    RoofDrawEnv env = push.env.v[0];
    uint i = itemIndex();
    if (i >= env.gridCount) return;
    RoofGrid g = env.roofs.grids.v[i];
    if ((g.house >> 24u) != env.roofs.plots.v[g.house & 0xFFFFFFu].generation) return;
    if (env.table.v[0].kinds[g.mesh & 255u].variantCount == 0u) return;
    bool many = g.firstRow != kNoIndex;
    vec2 size = many ? min(g.extent, g.step * vec2(g.cells & 0xFFFFu, g.cells >> 16u)) : g.size;
    // Meshes may stand out of their cells.
    RoofMesh mesh = env.roofs.meshes.v[g.mesh & 255u];
    vec3 low = vec3(min(mesh.low.xy, vec2(0.0)) * g.size, mesh.low.z * g.thickness);
    vec3 high = vec3(size + max(mesh.high.xy - 1.0, vec2(0.0)) * g.size, mesh.high.z * g.thickness);
    vec3 middle = 0.5 * (low + high);
    vec3 center = inWorld(env, g, g.origin + g.axisX * middle.x + g.axisY * middle.y + cross(g.axisX, g.axisY) * middle.z);
    float reach = 0.5 * length(high - low) + max(abs(g.taper.x), abs(g.taper.y));
    EmitView view = env.view.v[0];
    if (outside(view, center, reach) || hidden(view, center, reach)) return;
    float far = view.parallel != 0u ? 1.0 : max(distance(view.eye, center) - reach, 0.05);
    float pixels = view.pixelScale / far;
    if (pixels * max(size.x, size.y) < 0.7) return;
    bool shadow = (env.flags & kRoofShadow) != 0u;
    bool small = many && cellClarity(env, view, g, center, far) < 1.0;
    bool apart = many && standApart(g);
    if (apart && (small || (shadow && mesh.high.z * g.thickness < kLeastCaster))) return;
    bool pattern = !apart && (small || (many && shadow));
    // Cells go over into their pattern one by one, the furthest first.
    bool below = many && !apart && !pattern && cellClarity(env, view, g, center, far + 2.0 * reach) < kFadeEnd;
    if (pattern || below) {
        uint first = 0u;
        uint count = 1u;
        if (g.region != kNoIndex) {
            first = env.roofs.regions.v[g.region].firstPart;
            count = env.roofs.regions.v[g.region].partCount;
        }
        bool caps = g.region == kNoIndex && overRidge(g, env.roofs.meshes.v[g.mesh & 255u]);
        count = caps ? 2u : count;
        uint at = atomicAdd(env.state.v[0].rectangles, count);
        for (uint p = 0u; p < count && at + p < env.rectangleRoom; ++p)
            env.rectangles.v[at + p] = RoofTile(below ? i | kRectangleBelow : i,
                                                caps ? kCapLow + p : g.region != kNoIndex ? first + p : kNoIndex);
        if (pattern) return;
    }
    uint rows = g.cells >> 16u;
    uint at = atomicAdd(env.state.v[0].rows, rows);
    for (uint r = 0u; r < rows && at + r < env.rowRoom; ++r) {
        env.rows.v[at + r].grid = i;
        env.rows.v[at + r].row = r;
        if (((at + r) & 63u) == 0u) atomicAdd(env.state.v[0].rowGroups[0], 1u);
    }
}
