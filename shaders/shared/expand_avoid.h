// Stems that keep their distance from others: docs/decisions/stems_keep_their_distance.md.
//
// A step that would come too near to a span of earlier waves takes another direction, as where its condition fails. What
// the chunks of one wave do to each other is decided behind it: their spans enter a hashed grid, then rounds find the
// chunks that stand. One falls where it comes too near to a span of another branch that stands and comes before it; it
// grows again in the next wave, where it can give way to what stands.
#ifndef ESPALIER_SHARED_EXPAND_AVOID_H
#define ESPALIER_SHARED_EXPAND_AVOID_H
#include "records/expand_rows.h"
#include "shaders/shared/exact.h"
#include "shaders/shared/record_lookup.h"

ESPALIER_BEGIN

CONST_FLOAT(kJointReach, 3.0f);      // of the distance: spans that begin or end so near a joint may be near each other
CONST_FLOAT(kMostGridPoints, 32.0f);   // of a span, but for one; the host sees to it by the grid's width
CONST_UINT(kAvoidSteps, 8u);           // of a chunk: the fewer, the sooner others know of them
CONST_UINT(kMostTries, 3u);            // of a chunk that falls; then what stands in front of the place is kept

// A word that others change meanwhile.
#ifdef __cplusplus
#define LOAD_MEANWHILE(memory) loadShared(memory)
#else
#define LOAD_MEANWHILE(memory) atomicOr(memory, 0u)
#endif

CONST_UINT(kSpanStands, 0u);
CONST_UINT(kSpanWaits, 1u);    // it is near one of which nobody knows yet
CONST_UINT(kSpanYields, 2u);   // to one of the same wave
CONST_UINT(kSpanFalls, 3u);    // it is too near to one of an earlier wave

FN bool avoids(ExpandEnv env) { return env.status.v[0].avoidReach > 0.0f; }
// Whether all found room, in the grid, too. Else the attempt ends with this wave, and the host gives more.
FN bool roomToAvoid(ExpandEnv env) {
    return roomForNodes(env) && env.status.v[0].avoidTaken <= env.status.v[0].avoidCapacity;
}

FN uint leastOf(uint bounds) { return bounds & 255u; }
FN uint mostOf(uint bounds) { return (bounds >> 8u) & 255u; }
FN uint triesOf(uint bounds) { return bounds >> 16u; }
FN bool isDecided(uint bounds) { return leastOf(bounds) == mostOf(bounds); }

// How far a chunk's stem stays away from others. Frozen ones don't: what grows stays away from them.
FN float distanceKept(ExpandEnv env, uint chunk) {
    if (chunk < env.status.v[0].frozenChunks) return 0.0f;
    uint grammar = env.chunks.v[chunk].symbol >> 16u;
    return uintBitsToFloat(env.tables.v[grammar * kGrammarTables_words + kGrammarTables_avoid]);
}

// Metres along the world's axes, from the origin of an instance: so nothing depends on how far away the world's is.
struct WorldSpan { vec3 from, to; };

// Whole rows are read: kernels that read a single number of a vector by address grew other plants on lavapipe 22.3.6.
FN vec3 translationOf(ExpandEnv env, uint instance) {
    vec4 r0 = env.surfaces.v[instance].toWorld[0];
    vec4 r1 = env.surfaces.v[instance].toWorld[1];
    vec4 r2 = env.surfaces.v[instance].toWorld[2];
    return vec3(r0.w, r1.w, r2.w);
}
// base: the instance whose origin counts.
FN vec3 inWorld(ExpandEnv env, uint instance, vec3 p, uint base) {
    vec4 r0 = env.surfaces.v[instance].toWorld[0];
    vec4 r1 = env.surfaces.v[instance].toWorld[1];
    vec4 r2 = env.surfaces.v[instance].toWorld[2];
    // Both lie far from the origin perhaps, and near each other.
    return rowsTimes(r0, r1, r2, p) + (translationOf(env, instance) - translationOf(env, base));
}
FN vec3 worldPosition(ExpandEnv env, uint node, uint base) {
    return inWorld(env, env.nodes.v[node].place >> 16u, readPosition(env, node), base);
}
FN uint indexInChunk(ExpandEnv env, uint node) { return (loadShared(env.nodes.v[node].flags) >> 8u) & 31u; }
// The span that ends at a node; of a seed's foot it is a point.
FN WorldSpan spanAt(ExpandEnv env, uint node, uint base) {
    uint before = indexInChunk(env, node) > 0u ? node - 1u : env.chunks.v[env.nodes.v[node].chunk].previousNode;
    WorldSpan s = {};
    s.to = worldPosition(env, node, base);
    s.from = before == kNoIndex ? s.to : worldPosition(env, before, base);
    return s;
}

