// What growth reads and leaves: seeds, work items, chunks, nodes, leaves. See ARCHITECTURE.md, "Growth".
//
// A branch is a run of marching steps. It is stored as chunks of up to kChunkNodes nodes; a chunk is grown in
// one go by one thread, from an entry state that is kept, so that it can be grown again alone.
// Node k > 0 of a chunk spans from node k - 1; node 0 spans from Chunk::previousNode (kNoIndex: it is a seed's
// foot and has no span).
#ifndef ESPALIER_SHARED_GROWTH_RECORDS_H
#define ESPALIER_SHARED_GROWTH_RECORDS_H
#include "shaders/shared/surface_records.h"

ESPALIER_BEGIN

CONST_UINT(kChunkNodes, 32u);
CONST_UINT(kMaxArgs, 4u);
CONST_UINT(kMaxLayers, 16u);
CONST_UINT(kLayerTiles, 256u);   // what chunks read of layers is noted by this many tiles along either side,
CONST_UINT(kLayerCells, 1024u);  // what changes in layers by this many cells

// Where a walk stands, 28 bytes. direction: unit tangent of the surface, object space of its instance.
struct Walk {
    uint place;      // bits 31..16 surface instance, 15..0 chart
    vec2 uv;
    vec3 direction;
    float arc;       // metres walked since the branch began
};
STATIC_SIZE(Walk, 28);

// What the host plants, 64 bytes. key: the root of the derivation path (from the seed's id and random number).
struct Seed {
    u64 key;
    Walk walk;
    uint grammar;    // index into the rule maps, < 65536
    uint symbol;     // start symbol in that grammar
    float args[4];
    uint spare;
};
STATIC_SIZE(Seed, 64);

// One shape waiting for its rule, 80 bytes.
struct WorkItem {
    u64 key;
    Walk walk;
    uint symbol;         // bits 31..16 grammar, 15..0 symbol
    float args[4];
    uint parent;         // the chunk that it leaves or carries on, kNoIndex for a seed
    uint origin;         // index, in the parent's nodes, of the node that its first span starts from;
                         // kNoIndex: from the parent's own previous node (or none, for a seed)
    uint branch;         // the branch that it carries on, kNoIndex: it begins one
    uint seed;           // index of the seed that it comes from
    uint depth;          // bits 31..16 chunks one after another from the seed, 15..0 branches (0: the seed's own)
    uint step;           // bit 31 kItemAgain, 30..24 tries in vain (expand_avoid.h), 23..0 steps of the grammar since its branch began
};
STATIC_SIZE(WorkItem, 80);
RECORD_ACCESS(WorkItem)
CONST_UINT(kItemAgain, 1u << 31u);   // the chunk `origin` is to be grown again in its place

// Node::flags
//   bits 7..0   symbol of the extruded successor + 1 (0: none), bits 12..8 index in its chunk
//   bit 13      a sample that a seam, a crease or a split span put in, not a step of the grammar
//   bit 14      last node of its branch, bits 16..15 smoothness (kSmooth...) as its Shape asked
//   bit 17      bark is to be drawn on its span, bits 25..18 terminal mesh of that bark
//   bits 30..26 its step of the grammar, counted from the chunk's first (inserted samples belong to the step that
//               they lie in)
CONST_UINT(kSmoothNone, 0u);   // each span by itself
CONST_UINT(kSmoothC0, 1u);     // joined, with corners
CONST_UINT(kSmoothC1, 2u);     // G1 cubic Bézier, Buron 2015 §6
CONST_UINT(kNodeInserted, 1u << 13u);
CONST_UINT(kNodeTip, 1u << 14u);
CONST_UINT(kNodeBark, 1u << 17u);

// A recorded sample of a walk, 44 bytes. Object space of its instance. See isGap().
struct Node {
    vec3 position;
    uint normal;      // octahedral 2×16 snorm, outward
    uint tangent;     // octahedral 2×16 snorm, along the growth (Buron 2015 §6; stems ignore their children)
    uint uv;          // 2×16 unorm, walk UV
    uint place;       // bits 31..16 surface instance, 15..0 chart
    float radius;     // metres, world
    float arc;        // metres since the branch began
    uint chunk;
    uint flags;
};
STATIC_SIZE(Node, 44);
RECORD_ACCESS(Node)
// No node any more, since a regrowth has taken it out; of its flags its place in its chunk stays.
FN bool isGap(IN(Node) n) { return n.radius < 0.0f; }

// Where the walk was going is kept as 2×8 octahedral bits in the lowest four of each half of normal and tangent, which
// are of no account there.
CONST_UINT(kHeadingBits, 0x000F000Fu);
FN uint normalWithHeading(uint normal, uint heading) { return (normal & ~kHeadingBits) | ((heading >> 12u) & kHeadingBits); }
FN uint tangentWithHeading(uint tangent, uint heading) { return (tangent & ~kHeadingBits) | ((heading >> 8u) & kHeadingBits); }
FN uint headingOfNode(Node node) {
    return ((node.normal & kHeadingBits) << 12u) | ((node.tangent & kHeadingBits) << 8u) | 0x00800080u;
}
// A radius before its branch is fitted to its parent has a mantissa of ten bits: so it can be told again from what the
// fit made of it.
FN float roundRadius(float radius) { return uintBitsToFloat((floatBitsToUint(radius) + 0x1000u) & 0xFFFFE000u); }

