// The colours of views that show amounts, for shaders and for legends.
#ifndef ESPALIER_RENDER_HEAT_H
#define ESPALIER_RENDER_HEAT_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

CONST_FLOAT(kHottestDepth, 8.0f);       // branches from the seed
CONST_FLOAT(kHottestOverdraw, 16.0f);   // fragments a pixel

// From dark blue over green and yellow to red, as t goes from 0 to 1. Linear colour.
FN vec3 heatColor(float t) {
    float x = 4.0f * (t < 0.0f ? 0.0f : (t > 1.0f ? 1.0f : t));
    vec3 low = vec3(0.02f, 0.03f, 0.12f);
    vec3 high = vec3(0.03f, 0.25f, 0.60f);
    if (x > 1.0f) { low = high; high = vec3(0.10f, 0.55f, 0.15f); }
    if (x > 2.0f) { low = high; high = vec3(0.90f, 0.65f, 0.05f); }
    if (x > 3.0f) { low = high; high = vec3(0.85f, 0.06f, 0.03f); }
    float below = x > 3.0f ? 3.0f : (x > 2.0f ? 2.0f : (x > 1.0f ? 1.0f : 0.0f));
    return low + (high - low) * (x - below);
}

// A level of detail, 0 the finest; from kCoarsestLod on all are alike.
CONST_UINT(kCoarsestLod, 5u);
FN vec3 lodColor(uint lod) {
    if (lod == 0u) return vec3(0.85f, 0.15f, 0.1f);
    if (lod == 1u) return vec3(0.9f, 0.55f, 0.1f);
    if (lod == 2u) return vec3(0.75f, 0.8f, 0.15f);
    if (lod == 3u) return vec3(0.15f, 0.7f, 0.25f);
    if (lod == 4u) return vec3(0.1f, 0.5f, 0.85f);
    return vec3(0.45f, 0.25f, 0.8f);
}

// A chart: numbers that follow each other are far apart in hue.
FN vec3 chartColor(uint chart) {
    float h = float((chart * 40503u) & 0xFFFFu) * (6.0f / 65536.0f);
    float toRed = h > 3.0f ? h - 3.0f : 3.0f - h;
    float toGreen = h > 2.0f ? h - 2.0f : 2.0f - h;
    float toBlue = h > 4.0f ? h - 4.0f : 4.0f - h;
    vec3 hue = vec3(toRed - 1.0f, 2.0f - toGreen, 2.0f - toBlue);
    hue.x = hue.x < 0.0f ? 0.0f : (hue.x > 1.0f ? 1.0f : hue.x);
    hue.y = hue.y < 0.0f ? 0.0f : (hue.y > 1.0f ? 1.0f : hue.y);
    hue.z = hue.z < 0.0f ? 0.0f : (hue.z > 1.0f ? 1.0f : hue.z);
    uint kind = chart % 3u;   // full, dark or pale
    return kind == 0u ? hue * 0.34f + 0.1f : (kind == 1u ? hue * 0.2f + 0.04f : hue * 0.2f + 0.3f);
}

// A painted layer, from grey to orange.
FN vec3 layerColor(float t) {
    vec3 none = vec3(0.08f, 0.09f, 0.12f);
    vec3 all = vec3(0.9f, 0.35f, 0.08f);
    return none + (all - none) * (t < 0.0f ? 0.0f : (t > 1.0f ? 1.0f : t));
}

ESPALIER_END
#endif
