#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Pieces of patterns, under sun and sky.
#include "shaders/render/light.glsl"
#include "shaders/render/piece_records.h"
#include "shaders/render/fade.glsl"

layout(push_constant, scalar) uniform Data { PiecePush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) flat in vec3 base;
layout(location = 3) in vec3 uvFade;
layout(location = 4) flat in float turned;
layout(location = 0) out vec4 color;

void main() {
    if (fadedOut(uvFade.z, gl_FragCoord.xy)) discard;
    vec3 n = normalize(normal);
    vec3 eye = normalize(frame.eye - position);
    if (dot(n, eye) < 0.0 && gl_FrontFacing == turned < 0.0) n = -n;
    if (explains) {
        color = frame.view == kViewOverdraw ? oneFragment()
                : frame.view == kViewNormals ? stored(n * 0.5 + 0.5, 0.0)
                : frame.view == kViewLod ? diagnostic(lodColor(push.lod), n) : diagnostic(vec3(0.4), n);
        return;
    }
    vec3 own = base * (push.textured != 0u ? texelColor(texture(colorMap, uvFade.xy).rgb) : vec3(uvFade.x));
    vec3 sun = frame.sunDirection;
    float facing = max(dot(n, sun), 0.0);
    float visible = facingSunVisibility(facing, position, n);
    vec3 direct = frame.sunColor * visible * facing * (own + gloss(n, eye, sun, push.roughness));
    color = lit(direct, own * skyLight(n));
}
