// Where smoothing looks: found once a stroke for each texel that its dabs may reach, since dabs overlap and walking
// costs many times what a dab does.
//
// A texel's places are the UVs of six, [64 * (kSmoothPlaces * slot + k) + texel of the block], in 65,536ths of the
// picture, v << 16 | u. A gutter texel has one, what it stands for beyond its border.
#ifndef ESPALIER_PAINT_SMOOTH_RECORDS_H
#define ESPALIER_PAINT_SMOOTH_RECORDS_H
#include "shaders/paint/block_records.h"

ESPALIER_BEGIN

CONST_UINT(kSmoothPlaces, 6u);
CONST_UINT(kNoPlace, 0xFFFFFFFFu);
// | k, as the first place: those of texel k of the quad are taken (2x2 texels of a block). Places are less.
CONST_UINT(kPlacesOfQuad, 0xFFFFFFF0u);
CONST_FLOAT(kQuadReach, 6.0f);  // texels: for ways as long as this a quad's texels may look at the same places

struct PlacesEnv {
    TexelBuf texels;  // of the surface's finest level, as baked
    TexelTiles texelTiles;  // where others touch it: the placement's own; else none
    UintBuf blocks;   // [count]
    UintBuf places;   // of blocks[0]
    UintBuf walkers;  // [0]: how many texels must walk; then which, 64 * i + texel of block blocks[i]
    SurfaceBuf surfaces;
    float perScale;  // 1 / the placement's scale
    float reach;     // metres to the places
    uint count;
    uint instance;
    uint size;   // texels a side
    uint quads;  // 1: reach is kQuadReach or more
};
STATIC_SIZE(PlacesEnv, 72);

ESPALIER_END
#endif
