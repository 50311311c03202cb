// What the shaders of patterns' pieces read: each draw's push data. Instances are PatternPiece (pattern_records.h), four
// texels of four words each; of those that a draw shows, `set` is the bits of the fade: 1: all pixels; above 0: this
// share of them; below: those that -fade leaves out.
#ifndef ESPALIER_RENDER_PIECE_RECORDS_H
#define ESPALIER_RENDER_PIECE_RECORDS_H
#include "shaders/render/frame_records.h"

ESPALIER_BEGIN

struct PiecePush {
    uint firstInstance;
    uint lod;
    float roughness;
    uint textured;       // 1: the mesh has a picture; 0: u is how bright it leaves its colour
};
STATIC_SIZE(PiecePush, 16);

ESPALIER_END
#endif
