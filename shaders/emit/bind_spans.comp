#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A node each: the span that ends there, as an instance in the world, put into its cell.
#include "shaders/emit/watch.glsl"
#include "records/emit_records.h"
#include "shaders/emit/span_load.h"
#include "shaders/emit/span_thinning.h"
#include "shaders/shared/record_lookup.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) uniform TableBlock { EmitTable table; };

void addTriangles(uint count) { atomicAdd(HEAD.first, count); }
void writeSpan(uint i, SpanInstance o) { writeSpanInstance(push.spans, i, o); }

#include "shaders/emit/bind_span.h"

void main() {
    uint count = nodesToBind();
    for (uint i = FIRST_LANE; i < count; i += LANES) bindSpan(nodeToBind(i));
}