// Of two spans that are nearer to each other than the grid's reach there are points that are nearer than 1.75 of it. A
// cell is four times as wide as it: so who looks for a point's neighbours looks into eight cells, the first of which is
// gridCorner(). What is left takes up roundings of places that are far from the world's origin.
FN uint gridPoints(ExpandEnv env, IN(WorldSpan) s) {
    float wanted = divExact(length3(s.to - s.from), 0.75f * env.status.v[0].gridReach);
    return 1u + uint(smaller(wanted, kMostGridPoints));
}
FN vec3 gridPoint(IN(WorldSpan) s, uint i, uint points) {
    return s.from + (s.to - s.from) * divExact(float(i) + 0.5f, float(points));
}
FN vec3 gridFloor(vec3 at) {
    return vec3(floorExact(limited(at.x, -1e9f, 1e9f)), floorExact(limited(at.y, -1e9f, 1e9f)),
                floorExact(limited(at.z, -1e9f, 1e9f)));
}
FN vec3 gridScaled(ExpandEnv env, vec3 p) { return p * rcpExact(4.0f * env.status.v[0].gridReach); }
FN vec3 gridCell(ExpandEnv env, vec3 p) { return gridFloor(gridScaled(env, p)); }
FN vec3 gridCorner(ExpandEnv env, vec3 p) { return gridFloor(gridScaled(env, p) - vec3(0.5f)); }
FN uint headOf(ExpandEnv env, vec3 cell) { return hashVec3(uvec2(3u, 5u), cell).x & (env.status.v[0].avoidCells - 1u); }

// How wide the grid has to be for this span: points of a span are few, and cells are numbers that floats can tell apart.
FN void noteGridNeed(ExpandEnv env, IN(WorldSpan) s, vec3 origin) {
    vec3 far = s.to + origin;
    float farthest = larger(larger(absolute(far.x), absolute(far.y)), absolute(far.z));
    float need = larger(length3(s.to - s.from) * (1.5f / kMostGridPoints), farthest * 9.5367431640625e-7f);
    if (need > env.status.v[0].gridReach) atomicMax(env.status.v[0].gridNeed, floatBitsToUint(need));
}

FN void enterSpan(ExpandEnv env, uint node) {
    uint base = env.nodes.v[node].place >> 16u;
    WorldSpan s = spanAt(env, node, base);
    vec3 origin = translationOf(env, base);
    noteGridNeed(env, s, origin);
    UintBuf heads = env.status.v[0].avoidHeads;
    UintBuf entries = env.status.v[0].avoidEntries;
    uint points = gridPoints(env, s);
    for (uint i = 0u; i < points; ++i) {
        uint head = headOf(env, gridCell(env, gridPoint(s, i, points) + origin));
        uint at = atomicAdd(env.status.v[0].avoidTaken, 1u);
        if (at >= env.status.v[0].avoidCapacity) break;
        entries.v[2u * at] = node;
        entries.v[2u * at + 1u] = atomicExchange(heads.v[head], at);
    }
}

