// Enters: bound spans and leaves in the order of their cells. Leaves: what full detail draws, sorted by bucket: counted
// first, then put in place.
#include "runtime/emit/native_gather.hpp"

#include <algorithm>

namespace espalier {
namespace {

// each(item, leaf), spans first.
template <class Each>
void overItems(const BoundItems& bound, const Each& each) {
    for (uint32_t c = 0; c < kAllCells; ++c) {
        const EmitCell& cell = bound.cells[c];
        for (uint32_t i = cell.first; i < cell.first + cell.count; ++i) {
            const bool leaf = c >= kLeafClass * kMaxCells;
            each(bound.order[i] - (leaf ? bound.leafBase : 0), leaf);
        }
    }
}

uint32_t bucketOf(const BoundItems& bound, const EmitTable& table, uint32_t item, bool leaf) {
    if (!leaf) return table.variants[table.kinds[bound.spans[item].bits & 63u].firstVariant].firstBucket;
    const LeafInstance& l = bound.leaves[item];
    const KindRecord& kind = table.kinds[(l.bits >> 8u) & 255u];
    return table.variants[kind.firstVariant + (l.hash >> 3u) % kind.variantCount].firstBucket;
}

}  // namespace

void gatherNative(const BoundItems& bound, const EmitTable& table, DrawnItem* drawn, EmitState& state) {
    std::fill_n(state.counts, kMaxBuckets, 0u);
    overItems(bound, [&](uint32_t item, bool leaf) { state.counts[bucketOf(bound, table, item, leaf)] += 1; });
    uint32_t next[kMaxBuckets], sum = 0;
    state.spanCount = 0;
    for (uint32_t b = 0; b < kMaxBuckets; ++b) {
        state.starts[b] = next[b] = sum;
        sum += state.counts[b];
        if (b < table.barkBuckets) state.spanCount = sum;
    }
    state.leafCount = sum - state.spanCount;
    overItems(bound, [&](uint32_t item, bool leaf) {
        DrawnItem& to = drawn[next[bucketOf(bound, table, item, leaf)]++];
        to = {item, leaf ? 0u : 0xFFFF0000u, leaf ? 1.0f : 0.0f, 0};
    });
}

}  // namespace espalier