// 16 bytes; only branches of at least one node have one. extent is final when the branch has ended. Its key, depth
// and joint are its first chunk's. firstChunk kNoIndex: there is no such branch any more.
struct BranchRecord {
    float extent;        // length in metres
    float thickness;     // factor of its radii, so that it is no thicker than its parent at the joint
    uint firstChunk;
    uint seed;           // index of the seed that it comes from
};
STATIC_SIZE(BranchRecord, 16);

// Chunk::marks: bits 31..16 layers that were read, 15..14 and 2..1 the level of the read set, 13..8 number of nodes, 7..3
// and 0 flags; 0: there is no such chunk any more
CONST_UINT(kChunkPublished, 1u);
CONST_UINT(kChunkStopped, 8u);      // a limit ended it (counted in the stats)
CONST_UINT(kChunkDeadEnd, 16u);     // its ground isn't there, or no direction served
CONST_UINT(kChunkBeyond, 32u);      // it read at places that are none of its nodes': directions that failed
CONST_UINT(kChunkTurnedBack, 64u);  // a dead end where of some direction the condition didn't hold

// The read set: where the chunk read layers, failed directions and terminals included. kReadTiles tiles, which cover
// the walk's UV by kLayerTiles >> level along either side. The level stands in Chunk::marks, since the words are full;
// above kMaxReadLevel the chunk may have read anywhere.
//   word 0 bits 15..0 surface instance; then in halves from there on, lower ones first, tiles: bits 15..8 y, 7..0 x;
//   0xFFFF: unused
CONST_UINT(kReadTiles, 5u);
CONST_UINT(kMaxReadLevel, 8u);
CONST_UINT(kReadLevelBits, 0xC006u);   // of Chunk::marks
FN uint readLevelMarks(uint level) { return ((level & 3u) << 1u) | ((level & 12u) << 12u); }
FN uint readLevelOf(uint marks) { return ((marks >> 1u) & 3u) | ((marks >> 12u) & 12u); }

// 112 bytes. A chunk may be without nodes: its first step failed, and what it read says when to try again.
struct Chunk {
    u64 key;             // of its entry
    Walk entry;
    uint symbol;         // as WorkItem::symbol
    float args[4];
    uint parent;         // chunk, kNoIndex for a seed's first
    uint previousNode;   // kNoIndex: its first node is a seed's foot
    uint next;           // the chunk that carries the branch on, kNoIndex
    uint branch;         // kNoIndex if it is without nodes and begins its branch
    uint firstNode;      // of one without a branch: the index of its seed
    uint depth;          // as WorkItem::depth
    uint step;           // bits 31..24 shapes that a limit refused (at most 255), 23..0 steps of the grammar since its
                         // branch began
    uint marks;
    uint uses;           // what it used of its grammar: parameter slots from bit 0 up, symbols in the bits that these leave
    uint firstChild;     // of the chunks that it queued, in any order; the next one that its parent queued. kNoIndex
    uint nextSibling;
    uint reads[3];
};
STATIC_SIZE(Chunk, 112);
RECORD_ACCESS(Chunk)
FN uint chunkNodes(uint marks) { return (marks >> 8u) & 63u; }

// What the pass over nodes needs of a chunk.
struct ChunkBrief {
    u64 key;
    float entryArc;      // = entry.arc
    uint symbol;
    float args[4];
    uint previousNode, next, branch, firstNode, depth, step, marks;
};
RECORD_PART(ChunkBrief, Chunk)

// A leaf or a loose terminal, 16 bytes, on the span that ends at `node`.
// place, pose and tint are packed and unpacked by leaf_pose.h.
struct Leaf {
    uint node;
    uint place;
    uint pose;
    uint tint;
};
STATIC_SIZE(Leaf, 16);
RECORD_ACCESS(Leaf)

// One painted layer, resampled to a surface's walk UV: single channel floats in [0,1], 8×8 tiles as texels.
// address 0: nothing painted, every read is `fill`. size: of the surface's finest level, painted or not, so that a
// first stroke finds its readers by tile.
struct LayerRef {
    FloatBuf texels;
    uint size;
    float fill;
};
STATIC_SIZE(LayerRef, 16);
BUFFER(LayerBuf, LayerRef)     // [surface instance * kMaxLayers + layer]

BUFFER(SeedBuf, Seed)
BUFFER(WorkItemBuf, WorkItem)
BUFFER(NodeBuf, Node)
BUFFER(ChunkBuf, Chunk)
BUFFER(BranchBuf, BranchRecord)
BUFFER(LeafBuf, Leaf)

ESPALIER_END
#endif
