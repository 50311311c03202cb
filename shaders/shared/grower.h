// A chunk while it grows, in records by what changes together: a kernel has at hand only those that it is about.
#ifndef ESPALIER_SHARED_GROWER_H
#define ESPALIER_SHARED_GROWER_H
#include "shaders/shared/expand_scope.h"

ESPALIER_BEGIN

// The shape that waits for its rule or is marching.
struct PendingShape {
    u64 key;
    uint grammar, symbol;
    float args[4];
};
RECORD_WORDS(PendingShape)
RECORD_OFFSETS(PendingShape)

// Its rule, once that is known, and what the rule's code has given.
struct ActiveRule {
    uint head, links;    // as RuleRow
    uint arriveCode;
    uint conditionSlots, conditionValue;   // slots: of the condition, from bit 8 on of its blind part, plus 1
    float distance, angle;
};
RECORD_WORDS(ActiveRule)
RECORD_OFFSETS(ActiveRule)

// The step under way.
struct StepState {
    uint attempt;        // 0: the heading as the rule turned it, then detours
    bool turnedBack;     // of one of them the condition didn't hold for where it led
    bool fresh;          // the attempt has not left yet
    bool arrived;        // it has reached its end: the condition is to be asked there
    uint ground;         // the triangle under the last sample, where that is known
    uint laying;         // kStepKept, ...: of the step that has arrived
    uint pending;        // samples staged for it
    float lastArc;       // of the last sample staged
};
RECORD_WORDS(StepState)
RECORD_OFFSETS(StepState)

// What is done.
struct ChunkProgress {
    uint phase;
    uint count;          // nodes
    uint steps;
    uint inserted;
    uint trips;
    uint pushed, refused;   // items
};
RECORD_WORDS(ChunkProgress)
RECORD_OFFSETS(ChunkProgress)

// STAND(g): where the chunk stands, as a WalkState; KEEP_STAND(g): it stands where its step has come to. Native code
// has it at hand; kernels keep it in their lanes' memory.
struct Grower {
    PendingShape shape;
    ActiveRule rule;
    StepState step;
    ChunkProgress progress;
    ReadSet reads;
    WalkState trial;     // how far the step has come
    float remaining;     // and what of it is left, metres
#ifdef __cplusplus
    WalkState at;
#endif
};
#ifdef __cplusplus
#define STAND(g) (g).at
#define KEEP_STAND(g) (g).at = (g).trial
#endif

// What an invocation has grown, to be added to the counters at its end: each atomic costs.
struct GrowthTally {
    uint chunks, nodes, steps, inserted, stopped, deadEnds;
};
RECORD_WORDS(GrowthTally)
RECORD_OFFSETS(GrowthTally)

// The constants of a chunk's growth.
struct GrowthSite {
    uint chunk;          // its own index
    uint inputs, layers; // what its grammar asks of places
    uint sceneLayers;    // what it or its terminals read of layers, by the scene's numbers
    uint level;
    uint depth;          // branches from the seed
    uint stepBase;       // steps of its branch before it
    float minStep;       // metres
};
RECORD_WORDS(GrowthSite)
RECORD_OFFSETS(GrowthSite)

ESPALIER_END
#endif
