// How clearly cells are seen: below 1 a pattern stands for all of them, from kFadeEnd on each is drawn.
#ifndef ESPALIER_ROOF_CLARITY_GLSL
#define ESPALIER_ROOF_CLARITY_GLSL
#include "shaders/render/roof_draw_records.h"

const float kFadeEnd = 1.7;
const float kReliefEnd = 2.6;   // from here on cells are lit as their meshes are; below ever more as the pattern is

const float kApartClarity = 2.2;   // what stands apart is drawn until it is so many times smaller than a pattern's cells

// Along an axis without neighbours a cell is as long as its mesh: caps stand on a segment, whose step is 0 across.
vec2 cellSides(RoofGrid g) {
    return vec2((g.cells & 0xFFFFu) > 1u ? g.step.x : g.size.x, (g.cells >> 16u) > 1u ? g.step.y : g.size.y);
}
// Things that stand apart, such as a storey's windows: a pattern would paint over what lies between them. They have levels
// of detail in its place.
bool standApart(RoofGrid g) {
    vec2 cell = cellSides(g);
    return g.cells == 0x10001u || g.size.x * g.size.y < 0.6 * cell.x * cell.y;
}

// pixels: of a metre there. lying: how little its plane is seen edge-on.
float cellClarity(RoofDrawEnv env, RoofGrid g, float pixels, float lying) {
    vec2 cell = cellSides(g);
    float clarity = pixels * max(min(cell.x, cell.y), 0.25 * max(cell.x, cell.y)) / env.leastCell;
    if (standApart(g)) return clarity * kApartClarity;
    if ((g.cells >> 16u) <= 1u) return clarity;
    // Courses seen edge-on would flicker long before they are small.
    return min(clarity, pixels * g.step.y * lying / 1.5);
}
float cellClarity(RoofDrawEnv env, EmitView view, RoofGrid g, vec3 at, float far) {
    float lying = view.parallel != 0u ? 1.0 : abs(dot(cross(g.axisX, g.axisY), normalize(view.eye - at)));
    return cellClarity(env, g, view.pixelScale / far, lying);
}

// A row of what lies astride its line is bent over it, as caps are: from afar two sides of a small roof stand for it. One
// rectangle would hover, and be a line from the side.
bool overRidge(RoofGrid g, RoofMesh mesh) {
    return g.firstRow != kNoIndex && (g.cells >> 16u) == 1u && mesh.low.y < -0.4 && mesh.high.y > 0.4;
}
vec3 capNormal(RoofGrid g, RoofMesh mesh, float side) {
    float wide = 0.5 * (mesh.high.y - mesh.low.y) * g.size.y;
    return normalize(cross(g.axisX, g.axisY) * wide + g.axisY * (sign(side) * mesh.high.z * g.thickness));
}
#endif
