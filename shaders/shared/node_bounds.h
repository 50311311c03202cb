// Boxes around geometry as its program leaves it. Of instances the corners of a box around the shape are moved, which
// holds what lies within as long as steps behind the instances don't bend it much.
#ifndef ESPALIER_SHARED_NODE_BOUNDS_H
#define ESPALIER_SHARED_NODE_BOUNDS_H
#include "shaders/shared/node_deform.h"

ESPALIER_BEGIN

// Numbers in the order of floats, of which atomics find the least.
FN uint orderedBits(float x) {
    uint b = floatBitsToUint(x);
    return b ^ ((b & 0x80000000u) != 0u ? 0xFFFFFFFFu : 0x80000000u);
}
FN float floatOfOrdered(uint b) { return uintBitsToFloat(b ^ ((b & 0x80000000u) != 0u ? 0x80000000u : 0xFFFFFFFFu)); }

struct BoundArgs {
    NodePlanes from;
    UintBuf normals;
    DeformOpBuf ops;
    UintBuf shape;     // 6 ordered numbers: low, high of the shape. Null: this is what is looked for
    UintBuf box;       // likewise, of all
    uint firstOp, endOp;
    uint row, used;    // as GeometryPart's
    uint items;        // elements that aren't padding; with a shape, eight for each instance
    uint spare;
};
STATIC_SIZE(BoundArgs, 72);

FN vec3 boundPlace(BoundArgs a, uint i) {
    uint instance = i >> 3u;
    uint at = i / a.used * a.row + i % a.used;
    vec3 p;
    vec3 n = vec3(0.0f, 1.0f, 0.0f);
    if (IS_GIVEN(a.shape)) {
        p = vec3(floatOfOrdered(a.shape.v[(i & 1u) != 0u ? 3u : 0u]), floatOfOrdered(a.shape.v[(i & 2u) != 0u ? 4u : 1u]),
                 floatOfOrdered(a.shape.v[(i & 4u) != 0u ? 5u : 2u]));
    } else {
        p = takeVector(a.from, at);
        n = startNormal(a.normals, at);
    }
    for (uint k = a.firstOp; k < a.endOp; ++k) p = deformStep(a.ops.v[k], p, n, instance);
    return p;
}

ESPALIER_END
#endif
