// What kernels of the procedural graph read and write. Geometry lies in planes: x of all elements, then y, then z, each
// `stride` floats after the one before. Curves lie sample by sample: sample j of curve c is element j * row + c, where
// row is how many curves there are, rounded up. So what is done to all curves alike reads and writes side by side.
//
// Rows are padded to kNodeLanes elements. Native code works whole rows out; what it leaves in the padding is nobody's.
#ifndef ESPALIER_SHARED_NODE_RECORDS_H
#define ESPALIER_SHARED_NODE_RECORDS_H
#include "shaders/shared/exact.h"
#include "shaders/shared/surface_records.h"

ESPALIER_BEGIN

CONST_UINT(kNodeGroup, 64u);   // invocations of a group in every kernel of the graph
CONST_UINT(kNodeLanes, 16u);   // elements that native code works out side by side

FN uint nodeRow(uint elements) { return (elements + kNodeLanes - 1u) / kNodeLanes * kNodeLanes; }

struct NodePlanes {
    FloatBuf v;
    uint stride;   // floats from one plane to the next
    uint count;    // elements, with the padding between rows
};
STATIC_SIZE(NodePlanes, 16);

#ifdef __cplusplus
inline FloatBuf planeOf(const NodePlanes& p, uint number) { return {p.v.v + size_t(p.stride) * number}; }
#else
FloatBuf planeOf(NodePlanes p, uint number) { return FloatBuf(uint64_t(p.v) + 4ul * uint64_t(p.stride) * uint64_t(number)); }
#endif
FN vec3 takeVector(NodePlanes p, uint i) { return vec3(planeOf(p, 0u).v[i], planeOf(p, 1u).v[i], planeOf(p, 2u).v[i]); }
FN void putVector(NodePlanes p, uint i, vec3 v) {
    planeOf(p, 0u).v[i] = v.x;
    planeOf(p, 1u).v[i] = v.y;
    planeOf(p, 2u).v[i] = v.z;
}

// Uniform in [0, 1), a multiple of 2^-24: the draw number `site` for element i. 32 bits, since vectors of the processor
// multiply no larger ones.
FN uint mix32(uint x) {
    x ^= x >> 16u;
    x *= 0x7FEB352Du;
    x ^= x >> 15u;
    x *= 0x846CA68Bu;
    return x ^ (x >> 16u);
}
FN uint nodeHash(uint seed, uint i, uint site) { return mix32(i + mix32(seed + mix32(site + 0x51ED2701u))); }
FN float nodeRandom(uint seed, uint i, uint site) { return float(int(nodeHash(seed, i, site) >> 8u)) * 5.96046448e-8f; }

// Numbers beyond a limit, and what is none, count as 0: whole numbers hold no more.
FN float within(float x, float limit) { return absolute(x) < limit ? x : 0.0f; }

ESPALIER_END
#endif
