#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// As leaf_small.glsl, of one sample, one light over the whole leaf.
#define ESPALIER_ONE_SAMPLE
#include "shaders/render/leaf_alpha.glsl"
#include "shaders/render/leaf_light.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(location = 0) in vec2 uv;
layout(location = 1) flat in vec4 ownShare;
layout(location = 2) flat in vec3 turned;
layout(location = 3) flat in vec3 mirrored;
layout(location = 0) out vec4 color;

void main() {
    vec4 texel = texture(colorMap, uv);
    texel.rgb = texelColor(texel.rgb);
    CUT_OUT(texel.a, push.alphaCutoff, 0u)
    color = sceneColor(texel.rgb * ownShare.rgb + dot(texel.rgb, kLeafWeights) * turned + mirrored, ownShare.w);
}
