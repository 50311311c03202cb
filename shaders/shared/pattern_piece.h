// What a pattern places (pattern_records.h), as it is drawn.
#ifndef ESPALIER_SHARED_PATTERN_PIECE_H
#define ESPALIER_SHARED_PATTERN_PIECE_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

// A mesh in its place, in the world: a point p of the mesh goes to position + x p.x + y p.y + z p.z, where the mesh's
// y points up, as in glTF.
//
// A segment of a line (kPieceLine) leads from `position` to position + x. y is as long as the line is wide and points off
// the surface where the segment begins; z holds octahedral bits: the line's tangent at its begin and at its end, and what
// points off the surface at its end. The mesh is bent along the cubic curve between both.
struct PatternPiece {
    vec3 x, y, z;
    vec3 position;
    uint mesh;           // bits 15..0; bits 31..29: kPieceFree and so on
    uint set;
    uint colour;         // 3 × 10 bits, linear, red first; kNoIndex: the mesh's own
    uint next;           // in its cell of the grid; kNoIndex: none
};
STATIC_SIZE(PatternPiece, 64);
CONST_UINT(kPieceFree, 0x80000000u);     // it doesn't meet others
CONST_UINT(kPieceLine, 0x40000000u);
CONST_UINT(kPieceMerges, 0x20000000u);   // it goes into a like one that is near

BUFFER(PatternPieceBuf, PatternPiece)

ESPALIER_END
#endif
