// The steps of a chunk's growth: a rule is derived, branches are queued, a step is marched, its nodes are staged (Buron
// 2015 §5, §8). expand_grow.h begins and ends chunks.
//
// Lanes of a group run in lockstep on every device, and on a software device a masked branch costs its full path, so
// the loop has one walk, one run of each code and one push in it.
#ifndef ESPALIER_SHARED_EXPAND_STEP_H
#define ESPALIER_SHARED_EXPAND_STEP_H
#include "shaders/shared/expand_avoid.h"
#include "shaders/shared/expand_stage.h"
#include "shaders/shared/grower.h"
#include "shaders/shared/paper_walk.h"

ESPALIER_BEGIN

// Which walk: a kernel has one, chosen by ESPALIER_PAPER_WALK; the CPU has both.
#ifdef __cplusplus
#define PAPER_WALK(env) (env.status.v[0].walkMode != 0u)
#elif defined(ESPALIER_PAPER_WALK)
#define PAPER_WALK(env) true
#else
#define PAPER_WALK(env) false
#endif

// A seed's direction is in object space, a later chunk's is what the walk left.
FN bool enterWalk(ExpandEnv env, uint level, Walk walk, bool seed, OUT(WalkState) w) {
    if (PAPER_WALK(env)) {
        if (!seed) return resumePaperWalk(env.surfaces, level, walk, w);
        bool stands = startPaperWalk(env.surfaces, level, walk.place, walk.uv, walk.direction, w);
        w.walk.arc = walk.arc;
        return stands;
    }
    return resumeWalk(env.surfaces, level, walk, w);
}
FN void turnWalk(ExpandEnv env, INOUT(WalkState) w, float angle) {
    if (PAPER_WALK(env)) {
        rotatePaperHeading(w, angle);
    } else {
        rotateHeading(w, angle);
    }
}
FN uint advanceWalk(ExpandEnv env, uint level, INOUT(WalkState) w, INOUT(float) remaining, OUT(vec3) normal) {
    uint event = 0u;
    if (PAPER_WALK(env)) {
        event = paperAdvance(env.surfaces, level, w, remaining, normal);
    } else {
        event = walkAdvance(env.surfaces, level, w, remaining, normal);
    }
    return event;
}
FN vec3 headingOf(ExpandEnv env, WalkState w) { return PAPER_WALK(env) ? paperHeading3(w) : w.walk.direction; }

CONST_FLOAT(kMostTurn, 8000.0f);            // radians; sinCosExact takes little more
CONST_UINT(kDetours, 10u);                 // directions tried over the semicircle when the heading fails (§8)
CONST_FLOAT(kDetourAngle, 0.314159265f);   // between two of them on one side: the last ones go across the heading

CONST_UINT(kPhaseDerive, 0u);    // a rule is to be found
CONST_UINT(kPhaseMarch, 1u);     // a step is under way
CONST_UINT(kPhaseEnded, 2u);     // the branch has ended
CONST_UINT(kPhaseFull, 3u);      // the chunk is full: the branch goes on in the next
CONST_UINT(kPhaseDead, 4u);      // no direction serves
CONST_UINT(kPhaseStopped, 5u);   // a limit

FN void giveArgs(MACHINE_PARAM IN(PendingShape) shape) {
    SET_SLOT(kSlotArg, shape.args[0]);
    SET_SLOT(kSlotArg + 1u, shape.args[1]);
    SET_SLOT(kSlotArg + 2u, shape.args[2]);
    SET_SLOT(kSlotArg + 3u, shape.args[3]);
}
FN void takeArgs(INOUT(PendingShape) shape, vec4 args) {
    shape.args[0] = args.x;
    shape.args[1] = args.y;
    shape.args[2] = args.z;
    shape.args[3] = args.w;
}

