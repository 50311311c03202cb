#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// scan.glsl with sixteen lanes a bucket, for GPUs that have groups as large.
layout(local_size_x = 1024) in;

const uint kShares = 16u;
#include "shaders/emit/scan.glsl"
