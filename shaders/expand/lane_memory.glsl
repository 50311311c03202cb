// What a lane of the march keeps in its memory while it walks.
#ifndef ESPALIER_EXPAND_LANE_MEMORY_GLSL
#define ESPALIER_EXPAND_LANE_MEMORY_GLSL
#ifndef __cplusplus
#define ESPALIER_LANES
#define LANE_BINDING 1
#define LANE_SLOTS kLaneSlots
#include "shaders/shared/lane_slots.glsl"   // before what uses slots
#define THIS_LANE
#endif
#include "shaders/expand/lane_words.h"

WalkState laneWalk(uint first) {
    WalkState w = {};
    FILL_WalkState(w, LANE_WORD, first)
    return w;
}
void keepWalk(WalkState w, uint first) { KEEP_WalkState(w, LANE_WORD, first) }
#ifndef __cplusplus
#define STAND(g) laneWalk(kLaneStand)
#define KEEP_STAND(g) keepWalk((g).trial, kLaneStand)
#endif

GrowthSite laneSite() {
    GrowthSite s = {};
    FILL_GrowthSite(s, LANE_WORD, kLaneSite)
    return s;
}
GrowthTally laneTally() {
    GrowthTally t = {};
    FILL_GrowthTally(t, LANE_WORD, kLaneTally)
    return t;
}
void keepTally(GrowthTally t) { KEEP_GrowthTally(t, LANE_WORD, kLaneTally) }
// All but its walks; compilers leave out what nobody asks for.
Grower laneGrower() {
    Grower g = {};
    FILL_PendingShape(g.shape, LANE_WORD, kLaneShape)
    FILL_ActiveRule(g.rule, LANE_WORD, kLaneRule)
    FILL_StepState(g.step, LANE_WORD, kLaneStep)
    FILL_ChunkProgress(g.progress, LANE_WORD, kLaneProgress)
    FILL_ReadSet(g.reads, LANE_WORD, kLaneReads)
#ifdef __cplusplus   // a kernel's STAND reads it
    g.at = laneWalk(kLaneStand);
#endif
    return g;
}
void keepShape(Grower g) { KEEP_PendingShape(g.shape, LANE_WORD, kLaneShape) }
void keepRule(Grower g) { KEEP_ActiveRule(g.rule, LANE_WORD, kLaneRule) }
void keepStep(Grower g) { KEEP_StepState(g.step, LANE_WORD, kLaneStep) }
void keepProgress(Grower g) { KEEP_ChunkProgress(g.progress, LANE_WORD, kLaneProgress) }
void keepReads(Grower g) { KEEP_ReadSet(g.reads, LANE_WORD, kLaneReads) }
#endif
