#version 460
#extension GL_GOOGLE_include_directive : require
// Pieces of a wave -> pairs with all that they may meet.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/pattern_decide.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PatternEnvBuf env; };

void main() {
    PatternEnv e = env.v[0];
    uint count = foundRoom(e) ? e.status.v[0].pieces - e.status.v[0].firstPiece : 0u;
    uint lanes = gl_NumWorkGroups.x * kPatternGroup;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) lookAround(e, i);
}
