#version 460
#extension GL_GOOGLE_include_directive : require
// Thickness of every branch against its parent; see expand_fit.h.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/expand_fit.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    uint count = env.status.v[0].branches;
    bool ready = complete(env);
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = env.status.v[0].frozenBranches + gl_GlobalInvocationID.x; ready && i < count; i += lanes) {
        if (env.branches.v[i].firstChunk == kNoIndex) continue;
        if (env.phase == kTerminalsJoints) {
            sumJoint(env, i);
        } else {
            env.branches.v[i].thickness = thicknessOf(env, i);
        }
    }
}