// The arguments of a successor, `head` being its first word.
FN vec4 readArgs(MACHINE_PARAM ExpandEnv env, uint at, uint head) {
    vec4 args = vec4(0.0f);
    uint slots = TABLE(at + kSuccessorRow_slots);
    for (uint i = 0u; i < ((head >> 24u) & 7u); ++i) {
        uint immediate = TABLE(at + kSuccessorRow_args + i);
        float x = packedValue(MACHINE (slots >> (8u * i)) & 127u, immediate);
        args.x = i == 0u ? x : args.x;
        args.y = i == 1u ? x : args.y;
        args.z = i == 2u ? x : args.z;
        args.w = i == 3u ? x : args.w;
    }
    return args;
}
FN u64 successorKey(u64 key, uint head, uint nameHash) { return childKey(key, nameHash, (head >> 16u) & 255u); }

FN Place placeOf(ExpandEnv env, WalkState w) {
    Place p = {};
    p.position = w.position;
    p.normal = w.normal;
    p.heading = headingOf(env, w);
    p.uv = w.walk.uv;
    p.instance = w.walk.place >> 16u;
    p.level = w.level;
    return p;
}

// An item without its links: origin, branch, depth and step.
FN WorkItem itemOf(WorkItem entry, GrowthSite site, u64 key, uint grammar, uint symbol, vec4 args, IN(Walk) walk) {
    WorkItem item = {};
    item.key = key;
    item.walk = walk;
    item.symbol = (grammar << 16u) | symbol;
    item.args[0] = args.x;
    item.args[1] = args.y;
    item.args[2] = args.z;
    item.args[3] = args.w;
    item.parent = site.chunk;
    item.seed = entry.seed;
    item.step = 0u;
    return item;
}

// Puts an item into the next wave's queue, if it is wanted; beyond its capacity only the count grows. Those of a depth
// that may not be grown are refused. There is one atomic here, since on a software device masked ones cost their full price: the rest is counted at the chunk's end.
FN void pushItem(ExpandEnv env, WorkItem item, bool wanted, INOUT(Grower) g) {
    bool push = wanted && (item.depth >> 16u) <= env.phase;
    uint at = kNoIndex;
    if (push) at = atomicAdd(env.waves.v[env.wave + 1u].count, 1u);
    g.progress.pushed = g.progress.pushed + (push ? 1u : 0u);
    g.progress.refused = g.progress.refused + (wanted && !push ? 1u : 0u);
    if (at < env.itemCapacity) writeWorkItem(env.nextItems, at, item);
}

// Finds the shape's rule and applies it: a List at once (its branches are queued, what it continues with waits for
// its own rule), a March as far as its length and angle. The machine knows the place.
FN void deriveRule(MACHINE_PARAM ExpandEnv env, TableBases map, GrowthSite site, WorkItem entry, INOUT(Grower) g) {
    giveArgs(MACHINE g.shape);
    uint at = map.symbols + g.shape.symbol * kSymbolRow_words;
    uint rules = TABLE(at + kSymbolRow_rules);
    uint sites = TABLE(at + kSymbolRow_sites);
    drawTable(MACHINE env, map, sites & 0xFFFFu, (sites >> 16u) & 255u, g.shape.key, g.shape.key);
    runTable(MACHINE env, map, TABLE(at + kSymbolRow_select));
    float selected = packedValue(MACHINE sites >> 24u, TABLE(at + kSymbolRow_selected));
    g.reads.uses = g.reads.uses | TABLE(at + kSymbolRow_uses);
    uint ruleCount = rules >> 16u;
    if (!(selected >= 0.0f) || ruleCount == 0u) {
        g.progress.phase = kPhaseEnded;
        return;
    }
    uint number = uint(selected);
    at = map.rules + ((rules & 0xFFFFu) + (number < ruleCount ? number : ruleCount - 1u)) * kRuleRow_words;
    uint head = TABLE(at + kRuleRow_head);
    uint links = TABLE(at + kRuleRow_links);
    uint slots = TABLE(at + kRuleRow_slots);
    drawTable(MACHINE env, map, links >> 16u, (head >> 16u) & 255u, g.shape.key, g.shape.key);
    runTable(MACHINE env, map, TABLE(at + kRuleRow_start));
    g.rule.head = head;
    g.rule.links = links;
    g.rule.arriveCode = TABLE(at + kRuleRow_arrive);
    g.rule.distance = larger(packedValue(MACHINE slots & 127u, TABLE(at + kRuleRow_distance)), site.minStep);
    g.rule.angle = limited(packedValue(MACHINE (slots >> 8u) & 127u, TABLE(at + kRuleRow_angle)), -kMostTurn, kMostTurn);
    g.rule.conditionSlots = slots >> 16u;
    g.rule.conditionValue = TABLE(at + kRuleRow_condition);
    g.reads.uses = g.reads.uses | TABLE(at + kRuleRow_uses);
    g.step.attempt = 0u;
    g.step.turnedBack = false;
    g.step.fresh = true;
    g.progress.phase = (head & 3u) == kRuleMarch ? kPhaseMarch : kPhaseEnded;

    uint first = links & 0xFFFFu;
    uint count = (head & 3u) == kRuleList ? (head >> 2u) & 63u : 0u;
    u64 key = g.shape.key;
    for (uint i = first; i < first + count; ++i) {
        at = map.successors + i * kSuccessorRow_words;
        uint successor = TABLE(at + kSuccessorRow_head);
        runTable(MACHINE env, map, TABLE(at + kSuccessorRow_code));
        vec4 args = readArgs(MACHINE env, at, successor);
        u64 child = successorKey(key, successor, TABLE(at + kSuccessorRow_nameHash));
        uint symbol = successor & 0xFFFFu;
        bool branches = (successor & kPackedContinues) == 0u;
        WorkItem item = itemOf(entry, site, child, g.shape.grammar, symbol, args, STAND(g).walk);
        item.walk.arc = 0.0f;
        item.origin = g.progress.count == 0u ? kNoIndex : g.progress.count - 1u;
        item.branch = kNoIndex;
        item.depth = entry.depth + 0x10001u;
        pushItem(env, item, branches, g);
        if (!branches) {
            g.shape.key = child;
            g.shape.symbol = symbol;
            takeArgs(g.shape, args);
            g.progress.phase = kPhaseDerive;
        }
    }
}

