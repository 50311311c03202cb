// Leaves of three or four vertices and ribbons that a kernel has lit before they are drawn: what doesn't differ between vertices is
// found once, and on all cores of devices that shade vertices on one. An instance is two texels of light and one for
// each vertex, at its place in what is drawn.
//   leaf     own.rgb turned.r | turned.gb mirrored.rg || mirrored.b share, rest unused    (halves, four 16-bit pairs a texel)
//   ribbon   own.rgb other.r | other.gb share fade, at either end                         (halves)
//   vertex   clip x, y, w; texture coordinates (two halves). Clip z is the near plane's distance for all.
#ifndef ESPALIER_RENDER_LIT_GLSL
#define ESPALIER_RENDER_LIT_GLSL
#include "shaders/render/frame.glsl"

// light: of the texels before the vertices'. at: the instance's first word.
void writeLight(U64Buf lit, uint at, uint texel, vec4 a, vec4 b) {
    lit.v[at + 2u * texel] = packUint2x32(uvec2(packHalf2x16(a.xy), packHalf2x16(a.zw)));
    lit.v[at + 2u * texel + 1u] = packUint2x32(uvec2(packHalf2x16(b.xy), packHalf2x16(b.zw)));
}
void writeLitVertex(U64Buf lit, uint at, uint vertex, vec3 position, vec2 uv) {
    vec4 clip = frame.viewProjection * vec4(position, 1.0);
    lit.v[at + 4u + 2u * vertex] = packUint2x32(floatBitsToUint(clip.xy));
    lit.v[at + 5u + 2u * vertex] = packUint2x32(uvec2(floatBitsToUint(clip.w), packHalf2x16(uv)));
}
#endif
