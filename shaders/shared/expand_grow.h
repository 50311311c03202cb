// Growing one chunk: rules are derived, steps are marched, nodes recorded, branches queued (Buron 2015 §5, §8).
//
// A chunk is a pure function of its work item and of the inputs (surface, rule maps, layers): it reads nothing that
// growth writes but the chunk that it leaves. Lanes of a group run in lockstep on every device, and on a software
// device a masked branch costs its full path, so the loop has one walk, one run of each code and one push in it.
#ifndef ESPALIER_SHARED_EXPAND_GROW_H
#define ESPALIER_SHARED_EXPAND_GROW_H
#include "shaders/shared/expand_scope.h"
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
    uint event;
    if (PAPER_WALK(env)) {
        event = paperAdvance(env.surfaces, level, w, remaining, normal);
    } else {
        event = walkAdvance(env.surfaces, level, w, remaining, normal);
    }
    return event;
}
FN vec3 headingOf(ExpandEnv env, WalkState w) { return PAPER_WALK(env) ? paperHeading3(w) : w.walk.direction; }

CONST_UINT(kDetours, 10u);                 // directions tried over the semicircle when the heading fails (§8)
CONST_FLOAT(kDetourAngle, 0.314159265f);   // between two of them on one side: the last ones go across the heading

// Some software devices end every loop after some 65,000 trips of all loops of an invocation together: so a chunk
// ends early after this many of its main loop, and an invocation takes no more items than these.
CONST_UINT(kMaxTrips, 256u);
CONST_UINT(kMostTaken, 4u);
CONST_UINT(kItemsPerGroup, 64u);           // a group is dispatched for so many items; below kMostTaken an invocation

// A chunk's nodes are staged in an array of words of the invocation's own, since they get their place at its end.
CONST_UINT(kStagedWords, 9u);   // of a node: all but radius and chunk
#ifdef __cplusplus
#define STAGED(i) env.scratch.v[i]
#else
uint stagedNodes[288];
#define STAGED(i) stagedNodes[i]
#endif

CONST_UINT(kPhaseDerive, 0u);    // a rule is to be found
CONST_UINT(kPhaseMarch, 1u);     // a step is under way
CONST_UINT(kPhaseEnded, 2u);     // the branch has ended
CONST_UINT(kPhaseFull, 3u);      // the chunk is full: the branch goes on in the next
CONST_UINT(kPhaseDead, 4u);      // no direction serves
CONST_UINT(kPhaseStopped, 5u);   // a limit

// A chunk while it grows.
struct Grower {
    uint phase;
    // The shape that waits for its rule or is marching.
    u64 key;
    uint grammar, symbol;
    vec4 args;
    WalkState at;        // where it stands
    // The step under way.
    WalkState trial;     // how far it has come
    uint rule;           // word 0 of its packed record
    uint links;          // word 1
    uint arriveCode;
    uint conditionSlot, conditionValue;
    float distance, angle, remaining;
    uint attempt;        // 0: the heading as the rule turned it, then detours
    bool fresh;          // the attempt has not left yet
    bool arrived;        // it has reached its end: the condition is to be asked there
    bool placed;         // the machine knows the place where `trial` stands
    uint pending;        // samples staged for it
    float lastArc;       // of the last sample staged
    // What is done.
    uint count;          // nodes
    uint steps;
    uint inserted;
    uint trips;
    uint pushed, refused;   // items
    ReadSet reads;
    uvec2 hash;          // of all that the chunk leaves
};

// The constants of a chunk's growth.
struct GrowthSite {
    uint chunk;          // its own index
    uint inputs, layers; // what its grammar asks of places
    uint level;
    uint depth;          // branches from the seed
    uint stepBase;       // steps of its branch before it
    float minStep;       // metres
};

FN void giveArgs(MACHINE_PARAM vec4 args) {
    SLOT(kSlotArg) = args.x;
    SLOT(kSlotArg + 1u) = args.y;
    SLOT(kSlotArg + 2u) = args.z;
    SLOT(kSlotArg + 3u) = args.w;
}

