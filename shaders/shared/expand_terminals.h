// The second pass: when every branch is complete, each node runs the extrude program of its step, which gives the
// span its bark and leaves (Buron 2015 §5: ExtrudedSucc after TopSucc), and gets its tangent (§6).
#ifndef ESPALIER_SHARED_EXPAND_TERMINALS_H
#define ESPALIER_SHARED_EXPAND_TERMINALS_H
#include "shaders/shared/bezier.h"
#include "shaders/shared/expand_scope.h"
#include "shaders/shared/leaf_pose.h"
#include "shaders/shared/record_lookup.h"
#ifdef __cplusplus
#include <vector>
#endif

ESPALIER_BEGIN

CONST_FLOAT(kLeavesPerCell, 8.0f); // a cell of the density cap holds as many leaves as the cap allows

// The cap works on cells of the surface. They share counters by hash: where two cells fall together, both are
// thinned too much, but alike in every run.
FN uint densityCell(ExpandEnv env, uint seed, uint place, vec2 uv) {
    float cap = env.status.v[0].leafDensityCap;
    uint instance = place >> 16u;
    float perUv = env.surfaces.v[instance].charts.v[place & 0xFFFFu].metresPerUv * env.surfaces.v[instance].scale;
    float cells = perUv * sqrtExact(cap * (1.0f / kLeavesPerCell));
    uint x = uint(limited(uv.x * cells, 0.0f, 1e6f));
    uint y = uint(limited(uv.y * cells, 0.0f, 1e6f));
    uvec2 h = hashWord(hashWord(hashWord(hashWord(uvec2(1u, 2u), seed), place), x), y);
    return (h.x ^ (h.y >> 7u)) & (kDensityCells - 1u);
}

// The branch around a node, as the pass needs it.
struct NodeSite {
    uint index, chunk;
    uint extrude;        // program, kNoIndex: none
    bool foot;           // a seed's: no span, but the radius of the first
    bool tip;
    u64 chunkKey;
    uint flags;          // of the node
    u64 key;             // of the draws
    float before, after; // arcs of the nodes at both ends of its span
    float stepStart, stepEnd;
    uvec2 hash;          // sum over its leaves
    uint lastLeaf;       // kNoIndex: none yet
};

// A leaf before it is packed.
struct LeafDraft {
    float along, span;   // metres from where its node's span begins, and that span's length
    float size, lift, turn, pitch, tint;   // as packLeafPlace, packLeafPose and packLeafTint take them
    uint mesh;
    uint colour;         // packed
    uint word;           // of its key
};
// Without its node.
FN Leaf leafOf(LeafDraft d) {
    Leaf leaf = {};
    leaf.node = kNoIndex;
    leaf.place = packLeafPlace(divExact(d.along, larger(d.span, 1e-9f)), d.mesh, d.size);
    leaf.pose = packLeafPose(d.turn, d.pitch, d.lift, d.size);
    leaf.tint = packLeafTint(d.tint, vec3(0.0f), d.word) | d.colour;
    return leaf;
}
FN uint leafNode(ExpandEnv env, uint node) { return node | (env.phase == kTerminalsAgain ? kLeafPending : 0u); }

