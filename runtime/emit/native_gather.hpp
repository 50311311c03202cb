#pragma once

// What the culling kernels find at full detail, as native code: everything that is bound, by buckets, in their order.
// For software devices whose addresses are the process's own, where a dozen small kernels wait for each other.

#include "shaders/emit/emit_records.h"

namespace espalier {

// Bound growth (emit_bind.cpp) by pointer.
struct BoundItems {
    const EmitCell* cells;  // [kAllCells]
    const uint32_t* order;  // items of cells
    const SpanInstance* spans;
    const LeafInstance* leaves;
    uint32_t leafBase;  // number of the first leaf among items
};

// Writes every bound span and leaf to `drawn`, which has room for all of them, as a cull with kFullDetail does; sets
// counts, starts, spanCount and leafCount of `state`.
void gatherNative(const BoundItems& bound, const EmitTable& table, DrawnItem* drawn, EmitState& state);

}  // namespace espalier
