// Bark's colours.
#ifndef ESPALIER_RENDER_BARK_COLOR_GLSL
#define ESPALIER_RENDER_BARK_COLOR_GLSL

// Young wood is smooth and greenish, old wood grey-brown. Share of the former; radius2: log2 of the radius.
float youngBark(float radius2) { return 0.55 * clamp((log2(frame.unit) - radius2 - 7.6) * 0.5, 0.0, 1.0); }
const vec3 kYoungBark = vec3(0.16, 0.17, 0.06);
#endif
