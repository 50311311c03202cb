#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A far grid as one rectangle a part of its region; a row of caps as the two sides of a small roof.
#include "shaders/render/frame.glsl"
#include "shaders/render/roof_clarity.glsl"
#include "shaders/render/roof_place.glsl"

layout(push_constant, scalar) uniform Data { RoofDrawPush push; };
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 surface;      // in cells along x and y, 1: battens below tiles, tint
layout(location = 3) flat out uvec4 look;   // colour, key, bond, RoofGrid::mesh
layout(location = 4) flat out vec3 lean;    // of the normal at a slope of 1 of the profile
out float gl_ClipDistance[8];

void main() {
    RoofDrawEnv env = push.env.v[0];
    uint vertex = uint(gl_VertexIndex);
    RoofTile item = env.rectangles.v[vertex / 6u];
    bool below = (item.grid & kRectangleBelow) != 0u;
    RoofGrid g = env.roofs.grids.v[item.grid & ~kRectangleBelow];
    uint corner = vertex % 6u;
    vec2 share = vec2(corner == 1u || corner == 2u || corner == 4u ? 1.0 : 0.0, corner == 2u || corner == 4u || corner == 5u ? 1.0 : 0.0);
    // Where nothing repeats, what the mesh covers; else all cells.
    RoofMesh mesh = env.roofs.meshes.v[g.mesh & 255u];
    uvec2 cells = uvec2(g.cells & 0xFFFFu, g.cells >> 16u);
    vec2 low = vec2(0.0);
    vec2 high = min(g.extent, g.step * vec2(cells));
    float lift = (env.flags & kRoofShadow) != 0u ? -0.04 : below ? 0.0 : 0.01;   // cells don't shade themselves; battens end 6 mm below
    float base = lift;
    lift += 4.0 * min(mesh.high.z, 0.0);   // what lies below tiles stays there
    if (cells.y == 1u) {
        low.y = mesh.low.y * g.size.y;
        high.y = mesh.high.y * g.size.y;
        lift = mesh.high.z * g.thickness * (below ? 0.4 : 0.7);
    }
    if (cells.x == 1u) {
        low.x = mesh.low.x * g.size.x;
        high.x = mesh.high.x * g.size.x;
    }
    vec3 at = vec3(mix(low, high, share), lift);
    normal = cross(g.axisX, g.axisY);
    if (item.cell == kCapLow || item.cell == kCapHigh) {
        bool inner = (share.y > 0.5) == (item.cell == kCapLow);
        float edge = item.cell == kCapLow ? low.y : high.y;
        // Its eaves go into the roof, so that nobody looks under it.
        at.yz = (inner ? vec2(0.0, below ? 0.85 : 0.95) : vec2(edge, -0.3)) * vec2(1.0, mesh.high.z * g.thickness);
        at.z += min(base, 0.0);
        normal = capNormal(g, mesh, edge);
    }
    vec3 onPlot = gridPoint(g, at);
    position = inWorld(env, g, onPlot);
    surface = vec4(at.xy / max(g.step, vec2(1e-3)), mesh.high.z < 0.0 && cells.y > 1u ? 1.0 : 0.0, float(g.colour >> 24u) * (1.0 / 255.0));
    lean = -g.axisX * (g.thickness / max(g.size.x, 1e-3));
    look = uvec4(g.colour & 0xFFFFFFu, uint(g.key), (g.mesh & kGridBond) != 0u ? 1u : 0u, g.mesh);
    gl_Position = frame.viewProjection * vec4(position, 1.0);
    uint count = item.cell >= kCapLow ? 0u : env.roofs.parts.v[item.cell].counts & 255u;
    for (uint i = 0u; i < 8u; ++i)
        gl_ClipDistance[i] = i < count ? planeDistance(env, g, item.cell, i, onPlot, at) : 1.0;
}
