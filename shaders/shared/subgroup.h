// What depends on which lanes run together, for all kernels: sums, votes, and lanes that take work anew. Results may not
// depend on how many lanes a subgroup has, nor on the order in which they run between two operations: sums are of whole
// numbers, and what is voted on decides only when a lane takes what.
//
// All lanes of a subgroup reach each operation here: it stands in a kernel's main(), behind no `return`, and in loops and
// branches only whose conditions are the same for a subgroup. Where a device offers it, modules are also loaded with
// maximal reconvergence (reconverged() in runtime/gpu/spirv.hpp), so that lanes that have parted meet again there. Where
// lanes come in parts all the same, each part sums and votes for itself, as a smaller subgroup would.
//
// In C++ functions get the lane's subgroup: native code is a LoneLane, tests run kernels' text in emulated ones.
#ifndef ESPALIER_SHARED_SUBGROUP_H
#define ESPALIER_SHARED_SUBGROUP_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

#ifdef __cplusplus
struct LoneLane {
    bool anyLane(bool x) const { return x; }
    uint countLanes(bool x) const { return x ? 1u : 0u; }
    uint sumOfLanes(uint x) const { return x; }
    bool isFirstLane() const { return true; }
    uint lanesTogether() const { return 1u; }
};
#define LANES_FN template <class Lanes> inline
#define LANES_PARAM Lanes &lanes,
#define OF_LANES(call) lanes.call
#define THESE_LANES lanes,
#else
#define LANES_FN
#define LANES_PARAM
#define OF_LANES(call) call
#define THESE_LANES
bool anyLane(bool x) { return subgroupAny(x); }
uint countLanes(bool x) { return subgroupBallotBitCount(subgroupBallot(x)); }
uint sumOfLanes(uint x) { return subgroupAdd(x); }
bool isFirstLane() { return subgroupElect(); }
uint lanesTogether() { return gl_SubgroupSize < gl_WorkGroupSize.x ? gl_SubgroupSize : gl_WorkGroupSize.x; }
#endif

ESPALIER_END
#endif
