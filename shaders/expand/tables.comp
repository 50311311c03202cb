#version 460
#extension GL_GOOGLE_include_directive : require
// Packs the rule maps' tables, a group a grammar; see expand_tables.h.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/expand_tables.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    packGrammar(env.grammars, env.tables, gl_WorkGroupID.x, gl_LocalInvocationID.x, kExpandGroup);
}
