// Enters: growth's records. Leaves: an instance in the world for each span and leaf, and the order of items by cells of
// space, each cell's by their order of going when they are thinned out. Runs when growth or where it stands has
// changed; after edits and moves, on what they concerned: nodes that were written or moved and what hangs on them, and
// the cells where something was or is of that.
#include "runtime/emit/bound_growth.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/emit/emit_memory.hpp"
#include "runtime/run/emission.hpp"

namespace espalier {
namespace {

// At most so many leaves; beyond, they are counted as overflow and left out. Nodes are limited by growth.
constexpr uint32_t kMostLeaves = 6'000'000;

// Widens a box to whole steps, of an eighth of its longest side at most: what moves about in a scene seldom changes the
// grid, and yet the grid follows from the scene alone. Steps end beside round numbers, at which scenes like to end.
void widen(glm::vec3& low, glm::vec3& high) {
    constexpr float kBeside = 0.37f;
    const glm::vec3 extent = high - low;
    const float longest = std::max({extent.x, extent.y, extent.z});
    if (!(longest > 0)) return;
    const float step = std::exp2(std::ceil(std::log2(longest / 16)));
    low = (glm::floor(low / step - kBeside) + kBeside) * step;
    high = (glm::ceil(high / step - kBeside) + kBeside) * step;
}

// The cubes that fill the box, at most kMaxCells of them.
EmitGrid gridOver(glm::vec3 low, glm::vec3 high) {
    const glm::vec3 extent = glm::max(high - low, glm::vec3(1e-3f * std::max(1e-3f, glm::length(high - low))));
    float cell = std::cbrt(extent.x * extent.y * extent.z / float(kMaxCells));
    EmitGrid grid{};
    for (uint64_t cells = kMaxCells + 1; cells > kMaxCells; cell *= 1.03f) {
        cells = 1;
        for (int axis = 0; axis < 3; ++axis) {
            grid.size[axis] = uint32_t(std::clamp(std::ceil(extent[axis] / cell), 1.0f, float(kMaxCells)));
            cells *= grid.size[axis];
        }
        grid.rcpCell = 1 / cell;
    }
    grid.low = low;
    return grid;
}

}  // namespace

Result<BoundGrowth> BoundGrowth::create(Device& device, const Terminals& terminals) {
    BoundGrowth out;
    out.device_ = &device;
    out.terminals_ = &terminals;
    const DeviceTraits& traits = device.info().traits;
    Status programs = makeCompute(
        device, {{out.bindSpans_, "emit/bind_spans.comp", exactly()},
                 {out.bindLeaves_, "emit/bind_leaves.comp", exactly()},
                 {out.bindTouch_, "emit/bind_touch.comp"},
                 {out.bindStretches_, "emit/bind_stretches.comp", exactly()},
                 {out.bindKeep_, "emit/bind_keep.comp", {.constants = {{kConstantLanes, traits.cellLanes}}}},
                 {out.bindCount_, "emit/bind_count.comp", exactly()},
                 {out.bindCells_, "emit/bind_cells.comp"},
                 {out.bindOrder_, "emit/bind_order.comp"},
                 {out.bindSort_, "emit/bind_sort.comp", {.constants = {{kConstantLanes, traits.sortLanes}}}}});
    if (!programs) return programs.failure();
    if (Status s = allDone({makeRoom(device, out.cells_, "emit cells", (kAllCells + 1) * sizeof(EmitCell)),
                            makeRoom(device, out.bins_, "emit bins", kAllCells * kCellBins * 4ull)});
        !s)
        return s.failure();
    for (Buffer& given : out.inputs_)
        if (Status s = makeRoom(device, given, "bind inputs", sizeof(BindInputs)); !s) return s.failure();
    return out;
}

// Room for all that growth has room for, and for as much again where memory that isn't touched costs nothing.
BoundGrowth::HeldRoom BoundGrowth::roomFor(const GrowthView& growth, uint32_t leaves) const {
    const DeviceInfo& info = device_->info();
    const uint64_t most = std::min<uint64_t>(info.maxBufferBytes, 16ull * info.limits.maxTexelBufferElements);
    const auto room = [&](const Buffer* records, uint64_t recordBytes, uint32_t count, uint64_t instanceBytes) {
        const uint64_t there = std::max<uint64_t>(records ? records->size() / recordBytes : 0, count);
        return instanceRoom(there, instanceBytes, most, info.traits.lazyMemory);
    };
    return {room(growth.nodeBuffer, sizeof(Node), growth.nodeCount, sizeof(SpanInstance)),
            std::min<uint64_t>(room(growth.leafBuffer, sizeof(Leaf), leaves, sizeof(LeafInstance)), kMostLeaves)};
}

Result<BoundGrowth::Held> BoundGrowth::makeHeld(const GrowthView& growth, uint32_t leaves) {
    Held held;
    const auto make = [&](Buffer& buffer, const char* name, uint64_t bytes, TexelView* texels = nullptr) -> Status {
        return makeRoom(*device_, buffer, name, std::max<uint64_t>(bytes, 65536) / 16 * 16, texels);
    };
    const auto [spans, loose] = roomFor(growth, leaves);
    if (Status s = allDone({make(held.spans, "span instances", spans * sizeof(SpanInstance), &held.spanTexels),
                            make(held.leaves, "leaf instances", loose * sizeof(LeafInstance), &held.leafTexels)});
        !s)
        return s.failure();
    held.leafBase = uint32_t(held.spans.size() / sizeof(SpanInstance));
    if (Status s = allDone({make(held.keys, "emit keys", held.numbers() * 4),
                            make(held.leafHeads, "emit leaf heads", held.leafBase * 4ull),
                            make(held.leafNext, "emit next leaves", held.leaves.size() / sizeof(LeafInstance) * 4)});
        !s)
        return s.failure();
    return held;
}

// For the items of `held`, each cell with roomFor() its own; and as much again, for all of them may move to other
// cells.
Status BoundGrowth::makeOrder(Buffer& order, const Held& held) {
    const uint64_t numbers = 2 * (held.numbers() + held.numbers() / 4 + 16 * kAllCells);
    return makeAtLeast(*device_, order, "emit order", numbers * 4);
}

bool BoundGrowth::trim(const GrowthView& growth) {
    constexpr uint64_t kFarMore = 3;
    spareOrder_ = {};
    const HeldRoom room = roomFor(growth, std::min(growth.leafCount, kMostLeaves));
    if (held_.numbers() / kFarMore <= room.spans + room.leaves) return false;
    forget();
    hold({});
    noteTexels_ = {};  // no view outlives its buffer
    for (Buffer* buffer : {&flags_, &list_, &notes_}) *buffer = {};
    return true;
}

void BoundGrowth::forget() {
    source_ = {};
    ++version_;
}

void BoundGrowth::hold(Held held) {
    held_.spanTexels = {};  // no view outlives its buffer
    held_.leafTexels = {};
    held_ = std::move(held);
}

// Room for what kernels leave to each other, as much as held_ has.
Status BoundGrowth::reserve() {
    const uint64_t numbers = held_.numbers();
    const auto hold = [&](Buffer& buffer, const char* name, uint64_t bytes, TexelView* texels = nullptr) -> Status {
        if (buffer && buffer.size() >= bytes) return Done{};
        return makeRoom(*device_, buffer, name, (bytes + 15) / 16 * 16, texels);
    };
    const uint64_t blocks = numbers / kBlockItems + 2;
    return allDone({hold(flags_, "emit flags", held_.leafBase * 4ull),
                    hold(list_, "emit list", (numbers + kBlockItems) * 4),
                    hold(notes_, "emit notes", blocks * kBlockItems * sizeof(DrawnItem), &noteTexels_)});
}

void BoundGrowth::tell(EmitPush& push) const {
    push.cells = addressOf<EmitCellBuf>(cells_);
    push.bins = addressOf<UintBuf>(bins_);
    push.order = addressOf<UintBuf>(held_.order);
    push.list = addressOf<UintBuf>(list_);
    push.notes = addressOf<DrawnBuf>(notes_);
    push.grid = grid_;
    push.leafBase = held_.leafBase;
}

// Whether it is known that cells had no room for some of what is bound.
bool BoundGrowth::crowded(const EmitState& counted) const {
    return counted.crowded != 0 && counted.crowded == uint32_t(wholeBindings_);
}

BoundGrowth::Moved BoundGrowth::movedSince(const EmitInputs& inputs) const {
    constexpr float kMost = 0.4f;  // of the nodes: from here on it costs less to bind all
    const std::span<const Version> placed = inputs.placed;
    Moved moved;
    for (uint32_t i = 0; i < std::min(placed.size(), placed_.size()); ++i) {
        // Nothing was bound where no surface stood, and nothing is to be where none does.
        if (placed[i] == placed_[i] || placed[i] == 0 || placed_[i] == 0) continue;
        moved.whole = moved.whole || i / 32 >= kMovedWords;
        if (moved.whole) return moved;
        moved.bits[i / 32] |= 1u << i % 32;
        moved.words = i / 32 + 1;
    }
    if (moved.words > 0 && runsAtOnce(*device_, inputs.native, cells_))
        moved.whole = movedShare(inputs.growth.nodes, inputs.growth.nodeCount, moved.bits) > kMost;
    return moved;
}

// Whether what is bound is this growth, or what regrowths, or the gaps' closing before them, began with.
bool BoundGrowth::staysBound(const Source& wanted, const GrowthView& growth) const {
    const Source& s = source_;
    if (s.nodes == 0 || s.low != wanted.low || s.high != wanted.high) return false;
    if (s == wanted) return true;
    const GrowthMove& moved = growth.moved;
    const bool added = growth.renewed <= s.number && s.number <= growth.number && s.nodeCount <= wanted.nodeCount &&
                       s.leafCount <= wanted.leafCount;
    const bool movedThen = moved.nodes && s.number + 1 == growth.renewed && s.nodeCount == moved.nodesBefore &&
                           s.leafCount == moved.leavesBefore;
    return growth.touched != nullptr && (added || movedThen);
}

Status BoundGrowth::bind(Commands& commands, const EmitInputs& inputs, const TileWatch& watch, EmitState& counted) {
    const GrowthView& growth = inputs.growth;
    const uint32_t nodes = growth.nodeCount, leaves = std::min(growth.leafCount, kMostLeaves);
    Source wanted{uint64_t(growth.nodes.v),
                  uint64_t(growth.leaves.v),
                  growth.revision,
                  nodes,
                  leaves,
                  growth.number,
                  inputs.low,
                  inputs.high};
    widen(wanted.low, wanted.high);
    const Moved moved = movedSince(inputs);
    const bool same = wanted == source_;
    if (same && !moved.any() && !crowded(counted)) {
        placed_.assign(inputs.placed.begin(), inputs.placed.end());
        return Done{};
    }
    const bool partly = staysBound(wanted, growth) && !moved.whole && !crowded(counted);
    Source before = source_;
    forget();
    if (!partly) {
        ++wholeBindings_;
        if (!held_.fits(nodes, leaves)) {
            Result<Held> made = makeHeld(growth, leaves);
            if (!made) return made.failure();
            if (Status s = makeOrder(made->order, *made); !s) return s;
            hold(std::move(*made));
        }
    } else if (before.number < growth.renewed || !held_.fits(nodes, leaves) || nearlyCrowded(counted) || moved.any()) {
        if (Status s = carry(commands, inputs, leaves, before); !s) return s;
        counted.ordered = 0;  // until the next count comes back
    }
    if (Status s = reserve(); !s) return s;
    grid_ = gridOver(wanted.low, wanted.high);
    overflow_ = growth.leafCount - leaves;

    BindInputs given = bindInputs(inputs, wanted);
    if (partly) {
        given.partly = 1;
        if (!same) given.touched = addressOf<UintBuf>(*growth.touched);
        given.written = same ? 0 : 1;
        given.movedWords = moved.words;
        std::ranges::copy(moved.bits, given.moved);
        given.watched = watch.watched().width > 0 ? 1 : 0;
        given.nodesBefore = before.nodeCount;
        given.leavesBefore = before.leafCount;
    }
    given.since = before.number;
    // What stands then may be culled by native code at once.
    const bool native = runsAtOnce(*device_, inputs.native, cells_) && device_->finished(usedBy_);
    if (native) {
        bindNative(given, terminals_->kernelTable(), watch.watched());
    } else if (Status s = bindByKernels(commands, watch, given); !s) {
        return s;
    }
    source_ = wanted;
    placed_.assign(inputs.placed.begin(), inputs.placed.end());
    boundBy_ = native ? 0 : commands.serial();
    usedBy_ = commands.serial();
    return Done{};
}

// But for what an edit has.
BindInputs BoundGrowth::bindInputs(const EmitInputs& inputs, const Source& wanted) const {
    BindInputs given{};
    given.nodes = inputs.growth.nodes;
    given.chunks = inputs.growth.chunks;
    given.leaves = inputs.growth.leaves;
    given.surfaces = inputs.surfaces;
    given.spans = addressOf<SpanInstanceBuf>(held_.spans);
    given.leafInstances = addressOf<LeafInstanceBuf>(held_.leaves);
    given.cells = addressOf<EmitCellBuf>(cells_);
    given.bins = addressOf<UintBuf>(bins_);
    given.keys = addressOf<UintBuf>(held_.keys);
    given.order = addressOf<UintBuf>(held_.order);
    given.flags = addressOf<UintBuf>(flags_);
    given.list = addressOf<UintBuf>(list_);
    given.leafHeads = addressOf<UintBuf>(held_.leafHeads);
    given.leafNext = addressOf<UintBuf>(held_.leafNext);
    given.work = addressOf<UintBuf>(notes_);  // which a view writes only when all is bound
    given.leafWork = wanted.nodeCount;
    given.grid = grid_;
    given.nodeCount = wanted.nodeCount;
    given.leafCount = wanted.leafCount;
    given.leafBase = held_.leafBase;
    given.orderRoom = uint32_t(held_.order.size() / 4);
    given.binding = uint32_t(wholeBindings_);
    return given;
}

}  // namespace espalier