// Whether a chunk's spans are for others to stay away from.
FN bool entersGrid(ExpandEnv env, uint chunk) {
    return chunk < env.status.v[0].frozenChunks || distanceKept(env, chunk) > 0.0f;
}
FN void noteTries(ExpandEnv env, uint chunk, uint itemStep) {
    UintBuf bounds = env.status.v[0].avoidBounds;
    bounds.v[chunk] = ((itemStep >> 24u) & 127u) << 16u;
}
// What a chunk of the latest wave begins with; its growth has left the number of tries there.
FN void beginBounds(ExpandEnv env, uint chunk) {
    UintBuf bounds = env.status.v[0].avoidBounds;
    uint count = chunkNodes(env.chunks.v[chunk].marks);
    bool undecided = count > 0u && distanceKept(env, chunk) > 0.0f;
    uint tries = undecided ? bounds.v[chunk] & 0xFFFF0000u : 0u;
    bounds.v[chunk] = tries | (count << 8u) | (undecided ? 0u : count);
    if (undecided) atomicAdd(env.status.v[0].waveUndecided, 1u);
}

// The square of the distance between two spans.
FN float nearness2nd(IN(WorldSpan) a, IN(WorldSpan) b) {
    vec3 along = a.to - a.from;
    vec3 beside = b.to - b.from;
    vec3 apart = a.from - b.from;
    float aa = dot3(along, along);
    float bb = dot3(beside, beside);
    float ab = dot3(along, beside);
    float ac = dot3(along, apart);
    float bc = dot3(beside, apart);
    float slant = aa * bb - ab * ab;
    float s = slant > 1e-6f * aa * bb ? limited(divExact(ab * bc - ac * bb, slant), 0.0f, 1.0f) : 0.0f;
    float t = bb > 1e-20f ? limited(divExact(ab * s + bc, bb), 0.0f, 1.0f) : 0.0f;
    s = aa > 1e-20f ? limited(divExact(ab * t - ac, aa), 0.0f, 1.0f) : 0.0f;
    vec3 between = apart + along * s - beside * t;
    return dot3(between, between);
}

// A branch with what its chunks' decisions need.
struct AvoidBranch {
    uint branch;
    uint joint, stem;   // the node that it leaves, and that node's branch; kNoIndex: it is a seed's own
};
FN AvoidBranch avoidBranch(ExpandEnv env, uint branch) {
    AvoidBranch b = {};
    b.branch = branch;
    b.joint = kNoIndex;
    b.stem = kNoIndex;
    uint first = loadShared(env.branches.v[branch].firstChunk);
    if (first != kNoIndex) b.joint = env.chunks.v[first].previousNode;
    if (b.joint != kNoIndex) b.stem = env.chunks.v[env.nodes.v[b.joint].chunk].branch;
    return b;
}
// The node that an item's first span starts from.
FN uint startOfItem(ExpandEnv env, IN(WorkItem) item) {
    if (item.parent == kNoIndex) return kNoIndex;
    if (item.origin == kNoIndex) return env.chunks.v[item.parent].previousNode;
    return env.chunks.v[item.parent].firstNode + item.origin;
}
// The branch that an item carries on or begins.
FN AvoidBranch branchOfItem(ExpandEnv env, IN(WorkItem) item) {
    if (item.branch != kNoIndex) return avoidBranch(env, item.branch);
    AvoidBranch b = {};
    b.branch = kNoIndex;
    b.joint = startOfItem(env, item);
    b.stem = b.joint == kNoIndex ? kNoIndex : env.chunks.v[env.nodes.v[b.joint].chunk].branch;
    return b;
}
FN bool isNearJoint(vec3 joint, IN(WorldSpan) s, float distance) {
    vec3 from = s.from - joint;
    vec3 to = s.to - joint;
    float reach = kJointReach * distance;
    return smaller(dot3(from, from), dot3(to, to)) <= reach * reach;
}
// Whether spans of two branches lie at a joint of these: one leaves the other there, or both leave the same node.
FN bool meetAtJoint(ExpandEnv env, IN(AvoidBranch) a, IN(WorldSpan) spanA, IN(AvoidBranch) b, IN(WorldSpan) spanB,
                    uint base, float distance) {
    bool leaves = a.joint != kNoIndex && (a.stem == b.branch || a.joint == b.joint);
    bool isLeft = b.joint != kNoIndex && b.stem == a.branch;
    if (!leaves && !isLeft) return false;
    vec3 joint = worldPosition(env, leaves ? a.joint : b.joint, base);
    return isNearJoint(joint, spanA, distance) && isNearJoint(joint, spanB, distance);
}

