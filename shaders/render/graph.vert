#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Geometry of the procedural graph: a vertex and an instance of it, moved by the program. Drawn as pieces are.
#include "shaders/emit/triangle_vertex.glsl"
#include "shaders/render/frame.glsl"
#include "shaders/render/graph_records.h"

layout(push_constant, scalar) uniform Data { PiecePush push; };
layout(set = 0, binding = 10) uniform usamplerBuffer positions;
layout(set = 0, binding = 11) uniform usamplerBuffer normals;
layout(set = 0, binding = 12, scalar) readonly buffer Drawn {
    GraphDrawRecord drawn;
    DeformOp ops[];
};
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) flat out vec3 base;
layout(location = 3) out vec3 uvFade;
layout(location = 4) flat out float turned;   // as of pieces: never mirrored

vec3 deformed(vec3 p, vec3 n, uint instance) {
    for (uint k = 0u; k < drawn.opCount; ++k) p = deformStep(ops[k], p, n, instance);
    return p;
}

void main() {
    turned = 1.0;
    int v = gl_VertexIndex, stride = int(drawn.stride);
    vec3 p = uintBitsToFloat(uvec3(texelFetch(positions, v).x, texelFetch(positions, v + stride).x,
                                   texelFetch(positions, v + 2 * stride).x));
    vec3 n = octahedralToUnit(texelFetch(normals, v).x);
    position = p;
    normal = n;
    if (drawn.opCount > 0u) {
        // Two steps along the surface are moved, too: they tell where its outside has turned.
        uint instance = uint(gl_InstanceIndex);
        float step = 1e-3 * drawn.extent;
        vec3 across = normalize(cross(n, abs(n.y) < 0.7 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)));
        vec3 other = cross(n, across);
        position = deformed(p, n, instance);
        vec3 facing = cross(deformed(p + step * across, n, instance) - position,
                            deformed(p + step * other, n, instance) - position);
        normal = dot(facing, facing) > 0.0 ? normalize(facing) : n;
    }
    base = drawn.colour;
    uvFade = vec3(1.0);
    gl_Position = frame.viewProjection * vec4(position, 1.0);
}
