#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Distance along the view of every second pixel, for ambient occlusion.
#include "shaders/render/frame_records.h"

layout(push_constant, scalar) uniform Data { PostPush push; };
layout(set = 0, binding = 0) uniform sampler2DMS depthMap;
layout(location = 0) out float distanceAlong;

void main() {
    float z = texelFetch(depthMap, min(ivec2(gl_FragCoord.xy) * 2, textureSize(depthMap) - 1), 0).x;
    distanceAlong = z > 0.0 ? push.frame.v[0].nearPlane / z : 1e6;
}
