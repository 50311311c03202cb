#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// scan.glsl with a lane a bucket.
layout(local_size_x = 64) in;

const uint kShares = 1u;
#include "shaders/emit/scan.glsl"
