#pragma once

// The terminal pass over nodes as native code, of growth and regrowth: of the text that ESPALIER_AGAIN makes two of,
// each of the two files that include this has its own. Some nodes are finished at a time, so that what is alike for all
// of them, their frames and the packing of their leaves, is done side by side (wide_nodes.hpp).

#include <algorithm>
#include <memory>
#include <vector>

#include "runtime/host/wide_nodes.hpp"
#include "shaders/shared/expand_terminals.h"

namespace espalier {
namespace {

// What a thread works in.
struct FinishRoom {
    Machine machine;
    WideStems wide = {};
    WideLeaves leaves = {};
    LeafStage staged;
    StemNode stems[kNodeLanes];
    StemChunk chunks[kNodeLanes];  // of runs of these, in turn
    uint32_t chunkOf[kNodeLanes];
    NodeFinish finished[kNodeLanes];
};

void putStem(FinishRoom& room, uint32_t i, vec3 branches) {
    const StemNode& stem = room.stems[i];
    put(room.wide.before, i, stem.before);
    put(room.wide.at, i, stem.node.position);
    put(room.wide.after, i, stem.after);
    put(room.wide.branches, i, branches);
    room.wide.packedNormal[i] = stem.node.normal;
    room.wide.packedHeading[i] = headingOfNode(stem.node);
}
StemFrame frameIn(const WideStems& wide, uint32_t i) {
    return {vectorOf(wide.normal, i), vectorOf(wide.heading, i), wide.tangent[i]};
}

void putLeaf(WideLeaves& wide, uint32_t i, const LeafDraft& draft) {
    wide.along[i] = draft.along;
    wide.span[i] = draft.span;
    wide.size[i] = draft.size;
    wide.lift[i] = draft.lift;
    wide.turn[i] = draft.turn;
    wide.pitch[i] = draft.pitch;
    wide.tint[i] = draft.tint;
    wide.mesh[i] = draft.mesh;
    wide.colour[i] = draft.colour;
    wide.word[i] = draft.word;
}

// Reads a node and, unless the one before it has it already, its chunk. runs: chunks so far.
void readStem(const ExpandEnv& env, FinishRoom& room, uint32_t i, uint32_t index, uint32_t& runs) {
    StemNode& stem = room.stems[i];
    stem.index = index;
    stem.node = readNode(env, index);
    const uint32_t chunk = stem.node.chunk;
    if (i == 0 || chunk != room.stems[i - 1].node.chunk) room.chunks[runs++] = stemChunk(env, chunk);
    room.chunkOf[i] = runs - 1;
    lookAround(env, room.chunks[runs - 1].brief, stem);
}

// Writes what is staged where there is room, each leaf chained to its node's last. Returns the place of the first, and
// adds the leaves' hashes.
uint32_t writeLeaves(const ExpandEnv& env, FinishRoom& room, uvec2& hash) {
    const uint32_t count = uint32_t(room.staged.size());
    const uint32_t first = count > 0 ? atomicAdd(env.status.v[0].leaves, count) : 0;
    const uint32_t capacity = env.status.v[0].leafCapacity, most = env.status.v[0].mostLeaves;
    if (uint64_t(first) + count > most) atomicMin(env.status.v[0].leaves, most + 1);
    const UintBuf next = env.status.v[0].nextLeaves;
    for (uint32_t begin = 0; begin < count; begin += kLeafLanes) {
        const uint32_t lanes = std::min(count - begin, kLeafLanes);
        for (uint32_t i = 0; i < lanes; ++i) putLeaf(room.leaves, i, room.staged[begin + i].draft);
        packLeaves(room.leaves);
        for (uint32_t i = 0; i < lanes; ++i) {
            const StagedLeaf& staged = room.staged[begin + i];
            const Leaf leaf = {staged.node, room.leaves.packedPlace[i], room.leaves.packedPose[i],
                               room.leaves.packedTint[i]};
            const uint32_t at = first + begin + i;
            hash += hashOfLeaf(staged.chunkKey, staged.flags, leaf);
            if (at >= capacity) continue;
            writeLeaf(env.leaves, at, leaf);
            if (IS_GIVEN(next)) next.v[at] = staged.last == kNoIndex ? kNoIndex : first + staged.last;
        }
    }
    room.staged.clear();
    return first;
}

// Finishes the nodes nodeOf(i), i in [begin, end): keep(i, finish) is called for each. Returns the sum of their leaves'
// hashes.
template <class NodeOf, class Keep>
ESPALIER_FLATTEN uvec2 finishEach(ExpandEnv env, size_t begin, size_t end, const NodeOf& nodeOf, const Keep& keep) {
    uvec2 hash(0, 0);
    const auto room = std::make_unique<FinishRoom>();
    const bool joined = joints(env);
    for (; begin < end; begin += kNodeLanes) {
        const uint32_t lanes = uint32_t(std::min<size_t>(end - begin, kNodeLanes));
        uint32_t runs = 0;
        for (uint32_t i = 0; i < lanes; ++i) {
            readStem(env, *room, i, nodeOf(begin + i), runs);
            putStem(*room, i, joined ? jointsAt(env, room->stems[i].index) : vec3(0.0f));
        }
        frameStems(room->wide);
        for (uint32_t i = 0; i < lanes; ++i)
            room->finished[i] = finishStem(room->machine, room->staged, env, room->chunks[room->chunkOf[i]],
                                           room->stems[i], frameIn(room->wide, i), hash);
        const uint32_t firstLeaf = writeLeaves(env, *room, hash);
        for (uint32_t i = 0; i < lanes; ++i) {
            NodeFinish& finish = room->finished[i];
            if (finish.firstLeaf != kNoIndex) finish.firstLeaf += firstLeaf;
            keep(begin + i, finish);
        }
    }
    return hash;
}

}  // namespace
}  // namespace espalier
