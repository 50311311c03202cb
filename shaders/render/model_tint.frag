#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_demote_to_helper_invocation : require
#include "shaders/shared/extensions.glsl"
// What coloured glass leaves of the light behind it; multiplied with what has been drawn.
#include "shaders/render/fade.glsl"
#include "shaders/render/frame.glsl"

layout(push_constant, scalar) uniform Data { ModelPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(set = 0, binding = 9, scalar) uniform MaterialBlock { MaterialRecord material; };
layout(location = 3) in vec4 uvs;
layout(location = 4) in vec2 otherUv;
layout(location = 5) in vec4 tint;
layout(location = 0) out vec4 color;

void main() {
    if (!quick && push.fade != 1.0 && fadedOut(push.fade, gl_FragCoord.xy)) demote;
    vec3 at = vec3(push.colorOther != 0u ? otherUv : uvs.xy, 1.0);
    vec3 base = texelColor(texture(colorMap, vec2(dot(push.colorU, at), dot(push.colorV, at))).rgb) * push.baseColor.rgb * tint.rgb;
    color = vec4(sqrt(mix(vec3(1.0), base, material.transmission)), 1.0);   // the scene's image holds roots
}
