#pragma once

// What the culling kernels find, as native code: their own text compiled as C++. For software devices whose addresses
// are the process's own: there a kernel's lanes share a core, and pay for every branch of any of them.

#include <vector>

#include "shaders/emit/emit_records.h"

namespace espalier {

class NativeCull {
  public:
    // Looks at bound growth (bound_growth.hpp) as kernels do with this push data, and keeps what is seen. Reads of
    // `push` cells, bins, order, grid, leafBase; spans, leaves: [item], aligned to 16 bytes. On up to `threads` threads
    // (0: all cores); returns when done. Returns how many items are seen.
    uint32_t look(const EmitPush& push, const EmitView& view, const EmitTable& table, const SpanInstance* spans,
                  const LeafInstance* leaves, unsigned threads = 0);
    // Writes them to `drawn`, sorted by bucket, in the kernels' order, and sets all of `state` but blocks and groups.
    void write(const EmitPush& push, const EmitTable& table, DrawnItem* drawn, EmitState& state) const;

  private:
    // Of cells that follow each other.
    struct Piece {
        std::vector<DrawnItem> items;
        uint32_t counts[kMaxBuckets];
        uint32_t listed[2];  // spans, leaves
    };
    std::vector<Piece> pieces_;
};

}  // namespace espalier