// Writes a sample into the stage. normal, heading: packed.
FN void stageNode(ExpandEnv env, WalkState w, uint normal, uint heading, bool seam, uint flags, uint index) {
    UintBuf stage = env.scratch;
    UNUSED(stage);
    StagedSample s = {};
    s.position = w.position;
    s.normal = normal;
    s.heading = heading;
    s.uv = packUv(w.walk.uv);
    s.place = w.walk.place;
    s.arc = w.walk.arc;
    s.flags = flags | (index << 8u);
    s.nearUv = seam ? packUv(w.leftUv) : s.uv;
    s.nearPlace = seam ? w.leftPlace : s.place;
    KEEP_StagedSample(s, STAGED, index * kStagedSample_words)
}

// Width of a texel where the walk goes, object metres.
FN float texelOf(ExpandEnv env, GrowthSite site, uint instance) {
    return 4.0f * site.minStep * rcpExact(surfaceScale(env.surfaces, instance));
}

// What a step's samples need. Its span leaves the surface where its ends turn much for their distance, or at creases
// where they lie off each other's planes.
FN uint layingOf(ExpandEnv env, GrowthSite site, IN(Grower) g, IN(WalkState) from) {
    float scale = surfaceScale(env.surfaces, from.walk.place >> 16u);
    vec3 chord = (g.trial.position - from.position) * scale;
    float texel2nd = 16.0f * site.minStep * site.minStep;
    float bend = 2.0f * dot3(chord, chord) * (1.0f - dot3(from.normal, g.trial.normal));
    float lean = larger(absolute(dot3(chord, from.normal)), absolute(dot3(chord, g.trial.normal)));
    bool ends = (g.trial.flags & (kWalkFlagCrease | kWalkFlagBeside)) != 0u;
    bool creased = ends || (from.flags & (kWalkFlagCrease | kWalkFlagBeside)) != 0u;
    bool leaves = bend > kBendTexels * kBendTexels * texel2nd ||
                  (creased && lean * lean > kLeanTexels * kLeanTexels * texel2nd);
    bool moves = from.walk.place >> 16u != g.trial.walk.place >> 16u;   // to another instance's space
    return leaves || moves ? kStepFollowed : ends || (creased && g.step.pending > 0u) ? kStepLaid : kStepKept;
}

