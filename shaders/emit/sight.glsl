// Is a sphere in sight, and how large?
#ifndef ESPALIER_EMIT_SIGHT_GLSL
#define ESPALIER_EMIT_SIGHT_GLSL
#include "shaders/emit/emit_records.h"

bool outside(EmitView view, vec3 center, float radius) {
    for (uint i = 0u; i < 6u; ++i)
        if (dot(view.planes[i].xyz, center) + view.planes[i].w < -radius) return true;
    return false;
}

// Tiles that a sphere reaches, its middle at `clip`, its nearest point so far along the view.
struct Reach {
    ivec2 low, high;
    int columns;      // of all tiles
};
Reach reachOf(EmitView view, vec4 clip, float nearest, float radius) {
    float pixels = radius * view.pixelScale / nearest + 1.0;
    float rcpTile = 1.0 / float(view.tilePixels);
    vec2 size = vec2(view.width, view.height);
    vec2 at = (clip.xy / clip.w * 0.5 + 0.5) * size;
    ivec2 last = ivec2(ceil(size * rcpTile)) - 1;
    Reach o;
    o.low = clamp(ivec2(floor((at - pixels) * rcpTile)), ivec2(0), last);
    o.high = clamp(ivec2(floor((at + pixels) * rcpTile)), ivec2(0), last);
    o.columns = last.x + 1;
    return o;
}

// Is the sphere behind the models? Tests up to (most + 1)² tiles of the picture; larger spheres pass.
bool hidden(EmitView view, vec3 center, float radius, int most) {
    if (u64(view.tiles) == 0ul) return false;
    vec4 clip = view.viewProjection * vec4(center, 1.0);
    float nearest = view.parallel == 0u ? clip.w - radius : 1.0;
    if (nearest <= clip.z) return false;
    Reach tiles = reachOf(view, clip, nearest, radius);
    if (any(greaterThan(tiles.high - tiles.low, ivec2(most)))) return false;
    float depth = clip.z / nearest;   // clip.z is the near plane's distance everywhere
    for (int y = tiles.low.y; y <= tiles.high.y; ++y)
        for (int x = tiles.low.x; x <= tiles.high.x; ++x)
            if (view.tiles.v[y * tiles.columns + x] <= depth) return false;
    return true;
}

bool hidden(EmitView view, vec3 center, float radius) { return hidden(view, center, radius, 4); }

// Around a curve: center and radius.
vec4 spanSphere(vec3 p0, vec3 b1, vec3 b2, vec3 p3) {
    vec3 center = (p0 + p3) * 0.5;
    return vec4(center, max(max(distance(center, b1), distance(center, b2)), distance(center, p0)));
}

// Pixels that a metre covers at `center`.
float pixelsPerMetre(EmitView view, vec3 center) {
    float away = max(distance(view.eye, center), 1e-6);
    return view.pixelScale / (view.parallel == 0u ? away : 1.0);
}
#endif
