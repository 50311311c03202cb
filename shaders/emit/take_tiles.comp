#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// What is drawn of tiles that are taken costs no more than they do. One group: a lane looks at a run of tiles.
#include "shaders/emit/emit_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { TakePush push; };
#include "shaders/emit/take_tiles.h"

const uint kLanes = 64u;
shared uint laneTiles[kLanes];

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint places = takePlaces();
    uint run = (places + kLanes - 1u) / kLanes;
    uint begin = floatBitsToUint(push.taken.v[push.tiles]);
    uint first = min(lane * run, places);
    uint end = min(first + run, places);
    uint count = 0u;
    for (uint i = first; i < end; ++i) count += changedAt((begin + i) % places) ? 1u : 0u;
    laneTiles[lane] = count;
    barrier();
    uint rank = 0u;
    for (uint l = 0u; l < lane; ++l) rank += laneTiles[l];
    takeRun(begin, first, end, rank);
}
