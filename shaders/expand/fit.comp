#version 460
#extension GL_GOOGLE_include_directive : require
// Radii fitted to the branches' thickness, and the canonical hash; see expand_fit.h.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/expand_fit.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    uint count = env.status.v[0].nodes;
    bool ready = complete(env);
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    uvec2 hash = uvec2(0u);
    for (uint i = env.status.v[0].frozenNodes + gl_GlobalInvocationID.x; ready && i < count; i += lanes) {
        if (env.nodes.v[i].radius >= 0.0f) hash += fitNode(env, i);
    }
    addHash(env, gl_WorkGroupID.x, hash);
}
