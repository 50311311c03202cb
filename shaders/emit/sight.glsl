// Is a sphere in sight, and how large?
#ifndef ESPALIER_EMIT_SIGHT_GLSL
#define ESPALIER_EMIT_SIGHT_GLSL
#include "shaders/emit/emit_records.h"

bool outside(EmitView view, vec3 center, float radius) {
    for (uint i = 0u; i < 6u; ++i)
        if (dot(view.planes[i].xyz, center) + view.planes[i].w < -radius) return true;
    return false;
}

// Is the sphere behind the models? Tests up to (most + 1)² tiles of the picture; larger spheres pass.
bool hidden(EmitView view, vec3 center, float radius, int most) {
    if (u64(view.tiles) == 0ul) return false;
    vec4 clip = view.viewProjection * vec4(center, 1.0);
    float nearest = clip.w - radius;
    if (nearest <= clip.z) return false;
    float reach = radius * view.pixelScale / nearest + 1.0;
    vec2 at = (clip.xy / clip.w * 0.5 + 0.5) * vec2(view.width, view.height);
    ivec2 last = ivec2((uvec2(view.width, view.height) + kDepthTile - 1u) / kDepthTile) - 1;
    ivec2 low = clamp(ivec2(floor((at - reach) / float(kDepthTile))), ivec2(0), last);
    ivec2 high = clamp(ivec2(floor((at + reach) / float(kDepthTile))), ivec2(0), last);
    if (any(greaterThan(high - low, ivec2(most)))) return false;
    float depth = clip.z / nearest;   // clip.z is the near plane's distance everywhere
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
            if (view.tiles.v[y * (last.x + 1) + x] <= depth) return false;
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
