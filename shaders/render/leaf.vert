#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Leaves and other loose terminals.
#include "shaders/emit/triangle_vertex.glsl"
#include "shaders/render/frame_records.h"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec3 tangent;
layout(location = 3) out vec3 uvOpen;       // uv, share of the sky that is seen
layout(location = 4) flat out uvec3 bits;   // tint, hash, LOD and kind

void main() {
    uint vertex = uint(gl_VertexIndex);
    uint instance = vertex / push.vertexCount;
    uint local = vertex - instance * push.vertexCount;
    instance += uint(gl_InstanceIndex) * push.batch;
    LeafInstance o = push.leaves.v[push.state.v[0].starts[push.bucket] + instance];
    TerminalVertex mesh = push.vertices.v[push.firstVertex + local];
    vec3 arm = o.axisX * mesh.position.x + o.axisY * mesh.position.y + o.axisZ * mesh.position.z;
    position = o.origin + arm;
    float size = length(o.axisX);
    vec3 n = octahedralToUnit(mesh.normal);
    normal = (o.axisX * n.x + o.axisY * n.y + o.axisZ * n.z) / size;
    tangent = o.axisX / size;
    // Deep in the canopy little sky is seen: measured by the height over the surface, in leaf sizes.
    vec3 ground = octahedralToUnit(o.normal);
    float height = float(o.bits >> 16u) * (1.0 / 65535.0) * 1.1 + dot(arm, ground) / size;
    uvOpen = vec3(mesh.uv, clamp(0.30 + 1.05 * height, 0.22, 1.0));
    bits = uvec3(o.tint, o.hash, o.bits & 0xFFFFu);
    gl_Position = push.frame.v[0].viewProjection * vec4(position, 1.0);
}
