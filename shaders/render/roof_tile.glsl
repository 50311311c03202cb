// Cells as meshes. ESPALIER_CUT: those that planes cut, by clip distances.
#include "shaders/emit/triangle_vertex.glsl"
#include "shaders/render/frame.glsl"
#include "shaders/render/roof_clarity.glsl"
#include "shaders/render/roof_place.glsl"

layout(push_constant, scalar) uniform Data { RoofDrawPush push; };
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec3 surface;      // share of its pixels that a bar covers; the mesh's shade; tint, -1: a pane of glass
layout(location = 3) flat out uvec4 look;   // colour, hash, bucket, RoofGrid::mesh
#ifdef ESPALIER_CUT
out float gl_ClipDistance[8];
#endif

// A bar before a pane (uv.y as of thinAcross in tools/content) is at least a pixel wide: one that is thinner would be seen
// in some rows of pixels and not in others. Returns how far out a vertex of it moves, in metres; cover: how much of its
// pixels the bar covers.
vec2 widened(RoofDrawEnv env, RoofGrid g, vec3 onPlot, float side, out float cover) {
    bool alongX = abs(side) > 1.0;
    float narrow = (abs(side) - (alongX ? 1.0 : 0.0)) * (alongX ? g.size.x : g.size.y);
    vec3 ray = frame.eye - inWorld(env, g, onPlot);
    float far = max(length(ray), 0.05);
    // Seen aslant it is thinner still.
    float aslant = dot(alongX ? g.axisX : g.axisY, ray) / far;
    float pixel = far / (frame.pixelScale * sqrt(max(1.0 - aslant * aslant, 0.01)));
    float least = max(narrow, 0.5 * pixel);
    cover = narrow / least;
    float moved = sign(side) * (least - narrow);
    return alongX ? vec2(moved, 0.0) : vec2(0.0, moved);
}

void main() {
    RoofDrawEnv env = push.env.v[0];
    uint vertex = uint(gl_VertexIndex);
    uint instance = vertex / push.vertexCount;
    uint local = vertex - instance * push.vertexCount;
    instance += uint(gl_InstanceIndex) * push.batch;
#ifdef ESPALIER_CUT
    RoofCutTile tile = env.cuts.v[env.state.v[0].cutStarts[push.bucket] + instance];
#else
    RoofTile tile = env.tiles.v[env.state.v[0].wholeStarts[push.bucket] + instance];
#endif
    RoofGrid g = env.roofs.grids.v[tile.grid];
    TerminalVertex mesh = push.vertices.v[push.firstVertex + local];
    uint column = tile.cell & 0xFFFFu;
    uint row = tile.cell >> 16u;
    float shift = (g.mesh & kGridBond) != 0u && (row & 1u) != 0u ? -0.5 : 0.0;
    vec2 corner = vec2((float(column) + shift) * g.step.x, float(row) * g.step.y);
    vec3 at = vec3(corner + mesh.position.xy * g.size, mesh.position.z * g.thickness);
    float cover = 1.0;
    if (mesh.uv.y != 0.0 && (env.flags & kRoofShadow) == 0u) at.xy += widened(env, g, gridPoint(g, at), mesh.uv.y, cover);
    vec3 onPlot = gridPoint(g, at);
    position = inWorld(env, g, onPlot);
    vec3 n = octahedralToUnit(mesh.normal);
    // Normals are the mesh's in metres: what is stretched leans away.
    n = normalize(vec3(n.xy / max(g.size, vec2(1e-4)), n.z / max(g.thickness, 1e-4)));
    normal = g.axisX * n.x + g.axisY * n.y + cross(g.axisX, g.axisY) * n.z;
    // Cells are lit as their pattern is long before they give way to it: at a low sun the edges of some among others
    // without would be a mosaic of streaks. Smaller pictures, of what moves, keep them for longer: near roofs would lose
    // them when the camera sets off.
    float shadeHere = mesh.uv.x;
    if (g.firstRow != kNoIndex && !standApart(g)) {
        vec3 face = cross(g.axisX, g.axisY);
        vec3 ray = frame.eye - position;
        float far = max(length(ray), 0.05);
        float clear = smoothstep(1.0, quick ? kFadeEnd : kReliefEnd, cellClarity(env, g, frame.pixelScale / far, abs(dot(face, ray)) / far));
        RoofMesh bounds = env.roofs.meshes.v[g.mesh & 255u];
        bool open = n.z > 0.1;   // else an edge
        vec3 flatter = open ? normalize(g.axisX * n.x + face * n.z) : face;
        if (overRidge(g, bounds)) flatter = capNormal(g, bounds, n.y);
        normal = mix(flatter, normal, clear);
        if (!open) shadeHere = mix(1.0 - kDarkOfEdges, shadeHere, clear);
    }
    float tint = push.roughness < kRoughnessOfGlass ? -1.0 : float(g.colour >> 24u) * (1.0 / 255.0);
    surface = vec3(cover, shadeHere, tint);
    look = uvec4(g.colour & 0xFFFFFFu, cellHash(g, column, row), push.bucket, g.mesh);
    gl_Position = frame.viewProjection * vec4(position, 1.0);
#ifdef ESPALIER_CUT
    uint bits = tile.planes;
    for (uint i = 0u; i < 8u; ++i) {
        float d = 1.0;
        if (bits != 0u) {
            uint bit = uint(findLSB(bits));
            bits &= bits - 1u;
            d = planeDistance(env, g, tile.part, bit, onPlot, at);
        }
        gl_ClipDistance[i] = d;
    }
#endif
}
