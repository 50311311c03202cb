#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Bends a terminal mesh along its span (Buron 2015 §6): x and y in radii across, z along.
#include "shaders/emit/span_load.h"
#include "shaders/emit/triangle_vertex.glsl"
#include "shaders/render/drawn.glsl"
#include "shaders/render/frame.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 along;       // u around, metres along, log2 of the radius, fade
layout(location = 3) flat out uint hash;

void main() {
    uint vertex = uint(gl_VertexIndex);
    uint instance = vertex / push.vertexCount;
    uint local = vertex - instance * push.vertexCount;
    instance += uint(gl_InstanceIndex) * push.batch;
    SpanInstance o = drawnSpan(state.starts[push.bucket] + instance);
    TerminalVertex mesh = drawnVertex(push.firstVertex + local);
    float u = clamp(mesh.position.z, 0.0, 1.0);
    float v = 1.0 - u;
    vec3 center = o.p0 * (v * v * v) + o.b1 * (3.0 * v * v * u) + o.b2 * (3.0 * v * u * u) + o.p3 * (u * u * u);
    vec3 tangent = (o.b1 - o.p0) * (v * v) + (o.b2 - o.b1) * (2.0 * v * u) + (o.p3 - o.b2) * (u * u);
    vec3 up = octahedralToUnit(o.normal0) * v + octahedralToUnit(o.normal1) * u;
    vec3 side = cross(up, tangent);
    side *= inversesqrt(max(dot(side, side), 1e-30));
    up = cross(tangent, side);
    up *= inversesqrt(max(dot(up, up), 1e-30));
    if (push.vertexCount == 4u) {
        // A ribbon: across the view, its normal towards the eye.
        vec3 toEye = frame.eye - center;
        side = cross(toEye, tangent);
        side *= inversesqrt(max(dot(side, side), 1e-30));
        vec3 facing = cross(tangent, side);
        up = normalize(up + facing * inversesqrt(max(dot(facing, facing), 1e-30)));
    }
    float radius = o.radius0 * v + o.radius1 * u;
    center += up * (kBarkRise * radius);
    if ((o.bits & 256u) != 0u) radius = barkRadius(o.radius0, o.radius1, o.metres, true, u);
    position = center + (side * mesh.position.x + up * mesh.position.y) * radius;
    vec3 n = octahedralToUnit(mesh.normal);
    normal = side * n.x + up * n.y + normalize(tangent + vec3(1e-12)) * n.z;
    along = vec4(mesh.uv.x, o.arc0 + o.metres * u, log2(max(radius, 1e-9)), float(o.bits >> 16u) * (1.0 / 65535.0));
    hash = (o.normal0 ^ floatBitsToUint(o.p0.x)) * 0x9E3779B1u | (o.bits & 255u);
    hash = (hash & ~255u) | (o.bits & 255u);
    gl_Position = frame.viewProjection * vec4(position, 1.0);
}
