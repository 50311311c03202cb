#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Counts -> starts and indirect draws. One invocation: there are 64 buckets.
#include "shaders/emit/batches.h"
#include "shaders/render/roof_draw_records.h"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Data { RoofCullPush push; };

void writeDraws(RoofDrawEnv env, uint at, uint b, uint count) {
    DrawCommand whole, last;
    drawBatches(env.table.v[0].buckets[b], count, whole, last);
    env.state.v[0].draws[at] = whole;
    env.state.v[0].draws[at + 1u] = last;
}

void main() {
    RoofDrawEnv env = push.env.v[0];
    uint whole = 0u;
    uint cut = 0u;
    uint triangles = 0u;
    uint overflow = max(env.state.v[0].rows, env.rowRoom) - env.rowRoom;
    for (uint b = 0u; b < kMaxBuckets; ++b) {
        uint wanted = env.state.v[0].whole[b];
        uint count = min(wanted, env.tileRoom - whole);
        overflow += wanted - count;
        env.state.v[0].wholeStarts[b] = whole;
        writeDraws(env, 2u * b, b, count);
        whole += count;
        uint perTile = env.table.v[0].buckets[b].indexCount / 3u;
        triangles += count * perTile;
        wanted = env.state.v[0].cut[b];
        count = min(wanted, env.cutRoom - cut);
        overflow += wanted - count;
        env.state.v[0].cutStarts[b] = cut;
        writeDraws(env, 2u * (kMaxBuckets + b), b, count);
        cut += count;
        triangles += count * perTile;
    }
    uint rectangles = env.state.v[0].rectangles;
    overflow += max(rectangles, env.rectangleRoom) - env.rectangleRoom;
    rectangles = min(rectangles, env.rectangleRoom);
    env.state.v[0].rectangleDraw[0] = 6u * rectangles;
    env.state.v[0].rectangleDraw[1] = 1u;
    env.state.v[0].rectangleDraw[2] = 0u;
    env.state.v[0].rectangleDraw[3] = 0u;
    env.state.v[0].triangles = triangles + 2u * rectangles;
    env.state.v[0].overflow = overflow;
}