// A leaf is counted, written, and chained to its node's last one, so that a regrowth finds it.
#ifdef __cplusplus
// Native code keeps drafts until it has some to pack side by side; last: the draft before it on its node.
struct StagedLeaf {
    LeafDraft draft;
    u64 chunkKey;
    uint node, flags, last;
};
using LeafStage = std::vector<StagedLeaf>;
#define LEAVES leaves,
#define LEAVES_PARAM LeafStage &leaves,
FN void takeLeaf(LEAVES_PARAM const ExpandEnv& env, NodeSite& site, const LeafDraft& draft) {
    leaves.push_back({draft, site.chunkKey, leafNode(env, site.index), site.flags, site.lastLeaf});
    site.lastLeaf = uint(leaves.size() - 1);
}
#else
#define LEAVES
#define LEAVES_PARAM
UintBuf nextLeavesAtHand;   // GrowStatus::nextLeaves, to be set by the kernel
void takeLeaf(ExpandEnv env, inout NodeSite site, LeafDraft draft) {
    Leaf leaf = leafOf(draft);
    leaf.node = leafNode(env, site.index);
    uint at = atomicAdd(env.status.v[0].leaves, 1u);
    if (at < env.status.v[0].leafCapacity) {
        writeLeaf(env.leaves, at, leaf);
        nextLeavesAtHand.v[at] = site.lastLeaf;
        site.lastLeaf = at;
    } else if (at >= env.status.v[0].mostLeaves) {
        atomicMin(env.status.v[0].leaves, env.status.v[0].mostLeaves + 1u);
    }
    site.hash = site.hash + hashOfLeaf(site.chunkKey, site.flags, leaf);
}
#endif

// How many instances a terminal makes here. The first bark counts; a foot takes the radius of its plant's first span
// and nothing else.
FN uint instanceCount(float wanted, bool bark, bool barked, bool foot) {
    uint count = uint(limited(wanted, 0.0f, float(kMaxRepeat)));
    return (bark && barked) || (foot && !bark) ? 0u : count;
}

// A leaf, unless it lies on another of its step's spans or the density cap takes it. along: of the step, [0, 1].
FN void emitLeaf(LEAVES_PARAM ExpandEnv env, INOUT(NodeSite) site, LeafDraft draft, float along, u64 key, uint cell) {
    // Inserted samples cut a step into spans, one of which holds the instance.
    float arc = site.stepStart + limited(along, 0.0f, 1.0f) * (site.stepEnd - site.stepStart);
    bool last = site.after >= site.stepEnd;
    bool here = arc >= site.before && (arc < site.after || last) && draft.size > 0.0f;
    bool capped = (kFeatures & kFeatureDensity) != 0u && env.status.v[0].leafDensityCap > 0.0f;
    bool counts = capped && env.phase == kTerminalsCount;
    if ((kFeatures & kFeatureDensity) != 0u) {
        if (here && counts) atomicAdd(env.density.v[cell], 1u);
        if (here && !counts && capped) {
            float share = float(uint(key >> 40)) * 5.96046448e-8f;
            here = share * float(env.density.v[cell]) < kLeavesPerCell;
        }
    }
    if (!here || counts) return;
    draft.along = arc - site.before;
    draft.span = site.after - site.before;
    draft.word = uint(key);
    takeLeaf(LEAVES env, site, draft);
}

// Of a terminal that is coloured leaf by leaf, whose row begins at `at`; packed.
FN uint leafColour(MACHINE_PARAM ExpandEnv env, uint at) {
    uint slots = TABLE(at + kTerminalRow_colour);
    vec3 colour = vec3(0.0f);
    for (uint i = 0u; i < 3u; ++i) {
        uint immediate = TABLE(at + kTerminalRow_channels + i);
        colour[i] = packedValue(MACHINE (slots >> (8u * i)) & 127u, immediate);
    }
    return packLeafTint(0.0f, colour, 0u);
}

