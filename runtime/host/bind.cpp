// Enters: growth's records, and what was bound of them. Leaves: what the bind_*.comp kernels would, pass by pass.
#include "runtime/host/bind.hpp"

#include <algorithm>
#include <cstring>

#include "runtime/core/jobs.hpp"
#include "shaders/emit/cells.h"
#include "shaders/emit/leaf_place.h"
#include "shaders/emit/leaf_thinning.h"
#include "shaders/emit/sight.h"
#include "shaders/emit/span_load.h"
#include "shaders/emit/span_thinning.h"
#include "shaders/shared/record_lookup.h"

namespace espalier {
namespace {

constexpr size_t kItemsAtOnce = 1024, kNumbersAtOnce = 65536, kCellsAtOnce = 256;

// What is around the kernels' text there; one for each piece of a pass.
struct Kernels {
    const BindInputs& push;
    const EmitTable& table;
    const EmitView& watched;
    uint triangles = 0;

    void addTriangles(uint count) { triangles += count; }
    Leaf readLeaf(uint i) const { return push.leaves.v[i]; }
    const SpanInstance& spanInstance(uint i) const { return push.spans.v[i]; }
    void writeSpan(uint i, const SpanInstance& span) const { push.spans.v[i] = span; }
    void writeLeaf(uint i, const LeafInstance& leaf) const { push.leafInstances.v[i] = leaf; }
    uvec4 spanTexel(uint i) const { return texel(push.spans.v, i); }
    uvec4 leafTexel(uint i) const { return texel(push.leafInstances.v, i); }
    static uvec4 texel(const void* words, uint i) {
        uvec4 t;
        std::memcpy(&t, static_cast<const char*>(words) + i * sizeof t, sizeof t);
        return t;
    }
#include "shaders/emit/bind_item.h"
// Upon that:
#include "shaders/emit/bind_cell.h"
#include "shaders/emit/bind_stretch.h"
#include "shaders/emit/count_item.h"
#include "shaders/emit/note_change.h"
#include "shaders/emit/sort_bins.h"
#include "shaders/emit/touch_node.h"
// Upon these:
#include "shaders/emit/bind_leaf.h"
#include "shaders/emit/bind_span.h"
};

class Binding {
  public:
    Binding(const BindInputs& inputs, const EmitTable& table, const EmitView& watched, unsigned threads)
        : push(inputs), table_(table), watched_(watched), crew_(threads) {}

    void clear() {
        if (push.partly == 0) {
            std::memset(push.cells.v, 0, (kAllCells + 1) * sizeof(EmitCell));
            std::memset(push.bins.v, 0, size_t(kAllCells) * kCellBins * sizeof(uint));
            return;
        }
        HEAD.changed = HEAD.reach = HEAD.largest = 0;
        std::memset(push.flags.v, 0, std::max(push.nodeCount, push.nodesBefore) * sizeof(uint));
        for (uint cell = 0; cell < kAllCells; ++cell) push.cells.v[cell].changed = 0;
    }
    void touch() {
        each(push.nodeCount, kNumbersAtOnce, [&](Kernels& kernels, uint i) {
            const bool wrote = i >= push.nodesBefore || (push.written != 0 && push.touched.v[i] > push.since);
            if (wrote || kernels.hasMoved(i)) kernels.touchNode(i);
        });
    }
    void bindSpans() {
        each(nodes(), kItemsAtOnce, [&](Kernels& kernels, uint i) { kernels.bindSpan(kernels.nodeToBind(i)); });
        each(nodes(), kItemsAtOnce, [&](Kernels& kernels, uint i) { kernels.bindStretch(kernels.nodeToBind(i)); });
    }
    void bindLeaves() {
        const uint listed = std::min(HEAD.largest, push.leavesBefore);
        const UintBuf work = push.work;
        each(listed, kItemsAtOnce, [&](Kernels& kernels, uint i) { kernels.bindLeaf(work.v[push.leafWork + i]); });
        each(push.leafCount - push.leavesBefore, kItemsAtOnce,
             [&](Kernels& kernels, uint i) { kernels.bindLeaf(push.leavesBefore + i); });
    }
    // Items come to their cells.
    void order() {
        if (push.partly != 0) eachCell([](Kernels& kernels, uint cell) { kernels.keepItems(cell, 0, 1); });
        if (push.partly == 0) HEAD.changed = push.nodeCount + push.leafCount;
        const uint items = HEAD.changed;
        each(items, kItemsAtOnce, [](Kernels& kernels, uint i) { kernels.countItem(kernels.itemToPut(i)); });
        eachCell([](Kernels& kernels, uint cell) { kernels.makeCellRoom(cell); });
        each(items, kItemsAtOnce, [](Kernels& kernels, uint i) { kernels.putItem(kernels.itemToPut(i)); });
        eachCell([&](Kernels& kernels, uint cell) {
            if (push.cells.v[cell].count > 0) kernels.sortBins(cell, 0, 1);
        });
    }

  private:
    uint nodes() const { return push.partly != 0 ? HEAD.reach : push.nodeCount; }
    // body(kernels, i) over [0, count).
    template <class Body>
    void each(uint count, size_t atOnce, const Body& body) {
        crew_.overRange(count, atOnce, [&](size_t begin, size_t end) {
            Kernels kernels{push, table_, watched_};
            for (size_t i = begin; i < end; ++i) body(kernels, uint(i));
            if (kernels.triangles != 0) atomicAdd(HEAD.first, kernels.triangles);
        });
    }
    // Over the cells that are bound, or changed.
    template <class Body>
    void eachCell(const Body& body) {
        each(kAllCells, kCellsAtOnce, [&](Kernels& kernels, uint cell) {
            if (push.partly == 0 || push.cells.v[cell].changed != 0) body(kernels, cell);
        });
    }

    const BindInputs& push;  // as the kernels' text calls it
    const EmitTable& table_;
    const EmitView& watched_;
    Crew crew_;
};

}  // namespace

float movedShare(NodeBuf nodes, uint32_t count, std::span<const uint32_t> bits) {
    constexpr uint32_t kStep = 61;  // that chunks don't have
    uint32_t all = 0, moved = 0;
    for (uint32_t i = 0; i < count; i += kStep, ++all) {
        const uint32_t instance = nodes.v[i].place >> 16;
        moved += instance / 32 < bits.size() && (bits[instance / 32] >> (instance % 32) & 1) != 0;
    }
    return all > 0 ? float(moved) / float(all) : 0;
}

void bindNative(const BindInputs& push, const EmitTable& table, const EmitView& watched, unsigned threads) {
    Binding binding(push, table, watched, threads);
    binding.clear();
    if (push.partly != 0) binding.touch();
    binding.bindSpans();
    binding.bindLeaves();
    binding.order();
}

}  // namespace espalier
