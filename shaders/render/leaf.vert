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
layout(location = 3) out vec4 uvOpen;       // uv, share of the sky that is seen, tone of the patch (-1 to 1)
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
    vec3 q = o.origin * (2.3 / push.frame.v[0].unit);
    float patchTone = sin(q.x + 1.7 * sin(q.y * 0.8)) * sin(1.3 * q.y + 1.1 * q.z + 2.0 * sin(0.6 * q.x));
    uvOpen = vec4(mesh.uv, clamp(0.26 + 1.0 * height, 0.18, 1.0), patchTone);
    bits = uvec3(o.tint, o.hash, o.bits & 0xFFFFu);
    gl_Position = push.frame.v[0].viewProjection * vec4(position, 1.0);
}