// Runs the node's program. One loop over gates and bodies alike: a trip makes an instance, or evaluates a gate that
// has code of its own.
FN float runTerminals(MACHINE_PARAM LEAVES_PARAM ExpandEnv env, TableBases map, uint first, uint end,
                      INOUT(NodeSite) site, uint cell, INOUT(uint) barkFlags) {
    float radius = 0.0f;
    bool barked = false;
    uint made = 0u;
    uint count = 0u;
    bool gate = true;
    for (uint t = first; t < end;) {
        uint at = map.terminals + t * kTerminalRow_words;
        uint head = TABLE(at + kTerminalRow_head);
        uint gateCode = TABLE(at + kTerminalRow_gate);
        uint bodyCode = TABLE(at + kTerminalRow_body);
        uint sites = TABLE(at + kTerminalRow_sites);
        uint slots = TABLE(at + kTerminalRow_slots);
        bool bark = (head & kPackedBark) != 0u;
        bool codeless = (gateCode >> 16u) == 0u && ((head >> 16u) & 255u) == 0u;
        bool body = !gate || codeless;
        u64 key = childKey(site.key, TABLE(at + kTerminalRow_site), made);
        SET_SLOT(kSlotIndex, float(made));
        drawTable(MACHINE env, map, body ? sites >> 16u : sites & 0xFFFFu, body ? head >> 24u : (head >> 16u) & 255u,
                  site.key, key);
        if (gate && codeless) {
            count = instanceCount(packedValue(MACHINE slots & 127u, TABLE(at + kTerminalRow_count)), bark, barked, site.foot);
            SET_SLOT(kSlotCount, float(count));
        }
        runTable(MACHINE env, map, body ? bodyCode : gateCode);
        if (!body) {
            count = instanceCount(packedValue(MACHINE slots & 127u, TABLE(at + kTerminalRow_count)), bark, barked, site.foot);
            SET_SLOT(kSlotCount, float(count));
        }
        bool makes = body && made < count;
        float size = packedValue(MACHINE (slots >> 8u) & 127u, TABLE(at + kTerminalRow_size));
        if (makes && bark) {
            radius = limited(size, 0.0f, 1e3f);
            SET_SLOT(kSlotRadius, radius);
            barked = true;
            barkFlags = site.foot ? 0u : kNodeBark | ((head & 255u) << 18u) | (((head >> 8u) & 3u) << 15u);
            count = 1u;
        }
        if (makes && !bark) {
            uint more = TABLE(at + kTerminalRow_moreSlots);
            float along = packedValue(MACHINE (slots >> 16u) & 127u, TABLE(at + kTerminalRow_t));
            LeafDraft draft = {};
            draft.along = 0.0f;
            draft.span = 0.0f;
            draft.size = size;
            draft.lift = packedValue(MACHINE slots >> 24u, TABLE(at + kTerminalRow_lift));
            draft.turn = packedValue(MACHINE more & 127u, TABLE(at + kTerminalRow_turn));
            draft.pitch = packedValue(MACHINE (more >> 8u) & 127u, TABLE(at + kTerminalRow_pitch));
            draft.tint = packedValue(MACHINE (more >> 16u) & 127u, TABLE(at + kTerminalRow_tint));
            draft.mesh = head & 255u;
            draft.colour = TABLE(at + kTerminalRow_colour);
            if ((kFeatures & kFeatureColours) != 0u && (head & kPackedColoured) != 0u) draft.colour = leafColour(MACHINE env, at);
            draft.word = 0u;
            emitLeaf(LEAVES env, site, draft, along, key, cell);
        }
        made = makes ? made + 1u : made;
        bool done = made >= count;
        gate = done;
        t = done ? t + 1u : t;
        made = done ? 0u : made;
    }
    return radius;
}

// The arc at which the node's step began and ended, past the samples that were inserted into it.
FN void findStep(ExpandEnv env, uint firstNode, uint index, float arc, float entryArc, uint flags, INOUT(NodeSite) s) {
    uint j = index;
    bool more = true;
    float start = entryArc;
    while (more) {
        more = j > 0u;
        if (more) {
            j = j - 1u;
            NodeArc there = readArc(env, firstNode + j);
            start = there.arc;
            more = (there.flags & kNodeInserted) != 0u;
            start = more && j == 0u ? entryArc : start;
        }
    }
    s.stepStart = start;
    s.stepEnd = arc;
    // A step never ends in another chunk than it began in.
    uint k = firstNode + index;
    for (bool inserted = (flags & kNodeInserted) != 0u; inserted;) {
        k = k + 1u;
        NodeArc there = readArc(env, k);
        s.stepEnd = there.arc;
        inserted = (there.flags & kNodeInserted) != 0u;
    }
}