// A chunk that is to be decided, or whose next step is.
struct AvoidSite {
    AvoidBranch branch;
    u64 key;
    uint depth;       // branches from the seed
    uint firstNode;
    uint base;        // the instance from whose origin its spans are measured
    float distance;
};
FN AvoidSite avoidSite(ExpandEnv env, uint chunk) {
    AvoidSite site = {};
    site.branch = avoidBranch(env, env.chunks.v[chunk].branch);
    site.key = readKey(env, chunk);
    site.depth = env.chunks.v[chunk].depth & 0xFFFFu;
    site.firstNode = readFirstNode(env, chunk);
    site.base = env.nodes.v[site.firstNode].place >> 16u;
    site.distance = distanceKept(env, chunk);
    return site;
}

// Whether a chunk is of an earlier wave.
FN bool standsSince(ExpandEnv env, uint chunk) { return chunk < env.status.v[0].waveFirst; }
// Whether a chunk comes before the site's: those of earlier waves; of the same one stems before what leaves them.
FN bool comesBefore(ExpandEnv env, uint chunk, IN(AvoidSite) site) {
    if (standsSince(env, chunk)) return true;
    uint depth = env.chunks.v[chunk].depth & 0xFFFFu;
    return depth < site.depth || (depth == site.depth && readKey(env, chunk) < site.key);
}

// What becomes of a span of the site's for the one that ends at node `other`.
FN uint verdictBeside(ExpandEnv env, IN(AvoidSite) site, IN(WorldSpan) span, uint other) {
    uint chunk = env.nodes.v[other].chunk;
    uint branch = loadShared(env.chunks.v[chunk].branch);
    if (branch == site.branch.branch || branch == kNoIndex) return kSpanStands;
    if (!comesBefore(env, chunk, site)) return kSpanStands;
    float distance = larger(site.distance, distanceKept(env, chunk));
    WorldSpan there = spanAt(env, other, site.base);
    if (nearness2nd(span, there) >= distance * distance) return kSpanStands;
    if (meetAtJoint(env, site.branch, span, avoidBranch(env, branch), there, site.base, distance)) return kSpanStands;
    UintBuf bounds = env.status.v[0].avoidBounds;
    uint known = LOAD_MEANWHILE(bounds.v[chunk]);
    uint index = indexInChunk(env, other);
    uint stands = standsSince(env, chunk) ? kSpanFalls : kSpanYields;
    return index >= mostOf(known) ? kSpanStands : index < leastOf(known) ? stands : kSpanWaits;
}

// The same for all in a cell of the grid.
FN uint verdictInCell(ExpandEnv env, IN(AvoidSite) site, IN(WorldSpan) span, vec3 cell) {
    UintBuf heads = env.status.v[0].avoidHeads;
    UintBuf entries = env.status.v[0].avoidEntries;
    uint worst = kSpanStands;
    uint at = heads.v[headOf(env, cell)];
    while (at != kNoIndex && worst != kSpanFalls) {
        uint verdict = verdictBeside(env, site, span, entries.v[2u * at]);
        worst = worst > verdict ? worst : verdict;
        at = entries.v[2u * at + 1u];
    }
    // Software devices end long loops early: then nobody knows yet.
    return worst == kSpanStands && at != kNoIndex ? kSpanWaits : worst;
}

// Whether a span of the site's stands, as far as that is known.
FN uint verdictOf(ExpandEnv env, IN(AvoidSite) site, IN(WorldSpan) span) {
    uint points = gridPoints(env, span);
    vec3 origin = translationOf(env, site.base);
    uint worst = kSpanStands;
    vec3 last = vec3(0.0f);
    for (uint i = 0u; i < points && worst != kSpanFalls; ++i) {
        vec3 corner = gridCorner(env, gridPoint(span, i, points) + origin);
        if (i > 0u && corner.x == last.x && corner.y == last.y && corner.z == last.z) continue;
        last = corner;
        for (uint k = 0u; k < 8u && worst != kSpanFalls; ++k) {
            vec3 cell = corner + vec3(float(k & 1u), float((k >> 1u) & 1u), float(k >> 2u));
            uint verdict = verdictInCell(env, site, span, cell);
            worst = worst > verdict ? worst : verdict;
        }
    }
    return worst;
}

