#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
#include "shaders/tests/walk_case.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
    SurfaceBuf surfaces;
    WalkCaseBuf cases;
    WalkEndBuf ends;
    uint count;
    uint level;
} push;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < push.count) push.ends.v[i] = walkCase(push.surfaces, push.level, push.cases.v[i]);
}