// What the pass finds out about a node.
struct NodeFinish {
    uint tangent;
    uint flags;
    float radius;   // before the fit
    uint firstLeaf;
};
FN void keepFinish(NodeBuf nodes, uint index, NodeFinish f) {
    nodes.v[index].tangent = f.tangent;
    STORE_SHARED(nodes.v[index].flags, f.flags);   // neighbours look at the bits that stay
    nodes.v[index].radius = f.radius;
}

// What nodes of a chunk have in common.
struct StemChunk {
    ChunkBrief brief;
    BranchRecord branch;
    u64 branchKey;
};
FN StemChunk stemChunk(ExpandEnv env, uint chunk) {
    StemChunk c = {};
    c.brief = readChunkBrief(env.chunks, chunk);
    c.branch = readBranch(env, c.brief.branch);
    c.branchKey = readKey(env, c.branch.firstChunk);
    return c;
}

// A node and what lies around it along the stem.
struct StemNode {
    Node node;
    uint index;
    uint leader, follower;   // kNoIndex: it is a foot, a tip
    vec3 before, after;      // their positions in its own object space; its own where there is none
};
// Of s its node and index are given; finds the rest. In place: where a copy is read as soon as it is written, processors
// wait for it.
FN void lookAround(ExpandEnv env, IN(ChunkBrief) chunk, INOUT(StemNode) s) {
    uint index = s.index;
    uint local = index - chunk.firstNode;
    uint next = chunk.next;
    bool last = local + 1u >= chunkNodes(chunk.marks);
    s.follower = last ? kNoIndex : index + 1u;
    if (last && next != kNoIndex) {
        if (chunkNodes(readMarks(env, next)) > 0u) s.follower = readFirstNode(env, next);
    }
    s.leader = local > 0u ? index - 1u : chunk.previousNode;
    s.before = readPositionFrom(env, s.leader == kNoIndex ? index : s.leader, s.node.place);
    s.after = readPositionFrom(env, s.follower == kNoIndex ? index : s.follower, s.node.place);
}

// The directions of the branches that leave a node, where the paper's average is asked for: it is over all adjacent
// segments, the branches' too.
FN bool joints(ExpandEnv env) { return (kFeatures & kFeatureJoints) != 0u && env.status.v[0].tangentMode != 0u; }
FN vec3 jointsAt(ExpandEnv env, uint index) {
    uint at = kDensityCells + 3u * index;
    return vec3(float(int(env.density.v[at])), float(int(env.density.v[at + 1u])),
                float(int(env.density.v[at + 2u]))) * 9.53674316e-7f;
}

// What follows from the node's surroundings alone.
struct StemFrame {
    vec3 normal, heading;
    uint tangent;        // packed
};
// branches: jointsAt, or zero.
FN StemFrame stemFrame(vec3 before, vec3 at, vec3 after, vec3 branches, uint normal, uint heading) {
    StemFrame f = {};
    f.normal = unpackOct(normal);
    f.heading = unpackOct(heading);
    vec3 sum = segmentDirection(before, at) + segmentDirection(at, after) + branches;
    f.tangent = packOct(tangentFromSum(sum, f.normal, f.heading));
    return f;
}

