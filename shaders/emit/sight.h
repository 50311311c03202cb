// Is a sphere in sight, and how large?
#ifndef ESPALIER_EMIT_SIGHT_H
#define ESPALIER_EMIT_SIGHT_H
#include "shaders/emit/glsl_names.h"

ESPALIER_BEGIN

FN bool outside(IN(EmitView) view, vec3 center, float radius) {
    for (uint i = 0u; i < 6u; ++i)
        if (dot(vec3(view.planes[i]), center) + view.planes[i].w < -radius) return true;
    return false;
}

// Tiles that a sphere reaches, its middle at `clip`, its nearest point so far along the view.
struct Reach {
    ivec2 low, high;
    int columns;      // of all tiles
};
FN Reach reachOf(IN(EmitView) view, vec4 clip, float nearest, float radius) {
    float pixels = radius * view.pixelScale / nearest + 1.0f;
    float rcpTile = 1.0f / float(view.tilePixels);
    vec2 size = vec2(view.width, view.height);
    vec2 at = (vec2(clip) / clip.w * 0.5f + 0.5f) * size;
    ivec2 last = ivec2(ceil(size * rcpTile)) - 1;
    Reach o;
    o.low = clamp(ivec2(floor((at - pixels) * rcpTile)), ivec2(0), last);
    o.high = clamp(ivec2(floor((at + pixels) * rcpTile)), ivec2(0), last);
    o.columns = last.x + 1;
    return o;
}

// Is the sphere behind the models? What reaches too many tiles of the picture passes.
FN bool hidden(IN(EmitView) view, vec3 center, float sphere) {
    if (!IS_GIVEN(view.tiles)) return false;
    float radius = sphere + view.drift;
    vec4 clip = view.viewProjection * vec4(center, 1.0f);
    float nearest = view.parallel == 0u ? clip.w - radius : 1.0f;
    if (nearest <= clip.z) return false;
    // Nothing is known of what lies beyond another eye's picture. No branch on the view alone; see keep_cell.h.
    vec2 edge = abs(vec2(clip));
    if (min(view.drift, max(edge.x, edge.y) - clip.w) > 0.0f) return false;
    Reach tiles = reachOf(view, clip, nearest, radius);
    if (any(greaterThan(tiles.high - tiles.low, ivec2(int(kReachTiles))))) return false;
    float depth = clip.z / nearest;   // clip.z is the near plane's distance everywhere
    for (int y = tiles.low.y; y <= tiles.high.y; ++y)
        for (int x = tiles.low.x; x <= tiles.high.x; ++x)
            if (view.tiles.v[y * tiles.columns + x] <= depth) return false;
    return true;
}

// Around a curve: center and radius.
FN vec4 spanSphere(vec3 p0, vec3 b1, vec3 b2, vec3 p3) {
    vec3 center = (p0 + p3) * 0.5f;
    return vec4(center, max(max(distance(center, b1), distance(center, b2)), distance(center, p0)));
}

// Pixels that a metre covers at `center`.
FN float pixelsPerMetre(IN(EmitView) view, vec3 center) {
    float away = max(distance(view.eye, center), 1e-6f);
    return view.pixelScale / (view.parallel == 0u ? away : 1.0f);
}

ESPALIER_END
#endif
