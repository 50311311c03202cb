#version 460
#extension GL_GOOGLE_include_directive : require
// One round of decisions over the sets of a wave.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/pattern_decide.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PatternEnvBuf env; };

void main() {
    PatternEnv e = env.v[0];
    uint count = foundRoom(e) ? e.status.v[0].sets - e.status.v[0].firstSet : 0u;
    uint lanes = gl_NumWorkGroups.x * kPatternGroup;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) decideSet(e, i);
}
