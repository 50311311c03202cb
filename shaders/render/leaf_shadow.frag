#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Cut-out leaves in the shadow map.
#include "shaders/render/frame.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(location = 3) in vec4 uvOpen;

void main() {
    if (texture(colorMap, uvOpen.xy).a < push.alphaCutoff) discard;
}
