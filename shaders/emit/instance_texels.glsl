// Instances from their texels. Macros, since samplers can't be arguments of functions everywhere.
#ifndef ESPALIER_EMIT_INSTANCE_TEXELS_GLSL
#define ESPALIER_EMIT_INSTANCE_TEXELS_GLSL
#include "shaders/emit/emit_records.h"

LeafInstance leafOf(uvec4 a, uvec4 b, uvec4 c, uvec4 d) {
    LeafInstance o;
    o.origin = uintBitsToFloat(a.xyz);
    o.axisX = uintBitsToFloat(uvec3(a.w, b.xy));
    o.axisY = uintBitsToFloat(uvec3(b.zw, c.x));
    o.axisZ = uintBitsToFloat(c.yzw);
    o.normal = d.x;
    o.tint = d.y;
    o.hash = d.z;
    o.bits = d.w;
    return o;
}

SpanInstance spanOf(uvec4 a, uvec4 b, uvec4 c, uvec4 d, uvec4 e, uvec4 f) {
    SpanInstance o;
    o.p0 = uintBitsToFloat(a.xyz);
    o.b1 = uintBitsToFloat(uvec3(a.w, b.xy));
    o.b2 = uintBitsToFloat(uvec3(b.zw, c.x));
    o.p3 = uintBitsToFloat(c.yzw);
    o.normal0 = d.x;
    o.normal1 = d.y;
    o.radius0 = uintBitsToFloat(d.z);
    o.radius1 = uintBitsToFloat(d.w);
    o.arc0 = uintBitsToFloat(e.x);
    o.metres = uintBitsToFloat(e.y);
    o.errors = e.z;
    o.bits = e.w;
    o.center = uintBitsToFloat(f.xyz);
    o.reach = uintBitsToFloat(f.w);
    return o;
}

#define TEXEL(texels, i) texelFetch(texels, int(i))
#define LEAF_INSTANCE(texels, i) \
    leafOf(TEXEL(texels, 4u * (i)), TEXEL(texels, 4u * (i) + 1u), TEXEL(texels, 4u * (i) + 2u), TEXEL(texels, 4u * (i) + 3u))
#define SPAN_INSTANCE(texels, i)                                                                                     \
    spanOf(TEXEL(texels, 6u * (i)), TEXEL(texels, 6u * (i) + 1u), TEXEL(texels, 6u * (i) + 2u),                      \
           TEXEL(texels, 6u * (i) + 3u), TEXEL(texels, 6u * (i) + 4u), TEXEL(texels, 6u * (i) + 5u))
#endif
