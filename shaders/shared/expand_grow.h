// Growing one chunk: begun from its work item, stepped until it ends or is full, published (Buron 2015 §5).
//
// A chunk is a pure function of its work item and of the inputs (surface, rule maps, layers): it reads nothing that
// growth writes but the chunk that it leaves, and what stands since earlier waves where its stem keeps a distance. What a regrowth does otherwise (ESPALIER_AGAIN: it takes places of chunks
// that are grown again, and leaves those alone that come out as they were) is in shaders/expand/again_claim.h.
#ifndef ESPALIER_SHARED_EXPAND_GROW_H
#define ESPALIER_SHARED_EXPAND_GROW_H
#include "shaders/shared/expand_avoid.h"
#include "shaders/shared/expand_step.h"
#ifdef ESPALIER_AGAIN
#include "shaders/expand/again_claim.h"
#endif

ESPALIER_BEGIN

// The level on which shapes of this width grow: the coarsest whose texels are no wider, in the entry's chart.
FN uint levelFor(ExpandEnv env, uint place, float width, OUT(float) texel) {
    uint instance = place >> 16u;
    uint chart = place & 0xFFFFu;
    uint last = env.surfaces.v[instance].levelCount - 1u;
    uint size = levelSize(env.surfaces, instance, 0u);
    texel = env.surfaces.v[instance].charts.v[chart].metresPerUv * surfaceScale(env.surfaces, instance) *
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
// depth: of the item in chunks, which is its wave unless it is grown again.
FN bool refused(ExpandEnv env, uint depth, u64 key) {
    uint last = env.status.v[0].limitWave;
    return depth > last || (depth == last && uint(key >> 32) >= env.status.v[0].limitKey);
}

#ifndef ESPALIER_AGAIN
// The place of a new chunk. False: there is none.
FN bool claimChunk(ExpandEnv env, INOUT(WorkItem) item, OUT(uint) chunk) {
    UNUSED(item);
    chunk = atomicAdd(env.status.v[0].chunks, 1u);
    return chunk < env.status.v[0].chunkCapacity;
}
FN uint claimBranch(ExpandEnv env, uint chunk) {
    UNUSED(chunk);
    return atomicAdd(env.status.v[0].branches, 1u);
}
// The node that a chunk's first span starts from.
FN uint previousNodeOf(ExpandEnv env, WorkItem item) { return startOfItem(env, item); }
// Puts the chunk among its parent's; returns the next of these.
FN uint joinSiblings(ExpandEnv env, WorkItem item, uint chunk) {
    return item.parent == kNoIndex ? kNoIndex : atomicExchange(env.chunks.v[item.parent].firstChild, chunk);
}
// Groups for the passes over nodes and branches, which leave out those of frozen plants: so these don't count.
FN void askNodeGroups(ExpandEnv env, uint first, uint count) {
    uint added = laneGroupsAdded(first - env.status.v[0].frozenNodes, count, kNodesPerGroup);
    if (added > 0u) atomicAdd(env.status.v[0].nodeGroups[0], added);
}
FN void askBranchGroups(ExpandEnv env, uint branch) {
    uint added = groupsAdded(branch - env.status.v[0].frozenBranches, 1u, kExpandGroup);
    if (added > 0u) atomicAdd(env.status.v[0].branchGroups[0], added);
}
#endif

// Takes a range of nodes, copies what was staged, and returns the first index.
FN uint publishNodes(ExpandEnv env, uint chunk, uint count) {
    UintBuf stage = env.scratch;
    UNUSED(stage);
    uint first = count > 0u ? atomicAdd(env.status.v[0].nodes, count) : 0u;
    bool fits = first + count <= env.status.v[0].nodeCapacity;
    if (fits && count > 0u) askNodeGroups(env, first, count);
    for (uint i = 0u; i < (fits ? count : 0u); ++i) {
        StagedSample s = {};
        FILL_StagedSample(s, STAGED, i * kStagedSample_words)
        Node node = {};
        node.position = s.position;
        node.normal = normalWithHeading(s.normal, s.heading);
        node.tangent = tangentWithHeading(s.heading, s.heading);
        node.uv = s.uv;
        node.place = s.place;
        node.radius = 0.0f;
        node.arc = s.arc;
        node.chunk = chunk;
        node.flags = s.flags;
        writeNode(env.nodes, first + i, node);
    }
    return first;
}

// The branch's record: begun by its first chunk that has nodes, its length renewed by every one.
FN uint publishBranch(ExpandEnv env, WorkItem item, GrowthSite site, float length) {
    uint branch = item.branch;
    bool begins = branch == kNoIndex;
    if (begins) {
        branch = claimBranch(env, site.chunk);
        if (branch < env.status.v[0].branchCapacity) askBranchGroups(env, branch);
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
    Walk stand = STAND(g).walk;
    float length = stand.arc;
    uint branch = item.branch;
    uint first = publishNodes(env, site.chunk, g.progress.count);
    if (g.progress.count > 0u || branch != kNoIndex) branch = publishBranch(env, item, site, length);

    Chunk c = {};
    c.key = item.key;
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
    c.firstNode = branch == kNoIndex ? item.seed : first;
    c.depth = item.depth;
    c.step = (item.step & 0xFFFFFFu) | ((g.progress.refused < 255u ? g.progress.refused : 255u) << 24u);
    uint flags = kChunkPublished | (g.reads.beyond ? kChunkBeyond : 0u);
    flags = flags | (g.progress.phase == kPhaseDead ? kChunkDeadEnd : 0u) | (g.progress.phase == kPhaseStopped ? kChunkStopped : 0u);
    flags = flags | (g.progress.phase == kPhaseDead && g.step.turnedBack ? kChunkTurnedBack : 0u);
    c.marks = (site.sceneLayers << 16u) | (g.progress.count << 8u) | readLevelMarks(g.reads.level) | flags;
    c.uses = g.reads.uses;
    c.firstChild = kNoIndex;
    c.nextSibling = joinSiblings(env, item, site.chunk);
    c.reads[0] = readWord(g.reads, 0u);
    c.reads[1] = readWord(g.reads, 1u);
    c.reads[2] = readWord(g.reads, 2u);
    writeChunk(env.chunks, site.chunk, c);
#ifndef ESPALIER_AGAIN
    if ((kFeatures & kFeatureAvoid) != 0u && avoids(env)) noteTries(env, site.chunk, item.step);
#endif

    vec4 args = vec4(g.shape.args[0], g.shape.args[1], g.shape.args[2], g.shape.args[3]);
    WorkItem rest = itemOf(item, site, g.shape.key, g.shape.grammar, g.shape.symbol, args, stand);
    rest.origin = g.progress.count - 1u;
    rest.branch = branch;
    rest.depth = item.depth + 0x10000u;
    rest.step = (item.step & 0xFFFFFFu) + g.progress.steps;
    pushItem(env, rest, goesOn, g);
}

FN GrowthTally emptyTally() {
    GrowthTally t = {};
    t.chunks = 0u;
    t.nodes = 0u;
    t.steps = 0u;
    t.inserted = 0u;
    t.stopped = 0u;
    t.deadEnds = 0u;
    return t;
}
FN void addTally(ExpandEnv env, GrowthTally t) {
    atomicAdd(env.waves.v[env.wave].chunks, t.chunks);
    atomicAdd(env.waves.v[env.wave].nodes, t.nodes);
    atomicAdd(env.status.v[0].steps, t.steps);
    atomicAdd(env.status.v[0].inserted, t.inserted);
    atomicAdd(env.status.v[0].stopped, t.stopped);
    atomicAdd(env.status.v[0].deadEnds, t.deadEnds);
#ifndef ESPALIER_AGAIN
    if ((kFeatures & kFeatureAvoid) == 0u || !avoids(env)) return;
    uint before = atomicAdd(env.status.v[0].waveChunks, t.chunks);
    uint added = groupsAdded(before, t.chunks, 1u);
    if (added > 0u) atomicAdd(env.status.v[0].chunkGroups[0], added);
#endif
}

FN void countChunk(ExpandEnv env, IN(Grower) g, INOUT(GrowthTally) t) {
    t.chunks = t.chunks + 1u;
    t.nodes = t.nodes + g.progress.count;
    t.steps = t.steps + g.progress.steps;
    t.inserted = t.inserted + g.progress.inserted;
    t.stopped = t.stopped + g.progress.refused + (g.progress.phase == kPhaseStopped ? 1u : 0u);
    t.deadEnds = t.deadEnds + (g.progress.phase == kPhaseDead ? 1u : 0u);
    if (g.progress.pushed > 0u) {
        uint before = atomicAdd(env.waves.v[env.wave + 1u].announced, g.progress.pushed);
        uint added = laneGroupsAdded(before, g.progress.pushed, kItemsPerGroup);
        if (added > 0u) atomicAdd(env.waves.v[env.wave + 1u].groups[0], added);
    }
}

// A chunk in flight.
struct ChunkGrowth {
    WorkItem item;
    GrowthSite site;
    Grower g;
};

FN bool growing(IN(ChunkProgress) progress) { return progress.phase <= kPhaseMarch; }

FN Grower freshGrower(WorkItem item) {
    Grower g = {};
    g.progress.phase = kPhaseDerive;
    g.shape.key = item.key;
    g.shape.grammar = item.symbol >> 16u;
    g.shape.symbol = item.symbol & 0xFFFFu;
    for (uint i = 0u; i < 4u; ++i) g.shape.args[i] = item.args[i];
    g.rule.head = 0u;
    g.rule.links = 0u;
    g.rule.arriveCode = 0u;
    g.rule.conditionSlots = 0u;
    g.rule.conditionValue = 0u;
    g.rule.distance = 0.0f;
    g.rule.angle = 0.0f;
    g.remaining = 0.0f;
    g.step.attempt = 0u;
    g.step.turnedBack = false;
    g.step.fresh = true;
    g.step.arrived = false;
    g.step.ground = kNoIndex;
    g.step.laying = kStepKept;
    g.step.pending = 0u;
    g.step.lastArc = item.walk.arc;
    g.progress.count = 0u;
    g.progress.steps = 0u;
    g.progress.inserted = 0u;
    g.progress.trips = 0u;
    g.progress.pushed = 0u;
    g.progress.refused = 0u;
    g.reads = emptyReadSet();
    return g;
}

#ifndef ESPALIER_AGAIN
// Whether an item waited behind a part of a stem that has come too near to another.
FN bool isDropped(ExpandEnv env, WorkItem item) {
    if ((kFeatures & kFeatureAvoid) == 0u || !avoids(env) || !stemEnds(env, item.parent, item.origin)) return false;
    atomicAdd(env.status.v[0].dropped, 1u);
    return true;
}
#endif

// Starts the chunk of an item. False: it is refused, or there is no room for it.
FN bool beginChunk(MACHINE_PARAM ExpandEnv env, WorkItem item, INOUT(ChunkGrowth) c) {
#ifndef ESPALIER_AGAIN
    if (isDropped(env, item)) return false;
#endif
    if (refused(env, item.depth >> 16u, item.key)) {
        atomicAdd(env.status.v[0].stopped, 1u);
        return false;
    }
    uint chunk = 0u;
    if (!claimChunk(env, item, chunk)) return false;
    Walk walk = item.walk;
    bool exists = (walk.place & 0xFFFFu) < env.surfaces.v[walk.place >> 16u].chartCount;
    walk.place = exists ? walk.place : walk.place & 0xFFFF0000u;
    float texel = 0.0f;
    c.item = item;
    c.g = freshGrower(item);
    c.site.chunk = chunk;
    uint tables = c.g.shape.grammar * kGrammarTables_words;
    c.site.inputs = TABLE(tables + kGrammarTables_inputs);
    c.site.layers = TABLE(tables + kGrammarTables_layers);
    c.site.sceneLayers = TABLE(tables + kGrammarTables_sceneLayers);
    uint width = TABLE(tables + kGrammarTables_width);
    c.site.level = levelFor(env, walk.place, uintBitsToFloat(width), texel);
    c.site.depth = item.depth & 0xFFFFu;
    c.site.stepBase = item.step & 0xFFFFFFu;
    c.site.minStep = 0.25f * texel;
    bool stands = enterWalk(env, c.site.level, walk, item.parent == kNoIndex, c.g.trial) && exists;
    bool pruned = item.branch == kNoIndex &&
                  isAmong(env.status.v[0].pruned, 0u, env.status.v[0].prunedCount, item.key);
    KEEP_STAND(c.g);
    resetMachine(MACHINE_ONLY);
    if (!stands) {
        c.g.progress.phase = kPhaseDead;
        atomicAdd(env.status.v[0].lost, 1u);
    }
    if (pruned) c.g.progress.phase = kPhaseEnded;   // a chunk without nodes stays, so that the branch can come back
    if (stands && !pruned && item.parent == kNoIndex) {
        stageNode(env, c.g.trial, packOct(c.g.trial.normal), packOct(headingOf(env, c.g.trial)), false, 0u, 0u);   // the seed's foot
        c.g.progress.count = 1u;
    }
    return true;
}

// A trip is the decision at the end of a step, the rule for the next, and a stretch of it. Before the stretch: rules read
// layers at the ends of steps, terminals at every sample;
FN void noteWay(uint sceneLayers, IN(WalkState) trial, INOUT(ReadSet) reads) {
    if ((kFeatures & kFeatureSurface) != 0u && sceneLayers != 0u) notePlace(reads, trial.walk.place >> 16u, trial.walk.uv);
}
// whether there is something to decide,
FN bool decides(uint phase, bool arrived) { return arrived || phase == kPhaseDerive; }
// the place, which the machine is told (frame: of its instance),
FN void tellPlace(MACHINE_PARAM ExpandEnv env, WorldFrame frame, GrowthSite site, uint grammar, IN(WalkState) trial,
                  uint steps) {
    giveInputs(MACHINE env.surfaces, env.layers, env.grammars, frame, grammar, site.inputs, site.layers, placeOf(env, trial), site.depth,
               site.stepBase + steps, trial.walk.arc);
}
// and rules, one after another.
FN void deriveRules(MACHINE_PARAM ExpandEnv env, TableBases map, GrowthSite site, WorkItem entry, INOUT(Grower) g) {
    uint lists = 0u;
    do {
        deriveRule(MACHINE env, map, site, entry, g);
    } while (++lists <= kMaxListDepth && g.progress.phase == kPhaseDerive);
}
// After it.
FN void endTrip(INOUT(ChunkProgress) p) {
    p.trips = p.trips + 1u;
    if (growing(p) && p.trips >= kMaxTrips) p.phase = p.count > 0u ? kPhaseFull : kPhaseStopped;
}

FN void endChunk(ExpandEnv env, INOUT(ChunkGrowth) c, INOUT(GrowthTally) t) {
    bool goesOn = c.g.progress.phase == kPhaseFull;
    if (goesOn && refused(env, (c.item.depth >> 16u) + 1u, c.g.shape.key)) {
        goesOn = false;
        c.g.progress.phase = kPhaseStopped;
    }
    publishChunk(env, c.item, c.site, c.g, previousNodeOf(env, c.item), goesOn);
    countChunk(env, c.g, t);
}

ESPALIER_END
#endif
