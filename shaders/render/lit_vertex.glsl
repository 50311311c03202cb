// Reads what a kernel has lit (lit.glsl).
#ifndef ESPALIER_RENDER_LIT_VERTEX_GLSL
#define ESPALIER_RENDER_LIT_VERTEX_GLSL
#include "shaders/render/emit_state.glsl"
#include "shaders/render/frame.glsl"

layout(set = 0, binding = 13) uniform usamplerBuffer lit;   // four words a texel

// The first texel of a vertex' instance; of the instance's vertices.
int litInstance(TerminalPush push, uint corners) {
    uint instance = uint(gl_VertexIndex) / corners + uint(gl_InstanceIndex) * push.batch;
    return int(kLitTexels * (state.starts[push.bucket] + instance));
}
int litCorner(uint corners) { return int(uint(gl_VertexIndex) % corners); }
vec2 litUv(uvec4 vertex) { return unpackHalf2x16(vertex.w); }
vec4 litPosition(uvec4 vertex) {
    return vec4(uintBitsToFloat(vertex.xy), frame.nearPlane, uintBitsToFloat(vertex.z));
}
#endif
