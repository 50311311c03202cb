#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A node each: the span that ends there, as an instance in the world, put into its cell.
#include "shaders/emit/watch.glsl"
#include "shaders/emit/span_load.h"
#include "shaders/emit/span_thinning.h"
#include "shaders/shared/record_lookup.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) uniform TableBlock { EmitTable table; };

void addTriangles(uint count) { atomicAdd(HEAD.first, count); }
void writeSpan(uint i, SpanInstance o) {
    PairBuf to = PairBuf(uint64_t(push.spans) + uint64_t(i) * 96u);
    to.v[0] = pairOf(o.p0.x, o.p0.y);
    to.v[1] = pairOf(o.p0.z, o.b1.x);
    to.v[2] = pairOf(o.b1.y, o.b1.z);
    to.v[3] = pairOf(o.b2.x, o.b2.y);
    to.v[4] = pairOf(o.b2.z, o.p3.x);
    to.v[5] = pairOf(o.p3.y, o.p3.z);
    to.v[6] = pairOf(o.normal0, o.normal1);
    to.v[7] = pairOf(o.radius0, o.radius1);
    to.v[8] = pairOf(o.arc0, o.metres);
    to.v[9] = pairOf(o.errors, o.bits);
    to.v[10] = pairOf(o.center.x, o.center.y);
    to.v[11] = pairOf(o.center.z, o.reach);
}

#include "shaders/emit/bind_span.h"

void main() {
    uint count = nodesToBind();
    for (uint i = FIRST_LANE; i < count; i += LANES) bindSpan(nodeToBind(i));
}
