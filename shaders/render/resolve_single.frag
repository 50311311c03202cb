#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Pixels of one sample -> smooth edges, with ambient occlusion. Where brightness breaks, the edge is followed both
// ways to its ends (the idea of FXAA, Lottes 2009); from where between them the pixel lies follows how much of it
// belongs to the other side.
#include "shaders/render/frame.glsl"
#include "shaders/render/encode.glsl"
#include "shaders/render/heat.h"
#include "shaders/render/open.glsl"
#include "shaders/render/tone.glsl"

layout(push_constant, scalar) uniform Data { PostPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(set = 0, binding = 1) uniform sampler2D openMap;
layout(location = 0) out vec4 color;

const float kLeastContrast = 0.035;      // of the stored square roots
const float kRelativeContrast = 0.12;
const float kSpeckShare = 0.3;          // how far a lone pixel is drawn to its neighbours' mean
const int kReach = quick ? 4 : 8;        // pixels that an edge is followed

// Moving pictures take green alone for it, which spares them half of what a fetch costs software devices.
float brightness(vec3 c) { return quick ? c.g : dot(c, vec3(0.3, 0.6, 0.1)); }
vec4 colorAt(ivec2 at) { return texelFetch(colorMap, clamp(at, ivec2(0), textureSize(colorMap, 0) - 1), 0); }
float fetch(ivec2 at) { return brightness(colorAt(at).rgb); }

// How far away, in pixels along `along`, does the edge between `at` and its neighbour `across` end? next: the mean of
// both brightnesses a pixel on. over: does brightness there leave to the middle's other side? The loop's end is the only
// jump that software devices know: it ends when the last of a group's pixels has found its end.
float edgeEnd(ivec2 at, ivec2 across, ivec2 along, float next, float edge, float least, bool darkHere, out bool over) {
    float difference = next - edge;
    int far = 1;
    for (int i = 2;; i *= 2) {
        ivec2 there = at + along * i;
        float found = 0.5 * (fetch(there) + fetch(there + across)) - edge;
        bool goesOn = abs(difference) < least;
        difference = goesOn ? found : difference;
        far = goesOn ? i : far;
        if (i >= kReach || abs(difference) >= least) break;
    }
    over = (difference < 0.0) != darkHere;
    return float(far);
}

// at: the pixel, its colour.
vec4 smoothed(ivec2 at, vec4 middle) {
    float m = brightness(middle.rgb);
    float n = fetch(at + ivec2(0, -1));
    float s = fetch(at + ivec2(0, 1));
    float w = fetch(at + ivec2(-1, 0));
    float e = fetch(at + ivec2(1, 0));
    float most = max(m, max(max(n, s), max(w, e)));
    float range = most - min(m, min(min(n, s), min(w, e)));
    bool sharp = range >= max(kLeastContrast, kRelativeContrast * most);
    float nw = fetch(at + ivec2(-1, -1));
    float ne = fetch(at + ivec2(1, -1));
    float sw = fetch(at + ivec2(-1, 1));
    float se = fetch(at + ivec2(1, 1));
    float bendY = 2.0 * abs(n + s - 2.0 * m) + abs(ne + se - 2.0 * e) + abs(nw + sw - 2.0 * w);
    float bendX = 2.0 * abs(w + e - 2.0 * m) + abs(nw + ne - 2.0 * n) + abs(sw + se - 2.0 * s);
    bool flatEdge = bendY >= bendX;   // the edge runs along x
    float before = flatEdge ? n : w;
    float after = flatEdge ? s : e;
    bool toBefore = abs(before - m) >= abs(after - m);
    float other = toBefore ? before : after;
    ivec2 across = (flatEdge ? ivec2(0, 1) : ivec2(1, 0)) * (toBefore ? -1 : 1);
    ivec2 along = flatEdge ? ivec2(1, 0) : ivec2(0, 1);

    float edge = 0.5 * (m + other);
    float least = sharp ? 0.25 * abs(other - m) : 0.0;
    // A pixel on, back and forth.
    float backHere = flatEdge ? w : n;
    float forthHere = flatEdge ? e : s;
    float backThere = toBefore ? nw : flatEdge ? sw : ne;
    float forthThere = !toBefore ? se : flatEdge ? ne : sw;
    bool overBack;
    bool overForth;
    bool dark = m < edge;
    float back = edgeEnd(at, across, -along, 0.5 * (backHere + backThere), edge, least, dark, overBack);
    float forth = edgeEnd(at, across, along, 0.5 * (forthHere + forthThere), edge, least, dark, overForth);
    float nearer = min(back, forth);
    float share = (back < forth ? overBack : overForth) ? 0.5 - nearer / (back + forth) : 0.0;
    // Specks and thin things have no edge to follow.
    float mean = (2.0 * (n + s + w + e) + nw + ne + sw + se) * (1.0 / 12.0);
    float lone = smoothstep(0.0, 1.0, clamp(abs(mean - m) / range, 0.0, 1.0));
    share = max(share, lone * lone * kSpeckShare);
    return mix(middle, colorAt(at + across), sharp ? share : 0.0);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 shown = smoothed(at, texelFetch(colorMap, at, 0));
    float open = openAt(openMap, gl_FragCoord.xy, 2.0 * push.rcpSize);
    if (explains && frame.view == kViewOverdraw) shown = stored(heatColor(shown.x / (kOverdrawStep * kHottestOverdraw)), 0.0);
    color = pictureColor(shown, open, push.encode != 0u, at);
}
