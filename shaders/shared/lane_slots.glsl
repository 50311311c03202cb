// Memory of a kernel's lanes, and the machine's slots in it: registers hold what the part of a pass that a lane is in
// needs, so that many groups of lanes fit on a processor. Eight lanes have theirs side by side, four words each in turn: a
// line of a cache is read whole, and where a word lies is the lane's place and a small constant. Around it: LANE_BINDING,
// of the buffer, and LANE_SLOTS, the word of a lane where its slots begin.
#ifndef ESPALIER_SHARED_LANE_SLOTS_GLSL
#define ESPALIER_SHARED_LANE_SLOTS_GLSL
#include "shaders/shared/lanes.h"

layout(binding = LANE_BINDING) buffer LaneMemory { uvec4 laneQuads[]; };
uint laneAt;   // the lane's first
#define LANE_WORD(i) laneQuads[laneAt + ((i) >> 2u) * kLanesBeside][(i) & 3u]
#define SLOT(i) uintBitsToFloat(LANE_WORD(LANE_SLOTS + (i)))
#define SET_SLOT(i, value) LANE_WORD(LANE_SLOTS + (i)) = floatBitsToUint(value)

// words: that a lane has.
void openLane(uint words) {
    uint lane = gl_GlobalInvocationID.x;
    laneAt = lane / kLanesBeside * (words / 4u * kLanesBeside) + lane % kLanesBeside;
}
#endif