// The angle of an attempt: the rule's own, then a fan over the semicircle around the heading, the side that comes
// first drawn by the key.
FN float attemptAngle(IN(Grower) g) {
    if (g.step.attempt == 0u) return g.rule.angle;
    float side = ((uint(g.shape.key >> 17) ^ g.step.attempt) & 1u) != 0u ? 1.0f : -1.0f;
    return side * kDetourAngle * float((g.step.attempt + 1u) >> 1u);
}

// Begins an attempt: the walk stands where the step begins, and has to turn by attemptAngle.
FN void setOut(INOUT(Grower) g) {
    g.trial = STAND(g);
    g.remaining = g.rule.distance;
    g.step.pending = 0u;
    g.step.lastArc = g.trial.walk.arc;
    g.step.fresh = false;
}

// What comes of a stretch that ended with `event`. normal, heading: packed, of a sample put there.
FN void takeStretch(ExpandEnv env, GrowthSite site, INOUT(Grower) g, uint event, uint normal, uint heading) {
    bool goesOn = walkGoesOn(event);
    bool arrived = event == kWalkDone;
    g.step.arrived = arrived;
    bool recorded = arrived || (goesOn && walkHasSample(event));
    bool tiny = g.trial.walk.arc - g.step.lastArc < 0.02f * g.rule.distance;
    if (arrived && tiny && g.step.pending > 0u) g.step.pending = g.step.pending - 1u;
    recorded = recorded && (arrived || !tiny);

    uint index = g.progress.count + g.step.pending;
    g.step.laying = arrived && !PAPER_WALK(env) ? layingOf(env, site, g, STAND(g)) : kStepKept;
    uint spare = arrived ? (g.step.laying == kStepFollowed && g.progress.count > 0u ? kRoomToFollow : 0u) : 1u;
    bool room = index + spare < kChunkNodes;
    bool full = recorded && !room && g.progress.count > 0u;
    g.progress.phase = full ? kPhaseFull : g.progress.phase;   // the whole step moves to the next chunk
    if (recorded && room) {
        uint flags = ((g.rule.head >> 8u) & 255u) | (arrived ? 0u : kNodeInserted) | ((g.progress.steps & 31u) << 26u);
        stageNode(env, g.trial, normal, heading, event == kWalkSeam && !PAPER_WALK(env), flags, index);
        g.step.pending = g.step.pending + 1u;
        g.step.lastArc = g.trial.walk.arc;
    }
    if (!arrived && !goesOn) {
        // A border of the model, or no surface: the next direction.
        g.progress.phase = g.step.attempt >= kDetours ? kPhaseDead : g.progress.phase;
        g.step.attempt = g.step.attempt + 1u;
        g.step.fresh = true;
    }
}

// One stretch of the step under way.
FN void marchOn(ExpandEnv env, GrowthSite site, INOUT(Grower) g) {
    if (g.step.fresh) {
        setOut(g);
        turnWalk(env, g.trial, attemptAngle(g));
    }
    vec3 normal = vec3(0.0f);
    uint event = advanceWalk(env, site.level, g.trial, g.remaining, normal);
    takeStretch(env, site, g, event, packOct(normal), packOct(headingOf(env, g.trial)));
}

// Terminals read layers at the samples that a step got between its ends, too; `first` to `end`: those among its staged.
FN_SELDOM void noteStaged(ExpandEnv env, uint first, uint end, INOUT(ReadSet) reads) {
    for (uint i = first; i < end; ++i) {
        StagedNode s = stagedNode(env.scratch, i);
        notePlace(reads, s.place >> 16u, s.uv);
    }
}
FN bool notesStaged(uint sceneLayers, uint laid) { return (kFeatures & kFeatureSurface) != 0u && sceneLayers != 0u && laid > 0u; }

