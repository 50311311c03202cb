#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// scan.glsl with some lanes a bucket, for GPUs that have groups as large.
#include "shaders/emit/emit_records.h"

const uint kShares = kScanShares;
layout(local_size_x = kShares * kMaxBuckets) in;

#include "shaders/emit/scan.glsl"
