// Two levels of detail share the picture where one takes over: each pixel shows the one or the other.
#ifndef ESPALIER_RENDER_PROP_FADE_GLSL
#define ESPALIER_RENDER_PROP_FADE_GLSL
#include "shaders/render/light.glsl"

bool fadedOut(float fade) {
    float threshold = ditherAt(gl_FragCoord.xy);
    return fade < 1.0 && (fade > 0.0 ? threshold >= fade : threshold < -fade);
}
#endif
