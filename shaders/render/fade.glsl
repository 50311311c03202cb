// Two levels of detail share the picture where one takes over: each pixel shows the one or the other.
#ifndef ESPALIER_RENDER_FADE_GLSL
#define ESPALIER_RENDER_FADE_GLSL

// A threshold for each pixel, even over small neighbourhoods: with one sample, half a pixel is every second one.
float ditherAt(vec2 pixel) { return fract(52.98 * fract(dot(floor(pixel), vec2(0.0671, 0.00584)))) * 0.996 + 0.002; }

// fade: 1: all pixels; above 0: this share of them; below: those that -fade leaves out.
bool fadedOut(float fade, vec2 pixel) {
    float threshold = ditherAt(pixel);
    return fade > 0.0 ? threshold >= fade : threshold < -fade;
}
#endif
