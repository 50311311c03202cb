#version 460
#extension GL_GOOGLE_include_directive : require
#define ESPALIER_RECORD_FETCH
// Which chunks read what has changed, which go with their seeds.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/surface_lookup.h"
#include "shaders/shared/record_lookup.h"
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

// What a chunk has read, and its marks.
struct ChunkReads {
    uint marks, paramMask;
    uint words[3];   // Chunk::reads
};
ChunkReads readReads(ExpandEnv env, uint chunk) {
    ChunkReads r;
    if (kRecordsByAddress != 0u) {
        r.marks = env.chunks.v[chunk].marks;
        r.paramMask = env.chunks.v[chunk].paramMask;
        for (uint i = 0u; i < 3u; ++i) r.words[i] = env.chunks.v[chunk].reads[i];
    } else {
        uvec4 marks = CHUNK_TEXEL(7u * chunk + 5u);
        uvec4 reads = CHUNK_TEXEL(7u * chunk + 6u);
        r.marks = marks.y;
        r.paramMask = marks.z;
        r.words[0] = reads.y;
        r.words[1] = reads.z;
        r.words[2] = reads.w;
    }
    return r;
}
uint tileOf(ChunkReads r, uint i) { return (r.words[i >> 1u] >> ((i & 1u) * 16u)) & 0xFFFFu; }

// Whether one of its tiles lies in the box of what is dirty.
bool readsNear(ChunkReads r, uint box, uint level) {
    uvec2 low = uvec2(box & 255u, (box >> 8u) & 255u) >> level;
    uvec2 high = uvec2((box >> 16u) & 255u, box >> 24u) >> level;
    bool near = level > kMaxReadLevel;
    for (uint i = 1u; i <= kReadTiles; ++i) {
        uint tile = tileOf(r, i);
        uvec2 at = uvec2(tile & 255u, tile >> 8u);
        near = near || (tile != 0xFFFFu && all(greaterThanEqual(at, low)) && all(lessThanEqual(at, high)));
    }
    return near;
}

// By its read set, and, where all that it read was at its nodes, by these: cells are finer than tiles.
bool readsDirty(ExpandEnv env, UintBuf edits, uint chunk, ChunkReads r, uint grid, uint level) {
    if (level > kMaxReadLevel) return true;
    bool dirty = false;
    for (uint i = 1u; i <= kReadTiles && !dirty; ++i) {
        uint tile = tileOf(r, i);
        if (tile == 0xFFFFu) break;
        dirty = dirtyTile(edits, grid, level, tile & 255u, tile >> 8u);
    }
    if (!dirty || (r.marks & kChunkBeyond) != 0u) return dirty;
    dirty = dirtyPlace(edits, grid, env.chunks.v[chunk].entry.uv);
    uint first = readFirstNode(env, chunk);
    for (uint i = 0u; i < chunkNodes(r.marks) && !dirty; ++i) dirty = dirtyPlace(edits, grid, unpackUv(env.nodes.v[first + i].uv));
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
        ChunkReads r = readReads(env, c);
        if (r.marks == 0u) continue;
        uint level = (r.words[0] >> 8u) & 15u;
        bool dirty = false;
        // Loops, since software devices skip only those.
        for (uint asks = 0u; asks < (((r.marks >> 16u) & layers) != 0u ? 1u : 0u); ++asks) {
            uint grid = edits.v[kEditInstances + (r.words[0] & 255u)];
            bool near = grid != 0u ? readsNear(r, edits.v[grid - 1u], level) : level > kMaxReadLevel;
            for (uint k = 0u; k < (near ? 1u : 0u); ++k) dirty = readsDirty(env, edits, c, r, grid, level);
        }
        if (pruned != 0u) dirty = dirty || isAmong(edits, pruned + 1u, edits.v[pruned], env.chunks.v[c].key);
        uint looks = params + seeds != 0u || dirty ? 1u : 0u;
        for (uint k = 0u; k < looks; ++k) {
            uint branch = env.chunks.v[c].branch;
            bool first = branch != kNoIndex && env.branches.v[branch].firstChunk == c;
            uint seed = seedOf(AGAIN.branchesBefore, AGAIN.chunksBefore, c);
            if (seeds != 0u) seed = edits.v[seeds + seed];
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
            if (seeds != 0u && branch == kNoIndex) env.chunks.v[c].firstNode = seed;
            if (seeds != 0u && first) env.branches.v[branch].seed = seed;
            if (seed >= AGAIN.firstFrozen) {
                dirty = false;
                break;
            }
            uint grammar = env.chunks.v[c].symbol >> 16u;
            uint changed = params != 0u ? edits.v[params + grammar] : 0u;
            dirty = dirty || (changed & r.paramMask) != 0u;
            if (first && (changed & env.tables.v[grammar * kGrammarWords + kTableExtrudeParams]) != 0u) {
                againMarks.v[branch].branchBits = kBranchListed | kBranchRedo;
                appendTo(env, kListBranches, branch);
            }
        }
        for (uint k = 0u; k < (dirty ? 1u : 0u); ++k) {
            againMarks.v[c].bits = kMarkDirty;
            appendTo(env, kListDirty, c);
        }
    }
}
