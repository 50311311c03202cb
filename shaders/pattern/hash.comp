#version 460
#extension GL_GOOGLE_include_directive : require
// The hash of all pieces that stand.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/pattern_decide.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PatternEnvBuf env; };

void main() {
    PatternEnv e = env.v[0];
    uint lanes = gl_NumWorkGroups.x * kPatternGroup;
    uvec2 sum = uvec2(0u);
    for (uint i = gl_GlobalInvocationID.x; i < e.status.v[0].pieces; i += lanes) sum += hashOfPiece(e, i);
    atomicAdd(e.status.v[0].hash[0], sum.x);
    atomicAdd(e.status.v[0].hash[1], sum.y);
}
