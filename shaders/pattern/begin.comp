#version 460
#extension GL_GOOGLE_include_directive : require
// Between waves: which symbols the next one takes; see pattern_decide.h.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/pattern_decide.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PatternEnvBuf env; };

void main() {
    if (gl_GlobalInvocationID.x == 0u) beginWave(env.v[0]);
}
