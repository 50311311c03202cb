// What the last cull left, for vertex shaders: where each bucket's instances begin, and instances and meshes as texels,
// which software devices read in one piece each.
#ifndef ESPALIER_RENDER_DRAWN_GLSL
#define ESPALIER_RENDER_DRAWN_GLSL
#include "shaders/emit/emit_records.h"

layout(set = 0, binding = 9, scalar) uniform StateBlock { EmitState state; };
layout(set = 0, binding = 10) uniform usamplerBuffer instances;   // four words a texel
layout(set = 0, binding = 11) uniform usamplerBuffer meshes;      // two words a texel

TerminalVertex drawnVertex(uint i) {
    uvec2 a = texelFetch(meshes, int(3u * i)).xy;
    uvec2 b = texelFetch(meshes, int(3u * i + 1u)).xy;
    uvec2 c = texelFetch(meshes, int(3u * i + 2u)).xy;
    return TerminalVertex(vec3(uintBitsToFloat(a), uintBitsToFloat(b.x)), b.y, uintBitsToFloat(c));
}

LeafInstance drawnLeaf(uint i) {
    uvec4 a = texelFetch(instances, int(4u * i));
    uvec4 b = texelFetch(instances, int(4u * i + 1u));
    uvec4 c = texelFetch(instances, int(4u * i + 2u));
    uvec4 d = texelFetch(instances, int(4u * i + 3u));
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

SpanInstance drawnSpan(uint i) {
    uvec4 a = texelFetch(instances, int(6u * i));
    uvec4 b = texelFetch(instances, int(6u * i + 1u));
    uvec4 c = texelFetch(instances, int(6u * i + 2u));
    uvec4 d = texelFetch(instances, int(6u * i + 3u));
    uvec4 e = texelFetch(instances, int(6u * i + 4u));
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
    o.rise = uintBitsToFloat(e.z);
    o.bits = e.w;
    return o;
}
#endif
