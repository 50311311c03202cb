// What the last cull left, for vertex shaders: where each bucket's instances begin, which they are, all instances and
// meshes, as texels, which software devices read in one piece each.
#ifndef ESPALIER_RENDER_DRAWN_GLSL
#define ESPALIER_RENDER_DRAWN_GLSL
#include "shaders/emit/emit_records.h"
#include "shaders/emit/instance_texels.glsl"
#include "shaders/render/emit_state.glsl"

layout(set = 0, binding = 10) uniform usamplerBuffer instances;   // four words a texel
layout(set = 0, binding = 11) uniform usamplerBuffer meshes;      // two words a texel
layout(set = 0, binding = 12) uniform usamplerBuffer drawn;       // a DrawnItem a texel

TerminalVertex drawnVertex(uint i) {
    uvec2 a = texelFetch(meshes, int(3u * i)).xy;
    uvec2 b = texelFetch(meshes, int(3u * i + 1u)).xy;
    uvec2 c = texelFetch(meshes, int(3u * i + 2u)).xy;
    return TerminalVertex(vec3(uintBitsToFloat(a), uintBitsToFloat(b.x)), b.y, uintBitsToFloat(c));
}

// Instance `i` of what is drawn, as this view wants it. bits: 2..0 LOD, 7..3 branches from the seed, 15..8 kind,
// 31..16 depth below the canopy's outside (unorm16: 1 at the surface).
LeafInstance drawnLeaf(uint i) {
    uvec4 item = texelFetch(drawn, int(i));
    LeafInstance o = LEAF_INSTANCE(instances, item.x);
    float factor = uintBitsToFloat(item.z);
    o.axisX *= factor;
    o.axisY *= factor;
    o.axisZ *= factor;
    uint height = uint(float(o.bits >> 21u) * (65535.0 / 2047.0));   // in sizes that it has when all are drawn
    o.bits = (item.y & 7u) | ((o.bits >> 13u) & 0xF8u) | (o.bits & 0xFF00u) | (height << 16u);
    return o;
}

// A stretch is one span, its ends those of the first and last. bits: 2..0 LOD, 7..3 branches from the seed, bit 8 rounded tip, bits 31..16 fade (unorm16).
SpanInstance drawnSpan(uint i) {
    uvec4 item = texelFetch(drawn, int(i));
    SpanInstance o = SPAN_INSTANCE(instances, item.x);
    uint before = (item.y >> 3u) & 7u;
    if (before > 0u) {
        SpanInstance first = SPAN_INSTANCE(instances, item.x - before);
        o.p0 = first.p0;
        o.b1 = first.b1;
        o.normal0 = first.normal0;
        o.radius0 = first.radius0;
        o.metres += o.arc0 - first.arc0;
        o.arc0 = first.arc0;
    }
    // Thinner than it can be drawn: drawn at that width, but fainter.
    float least = uintBitsToFloat(item.z);
    float radius0 = o.radius0;
    o.radius0 = max(o.radius0, least * min(o.radius0 / max(o.radius1, 1e-9), 1.0));
    o.radius1 = max(o.radius1, least * min(o.radius1 / max(radius0, 1e-9), 1.0));
    o.bits = (item.y & 0xFFFF0007u) | ((o.bits >> 4u) & 0xF8u) | ((o.bits & 64u) << 2u);
    return o;
}
#endif
