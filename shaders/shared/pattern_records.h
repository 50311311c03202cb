// What patterns are derived from and what they leave (Li 2011): shapes with a scope each, sets of pieces that stand or
// fall together, and the wave in which they are decided.
//
// A wave takes all symbols of the highest priority that wait. Each becomes a shape: its scope, its rule, room for the
// rule's sets. Pieces of sets take their places and are looked up against all that stand and against the wave's other
// pieces; then rounds decide set after set, and what stands lets the symbols behind it wait for a later wave. The result
// is that of deciding one set after the other in the order of (wave, production's key, number in the production),
// whatever the schedule: a set falls if one stands that meets it, and a set of its own wave counts only if it comes
// before it in this order.
#ifndef ESPALIER_SHARED_PATTERN_RECORDS_H
#define ESPALIER_SHARED_PATTERN_RECORDS_H
#include "shaders/shared/expand_env.h"
#include "shaders/shared/field_records.h"
#include "shaders/shared/pattern_piece.h"

ESPALIER_BEGIN

CONST_UINT(kPatternGroup, 64u);       // invocations of a group in every kernel of patterns
CONST_UINT(kPatternGroups, 1024u);    // at most: beyond, invocations take several items, so that lanes' memory is bounded
CONST_UINT(kPatternPriorities, 8u);
CONST_UINT(kPatternRounds, 6u);       // that are recorded for a wave; a wave that needs more takes another turn
CONST_UINT(kPieceClasses, 32u);       // pieces are looked up by size: class c holds radii up to kPieceLeast * 2^c
CONST_FLOAT(kPieceLeast, 1e-4f);      // metres
CONST_UINT(kClusterTriangles, 8u);    // triangles of a mesh come in runs of so many, each within a sphere

// Where a shape stands (Li 2011 §3, Fig. 3): a frame on a surface and a size. The frame's axes are `turn`, a unit
// quaternion (x, y, z, w), applied to (heading, left, outside) of the walk; the origin lies `lift` metres of the world
// off the surface.
struct PatternScope {
    Walk walk;           // arc: not used
    float lift;
    vec4 turn;
    vec3 size;           // metres of the world
};
STATIC_SIZE(PatternScope, 60);

// A symbol that waits. It is born where `part` leads from the scope of the production that names it.
struct PatternItem {
    u64 key;             // of that production; of a seed: its own
    PatternScope scope;  // likewise
    float args[4];       // likewise
    uint grammar;
    uint part;           // kNoIndex: a seed, whose symbol is `symbol`
    uint symbol;
    uint depth;          // productions before it
    uint seed;
};
STATIC_SIZE(PatternItem, 104);

// A symbol that has been derived, for as long as its wave goes on.
struct PatternShape {
    u64 key;
    PatternScope scope;
    float args[4];
    uint grammar;
    uint rule;           // kNoIndex: none holds, or it has come to an end of the surface
    uint firstSet;       // of its sets in the list of all
    uint depth;
    uint seed;
};
STATIC_SIZE(PatternShape, 104);

// How much of a set stands: the bits of a share. A segment that was cut has one in between.
CONST_UINT(kSetFallen, 0u);
CONST_UINT(kSetStands, 0x3F800000u);
CONST_UINT(kSetOpen, 0xFFFFFFFFu);
// Pieces that stand or fall together. Earlier in the order: lesser (key, number).
struct PatternSet {
    u64 key;             // of its production
    uint number;         // in that
    uint shape;          // of its wave
    uint prereq;         // set before it in the production that has to stand, or with kIfFallen to have fallen;
                         // kNoIndex: none
    uint state;
    uint met;            // first of its list of earlier sets that it meets, in PatternEnv::edges; kNoIndex: none
    uint piece;          // first of its pieces
    float reach;         // metres: of a piece that merges, how far; of a segment, how wide it is; else 0
    float turn;          // of a piece that merges: the cosine of how far it turns
    uint into;           // the set that it merged into or was cut at; kNoIndex: none
    uint spare;
};
STATIC_SIZE(PatternSet, 48);

