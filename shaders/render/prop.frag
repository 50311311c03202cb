#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Walls, fences, wood and stone of props: a texture, or the shade that texture u carries, under sun and sky.
#include "shaders/render/light.glsl"
#include "shaders/render/prop_records.h"
#include "shaders/render/fade.glsl"

layout(push_constant, scalar) uniform Data { PropPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) flat in vec2 tintFade;
layout(location = 0) out vec4 color;

// Weathered, by hands' breadths and finer: without a texture, since palettes have none. p: metres.
float weathered(vec3 p, float metres) {
    p += 0.21 * sin(p.yzx * 5.3) + 0.07 * sin(p.zxy * 14.9);
    vec3 broad = sin(p * 9.1), fine = sin(p * 37.0 + 2.0 * broad.yzx);
    float share = clamp(1.4 - 0.08 * metres, 0.0, 1.0);
    return 1.0 + 0.16 * broad.x * broad.y * broad.z + 0.15 * share * fine.x * fine.y * fine.z + 0.05 * broad.y;
}

void main() {
    vec4 texel = texture(colorMap, uv);   // before any pixel is discarded: its neighbours need it for their levels
    if (fadedOut(tintFade.y, gl_FragCoord.xy)) discard;
    vec3 n = normalize(normal);
    vec3 eye = normalize(frame.eye - position);
    if (dot(n, eye) < 0.0 && !gl_FrontFacing) n = -n;
    if (explains) {
        color = frame.view == kViewOverdraw ? oneFragment()
                : frame.view == kViewNormals ? stored(n * 0.5 + 0.5, 0.0) : diagnostic(vec3(0.4), n);
        return;
    }
    vec3 base = texelColor(texel.rgb) * push.baseColor.rgb * (0.88 + 0.24 * tintFade.x);
    base *= weathered(position / frame.unit, distance(frame.eye, position) / frame.unit);
    // What stands on the ground is dark and damp at its foot.
    float foot = clamp((position.y - frame.groundLevel) * 4.0 / frame.unit, 0.0, 1.0);
    base *= 0.72 + 0.28 * foot;
    vec3 sun = frame.sunDirection;
    float facing = max(dot(n, sun), 0.0);
    float visible = facingSunVisibility(facing, position, n);
    vec3 direct = frame.sunColor * visible * facing * (base + gloss(n, eye, sun, max(push.roughness, 0.35)));
    color = lit(direct, base * skyLight(n) * (0.75 + 0.25 * foot));
}
