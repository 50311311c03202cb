// What a pattern places (pattern_records.h), as it is drawn.
#ifndef ESPALIER_SHARED_PATTERN_PIECE_H
#define ESPALIER_SHARED_PATTERN_PIECE_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

// A mesh in its place, in the world: a point p of the mesh goes to position + x p.x + y p.y + z p.z, where the mesh's
// y points up, as in glTF.
struct PatternPiece {
    vec3 x, y, z;
    vec3 position;
    uint mesh;           // bits 15..0; bit 31: it doesn't meet others
    uint set;
    uint colour;         // 3 × 10 bits, linear, red first; kNoIndex: the mesh's own
    uint next;           // in its cell of the grid; kNoIndex: none
};
STATIC_SIZE(PatternPiece, 64);
CONST_UINT(kPieceFree, 0x80000000u);

BUFFER(PatternPieceBuf, PatternPiece)

ESPALIER_END
#endif
