// Which chunks read what has changed, which go with their seeds.
#ifndef ESPALIER_EXPAND_AGAIN_FIND_H
#define ESPALIER_EXPAND_AGAIN_FIND_H
#include "records/expand_rows.h"
#include "shaders/expand/again.h"
#include "shaders/shared/record_lookup.h"

ESPALIER_BEGIN

FN bool dirtyTile(UintBuf edits, uint grid, uint level, uint x, uint y) {
    uint bit = y * (kLayerTiles >> level) + x;
    return ((edits.v[grid + dirtyGrid(level) + (bit >> 5u)] >> (bit & 31u)) & 1u) != 0u;
}

// What a chunk has read, and its marks.
struct ChunkReads {
    uint marks, uses;
    uint words[3];   // Chunk::reads
};
FN ChunkReads readReads(ExpandEnv env, uint chunk) {
    ChunkReads r = {};
    r.marks = env.chunks.v[chunk].marks;
    r.uses = env.chunks.v[chunk].uses;
    for (uint i = 0u; i < 3u; ++i) r.words[i] = env.chunks.v[chunk].reads[i];
    return r;
}
FN uint tileOf(ChunkReads r, uint i) { return (r.words[i >> 1u] >> ((i & 1u) * 16u)) & 0xFFFFu; }

// Whether one of its tiles lies in the box of what is dirty.
FN bool readsNear(ChunkReads r, uint box, uint level) {
    uint lowX = (box & 255u) >> level;
    uint lowY = ((box >> 8u) & 255u) >> level;
    uint highX = ((box >> 16u) & 255u) >> level;
    uint highY = (box >> 24u) >> level;
    bool near = level > kMaxReadLevel;
    for (uint i = 1u; i <= kReadTiles; ++i) {
        uint tile = tileOf(r, i);
        uint x = tile & 255u;
        uint y = tile >> 8u;
        near = near || (tile != 0xFFFFu && x >= lowX && x <= highX && y >= lowY && y <= highY);
    }
    return near;
}

// By its read set, and, where all that it read was at its nodes, by these: cells are finer than tiles.
FN bool readsDirty(ExpandEnv env, UintBuf edits, uint chunk, ChunkReads r, uint grid, uint level) {
    if (level > kMaxReadLevel) return true;
    bool dirty = false;
    for (uint i = 1u; i <= kReadTiles && !dirty; ++i) {
        uint tile = tileOf(r, i);
        if (tile == 0xFFFFu) break;
        dirty = dirtyTile(edits, grid, level, tile & 255u, tile >> 8u);
    }
    if (!dirty || (r.marks & kChunkBeyond) != 0u) return dirty;
    uint cells = grid + dirtyGrid(kMaxReadLevel + 1u);
    dirty = readsCells(edits, cells, env.chunks.v[chunk].entry.uv);
    uint first = readFirstNode(env, chunk);
    for (uint i = 0u; i < chunkNodes(r.marks) && !dirty; ++i) dirty = readsCells(edits, cells, unpackUv(env.nodes.v[first + i].uv));
    return dirty;
}

// The head of AgainState::edits.
struct EditHead {
    UintBuf edits;
    uint layers, seeds, uses, pruned, extrudes, instances;
};
FN EditHead editHead(ExpandEnv env) {
    EditHead head;
    head.edits = AGAIN.edits;
    head.layers = head.edits.v[kEditLayers];
    head.seeds = head.edits.v[kEditSeeds];
    head.uses = head.edits.v[kEditUses];
    head.pruned = head.edits.v[kEditPruned];
    head.extrudes = head.edits.v[kEditExtrudes];
    head.instances = head.edits.v[kEditInstances];
    return head;
}

FN void findChunk(ExpandEnv env, EditHead head, uint c) {
    ChunkReads r = readReads(env, c);
    if (r.marks == 0u) return;
    uint level = readLevelOf(r.marks);
    bool dirty = false;
    if (((r.marks >> 16u) & head.layers) != 0u) {
        uint instance = r.words[0] & 0xFFFFu;
        uint grid = instance < head.instances ? head.edits.v[kEditGrids + instance] : 0u;
        bool near = grid != 0u ? readsNear(r, head.edits.v[grid - 1u], level) : level > kMaxReadLevel;
        if (near) dirty = readsDirty(env, head.edits, c, r, grid, level);
    }
    if (head.pruned != 0u) dirty = dirty || isAmong(head.edits, head.pruned + 1u, head.edits.v[head.pruned], env.chunks.v[c].key);
    uint looks = head.uses + head.seeds + head.extrudes != 0u || dirty ? 1u : 0u;
    for (uint k = 0u; k < looks; ++k) {
        uint branch = env.chunks.v[c].branch;
        bool first = branch != kNoIndex && env.branches.v[branch].firstChunk == c;
        uint seed = seedOf(AGAIN.branchesBefore, AGAIN.chunksBefore, c);
        if (head.seeds != 0u) seed = head.edits.v[head.seeds + seed];
        if (seed == kNoIndex) {
            appendTo(env, kListGone, c);
            atomicAdd(AGAIN.goneNodes, chunkNodes(r.marks));
            atomicAdd(AGAIN.goneChunks, 1u);
            if (first) {
                atomicAdd(AGAIN.goneBranches, 1u);
                env.branches.v[branch].firstChunk = kNoIndex;
            }
            dirty = false;
            break;
        }
        if (head.seeds != 0u && branch == kNoIndex) env.chunks.v[c].firstNode = seed;
        if (head.seeds != 0u && first) env.branches.v[branch].seed = seed;
        if (seed >= AGAIN.firstFrozen) {
            dirty = false;
            break;
        }
        uint grammar = env.chunks.v[c].symbol >> 16u;
        uint changed = head.uses != 0u ? head.edits.v[head.uses + grammar] : 0u;
        dirty = dirty || (changed & r.uses) != 0u;
        bool other = head.extrudes != 0u && head.edits.v[head.extrudes + grammar] != 0u;
        if (first && (other || (changed & env.tables.v[grammar * kGrammarTables_words + kGrammarTables_extrudeParams]) != 0u)) {
            AGAIN_MARKS.v[branch].branchBits = kBranchListed | kBranchRedo;
            appendTo(env, kListBranches, branch);
        }
    }
    if (dirty) {
        AGAIN_MARKS.v[c].bits = kMarkDirty;
        appendTo(env, kListDirty, c);
    }
}

ESPALIER_END
#endif
