// Growing again only what an edit concerns: what the kernels of a regrowth share (shaders/expand/again_*.comp, in the
// order find, start, march, settle, work, terminals, apply, thickness, fit; runtime/expand/regrowth.cpp records them).
//
// Chunks and branches are a copy of those that are drawn from, so all of it may be changed; nodes and leaves are the
// drawn ones: until everything is known to fit, new ones are only appended. A chunk that is grown again keeps its
// place. The items that it queues are compared with its children before: a child with the same key and entry that read
// nothing dirty is kept with all that follows from it, one with the same key is grown again in its place, another is
// new; children that none asked for are gone with what follows from them.
#ifndef ESPALIER_SHARED_EXPAND_AGAIN_H
#define ESPALIER_SHARED_EXPAND_AGAIN_H
#include "shaders/shared/expand_env.h"

ESPALIER_BEGIN

// Lists of indices, each with room for as many as there may be chunks.
CONST_UINT(kListDirty, 0u);      // chunks that read what has changed
CONST_UINT(kListGrown, 1u);      // chunks that were grown, in an old place or a new one
CONST_UINT(kListGone, 2u);       // chunks that are no more
CONST_UINT(kListBranches, 3u);   // branches with grown chunks, or whose terminals depend on what has changed
CONST_UINT(kListKin, 4u);        // these and all branches that leave them, and so on: their thickness may change
CONST_UINT(kListWork, 5u);       // nodes whose terminals are to be made: counted here, their indices are in AgainState::results
CONST_UINT(kListFit, 6u);        // chunks whose nodes get their radius
CONST_UINT(kLists, 7u);

// AgainMark::bits
CONST_UINT(kMarkDirty, 1u);
CONST_UINT(kMarkAgain, 2u);      // grown again in its place
CONST_UINT(kMarkGrown, 4u);      // that, or new
CONST_UINT(kMarkKept, 8u);       // its parent was grown again and asked for it as it was
CONST_UINT(kMarkTurned, 16u);    // it stands, but the node that it starts from lies elsewhere by a hair
// AgainMark::branchBits
CONST_UINT(kBranchListed, 1u);
CONST_UINT(kBranchRedo, 2u);     // all its terminals are to be made anew

// Of a chunk; branchBits is of the branch of this index. Zero at first.
// A dirty chunk with a dirty chunk before it waits until that has been grown: at the chunk below that one on the way
// to it, since whether this is kept decides.
struct AgainMark {
    uint bits;
    uint firstWaiting, nextWaiting;   // chunk + 1
    uint branchBits;
    uint nodes;                       // bit i: terminals of its node i are to be made
};
STATIC_SIZE(AgainMark, 20);
BUFFER(AgainMarkBuf, AgainMark)

struct AgainState {
    ChunkBuf chunksBefore;
    BranchBuf branchesBefore;
    AgainMarkBuf marks;
    UintBuf lists;           // [list * listCapacity + i]
    UintBuf edits;           // see below
    UintBuf results;         // [i]: node i of kListWork, with kResultKept where its chunk wasn't grown; and of such a
                             // one, [resultCapacity + kResultWords * i]: NodeFinish
    UintBuf touched;         // GrowthView::touched
    uint listCapacity, resultCapacity;   // chunks, nodes
    uint chunkCount, nodeCount, branchCount, leafCount;   // before, with the gaps among them
    uint liveNodes, liveChunks;          // before, without
    uint mostNodes, mostChunks;          // limits
    uint chainedLeaves;                  // leaves from this one on aren't among their nodes' yet
    uint number;             // that written nodes get in `touched`
    uint counts[8];          // of the lists
    uint overrun;            // not 0: this is too much for a regrowth
    uint goneNodes, goneChunks, goneBranches, goneLeaves, goneInserted, goneFeet, goneDeadEnds, goneStopped;
    uint firstFrozen;        // seeds from this index on are frozen: what they have grown is never dirty
};
STATIC_SIZE(AgainState, 176);
BUFFER(AgainStateBuf, AgainState)

// AgainState::edits, words: 0 dirty layers (bits), 1 first word of the seeds' new indices (0: seeds are the same;
// kNoIndex: gone), 2 first word of what has changed of each grammar, as Chunk::uses (0: nothing), 3 first word of the
// branches that are cut away or grow again (0: none): their number, then their keys as isAmong() takes them, 4 first
// word of a grammar's word each that isn't 0 where what its branches draw on spans is another (0: none), 5 the number of
// instances up to the last one with dirty tiles; then a word for each of these: where its dirty tiles begin (0: none).
// These are bits y * side + x of grids of side 256, 128, … 1, each beginning with a new word, where reads may have
// changed; and then cells whose texels have, of side kLayerCells. The word before them is the box around the dirty ones
// of side 256: bits 7..0 least x, 15..8 least y, 23..16 most x, 31..24 most y.
CONST_UINT(kEditLayers, 0u);
CONST_UINT(kEditSeeds, 1u);
CONST_UINT(kEditUses, 2u);
CONST_UINT(kEditPruned, 3u);
CONST_UINT(kEditExtrudes, 4u);
CONST_UINT(kEditInstances, 5u);
CONST_UINT(kEditHead, 6u);
CONST_UINT(kEditGrids, kEditHead);   // [instance]
// First word of the grid of a level, and (level 9) of the cells.
FN uint dirtyGrid(uint level) {
    uint at = 0u;
    for (uint i = 0u; i < level; ++i) {
        uint side = kLayerTiles >> i;
        at = at + (side * side + 31u) / 32u;
    }
    return at;
}

CONST_UINT(kCellWords, kLayerCells * kLayerCells / 32u);
// Half a cell, and half a 65,535th of the UV, to which nodes keep their place.
CONST_FLOAT(kCellReach, 0.508f);
FN uint cellAt(float at) {
    float last = float(kLayerCells - 1u);
    return uint(at < 0.0f ? 0.0f : at > last ? last : at);
}
// Whether a cell is marked that a read at `uv` may take texels from. at: first word of the cells.
FN bool readsCells(UintBuf words, uint at, vec2 uv) {
    float x = uv.x * float(kLayerCells);
    float y = uv.y * float(kLayerCells);
    uint endX = cellAt(x + kCellReach);
    uint endY = cellAt(y + kCellReach);
    bool marked = false;
    for (uint cy = cellAt(y - kCellReach); cy <= endY; ++cy) {
        for (uint cx = cellAt(x - kCellReach); cx <= endX; ++cx) {
            uint bit = cy * kLayerCells + cx;
            marked = marked || ((words.v[at + (bit >> 5u)] >> (bit & 31u)) & 1u) != 0u;
        }
    }
    return marked;
}

CONST_UINT(kResultWords, 4u);
CONST_UINT(kResultKept, 1u << 31u);
CONST_UINT(kMostVisited, 16384u);   // chunks that one invocation goes through, see kMaxTrips

ESPALIER_END
#endif
