// One wave of the queue. Chunks are unlike in length: lanes that have published theirs take further items (refill.h).
//
// Each part of a trip reads what it is about from the lane's memory, and keeps there what it has changed. A test runs this
// text as C++, as members of what stands for a lane.
#include "shaders/expand/lane_memory.glsl"
#include "shaders/shared/expand_grow.h"
#ifndef __cplusplus
layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };
#endif

bool begin(uint item) {
    ChunkGrowth c = {};
    if (!beginChunk(MACHINE env, readWorkItem(env.items, item), c)) return false;
    keepShape(c.g);
    keepRule(c.g);
    keepStep(c.g);
    keepProgress(c.g);
    keepReads(c.g);
    keepWalk(c.g.trial, kLaneTrial);
#ifdef __cplusplus   // a kernel's KEEP_STAND has
    keepWalk(c.g.at, kLaneStand);
#endif
    KEEP_GrowthSite(c.site, LANE_WORD, kLaneSite)
    LANE_WORD(kLaneItem) = item;
    return true;
}

uint phaseNow() { return LANE_WORD(kLaneProgress + kChunkProgress_phase); }
TableBases laneTables() { return basesOf(env, LANE_WORD(kLaneShape + kPendingShape_grammar)); }

void note() {
    uint sceneLayers = LANE_WORD(kLaneSite + kGrowthSite_sceneLayers);
    if ((kFeatures & kFeatureSurface) == 0u || sceneLayers == 0u) return;
    Grower g = laneGrower();
    noteWay(sceneLayers, laneWalk(kLaneTrial), g.reads);
    keepReads(g);
}
void tell(bool arrived) {
    WalkState trial = laneWalk(kLaneTrial);
    GrowthSite site = laneSite();
    Grower g = laneGrower();
    tellPlace(MACHINE env, frameOf(env.surfaces, trial.walk.place >> 16u, site.inputs), site, g.shape.grammar, trial,
              g.progress.steps + (arrived ? 1u : 0u));
}
bool askCondition() {
    Grower g = laneGrower();
    bool good = conditionHolds(MACHINE env, laneTables(), g);
#ifndef ESPALIER_AGAIN
    if (good && keepsDistance(env, g.shape.grammar))
        good = staysAway(env, readWorkItem(env.items, LANE_WORD(kLaneItem)), laneWalk(kLaneStand), laneWalk(kLaneTrial), g);
#endif
    keepStep(g);
    keepReads(g);
    LANE_WORD(kLaneProgress + kChunkProgress_phase) = g.progress.phase;
    return good;
}
void lay() {
    Grower g = laneGrower();
    uint staged = g.step.pending;
    layStep(env, laneSite(), g);
    uint laid = g.step.pending - staged;
    LANE_WORD(kLaneStep + kStepState_pending) = g.step.pending;
    LANE_WORD(kLaneStep + kStepState_ground) = g.step.ground;
    if (!notesStaged(LANE_WORD(kLaneSite + kGrowthSite_sceneLayers), laid)) return;
    Grower h = laneGrower();
    noteStaged(env, h.progress.count, h.progress.count + h.step.pending, h.reads);
    keepReads(h);
}
void finish() {
    Grower g = laneGrower();
    finishStep(MACHINE env, laneTables(), g);
    keepShape(g);
    keepStep(g);
    keepProgress(g);
}
void derive() {
    Grower g = laneGrower();
    deriveRules(MACHINE env, laneTables(), laneSite(), readWorkItem(env.items, LANE_WORD(kLaneItem)), g);
    keepShape(g);
    keepRule(g);
    keepStep(g);
    keepProgress(g);
    keepReads(g);
}
void decide() {
    bool arrived = LANE_WORD(kLaneStep + kStepState_arrived) != 0u;
    note();
    if (!decides(phaseNow(), arrived)) return;
    tell(arrived);
    if (arrived && askCondition()) {
        if (LANE_WORD(kLaneStep + kStepState_laying) != kStepKept) lay();
        keepWalk(laneWalk(kLaneTrial), kLaneStand);
        finish();
    }
    if (phaseNow() == kPhaseDerive) derive();
}

void march() {
    WalkState trial = {};
    float remaining = 0.0f;
    if (LANE_WORD(kLaneStep + kStepState_fresh) != 0u) {
        Grower g = laneGrower();
        setOut(g);
        keepStep(g);
        trial = g.trial;
        remaining = g.remaining;
        turnWalk(env, trial, attemptAngle(g));
    } else {
        trial = laneWalk(kLaneTrial);
        remaining = uintBitsToFloat(LANE_WORD(kLaneRemaining));
    }
    vec3 normal = vec3(0.0f);
    uint event = advanceWalk(env, LANE_WORD(kLaneSite + kGrowthSite_level), trial, remaining, normal);
    keepWalk(trial, kLaneTrial);
    LANE_WORD(kLaneRemaining) = floatBitsToUint(remaining);
    Grower g = laneGrower();
    g.trial = trial;
    takeStretch(env, laneSite(), g, event, packOct(normal), packOct(headingOf(env, trial)));
    keepStep(g);
    LANE_WORD(kLaneProgress + kChunkProgress_phase) = g.progress.phase;
}

// For refillLanes:
bool takeItem(INOUT(bool) more) {
    uint i = atomicAdd(env.waves.v[env.wave].taken, 1u);
    bool there = i < env.waves.v[env.wave].count && i < env.itemCapacity;
    uint taken = LANE_WORD(kLaneTaken) + 1u;
    LANE_WORD(kLaneTaken) = taken;
    more = there && taken < kMostTaken;
    return there && begin(i);
}
bool goesOn() { return phaseNow() <= kPhaseMarch; }
bool tripOfItem() {
    decide();
    if (phaseNow() == kPhaseMarch) march();
    Grower g = laneGrower();
    endTrip(g.progress);
    LANE_WORD(kLaneProgress + kChunkProgress_phase) = g.progress.phase;
    LANE_WORD(kLaneProgress + kChunkProgress_trips) = g.progress.trips;
    return growing(g.progress);
}
void endItem() {
    ChunkGrowth c = {};
    c.g = laneGrower();
    c.site = laneSite();
    c.item = readWorkItem(env.items, LANE_WORD(kLaneItem));
    GrowthTally tally = laneTally();
    endChunk(env, c, tally);
    keepTally(tally);
}
#ifndef __cplusplus
#include "shaders/shared/refill.h"   // behind what it calls
#endif

void growWave() {
    uint wanted = env.waves.v[env.wave].count;
    if (wanted > env.itemCapacity) atomicMax(env.status.v[0].items, wanted);
    keepTally(emptyTally());
    LANE_WORD(kLaneTaken) = 0u;
    // Groups come late to what others have taken.
    uint taken = loadShared(env.waves.v[env.wave].taken);
    refillLanes(THIS_LANE taken < wanted && taken < env.itemCapacity);
    addTally(env, laneTally());
}

#ifndef __cplusplus
void main() {
    openLane(kLaneWords);
    growWave();
}
#endif
