#version 460
#extension GL_GOOGLE_include_directive : require
// Which chunks read what has changed, which go with their seeds.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/surface_lookup.h"
#include "shaders/expand/again.glsl"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

bool dirtyTile(UintBuf edits, uint grid, uint level, uint x, uint y) {
    uint bit = y * (kLayerTiles >> level) + x;
    return ((edits.v[grid + dirtyGrid(level) + (bit >> 5u)] >> (bit & 31u)) & 1u) != 0u;
}
bool dirtyPlace(UintBuf edits, uint grid, vec2 uv) {
    float side = float(kLayerCells);
    uvec2 cell = uvec2(clamp(uv * side, vec2(0.0), vec2(side - 1.0)));
    uint bit = cell.y * kLayerCells + cell.x;
    return ((edits.v[grid + dirtyGrid(kMaxReadLevel + 1u) + (bit >> 5u)] >> (bit & 31u)) & 1u) != 0u;
}

// By its read set, and, where all that it read was at its nodes, by these: cells are finer than tiles.
bool readsDirty(ExpandEnv env, UintBuf edits, uint chunk, uint marks) {
    uint head = env.chunks.v[chunk].reads[0];
    uint level = (head >> 8u) & 15u;
    uint grid = edits.v[kEditInstances + (head & 255u)];
    if (level > kMaxReadLevel) return true;
    bool dirty = false;
    uint words[3];
    for (uint i = 0u; i < (grid != 0u ? 3u : 0u); ++i) words[i] = i == 0u ? head : env.chunks.v[chunk].reads[i];
    for (uint i = 1u; i <= (grid != 0u ? kReadTiles : 0u) && !dirty; ++i) {
        uint tile = (words[i >> 1u] >> ((i & 1u) * 16u)) & 0xFFFFu;
        if (tile == 0xFFFFu) break;
        dirty = dirtyTile(edits, grid, level, tile & 255u, tile >> 8u);
    }
    if (!dirty || (marks & kChunkBeyond) != 0u) return dirty;
    dirty = dirtyPlace(edits, grid, env.chunks.v[chunk].entry.uv);
    uint first = env.chunks.v[chunk].firstNode;
    for (uint i = 0u; i < chunkNodes(marks) && !dirty; ++i) dirty = dirtyPlace(edits, grid, unpackUv(env.nodes.v[first + i].uv));
    return dirty;
}

void main() {
    openAgain(env);
    UintBuf edits = AGAIN.edits;
    uint count = AGAIN.chunkCount;
    uint layers = edits.v[kEditLayers];
    uint seeds = edits.v[kEditSeeds];
    uint params = edits.v[kEditParams];
    uint pruned = edits.v[kEditPruned];
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint c = gl_GlobalInvocationID.x; c < count; c += lanes) {
        uint chunkMarks = env.chunks.v[c].marks;
        if (chunkMarks == 0u) continue;
        bool dirty = ((chunkMarks >> 16u) & layers) != 0u && readsDirty(env, edits, c, chunkMarks);
        if (pruned != 0u) dirty = dirty || isAmong(edits, pruned + 1u, edits.v[pruned], env.chunks.v[c].key);
        if (params + seeds != 0u || dirty) {
            uint branch = env.chunks.v[c].branch;
            bool first = branch != kNoIndex && env.branches.v[branch].firstChunk == c;
            uint seed = seedOf(AGAIN.branchesBefore, AGAIN.chunksBefore, c);
            if (seeds != 0u) seed = edits.v[seeds + seed];
            if (seed == kNoIndex) {
                appendTo(env, kListGone, c);
                atomicAdd(AGAIN.goneNodes, chunkNodes(chunkMarks));
                atomicAdd(AGAIN.goneChunks, 1u);
                if (first) {
                    atomicAdd(AGAIN.goneBranches, 1u);
                    env.branches.v[branch].firstChunk = kNoIndex;
                }
                continue;
            }
            if (seeds != 0u && branch == kNoIndex) env.chunks.v[c].firstNode = seed;
            if (seeds != 0u && first) env.branches.v[branch].seed = seed;
            if (seed >= AGAIN.firstFrozen) continue;
            uint grammar = env.chunks.v[c].symbol >> 16u;
            uint changed = params != 0u ? edits.v[params + grammar] : 0u;
            dirty = dirty || (changed & env.chunks.v[c].paramMask) != 0u;
            if (first && (changed & env.tables.v[grammar * kGrammarWords + kTableExtrudeParams]) != 0u) {
                againMarks.v[branch].branchBits = kBranchListed | kBranchRedo;
                appendTo(env, kListBranches, branch);
            }
        }
        if (dirty) {
            againMarks.v[c].bits = kMarkDirty;
            appendTo(env, kListDirty, c);
        }
    }
}
