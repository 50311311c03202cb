#pragma once

// The kernels that write bark's triangles as native code: their own text compiled as C++ (-ffp-contract=off), so it
// leaves the same bits. For software devices whose addresses are the process's own: there a kernel's lanes share one
// core, and stores that pass by the caches are worth more than they.

#include "shaders/emit/emit_records.h"

namespace espalier {

// Writes kBarkVertices vertices and kBarkIndices indices for each of drawn[0, count), one span after another; both
// arrays begin at multiples of 16 bytes. spans: [DrawnItem::item]. Indices count from the first vertex. On all cores;
// returns when all is written.
void writeBarkNative(const SpanInstance* spans, const DrawnItem* drawn, uint32_t count, TriangleVertex* vertices,
                     uint32_t* indices);

}  // namespace espalier