// The arguments of a successor, `head` being its first word.
FN vec4 readArgs(MACHINE_PARAM ExpandEnv env, uint at, uint head) {
    vec4 args = vec4(0.0f);
    uint slots = TABLE(at + 3u);
    for (uint i = 0u; i < ((head >> 24u) & 7u); ++i) {
        uint immediate = TABLE(at + 4u + i);
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
    Place p;
    p.position = w.position;
    p.normal = w.normal;
    p.heading = headingOf(env, w);
    p.uv = w.walk.uv;
    p.instance = w.walk.place >> 16u;
    p.level = w.level;
    return p;
}

// An item without its links: origin, branch, depth and step.
FN WorkItem itemOf(WorkItem entry, GrowthSite site, u64 key, uint grammar, uint symbol, vec4 args, Walk walk) {
    WorkItem item;
    item.key = key;
    item.walk = walk;
    item.symbol = (grammar << 16u) | symbol;
    item.args[0] = args.x;
    item.args[1] = args.y;
    item.args[2] = args.z;
    item.args[3] = args.w;
    item.parent = site.chunk;
    item.seed = entry.seed;
    return item;
}

// Puts an item into the next wave's queue, if it is wanted; beyond its capacity only the count grows. There is one
// atomic here, since on a software device masked ones cost their full price: the rest is counted at the chunk's end.
FN void pushItem(ExpandEnv env, WorkItem item, bool wanted, INOUT(Grower) g) {
    bool push = wanted && env.wave < env.phase;
    uint at = kNoIndex;
    if (push) at = atomicAdd(env.waves.v[env.wave + 1u].count, 1u);
    g.pushed = g.pushed + (push ? 1u : 0u);
    g.refused = g.refused + (wanted && !push ? 1u : 0u);
    if (at < env.itemCapacity) writeItem(env.nextItems, at, item);
}

// Finds the shape's rule and applies it: a List at once (its branches are queued, what it continues with waits for
// its own rule), a March as far as its length and angle. The machine knows the place.
FN void deriveRule(MACHINE_PARAM ExpandEnv env, TableBases map, GrowthSite site, WorkItem entry, INOUT(Grower) g) {
    giveArgs(MACHINE g.args);
    uint at = map.symbols + g.symbol * kSymbolWords;
    uint rules = TABLE(at);
    uint sites = TABLE(at + 2u);
    drawTable(MACHINE env, map, sites & 0xFFFFu, (sites >> 16u) & 255u, g.key, g.key);
    runTable(MACHINE env, map, TABLE(at + 1u));
    float selected = packedValue(MACHINE sites >> 24u, TABLE(at + 3u));
    g.reads.params = g.reads.params | TABLE(at + 4u);
    uint ruleCount = rules >> 16u;
    if (!(selected >= 0.0f) || ruleCount == 0u) {
        g.phase = kPhaseEnded;
        return;
    }
    uint number = uint(selected);
    at = map.rules + ((rules & 0xFFFFu) + (number < ruleCount ? number : ruleCount - 1u)) * kRuleWords;
    uint head = TABLE(at);
    uint links = TABLE(at + 1u);
    uint slots = TABLE(at + 4u);
    drawTable(MACHINE env, map, links >> 16u, (head >> 16u) & 255u, g.key, g.key);
    runTable(MACHINE env, map, TABLE(at + 2u));
    g.rule = head;
    g.links = links;
    g.arriveCode = TABLE(at + 3u);
    g.distance = larger(packedValue(MACHINE slots & 127u, TABLE(at + 5u)), site.minStep);
    g.angle = packedValue(MACHINE (slots >> 8u) & 127u, TABLE(at + 6u));
    g.conditionSlot = (slots >> 16u) & 127u;
    g.conditionValue = TABLE(at + 7u);
    g.reads.params = g.reads.params | TABLE(at + 8u);
    g.attempt = 0u;
    g.fresh = true;
    g.phase = (head & 3u) == kRuleMarch ? kPhaseMarch : kPhaseEnded;

    uint first = links & 0xFFFFu;
    uint count = (head & 3u) == kRuleList ? (head >> 2u) & 63u : 0u;
    u64 key = g.key;
    for (uint i = first; i < first + count; ++i) {
        at = map.successors + i * kSuccessorWords;
        uint successor = TABLE(at);
        runTable(MACHINE env, map, TABLE(at + 2u));
        vec4 args = readArgs(MACHINE env, at, successor);
        u64 child = successorKey(key, successor, TABLE(at + 1u));
        uint symbol = successor & 0xFFFFu;
        bool branches = (successor & kPackedContinues) == 0u;
        Walk walk = g.at.walk;
        walk.arc = 0.0f;
        WorkItem item = itemOf(entry, site, child, g.grammar, symbol, args, walk);
        item.origin = g.count == 0u ? kNoIndex : g.count - 1u;
        item.branch = kNoIndex;
        item.depth = entry.depth + 0x10001u;
        item.step = entry.step & 0xFF000000u;
        pushItem(env, item, branches, g);
        if (branches) {
            g.hash = hashWord(hashWord(g.hash, uint(child)), uint(child >> 32));
        } else {
            g.key = child;
            g.symbol = symbol;
            g.args = args;
            g.phase = kPhaseDerive;
        }
    }
}

// Writes a sample into the stage.
FN void stageNode(ExpandEnv env, WalkState w, vec3 normal, uint flags, uint index) {
    uint at = index * kStagedWords;
    STAGED(at) = floatBitsToUint(w.position.x);
    STAGED(at + 1u) = floatBitsToUint(w.position.y);
    STAGED(at + 2u) = floatBitsToUint(w.position.z);
    STAGED(at + 3u) = packOct(normal);
    STAGED(at + 4u) = packOct(headingOf(env, w));
    STAGED(at + 5u) = packUv(w.walk.uv);
    STAGED(at + 6u) = w.walk.place;
    STAGED(at + 7u) = floatBitsToUint(w.walk.arc);
    STAGED(at + 8u) = flags | (index << 8u);
}

// The angle of an attempt: the rule's own, then a fan over the semicircle around the heading, the side that comes
// first drawn by the key.
FN float attemptAngle(Grower g) {
    float side = ((uint(g.key >> 17) ^ g.attempt) & 1u) != 0u ? 1.0f : -1.0f;
    return g.attempt == 0u ? g.angle : side * kDetourAngle * float((g.attempt + 1u) >> 1u);
}

// One stretch of the step under way.
FN void marchOn(ExpandEnv env, GrowthSite site, INOUT(Grower) g) {
    if (g.fresh) {
        g.trial = g.at;
        g.remaining = g.distance;
        g.pending = 0u;
        g.lastArc = g.at.walk.arc;
        g.fresh = false;
        turnWalk(env, g.trial, attemptAngle(g));
    }
    vec3 normal;
    uint event = advanceWalk(env, site.level, g.trial, g.remaining, normal);
    bool goesOn = walkGoesOn(event);
    bool arrived = event == kWalkDone;
    g.arrived = arrived;
    g.placed = false;
    bool recorded = arrived || (goesOn && walkHasSample(event));
    bool tiny = g.trial.walk.arc - g.lastArc < 0.02f * g.distance;
    if (arrived && tiny && g.pending > 0u) g.pending = g.pending - 1u;
    recorded = recorded && (arrived || !tiny);

    uint index = g.count + g.pending;
    bool room = index + (arrived ? 0u : 1u) < kChunkNodes;
    bool full = recorded && !room && g.count > 0u;
    g.phase = full ? kPhaseFull : g.phase;   // the whole step moves to the next chunk
    if (recorded && room) {
        uint flags = ((g.rule >> 8u) & 255u) | (arrived ? 0u : kNodeInserted) | ((g.steps & 31u) << 26u);
        stageNode(env, g.trial, normal, flags, index);
        g.pending = g.pending + 1u;
        g.lastArc = g.trial.walk.arc;
    }
    if (!arrived && !goesOn) {
        // A border of the model, or no surface: the next direction.
        g.phase = g.attempt >= kDetours ? kPhaseDead : g.phase;
        g.attempt = g.attempt + 1u;
        g.fresh = true;
    }
}

// At the end of a step: its condition, and its successor. The machine knows the place.
FN void arrive(MACHINE_PARAM ExpandEnv env, TableBases map, INOUT(Grower) g) {
    g.arrived = false;
    runTable(MACHINE env, map, g.arriveCode);
    if (!holds(packedValue(MACHINE g.conditionSlot, g.conditionValue))) {
        // Where the condition asks nothing of the place, no other direction can help.
        bool blind = (g.rule & kRuleBlind) != 0u;
        g.phase = blind ? kPhaseEnded : g.attempt >= kDetours ? kPhaseDead : kPhaseMarch;
        g.attempt = g.attempt + 1u;
        g.fresh = true;
        return;
    }
    g.at = g.trial;
    g.count = g.count + g.pending;
    g.inserted = g.inserted + g.pending - 1u;
    g.pending = 0u;
    g.steps = g.steps + 1u;
    g.hash = hashVec3(g.hash, g.at.position);
    if ((g.rule & 252u) == 0u) {
        g.phase = kPhaseEnded;   // no successor
        return;
    }
    uint at = map.successors + (g.links & 0xFFFFu) * kSuccessorWords;
    uint head = TABLE(at);
    g.args = readArgs(MACHINE env, at, head);
    g.key = successorKey(g.key, head, TABLE(at + 1u));
    g.symbol = head & 0xFFFFu;
    g.phase = g.count >= kChunkNodes ? kPhaseFull : kPhaseDerive;
}

// The level on which shapes of this width grow: the coarsest whose texels are no wider, in the entry's chart.
FN uint levelFor(ExpandEnv env, uint place, float width, OUT(float) texel) {
    uint instance = place >> 16u;
    uint chart = place & 0xFFFFu;
    uint last = env.surfaces.v[instance].levelCount - 1u;
    uint size = env.surfaces.v[instance].levels[0].size;
    texel = env.surfaces.v[instance].charts.v[chart].metresPerUv * env.surfaces.v[instance].scale *
            rcpExact(float(size));
    uint level = 0u;
    for (uint i = 0u; i < kMaxLevels; ++i) {
        if (level >= last || texel * 2.0f > width) break;
        level = level + 1u;
        texel = texel * 2.0f;
    }
    return level;
}

// A growth that must stop somewhere takes whole waves, and of the last one a share that the keys draw.
FN bool refused(ExpandEnv env, uint wave, u64 key) {
    uint last = env.status.v[0].limitWave;
    return wave > last || (wave == last && uint(key >> 32) >= env.status.v[0].limitKey);
}

// The node that a chunk's first span starts from.
FN uint previousNodeOf(ExpandEnv env, WorkItem item) {
    if (item.parent == kNoIndex) return kNoIndex;
    return item.origin == kNoIndex ? env.chunks.v[item.parent].previousNode
                                   : env.chunks.v[item.parent].firstNode + item.origin;
}

// Takes a range of nodes, copies what was staged, and returns the first index.
FN uint publishNodes(ExpandEnv env, uint chunk, uint count) {
    uint first = count > 0u ? atomicAdd(env.status.v[0].nodes, count) : 0u;
    bool fits = first + count <= env.status.v[0].nodeCapacity;
    if (count > 0u) {
        atomicAdd(env.waves.v[env.wave].nodes, count);
        uint added = groupsAdded(first, count, kExpandGroup);
        if (fits && added > 0u) atomicAdd(env.status.v[0].nodeGroups[0], added);
    }
    for (uint i = 0u; i < (fits ? count : 0u); ++i) {
        uint at = i * kStagedWords;
        Node node;
        node.position = vec3(uintBitsToFloat(STAGED(at)), uintBitsToFloat(STAGED(at + 1u)), uintBitsToFloat(STAGED(at + 2u)));
        node.normal = STAGED(at + 3u);
        node.tangent = STAGED(at + 4u);
        node.uv = STAGED(at + 5u);
        node.place = STAGED(at + 6u);
        node.radius = 0.0f;
        node.arc = uintBitsToFloat(STAGED(at + 7u));
        node.chunk = chunk;
        node.flags = STAGED(at + 8u);
        env.nodes.v[first + i] = node;
    }
    return first;
}

// The branch's record: begun by its first chunk that has nodes, its length renewed by every one.
FN uint publishBranch(ExpandEnv env, WorkItem item, GrowthSite site, float length) {
    uint branch = item.branch;
    bool begins = branch == kNoIndex;
    if (begins) {
        branch = atomicAdd(env.status.v[0].branches, 1u);
        uint added = groupsAdded(branch, 1u, kExpandGroup);
        if (added > 0u && branch < env.status.v[0].branchCapacity) atomicAdd(env.status.v[0].branchGroups[0], added);
    }
    if (branch >= env.status.v[0].branchCapacity) return branch;
    if (begins) {
        env.branches.v[branch].thickness = 1.0f;
        env.branches.v[branch].firstChunk = site.chunk;
        env.branches.v[branch].seed = item.seed;
    } else {
        env.chunks.v[item.parent].next = site.chunk;
    }
    env.branches.v[branch].extent = length;
    return branch;
}

FN void publishChunk(ExpandEnv env, WorkItem item, GrowthSite site, INOUT(Grower) g, uint previousNode, bool goesOn) {
    float length = g.at.walk.arc;
    uint branch = item.branch;
    uint first = publishNodes(env, site.chunk, g.count);
    if (g.count > 0u || branch != kNoIndex) branch = publishBranch(env, item, site, length);

    Chunk c;
    c.key = item.key;
    uvec2 h = hashVec3(g.hash, g.at.walk.direction);
    h = hashWord(hashWord(h, uint(g.key)), uint(g.key >> 32));
    c.exitHash = h.x ^ h.y;
    c.entry = item.walk;
    c.symbol = item.symbol;
    c.args[0] = item.args[0];
    c.args[1] = item.args[1];
    c.args[2] = item.args[2];
    c.args[3] = item.args[3];
    c.parent = item.parent;
    c.previousNode = previousNode;
    c.next = kNoIndex;
    c.branch = branch;
    c.firstNode = first;
    c.depth = item.depth;
    c.step = item.step;
    uint flags = kChunkPublished | (g.reads.all ? kChunkReadsAll : 0u) | (goesOn ? 0u : kChunkEndsBranch);
    flags = flags | (g.phase == kPhaseDead ? kChunkDeadEnd : 0u) | (g.phase == kPhaseStopped ? kChunkStopped : 0u);
    c.marks = (g.reads.layers << 16u) | (g.count << 8u) | flags;
    c.paramMask = g.reads.params;
    c.readTiles[0] = g.reads.tile0;
    c.readTiles[1] = g.reads.tile1;
    c.readTiles[2] = g.reads.tile2;
    c.readTiles[3] = g.reads.tile3;
    writeChunk(env.chunks, site.chunk, c);

    WorkItem rest = itemOf(item, site, g.key, g.grammar, g.symbol, g.args, g.at.walk);
    rest.origin = g.count - 1u;
    rest.branch = branch;
    rest.depth = item.depth + 0x10000u;
    rest.step = item.step + g.steps;
    pushItem(env, rest, goesOn, g);
}

FN void countChunk(ExpandEnv env, Grower g) {
    atomicAdd(env.waves.v[env.wave].chunks, 1u);
    if (g.steps > 0u) atomicAdd(env.status.v[0].steps, g.steps);
    if (g.inserted > 0u) atomicAdd(env.status.v[0].inserted, g.inserted);
    uint stopped = g.refused + (g.phase == kPhaseStopped ? 1u : 0u);
    if (stopped > 0u) atomicAdd(env.status.v[0].stopped, stopped);
    if (g.pushed > 0u) {
        uint before = atomicAdd(env.waves.v[env.wave + 1u].announced, g.pushed);
        uint added = groupsAdded(before, g.pushed, kItemsPerGroup);
        if (added > 0u) atomicAdd(env.waves.v[env.wave + 1u].groups[0], added);
    }
    if (g.phase == kPhaseDead) atomicAdd(env.status.v[0].deadEnds, 1u);
}

// A chunk in flight.
struct ChunkGrowth {
    WorkItem item;
    GrowthSite site;
    TableBases map;
    WorldFrame frame;
    Grower g;
};

FN bool growing(Grower g) { return g.phase <= kPhaseMarch; }

FN Grower freshGrower(WorkItem item) {
    Grower g;
    g.phase = kPhaseDerive;
    g.key = item.key;
    g.grammar = item.symbol >> 16u;
    g.symbol = item.symbol & 0xFFFFu;
    g.args = vec4(item.args[0], item.args[1], item.args[2], item.args[3]);
    g.rule = 0u;
    g.links = 0u;
    g.arriveCode = 0u;
    g.conditionSlot = 0u;
    g.conditionValue = 0u;
    g.distance = 0.0f;
    g.angle = 0.0f;
    g.remaining = 0.0f;
    g.attempt = 0u;
    g.fresh = true;
    g.arrived = false;
    g.placed = false;
    g.pending = 0u;
    g.lastArc = item.walk.arc;
    g.count = 0u;
    g.steps = 0u;
    g.inserted = 0u;
    g.trips = 0u;
    g.pushed = 0u;
    g.refused = 0u;
    g.reads = emptyReadSet();
    g.hash = hashKey(item.key);
    return g;
}

// Starts the chunk of an item. False: it is refused, or there is no room for it.
FN bool beginChunk(MACHINE_PARAM ExpandEnv env, WorkItem item, INOUT(ChunkGrowth) c) {
    if (refused(env, env.wave, item.key)) {
        atomicAdd(env.status.v[0].stopped, 1u);
        return false;
    }
    uint chunk = atomicAdd(env.status.v[0].chunks, 1u);
    if (chunk >= env.status.v[0].chunkCapacity) return false;
    Walk walk = item.walk;
    bool exists = (walk.place & 0xFFFFu) < env.surfaces.v[walk.place >> 16u].chartCount;
    walk.place = exists ? walk.place : walk.place & 0xFFFF0000u;
    float texel;
    c.item = item;
    c.g = freshGrower(item);
    c.map = basesOf(env, c.g.grammar);
    c.site.chunk = chunk;
    uint tables = c.g.grammar * kGrammarWords;
    c.site.inputs = TABLE(tables + kTableInputs);
    c.site.layers = TABLE(tables + kTableLayers);
    uint width = TABLE(tables + kTableWidth);
    c.site.level = levelFor(env, walk.place, uintBitsToFloat(width), texel);
    c.site.depth = item.depth & 0xFFFFu;
    c.site.stepBase = item.step & 0xFFFFFFu;
    c.site.minStep = 0.25f * texel;
    c.frame = frameOf(env.surfaces, walk.place >> 16u, c.site.inputs);
    bool stands = enterWalk(env, c.site.level, walk, item.parent == kNoIndex, c.g.at) && exists;
    c.g.trial = c.g.at;
    resetMachine(MACHINE_ONLY);
    if (!stands) {
        c.g.phase = kPhaseDead;
        atomicAdd(env.status.v[0].lost, 1u);
    }
    if (stands && item.parent == kNoIndex) {
        stageNode(env, c.g.at, c.g.at.normal, 0u, 0u);   // the seed's foot
        c.g.count = 1u;
    }
    return true;
}

// One trip: the decision at the end of a step, the rule for the next, and a stretch of it.
FN void growOn(MACHINE_PARAM ExpandEnv env, INOUT(ChunkGrowth) c) {
    bool here = c.g.arrived || c.g.phase == kPhaseDerive;
    if (here && !c.g.placed) {
        uint instance = c.g.trial.walk.place >> 16u;
        if (instance != c.frame.instance) c.frame = frameOf(env.surfaces, instance, c.site.inputs);
        giveInputs(MACHINE env, c.frame, c.g.grammar, c.site.inputs, c.site.layers, placeOf(env, c.g.trial), c.site.depth,
                   c.site.stepBase + c.g.steps + (c.g.arrived ? 1u : 0u), c.g.trial.walk.arc, c.g.reads);
        c.g.placed = true;
    }
    if (c.g.arrived) arrive(MACHINE env, c.map, c.g);
    for (uint lists = 0u; lists <= kMaxListDepth && c.g.phase == kPhaseDerive; ++lists) {
        deriveRule(MACHINE env, c.map, c.site, c.item, c.g);
    }
    if (c.g.phase == kPhaseMarch) marchOn(env, c.site, c.g);
    c.g.trips = c.g.trips + 1u;
    if (growing(c.g) && c.g.trips >= kMaxTrips) c.g.phase = c.g.count > 0u ? kPhaseFull : kPhaseStopped;
}

FN void endChunk(ExpandEnv env, INOUT(ChunkGrowth) c) {
    bool goesOn = c.g.phase == kPhaseFull;
    if (goesOn && refused(env, env.wave + 1u, c.g.key)) {
        goesOn = false;
        c.g.phase = kPhaseStopped;
    }
    publishChunk(env, c.item, c.site, c.g, previousNodeOf(env, c.item), goesOn);
    countChunk(env, c.g);
}

ESPALIER_END
#endif
