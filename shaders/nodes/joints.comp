#version 460
#extension GL_GOOGLE_include_directive : require
// Numbers -> a tree of joints.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_joints.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { JointArgs a; };

void main() {
    uint i = itemIndex();
    if (i < a.count) placeJoint(a, i);
}
