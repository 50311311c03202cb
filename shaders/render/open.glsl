// What occlusion.frag has left: the mean of the four pixels that ask in different directions.
#ifndef ESPALIER_RENDER_OPEN_GLSL
#define ESPALIER_RENDER_OPEN_GLSL
#include "shaders/render/frame.glsl"

// at: in pixels of the picture, which has two to one of the map's; rcp: 1 / pixels of the map. Moving pictures take the
// four that are nearest.
float openAt(sampler2D openMap, vec2 at, vec2 rcp) {
    vec2 uv = at * 0.5;
    if (quick) return textureLod(openMap, floor(uv + 0.5) * rcp, 0.0).x;
    vec2 low = (uv - 0.5) * rcp, high = (uv + 0.5) * rcp;
    return 0.25 * (textureLod(openMap, low, 0.0).x + textureLod(openMap, vec2(high.x, low.y), 0.0).x +
                   textureLod(openMap, vec2(low.x, high.y), 0.0).x + textureLod(openMap, high, 0.0).x);
}
#endif
