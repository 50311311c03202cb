#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Leaves and other loose terminals, to be lit at each pixel.
#include "shaders/render/leaf_vertex.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec3 tangent;
layout(location = 3) out vec4 uvOpen;       // uv, share of the sky that is seen, tone of the patch (-1 to 1)
layout(location = 4) flat out uvec3 bits;   // tint, hash, LOD and kind

void main() {
    LeafVertex v = leafVertex(push, uint(gl_VertexIndex), uint(gl_InstanceIndex));
    position = v.position;
    normal = v.normal;
    tangent = v.tangent;
    uvOpen = vec4(v.uv, v.open, v.patchTone);
    bits = uvec3(v.instance.tint, v.instance.hash, v.instance.bits & 0xFFFFu);
    gl_Position = frame.viewProjection * vec4(position, 1.0);
}