struct PatternEdge {
    uint set;            // an earlier set; of those that merge from any wave, else from the same
    uint next;
    float at;            // the share of the own set that is left if that one stands
    float there;         // and that must be left of that one
};
STATIC_SIZE(PatternEdge, 16);

// Two pieces that may meet: `piece` of this wave, `other` before it in the order.
struct PatternPair {
    uint piece, other;
};
STATIC_SIZE(PatternPair, 8);

// The triangles by which a mesh meets others, in its own space.
struct PatternMesh {
    vec3 centre;         // of a sphere around all
    float radius;
    uint firstCluster, clusterCount;
    uint firstVertex;    // three for each triangle, cluster after cluster, then all once more, each place but once
    uint triangleCount;
    uint placeCount;     // places of vertices
    vec3 within;         // the middle of a ball inside of it
    float inner;         // the ball's radius; 0: the mesh has no inside
};
STATIC_SIZE(PatternMesh, 52);

BUFFER(PatternItemBuf, PatternItem)
BUFFER(PatternShapeBuf, PatternShape)
BUFFER(PatternSetBuf, PatternSet)
BUFFER(PatternEdgeBuf, PatternEdge)
BUFFER(PatternPairBuf, PatternPair)
BUFFER(PatternMeshBuf, PatternMesh)
BUFFER(PatternVec4Buf, vec4)
BUFFER(PatternVec3Buf, vec3)

// Counters. What is taken may exceed its room: then nothing was written beyond it, and the host grows again with more.
struct PatternStatus {
    uint sets, pieces, edges, pairs;                // taken, of all waves; pairs: of the wave
    uint itemRoom, setRoom, pieceRoom, edgeRoom, pairRoom;   // itemRoom: of each priority
    uint waiting[8];                                // symbols that wait, by priority
    uint mostItems;                                 // most that waited in one priority
    uint wave, waves;                               // items of the wave that goes on; how many have begun
    uint priority;                                  // that it takes its items from
    uint firstSet, firstPiece;                      // of the wave
    uint decided;                                   // of its sets
    // VkDispatchIndirectCommand
    uint deriveGroups[3], shapeGroups[3], pieceGroups[3], pairGroups[3], setGroups[3];
    uint mostPairs;                                 // of a wave, where that was too many
    uint classes[3];                                // of each layer; bit c: there are pieces of class c
    uint rounds;                                    // of decisions, all waves together: as many as were of use
    uint shapes, standing, fallen, ended, deep;     // symbols derived; sets; symbols at a surface's end, beyond maxDepth
    uint mostDepth;
    uint hash[2];
};
STATIC_SIZE(PatternStatus, 208);
BUFFER(PatternStatusBuf, PatternStatus)

struct PatternEnv {
    SurfaceBuf surfaces;
    LayerBuf layers;
    RuleMapBuf grammars;
    FieldBuf fields;         // [(grammar * instances + instance) * kMaxFields + field]
    PatternItemBuf items;    // [priority * itemRoom + i]
    PatternShapeBuf shapes;  // [itemRoom]
    PatternSetBuf sets;
    PatternPieceBuf pieces;
    PatternEdgeBuf edges;
    PatternPairBuf pairs;
    UintBuf cells;           // first piece of each cell, kNoIndex: none; a power of two of them
    PatternMeshBuf meshes;
    PatternVec4Buf clusters; // spheres of meshes' runs of triangles
    PatternVec3Buf corners;  // of their triangles
    PatternStatusBuf status;
    uint instances;
    uint cellMask;
};
STATIC_SIZE(PatternEnv, 128);
BUFFER(PatternEnvBuf, PatternEnv)

FN uint patternGroups(uint items) {
    uint groups = (items + kPatternGroup - 1u) / kPatternGroup;
    return groups < kPatternGroups ? groups : kPatternGroups;
}
FN bool comesBefore(PatternSet a, PatternSet b) { return a.key < b.key || (a.key == b.key && a.number < b.number); }

ESPALIER_END
#endif
