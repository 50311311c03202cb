// Moving whole blocks of a layer: what strokes keep, exchange and compare.
#ifndef ESPALIER_PAINT_BLOCK_RECORDS_H
#define ESPALIER_PAINT_BLOCK_RECORDS_H
#include "shaders/paint/brush.h"

ESPALIER_BEGIN

CONST_UINT(kBlocksSave, 0u);      // kept = layer
CONST_UINT(kBlocksSwap, 1u);      // each gets the other's
CONST_UINT(kBlocksCompare, 2u);   // marks: which texels differ
CONST_UINT(kBlocksFill, 3u);      // layer = value
CONST_UINT(kBlocksTake, 4u);      // layer = kept, but where that is kBlocksUntouched

CONST_UINT(kBlocksUntouched, 0xFFFFFFFFu);   // bits that no texel has

// Push constants. Texels are moved as bits.
struct BlocksEnv {
    UintBuf layer;
    UintBuf kept;      // [64 * (first + i)]: block blocks[i]
    UintBuf blocks;
    UintBuf marks;     // [2 * i], [2 * i + 1]: a bit a texel of block blocks[i]
    uint count, first, job, value;
};
STATIC_SIZE(BlocksEnv, 48);

ESPALIER_END
#endif
