#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Of the tiles of a watched picture that edits have changed, the next ones are taken, at most so many: what is drawn
// then costs no more than they do. They come in strips of four rows, column by column, so that they lie close together.
// One group: a lane looks at a run of tiles.
#include "shaders/emit/emit_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { TakePush push; };

const uint kLanes = 64u;
const uint kStrip = 4u;
shared uint laneTiles[kLanes];

uint tileAt(uint place) {
    uint along = place / kStrip;
    return (along / push.columns * kStrip + place % kStrip) * push.columns + along % push.columns;
}
bool changedAt(uint place) {
    uint tile = tileAt(place);
    uint bits = kKeptTile;
    if (tile < push.tiles) bits = floatBitsToUint(push.watched.v[tile]);
    return bits == kChangedTile;
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint places = (push.tiles + push.columns * kStrip - 1u) / (push.columns * kStrip) * push.columns * kStrip;
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
    for (uint i = first; i < end; ++i) {
        uint place = (begin + i) % places;
        uint tile = tileAt(place);
        bool changed = changedAt(place);
        bool takes = changed && rank < push.most;
        rank += changed ? 1u : 0u;
        if (tile < push.tiles) push.taken.v[tile] = uintBitsToFloat(takes ? kChangedTile : kKeptTile);
        if (takes) push.watched.v[tile] = uintBitsToFloat(kKeptTile);
        if (takes && rank == push.most) push.taken.v[push.tiles] = uintBitsToFloat((place + 1u) % places);
    }
}
