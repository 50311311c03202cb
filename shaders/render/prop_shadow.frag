#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Cut-out cards in the shadow map.
#include "shaders/render/prop_records.h"

layout(push_constant, scalar) uniform Data { PropPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(location = 2) in vec2 uv;

void main() {
    if (push.alphaCutoff > 0.0 && texture(colorMap, uv).a < push.alphaCutoff) discard;
}
