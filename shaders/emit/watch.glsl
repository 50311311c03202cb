// A watched picture (Emit::watch): tiles where spans and leaves were or are that are bound anew.
#ifndef ESPALIER_EMIT_WATCH_GLSL
#define ESPALIER_EMIT_WATCH_GLSL
#include "shaders/emit/bind.glsl"
#include "shaders/emit/leaf_thinning.h"
#include "shaders/emit/sight.h"

layout(set = 0, binding = 7, scalar) uniform WatchBlock { EmitView watched; };

void noteChange(vec3 center, float radius) {
    Reach tiles = reachOf(watched, watched.viewProjection * vec4(center, 1.0), 1.0, radius);
    for (int y = tiles.low.y; y <= tiles.high.y; ++y)
        for (int x = tiles.low.x; x <= tiles.high.x; ++x)
            watched.tiles.v[y * tiles.columns + x] = uintBitsToFloat(kChangedTile);
}

// As far as the culling kernels take them to reach.
void noteSpan(vec3 p0, vec3 b1, vec3 b2, vec3 p3, float thick) {
    for (bool noted = push.watched != 0u; noted; noted = false) {
        vec4 sphere = spanSphere(p0, b1, b2, p3);
        noteChange(sphere.xyz, sphere.w + 2.0 * max(thick, watched.leastPixels / watched.pixelScale));
    }
}
void noteLeaf(vec3 origin, float size, float extent) {
    for (bool noted = push.watched != 0u; noted; noted = false)
        noteChange(origin, size * leafGrowth(leafShare(watched, size * watched.pixelScale)) * extent);
}
#endif
