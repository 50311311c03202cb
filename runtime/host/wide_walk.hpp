#pragma once

// Walks side by side, a lane of the processor's vectors each: a stretch is a chain of reciprocals and roots that wait
// for each other, and lanes share that wait. The arithmetic is the kernels' text (walk_stretch.h), so the bits are the
// same.

#include <cstdint>

#include "runtime/core/lanes.hpp"
#include "runtime/core/platform.hpp"
#include "shaders/shared/walk.h"

namespace espalier {

constexpr uint32_t kWalkLanes = 16;

// What lanes compute with. Lanes that were never put are zero, or hold what another walk left there.
struct alignas(64) WideWalks {
    using Floats = float[kWalkLanes];
    using Words = uint32_t[kWalkLanes];
    using Vectors = LaneVectors<kWalkLanes>;

    VectorKind vectors;  // platform::widestVectors(), which aren't narrow: walks go one by one there

    // The walk: WalkState's parts, and what is still to be walked, metres of the world.
    Vectors position, du, dv, normal, heading;
    Floats u, v, slipU, slipV, spread, clear, limit, arc, remaining;
    Words flags;
    Floats scale, farthest;
    // The chart and level that it is in; once it leaves, those that it comes to. size: texels along a side.
    Words instance, chart, level;
    Floats orientation, size;
    Words wanted;  // the level asked for
    // By how much it turns first, radians; 0 or 1: it does.
    Floats angle;
    Words turns;
    // How its stretch ended: the event, and what a sample there keeps, packed.
    Words event, packedNormal, packedHeading;

    // The stretch, and the four texels about its end.
    Vectors along;  // the heading that it sets out with
    Floats texel;   // in UV
    Floats metres, pace, rateU, rateV, toU, toV;
    Words partly, searches, leaves;
    Words at00, at10, at01, at11;
    Floats fx, fy;
    Vectors texel00, texel10, texel01, texel11;
    Words bits00, bits10, bits01, bits11;
    Reach reach[kWalkLanes];  // of those that leave their chart
    // Their blend, or the plane taken in its stead.
    Vectors position1, du1, dv1;
    Words nearest, bits, own, creased, valid, landed;
};

// A walk into a lane, with `remaining` to be walked; it doesn't turn. level: see walkAdvance.
void putWalk(WideWalks& walks, uint32_t lane, SurfaceBuf surfaces, uint32_t level, const WalkState& w, float remaining);
// Walks what walkAdvance would, in the lanes of which `lanes` has the bit. Returns those whose stretch has landed
// inside its chart. The others have met something, and are taken by takeMeeting.
uint32_t advanceWide(WideWalks& walks, SurfaceBuf surfaces, uint32_t lanes);
// The walk of a lane that has landed into the state that it was put from.
void takeWalk(const WideWalks& walks, uint32_t lane, WalkState& w);
// What walkAdvance would make of the state that a lane was put from, turned if it turns, where the lane hasn't landed.
// Returns the event.
uint32_t takeMeeting(const WideWalks& walks, uint32_t lane, WalkState& w, float& remaining, vec3& jointNormal);

}  // namespace espalier