// At the end of a step, in whose place the machine is: whether its condition holds there. If not, the next direction.
FN bool conditionHolds(MACHINE_PARAM ExpandEnv env, TableBases map, INOUT(Grower) g) {
    g.step.arrived = false;
    runTable(MACHINE env, map, g.rule.arriveCode);
    if (holds(packedValue(MACHINE g.rule.conditionSlots & 127u, g.rule.conditionValue))) return true;
    // Where it fails for what isn't asked of the place, no other direction can help.
    uint part = g.rule.conditionSlots >> 8u;
    bool blind = (g.rule.head & kRuleBlind) != 0u || (part != 0u && !holds(SLOT(part - 1u)));
    g.reads.beyond = g.reads.beyond || !blind;
    g.step.turnedBack = g.step.turnedBack || !blind;
    g.progress.phase = blind ? kPhaseEnded : g.step.attempt >= kDetours ? kPhaseDead : kPhaseMarch;
    g.step.attempt = g.step.attempt + 1u;
    g.step.fresh = true;
    return false;
}

// How far stems of a grammar stay away from others.
FN float distanceOfGrammar(ExpandEnv env, uint grammar) {
    return uintBitsToFloat(TABLE(grammar * kGrammarTables_words + kGrammarTables_avoid));
}
#ifdef ESPALIER_AGAIN   // where any does, nothing grows again by itself
FN bool keepsDistance(ExpandEnv, uint) { return false; }
#else
FN bool keepsDistance(ExpandEnv env, uint grammar) {
    return (kFeatures & kFeatureAvoid) != 0u && distanceOfGrammar(env, grammar) > 0.0f;
}
// At the end of a step whose condition holds: whether it stays away from what stands. If not, the next direction.
FN bool staysAway(ExpandEnv env, IN(WorkItem) item, IN(WalkState) from, IN(WalkState) to,
                  INOUT(Grower) g) {
    WorldSpan span = {};
    AvoidSite site = {};
    site.base = to.walk.place >> 16u;
    span.from = inWorld(env, from.walk.place >> 16u, from.position, site.base);
    span.to = inWorld(env, site.base, to.position, site.base);
    site.branch = branchOfItem(env, item);
    site.distance = distanceOfGrammar(env, g.shape.grammar);
    if (verdictOf(env, site, span) == kSpanStands) return true;
    g.step.turnedBack = true;
    g.progress.phase = g.step.attempt >= kDetours ? kPhaseDead : kPhaseMarch;
    g.step.attempt = g.step.attempt + 1u;
    g.step.fresh = true;
    return false;
}
#endif

// Lays the step's samples on the mesh.
FN void layStep(ExpandEnv env, GrowthSite site, INOUT(Grower) g) {
    StagedNode start = {};
    if (g.progress.count > 0u) {
        start = stagedNode(env.scratch, g.progress.count - 1u);
    } else {
        start = enteredNode(STAND(g));
    }
    float texel = texelOf(env, site, start.place >> 16u);
    float size = float(levelSize(env.surfaces, start.place >> 16u, site.level));
    uint end = g.progress.count + g.step.pending;
    bool followed = g.step.laying == kStepFollowed;
    uint laid = layOnMesh(env.surfaces, env.scratch, start, texel, size, followed, g.progress.count, end, g.step.ground);
    g.step.pending = g.step.pending + laid;
}

// The step is done; its successor.
FN void finishStep(MACHINE_PARAM ExpandEnv env, TableBases map, INOUT(Grower) g) {
    g.step.ground = g.step.laying != kStepKept ? g.step.ground : kNoIndex;
    g.progress.count = g.progress.count + g.step.pending;
    g.progress.inserted = g.progress.inserted + g.step.pending - 1u;
    g.step.pending = 0u;
    g.progress.steps = g.progress.steps + 1u;
    if ((g.rule.head & 252u) == 0u) {
        g.progress.phase = kPhaseEnded;   // no successor
        return;
    }
    uint at = map.successors + (g.rule.links & 0xFFFFu) * kSuccessorRow_words;
    uint head = TABLE(at + kSuccessorRow_head);
    takeArgs(g.shape, readArgs(MACHINE env, at, head));
    g.shape.key = successorKey(g.shape.key, head, TABLE(at + kSuccessorRow_nameHash));
    g.shape.symbol = head & 0xFFFFu;
    bool full = g.progress.count >= kChunkNodes || (keepsDistance(env, g.shape.grammar) && g.progress.steps >= kAvoidSteps);
    g.progress.phase = full ? kPhaseFull : kPhaseDerive;
}

ESPALIER_END
#endif
