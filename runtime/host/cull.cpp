// Enters: bound growth in cells, and a view. Leaves: what of it is drawn, sorted by bucket. Cells go in pieces, each on
// one core; the order of pieces and of what lies in them is the order of drawing.
#include "runtime/host/cull.hpp"

#include <algorithm>

#include "runtime/core/jobs.hpp"
#include "shaders/emit/batches.h"
#include "shaders/emit/cells.h"
#include "shaders/emit/leaf_thinning.h"
#include "shaders/emit/sight.h"
#include "shaders/emit/span_thinning.h"
#include "shaders/shared/leaf_pose.h"

namespace espalier {
namespace {

constexpr uint32_t kCellsAtOnce = 512;
constexpr uint32_t kAhead = 8;  // items that memory is asked for before they are looked at

// What is around the kernels' text there.
struct Kernels {
    const EmitPush& push;
    const EmitView& view;
    const EmitTable& table;
    const uvec4* spanWords;
    const uvec4* leafWords;

    uvec4 spanTexel(uint i) const { return spanWords[i]; }
    uvec4 leafTexel(uint i) const { return leafWords[i]; }
#include "shaders/emit/classify_leaf.h"
#include "shaders/emit/classify_span.h"
#include "shaders/emit/keep_cell.h"

    // Asks memory for the words that are looked at.
    void ask(uint item, bool leaf) const {
        if (leaf) {
            ESPALIER_WILL_READ(leafWords + 4 * (item - push.leafBase));
            return;
        }
        ESPALIER_WILL_READ(spanWords + 6 * item);
        ESPALIER_WILL_READ(spanWords + 6 * item + 5);
    }
};

}  // namespace

uint32_t NativeCull::look(const EmitPush& push, const EmitView& view, const EmitTable& table, const SpanInstance* spans,
                          const LeafInstance* leaves, unsigned threads) {
    Kernels kernels{push, view, table, reinterpret_cast<const uvec4*>(spans), reinterpret_cast<const uvec4*>(leaves)};
    pieces_.resize(kAllCells / kCellsAtOnce);
    const auto lookAt = [&](Piece& piece, uint32_t cell) {
        const bool leaf = cell >= kLeafClass * kMaxCells;
        const uint32_t kept = kernels.keptOfCell(cell);
        const uint32_t* items = push.order.v + push.cells.v[cell].first;
        piece.listed[leaf] += kept;
        for (uint32_t i = 0; i < kept; ++i) {
            if (i + kAhead < kept) kernels.ask(items[i + kAhead], leaf);
            DrawnItem found;
            const uint32_t bucket =
                leaf ? kernels.bucketOfLeaf(items[i] - push.leafBase, found) : kernels.bucketOfSpan(items[i], found);
            if (bucket == kNoBucket) continue;
            found.place = bucket;
            piece.counts[bucket] += 1;
            piece.items.push_back(found);
        }
    };
    parallelFor(
        pieces_.size(), 1,
        [&](size_t begin, size_t end) {
            for (size_t p = begin; p < end; ++p) {
                Piece& piece = pieces_[p];
                piece.items.clear();
                std::fill_n(piece.counts, kMaxBuckets, 0u);
                std::fill_n(piece.listed, 2, 0u);
                for (uint32_t c = 0; c < kCellsAtOnce; ++c) lookAt(piece, uint32_t(p) * kCellsAtOnce + c);
            }
        },
        threads);
    size_t seen = 0;
    for (const Piece& piece : pieces_) seen += piece.items.size();
    return uint32_t(seen);
}

void NativeCull::write(const EmitPush& push, const EmitTable& table, DrawnItem* drawn, EmitState& state) const {
    const EmitCell& all = push.cells.v[kAllCells];
    state = {};
    state.fullTriangles = all.first;
    state.boundItems = all.changed;
    state.crowded = all.room;
    state.ordered = all.count;
    for (const Piece& piece : pieces_) {
        for (uint32_t b = 0; b < kMaxBuckets; ++b) state.counts[b] += piece.counts[b];
        for (uint32_t i = 0; i < 2; ++i) state.listed[i] += piece.listed[i];
    }
    uint32_t next[kMaxBuckets], sum = 0;
    for (uint32_t b = 0; b < kMaxBuckets; ++b) {
        state.starts[b] = next[b] = sum;
        sum += state.counts[b];
        (b < table.barkBuckets ? state.spanCount : state.leafCount) += state.counts[b];
        state.drawnTriangles += state.counts[b] * (table.buckets[b].indexCount / 3);
        drawBatches(table.buckets[b], state.counts[b], state.draws[2 * b], state.draws[2 * b + 1]);
    }
    for (const Piece& piece : pieces_)
        for (const DrawnItem& item : piece.items) drawn[next[item.place]++] = {item.item, item.bits, item.value, 0};
}

}  // namespace espalier