// A step stands as a whole: the first index of the one that this node lies in.
FN uint stepStart(ExpandEnv env, uint firstNode, uint index) {
    for (uint i = index; i > 0u; --i) {
        if ((loadShared(env.nodes.v[firstNode + i - 1u].flags) & kNodeInserted) == 0u) return i;
    }
    return 0u;
}

// What a round has found of a chunk: the first of its spans that fall, that yield and that wait; the number of those that
// may stand, if none does. again: it may grow again, where it falls for one of its own wave first. Then it stands whole,
// or not at all.
struct Found {
    uint falls, yields, waits;
};
FN uint firstOf(uint a, uint b) { return a < b ? a : b; }
FN uint boundsAfter(ExpandEnv env, IN(AvoidSite) site, uint known, Found found, bool again) {
    uint falls = again ? found.falls : firstOf(found.falls, found.yields);
    uint most = stepStart(env, site.firstNode, falls);
    uint least = stepStart(env, site.firstNode, firstOf(found.waits, falls));
    if (again) {
        most = found.yields < falls ? 0u : most;
        least = least < most ? 0u : most;
    }
    return (known & 0xFFFF0000u) | (most << 8u) | least;
}

// Whether a chunk that falls may grow again in the next wave.
FN bool mayTryAgain(ExpandEnv env, uint chunk, uint known) {
    return triesOf(known) < kMostTries && (env.chunks.v[chunk].depth >> 16u) < env.phase;
}

// Makes a gap of a node of a chunk that ends before it.
FN void cutNode(ExpandEnv env, uint node, uint previousNode) {
    uint flags = env.nodes.v[node].flags;
    bool foot = previousNode == kNoIndex && ((flags >> 8u) & 31u) == 0u;
    bool inserted = (flags & kNodeInserted) != 0u;
    env.nodes.v[node].radius = -1.0f;
    STORE_SHARED(env.nodes.v[node].flags, flags & 0x3F00u);   // others look at where it lies in its step
    atomicAdd(env.status.v[0].cutNodes, 1u);
    if (inserted) atomicAdd(env.status.v[0].inserted, 0xFFFFFFFFu);
    if (!inserted && !foot) atomicAdd(env.status.v[0].steps, 0xFFFFFFFFu);
}
// Takes a branch away, of which this was all.
FN void dropBranch(ExpandEnv env, uint branch) {
    STORE_SHARED(env.branches.v[branch].firstChunk, kNoIndex);
    atomicAdd(env.status.v[0].cutBranches, 1u);
}
// Ends a chunk after so many nodes.
FN void cutChunk(ExpandEnv env, uint chunk, uint count) {
    uint branch = env.chunks.v[chunk].branch;
    uint marks = env.chunks.v[chunk].marks;
    if ((marks & kChunkStopped) != 0u) atomicAdd(env.status.v[0].stopped, 0xFFFFFFFFu);
    if ((marks & kChunkDeadEnd) == 0u) atomicAdd(env.status.v[0].deadEnds, 1u);
    marks = (marks & ~(63u << 8u) & ~kChunkStopped) | kChunkDeadEnd | kChunkTurnedBack;
    env.chunks.v[chunk].marks = marks | (count << 8u);
    float length = env.chunks.v[chunk].entry.arc;
    if (count > 0u) length = env.nodes.v[env.chunks.v[chunk].firstNode + count - 1u].arc;
    env.branches.v[branch].extent = length;
    if (count > 0u || env.branches.v[branch].firstChunk != chunk) return;
    env.chunks.v[chunk].firstNode = env.branches.v[branch].seed;   // as one without a branch has it
    STORE_SHARED(env.chunks.v[chunk].branch, kNoIndex);
    dropBranch(env, branch);
}

