#version 460
#extension GL_GOOGLE_include_directive : require
// What each grammar asks of places; see needsOf. The widths are there already.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/expand_scope.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    uint grammar = gl_GlobalInvocationID.x;
    if (grammar < env.phase) env.needs.v[grammar] = needsOf(env.grammars, grammar, env.needs.v[grammar].width);
}
