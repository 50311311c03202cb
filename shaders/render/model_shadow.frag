#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// What is cut out of a model's triangles, in the shadow map.
#include "shaders/render/frame_records.h"

layout(push_constant, scalar) uniform Data { ModelPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(location = 0) in vec3 uvAlpha;

void main() {
    if (texture(colorMap, uvAlpha.xy).a * push.baseColor.a * uvAlpha.z < push.alphaCutoff) discard;
}
