// Where a point of a grid lies on its house's plot and in the world, and its distances from the planes that cut it.
#ifndef ESPALIER_ROOF_PLACE_GLSL
#define ESPALIER_ROOF_PLACE_GLSL
#include "shaders/render/roof_draw_records.h"
#include "shaders/shared/roof_layers.h"

vec3 gridPoint(RoofGrid g, vec3 p) {
    // Upper corners that Join has moved take their column along.
    float t = g.extent.y > 0.0 && g.extent.y < 1e5 ? p.y / g.extent.y : 0.0;
    p.x += t * mix(g.taper.x, g.taper.y, g.extent.x > 0.0 ? p.x / g.extent.x : 0.0);
    return g.origin + g.axisX * p.x + g.axisY * p.y + cross(g.axisX, g.axisY) * p.z;
}

vec3 inWorld(RoofDrawEnv env, RoofGrid g, vec3 p) {
    vec2 plot = plotOf(env.roofs, g.house);
    return p + vec3(plot.x, 0.0, plot.y);
}

// Above 0: on the side that stays. p: gridPoint(at); at: the grid's own coordinates.
float planeDistance(RoofDrawEnv env, RoofGrid g, uint part, uint bit, vec3 p, vec3 at) {
    if (bit == 8u) return at.x;
    if (bit == 9u) return g.extent.x - at.x;
    if (bit == 10u) return g.extent.y - at.y;
    RoofRegion r = env.roofs.regions.v[g.region];
    vec4 plane = env.roofs.planes.v[env.roofs.parts.v[part].firstPlane + bit];
    vec3 d = p - vec3(r.origin.x, g.base, r.origin.z);
    d.y *= g.shrink;
    return plane.w - dot(plane.xyz, vec3(dot(r.axisA, d), dot(r.axisB, d), dot(r.axisC, d)));
}

uint cellHash(RoofGrid g, uint column, uint row) { return roofCellHash(g.key, column, row); }
#endif
