// Where a leaf's vertices stand.
#ifndef ESPALIER_RENDER_LEAF_VERTEX_GLSL
#define ESPALIER_RENDER_LEAF_VERTEX_GLSL
#include "shaders/emit/triangle_vertex.glsl"
#include "shaders/render/drawn.glsl"
#include "shaders/render/frame.glsl"
#include "shaders/render/wind.glsl"

struct LeafVertex {
    LeafInstance instance;
    vec3 position, normal, tangent;
    vec2 uv;
    float open;        // share of the sky that is seen
    float patchTone;   // -1 to 1
};

LeafVertex leafVertexOf(LeafInstance o, TerminalVertex mesh) {
    LeafVertex v;
    vec3 arm = o.axisX * mesh.position.x + o.axisY * mesh.position.y + o.axisZ * mesh.position.z;
    float size = length(o.axisX);
    vec3 n = octahedralToUnit(mesh.normal);
    v.instance = o;
    v.position = o.origin + arm;
    v.normal = (o.axisX * n.x + o.axisY * n.y + o.axisZ * n.z) / size;
    if (windy) v.position = o.origin + blown(arm, v.normal, o.origin, o.hash);
    v.tangent = o.axisX / size;
    v.uv = mesh.uv;
    // Deep in the canopy little sky is seen: measured by the height over the surface, in leaf sizes.
    vec3 ground = octahedralToUnit(o.normal);
    float height = float(o.bits >> 16u) * (1.0 / 65535.0) * 1.1 + dot(arm, ground) / size;
    v.open = clamp(0.12 + 0.90 * height, 0.10, 1.0);
    vec3 q = o.origin * (kTonesPerUnit / frame.unit) + frame.tonesFrom;
    v.patchTone = sin(q.x + 1.7 * sin(q.y * 0.8)) * sin(1.3 * q.y + 1.1 * q.z + 2.0 * sin(0.6 * q.x));
    return v;
}

LeafVertex leafVertex(TerminalPush push, uint vertex, uint drawn) {
    uint instance = vertex / push.vertexCount;
    uint local = vertex - instance * push.vertexCount;
    instance += drawn * push.batch;
    return leafVertexOf(drawnLeaf(state.starts[push.bucket] + instance), drawnVertex(push.firstVertex + local));
}
#endif
