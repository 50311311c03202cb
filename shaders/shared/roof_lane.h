// What a lane keeps while it expands a shape of a roof. Native code hands it on with the machine, which it holds; kernels
// have it in their lanes' memory (lane_slots.glsl), from which each part of the expansion reads what it is about, so that
// registers hold no more than that. For the same reason a kernel reads its environment where it is used (ENV), and not
// once. Functions that use these begin their parameters with LANE_PARAM and are called with MACHINE first.
#ifndef ESPALIER_SHARED_ROOF_LANE_H
#define ESPALIER_SHARED_ROOF_LANE_H
#include "records/roof_records.h"
#include "shaders/shared/interpreter.h"
#include "shaders/shared/lanes.h"

ESPALIER_BEGIN

CONST_UINT(kRoofNumbers, 16u);   // a rule's numbers, kept while its successors' code runs
// Where a kernel's lane keeps what, in words, after the machine's slots.
CONST_UINT(kRoofLaneShape, kSlotWords);                          // the shape that waits for its rule,
CONST_UINT(kRoofLaneChild, kRoofLaneShape + kRoofScope_words);   // one that the rule makes, and
CONST_UINT(kRoofLaneNext, kRoofLaneChild + kRoofScope_words);    // the one to go on with
CONST_UINT(kRoofLaneNumbers, kRoofLaneNext + kRoofScope_words);
CONST_UINT(kRoofLaneKind, kRoofLaneNumbers + kRoofNumbers);      // of the rule: roofKind,
CONST_UINT(kRoofLaneDetail, kRoofLaneKind + 1u);                 // RuleRecord::extrude
CONST_UINT(kRoofLaneWords, kRoofLaneKind + 4u);
CONST_UINT(kRoofLaneGroups, kMostLanes / kRoofGroup);

#ifdef __cplusplus
static_assert(kMaxSplit <= kRoofNumbers && kScopeValues <= kRoofNumbers && kRoofScope_words % 4 == 0);
struct RoofLane : Machine {
    RoofEnv env;
    RoofScope shape, child, next;
    float numbers[kRoofNumbers];
    uint kind, detail;
};
#define LANE_PARAM RoofLane &machine,
#define LANE_ONLY_PARAM RoofLane &machine
#define ENV machine.env
#define WAVE machine.env.wave
#define NUMBER(i) machine.numbers[i]
#define SET_NUMBER(i, value) machine.numbers[i] = value
inline uint laneKind(const RoofLane& machine) { return machine.kind; }
inline uint laneDetail(const RoofLane& machine) { return machine.detail; }
inline void keepRule(RoofLane& machine, uint kind, uint detail) { machine.kind = kind, machine.detail = detail; }
inline const RoofScope& laneShape(const RoofLane& machine) { return machine.shape; }
inline void keepShape(RoofLane& machine, const RoofScope& shape) { machine.shape = shape; }
inline void keepChild(RoofLane& machine, const RoofScope& shape) { machine.child = shape; }
inline const RoofScope& laneChild(const RoofLane& machine) { return machine.child; }
inline void keepNext(RoofLane& machine, const RoofScope& shape) { machine.next = shape; }
inline void goOnWithNext(RoofLane& machine) { machine.shape = machine.next; }
#else
#define LANE_PARAM
#define LANE_ONLY_PARAM
layout(binding = 0, scalar) uniform Environment { RoofEnv roofEnv; };
layout(push_constant, scalar) uniform Push { uint wave; };
#define ENV roofEnv
#define WAVE wave
#define NUMBER(i) uintBitsToFloat(LANE_WORD(kRoofLaneNumbers + (i)))
#define SET_NUMBER(i, value) LANE_WORD(kRoofLaneNumbers + (i)) = floatBitsToUint(value)
// Read anew, what compares with it needs no registers from one part to the next.
uint laneKind() { return LANE_WORD(kRoofLaneKind); }
uint laneDetail() { return LANE_WORD(kRoofLaneDetail); }
void keepRule(uint kind, uint detail) {
    LANE_WORD(kRoofLaneKind) = kind;
    LANE_WORD(kRoofLaneDetail) = detail;
}
// Compilers leave out the words that nobody asks for.
RoofScope laneShape() {
    RoofScope s = {};
    FILL_RoofScope(s, LANE_WORD, kRoofLaneShape)
    return s;
}
RoofScope laneChild() {
    RoofScope s = {};
    FILL_RoofScope(s, LANE_WORD, kRoofLaneChild)
    return s;
}
void keepShape(RoofScope shape) { KEEP_RoofScope(shape, LANE_WORD, kRoofLaneShape) }
void keepChild(RoofScope shape) { KEEP_RoofScope(shape, LANE_WORD, kRoofLaneChild) }
void keepNext(RoofScope shape) { KEEP_RoofScope(shape, LANE_WORD, kRoofLaneNext) }
void goOnWithNext() {
    for (uint i = 0u; i < kRoofScope_words; ++i) LANE_WORD(kRoofLaneShape + i) = LANE_WORD(kRoofLaneNext + i);
}
#endif
FN vec3 vectorOf(LANE_PARAM uint i) { return vec3(NUMBER(i), NUMBER(i + 1u), NUMBER(i + 2u)); }

ESPALIER_END
#endif