// The node's radius, bark and leaves. It may run again on a node that was finished before.
FN NodeFinish finishStem(MACHINE_PARAM LEAVES_PARAM ExpandEnv env, IN(StemChunk) chunk, IN(StemNode) s,
                         StemFrame frame, INOUT(uvec2) hash) {
    Node node = s.node;
    ChunkBrief brief = chunk.brief;
    uint local = s.index - brief.firstNode;
    NodeSite site = {};
    site.index = s.index;
    site.chunk = node.chunk;
    site.foot = s.leader == kNoIndex;
    site.tip = s.follower == kNoIndex;
    site.chunkKey = brief.key;
    site.flags = node.flags;
    site.hash = uvec2(0u, 0u);
    site.lastLeaf = kNoIndex;
    site.after = node.arc;
    site.before = local > 0u ? readArc(env, s.index - 1u).arc : brief.entryArc;
    uint flags = node.flags;
    if (site.foot && !site.tip) flags = readArc(env, s.follower).flags;
    uint extrude = flags & 255u;
    site.extrude = extrude - 1u;
    uint step = (brief.step & 0xFFFFFFu) + ((flags >> 26u) & 31u) + 1u;
    float radius = 0.0f;
    uint barkFlags = 0u;
    findStep(env, brief.firstNode, local, node.arc, brief.entryArc, node.flags, site);

    if (extrude != 0u) {
        uint grammar = brief.symbol >> 16u;
        TableBases map = basesOf(env, grammar);
        uint program = map.extrudes + site.extrude * kExtrudeRow_words;
        uint range = TABLE(program + kExtrudeRow_terminals);
        uint nameHash = TABLE(program + kExtrudeRow_nameHash);
        uint inputs = TABLE(program + kExtrudeRow_inputs);
        uint layers = TABLE(program + kExtrudeRow_layers);
        uint first = range & 0xFFFFu;
        float length = chunk.branch.extent;
        site.key = childKey(chunk.branchKey, nameHash, step);
        Place place = {};
        place.position = node.position;
        place.normal = frame.normal;
        place.heading = frame.heading;
        place.uv = unpackUv(node.uv);
        place.instance = node.place >> 16u;
        place.level = 0u;
        resetMachine(MACHINE_ONLY);
        SET_SLOT(kSlotArg, brief.args[0]);
        SET_SLOT(kSlotArg + 1u, brief.args[1]);
        SET_SLOT(kSlotArg + 2u, brief.args[2]);
        SET_SLOT(kSlotArg + 3u, brief.args[3]);
        SET_SLOT(kSlotBranchLength, length);
        SET_SLOT(kSlotToTip, length - node.arc);
        SET_SLOT(kSlotSpanLength, site.stepEnd - site.stepStart);
        SET_SLOT(kSlotRadius, 0.0f);
        SET_SLOT(kSlotCount, 0.0f);
        WorldFrame world = frameOf(env.surfaces, place.instance, inputs);
        giveInputs(MACHINE env.surfaces, env.layers, env.grammars, world, grammar, inputs, layers, place, brief.depth & 0xFFFFu, step, node.arc);
        uint cell = 0u;
        if ((kFeatures & kFeatureDensity) != 0u && env.status.v[0].leafDensityCap > 0.0f)
            cell = densityCell(env, chunk.branch.seed, node.place, place.uv);
        radius = runTerminals(MACHINE LEAVES env, map, first, first + (range >> 16u), site, cell, barkFlags);
    }
    hash = hash + site.hash;
    NodeFinish finish = {};
    finish.tangent = tangentWithHeading(frame.tangent, headingOfNode(node));
    finish.flags = (node.flags & 0x7C003FFFu) | barkFlags | (site.tip ? kNodeTip : 0u);
    finish.radius = roundRadius(radius);
    finish.firstLeaf = site.lastLeaf;
    return finish;
}

#ifndef __cplusplus
// All of it. hash: the sum of its leaves' hashes is added. Native code does the same for some nodes at a time
// (runtime/host/finish.hpp).
NodeFinish finishNode(ExpandEnv env, uint index, inout uvec2 hash) {
    StemNode s = {};
    s.index = index;
    s.node = readNode(env, index);
    StemChunk chunk = stemChunk(env, s.node.chunk);
    lookAround(env, chunk.brief, s);
    vec3 branches = vec3(0.0f);
    if (joints(env)) branches = jointsAt(env, index);
    StemFrame frame = stemFrame(s.before, s.node.position, s.after, branches, s.node.normal, headingOfNode(s.node));
    return finishStem(env, chunk, s, frame, hash);
}
#endif

ESPALIER_END
#endif