// The item that a chunk has grown from, for another try in the next wave.
FN WorkItem itemAgain(ExpandEnv env, IN(Chunk) chunk, uint branch, bool begins, uint tries) {
    WorkItem item = {};
    item.key = chunk.key;
    item.walk = chunk.entry;
    item.symbol = chunk.symbol;
    for (uint i = 0u; i < kMaxArgs; ++i) item.args[i] = chunk.args[i];
    item.parent = chunk.parent;
    item.origin = kNoIndex;
    if (chunk.parent != kNoIndex && chunk.previousNode != kNoIndex) {
        uint origin = chunk.previousNode - env.chunks.v[chunk.parent].firstNode;
        if (origin < chunkNodes(env.chunks.v[chunk.parent].marks)) item.origin = origin;
    }
    item.branch = begins ? kNoIndex : branch;
    item.seed = env.branches.v[branch].seed;
    item.depth = chunk.depth + 0x10000u;
    item.step = (chunk.step & 0xFFFFFFu) | (tries << 24u);
    return item;
}
FN void queueAgain(ExpandEnv env, WorkItem item) {
    uint at = atomicAdd(env.waves.v[env.wave + 1u].count, 1u);
    if (at < env.itemCapacity) writeWorkItem(env.nextItems, at, item);
    uint before = atomicAdd(env.waves.v[env.wave + 1u].announced, 1u);
    uint added = laneGroupsAdded(before, 1u, kItemsPerGroup);
    if (added > 0u) atomicAdd(env.waves.v[env.wave + 1u].groups[0], added);
}
// Takes a chunk away, whose nodes are gaps, and queues it again.
FN void growAgain(ExpandEnv env, uint chunk, uint known) {
    Chunk c = readChunk(env.chunks, chunk);
    bool begins = env.branches.v[c.branch].firstChunk == chunk;
    queueAgain(env, itemAgain(env, c, c.branch, begins, triesOf(known) + 1u));
    if (begins) {
        dropBranch(env, c.branch);
    } else {
        env.chunks.v[c.parent].next = kNoIndex;
        env.branches.v[c.branch].extent = c.entry.arc;
    }
    uint stopped = (c.step >> 24u) + ((c.marks & kChunkStopped) != 0u ? 1u : 0u);
    atomicAdd(env.status.v[0].stopped, 0u - stopped);
    if ((c.marks & kChunkDeadEnd) != 0u) atomicAdd(env.status.v[0].deadEnds, 0xFFFFFFFFu);
    env.chunks.v[chunk].marks = 0u;
    STORE_SHARED(env.chunks.v[chunk].branch, kNoIndex);
    atomicAdd(env.status.v[0].cutChunks, 1u);
}

// A chunk is decided: what doesn't stand of it are gaps already. retry: it grows again.
FN void endDecision(ExpandEnv env, uint chunk, uint found, uint count, bool retry) {
    atomicAdd(env.status.v[0].waveUndecided, 0xFFFFFFFFu);
    if (mostOf(found) == count) return;
    if (retry) {
        growAgain(env, chunk, found);
    } else {
        cutChunk(env, chunk, mostOf(found));
    }
}

// Whether the stem that an item would leave, or carry on, isn't there at the node that it starts from.
FN bool stemEnds(ExpandEnv env, uint parent, uint origin) {
    if (parent == kNoIndex) return false;
    uint marks = env.chunks.v[parent].marks;
    return marks == 0u || (origin != kNoIndex && origin >= chunkNodes(marks));
}

// After the last round: the next wave's chunks are those behind all that are there.
FN void endDecisions(ExpandEnv env, bool room) {
    env.status.v[0].waveFirst = env.status.v[0].chunks;
    env.status.v[0].waveChunks = 0u;
    env.status.v[0].chunkGroups[0] = 0u;
    if (room) return;
    env.waves.v[env.wave + 1u].count = 0u;
    env.waves.v[env.wave + 1u].groups[0] = 0u;
}

ESPALIER_END
#endif
