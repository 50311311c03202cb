// Enters: growth's records. Leaves: an instance in the world for each span and leaf, and the order of items by cells of
// space, each cell's by their order of going when they are thinned out. Runs when growth has changed; after edits, on
// what they concerned: nodes that were written and what hangs on them, and the cells where something was or is of that.
#include <algorithm>
#include <cmath>

#include "runtime/emit/cell_lanes.hpp"
#include "runtime/emit/emit.hpp"
#include "runtime/emit/instance_room.hpp"
#include "runtime/emit/native_bind.hpp"

namespace espalier {
namespace {

// At most so many leaves; beyond, they are counted as overflow and left out. Nodes are limited by growth.
constexpr uint32_t kMostLeaves = 6'000'000;

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

// Room for all that growth has room for, and for as much again on software devices.
Emit::HeldRoom Emit::roomFor(const GrowthView& growth, uint32_t leaves) const {
    const DeviceInfo& info = device_->info();
    const uint64_t most = std::min<uint64_t>(info.maxBufferBytes, 16ull * info.limits.maxTexelBufferElements);
    const auto room = [&](const Buffer* records, uint64_t recordBytes, uint32_t count, uint64_t instanceBytes) {
        const uint64_t there = std::max<uint64_t>(records ? records->size() / recordBytes : 0, count);
        return instanceRoom(there, instanceBytes, most, sharesMemory());
    };
    return {room(growth.nodeBuffer, sizeof(Node), growth.nodeCount, sizeof(SpanInstance)),
            std::min<uint64_t>(room(growth.leafBuffer, sizeof(Leaf), leaves, sizeof(LeafInstance)), kMostLeaves)};
}

Result<Emit::Held> Emit::makeHeld(const GrowthView& growth, uint32_t leaves) {
    Held held;
    const auto make = [&](Buffer& buffer, const char* name, uint64_t bytes, TexelView* texels = nullptr) -> Status {
        return makeRoom(buffer, name, std::max<uint64_t>(bytes, 65536) / 16 * 16, texels);
    };
    const auto [spans, loose] = roomFor(growth, leaves);
    Status instances[] = {make(held.spans, "span instances", spans * sizeof(SpanInstance), &held.spanTexels),
                          make(held.leaves, "leaf instances", loose * sizeof(LeafInstance), &held.leafTexels)};
    for (Status& s : instances)
        if (!s) return s.failure();
    held.leafBase = uint32_t(held.spans.size() / sizeof(SpanInstance));
    Status rest[] = {make(held.keys, "emit keys", held.numbers() * 4),
                     make(held.leafHeads, "emit leaf heads", held.leafBase * 4ull),
                     make(held.leafNext, "emit next leaves", held.leaves.size() / sizeof(LeafInstance) * 4)};
    for (Status& s : rest)
        if (!s) return s.failure();
    return held;
}

// For the items of `held`, with room for cells that outgrow theirs.
Status Emit::makeOrder(Buffer& order, const Held& held) {
    const uint64_t bytes = (held.numbers() + held.numbers() / 2 + 32 * kAllCells) * 4;
    if (order && order.size() >= bytes) return Done{};
    Result<Buffer> made = Buffer::create(*device_, "emit order", bytes);
    if (!made) return made.failure();
    order = std::move(*made);
    return Done{};
}

void Emit::trim(const GrowthView& growth) {
    constexpr uint64_t kFarMore = 3;
    spareOrder_ = {};
    for (TexelView* view : {&nodeRecords_, &chunkRecords_, &leafRecords_, &touchedRecords_}) *view = {};
    const HeldRoom room = roomFor(growth, std::min(growth.leafCount, kMostLeaves));
    if (held_.numbers() / kFarMore <= room.spans + room.leaves) return;
    forget();
    culled_ = {};
    hold({});
    for (TexelView* view : {&noteTexels_, &drawnTexels_}) *view = {};  // no view outlives its buffer
    for (Buffer* buffer : {&flags_, &list_, &rows_, &notes_, &drawn_}) *buffer = {};
    for (Native& native : natives_) {
        native.drawnTexels = {};
        native = {};
    }
    native_ = ~size_t(0);
}

void Emit::hold(Held held) {
    held_.spanTexels = {};  // no view outlives its buffer
    held_.leafTexels = {};
    held_ = std::move(held);
}

// texels: null, or the view that goes with the buffer.
Status Emit::makeRoom(Buffer& buffer, const char* name, uint64_t bytes, TexelView* texels) {
    if (texels) return makeTexels(*device_, name, bytes, VK_FORMAT_R32G32B32A32_UINT, buffer, *texels);
    Result<Buffer> made = Buffer::create(*device_, name, bytes);
    if (!made) return made.failure();
    buffer = std::move(*made);
    return Done{};
}

// Room for what kernels leave to each other, as much as held_ has.
Status Emit::reserve() {
    const uint64_t numbers = held_.numbers();
    const auto hold = [&](Buffer& buffer, const char* name, uint64_t bytes, TexelView* texels = nullptr) -> Status {
        if (buffer && buffer.size() >= bytes) return Done{};
        return makeRoom(buffer, name, (bytes + 15) / 16 * 16, texels);
    };
    const uint64_t blocks = numbers / kBlockItems + 2;
    Status rest[] = {hold(flags_, "emit flags", held_.leafBase * 4ull),
                     hold(list_, "emit list", (numbers + kBlockItems) * 4),
                     hold(rows_, "emit rows", blocks * kMaxBuckets * 4),
                     hold(notes_, "emit notes", blocks * kBlockItems * sizeof(DrawnItem), &noteTexels_),
                     hold(drawn_, "drawn instances", numbers * sizeof(DrawnItem), &drawnTexels_)};
    for (Status& s : rest)
        if (!s) return s;
    return Done{};
}

// Records as texels, which software devices read faster than by address.
Status Emit::viewRecords(const GrowthView& growth, uint32_t nodesBefore) {
    const struct {
        TexelView& view;
        const Buffer* buffer;
    } rows[] = {
        {nodeRecords_, growth.nodeBuffer}, {chunkRecords_, growth.chunkBuffer}, {leafRecords_, growth.leafBuffer}};
    const uint64_t most = 16ull * device_->info().limits.maxTexelBufferElements;
    fetches_ = device_->info().cpu;
    for (const auto& row : rows)
        fetches_ = fetches_ && row.buffer && row.buffer->size() >= 16 && row.buffer->size() <= most;
    for (const auto& row : rows) {
        row.view = {};
        const Buffer& buffer = fetches_ ? *row.buffer : noTexels_;
        Result<TexelView> made = TexelView::create(*device_, buffer, VK_FORMAT_R32G32B32A32_UINT);
        if (!made) return made.failure();
        row.view = std::move(*made);
    }
    // Four numbers a texel.
    const Buffer* touched = growth.touched;
    fetchesTouched_ = fetches_ && touched && touched->size() / 16 * 4 >= nodesBefore && touched->size() <= most;
    touchedRecords_ = {};
    Result<TexelView> made =
        TexelView::create(*device_, fetchesTouched_ ? *touched : noTexels_, VK_FORMAT_R32G32B32A32_UINT);
    if (!made) return made.failure();
    touchedRecords_ = std::move(*made);
    return Done{};
}

// Whether it is known that cells had no room for some of what is bound.
bool Emit::crowded() const {
    const uint32_t binding = reinterpret_cast<const EmitState*>(readback_.mapped())->crowded;
    return binding != 0 && binding == uint32_t(wholeBindings_);
}

// Whether what is bound is what regrowths, or the gaps' closing before them, began with.
bool Emit::staysBound(const Bound& wanted, const GrowthView& growth) const {
    const Bound& b = bound_;
    const GrowthMove& moved = growth.moved;
    const bool added = growth.renewed <= b.number && b.number <= growth.number && b.nodeCount <= wanted.nodeCount &&
                       b.leafCount <= wanted.leafCount;
    const bool movedThen = moved.nodes && b.number + 1 == growth.renewed && b.nodeCount == moved.nodesBefore &&
                           b.leafCount == moved.leavesBefore;
    return b.nodes != 0 && b.surfaces == wanted.surfaces && b.surfacesRevision == wanted.surfacesRevision &&
           b.low == wanted.low && b.high == wanted.high && growth.touched != nullptr && (added || movedThen) &&
           !crowded();
}

Status Emit::bind(Commands& commands, const EmitInputs& inputs) {
    const GrowthView& growth = inputs.growth;
    const uint32_t nodes = growth.nodeCount, leaves = std::min(growth.leafCount, kMostLeaves);
    const Bound wanted{uint64_t(growth.nodes.v),
                       uint64_t(growth.leaves.v),
                       uint64_t(inputs.surfaces.v),
                       inputs.surfacesRevision,
                       growth.revision,
                       nodes,
                       leaves,
                       growth.number,
                       inputs.low,
                       inputs.high};
    if (wanted == bound_ && !crowded()) return Done{};
    const bool partly = staysBound(wanted, growth);
    Bound before = bound_;
    bound_ = culled_ = {};
    if (!partly) {
        ++wholeBindings_;
        if (!held_.fits(nodes, leaves)) {
            Result<Held> made = makeHeld(growth, leaves);
            if (!made) return made.failure();
            if (Status s = makeOrder(made->order, *made); !s) return s;
            hold(std::move(*made));
        }
    } else if (before.number < growth.renewed || !held_.fits(nodes, leaves) || nearlyCrowded()) {
        if (Status s = carry(commands, inputs, leaves, before); !s) return s;
    }
    if (Status s = reserve(); !s) return s;
    grid_ = gridOver(inputs.low, inputs.high);
    overflow_ = growth.leafCount - leaves;

    BindInputs given{};
    given.nodes = growth.nodes;
    given.chunks = growth.chunks;
    given.leaves = growth.leaves;
    given.surfaces = inputs.surfaces;
    given.spans = addressOf<SpanInstanceBuf>(held_.spans);
    given.leafInstances = addressOf<LeafInstanceBuf>(held_.leaves);
    given.cells = addressOf<EmitCellBuf>(cells_);
    given.bins = addressOf<UintBuf>(bins_);
    given.keys = addressOf<UintBuf>(held_.keys);
    given.order = addressOf<UintBuf>(held_.order);
    if (partly) given.touched = addressOf<UintBuf>(*growth.touched);
    given.flags = addressOf<UintBuf>(flags_);
    given.list = addressOf<UintBuf>(list_);
    given.leafHeads = addressOf<UintBuf>(held_.leafHeads);
    given.leafNext = addressOf<UintBuf>(held_.leafNext);
    given.work = addressOf<UintBuf>(notes_);  // which a view writes only when all is bound
    given.leafWork = nodes;
    given.grid = grid_;
    given.nodeCount = nodes;
    given.leafCount = leaves;
    given.leafBase = held_.leafBase;
    given.orderRoom = uint32_t(held_.order.size() / 4);
    given.partly = partly ? 1 : 0;
    given.watched = partly && watched_.width > 0 ? 1 : 0;
    given.binding = uint32_t(wholeBindings_);
    given.since = before.number;
    given.nodesBefore = partly ? before.nodeCount : 0;
    given.leavesBefore = partly ? before.leafCount : 0;

    // What stands then may be culled by native code at once.
    const bool native = inputs.native && sharesMemory() && device_->finished(usedBy_);
    if (native) {
        bindNative(given, terminals_->kernelTable(), watched_);
    } else if (Status s = bindByKernels(commands, growth, given); !s) {
        return s;
    }
    bound_ = wanted;
    boundBy_ = native ? 0 : commands.serial();
    usedBy_ = commands.serial();
    return Done{};
}

Status Emit::bindByKernels(Commands& commands, const GrowthView& growth, const BindInputs& given) {
    if (Status s = viewRecords(growth, given.nodesBefore); !s) return s;
    const bool partly = given.partly != 0;
    const uint32_t nodes = given.nodeCount, leaves = given.leafCount;
    const Buffer& table = terminals_->tableBuffer();
    const Buffer& in = binds_[bindSlot_++ % binds_.size()];
    Pass pass(commands, "bind");
    commands.barrier(Use::compute | Use::vertex, Use::transfer | Use::compute);
    if (Status s = commands.upload(in, std::as_bytes(std::span(&given, 1))); !s) return s;
    if (partly) {
        commands.fill(flags_, 0, 0, std::max(nodes, given.nodesBefore) * 4ull);
        commands.fill(cells_, 0, kAllCells * sizeof(EmitCell) + offsetof(EmitCell, changed),
                      sizeof(EmitCell) - offsetof(EmitCell, changed));
    } else {
        commands.fill(cells_, 0);
        commands.fill(bins_, 0);
    }
    commands.barrier(Use::transfer, Use::compute);
    if (partly) {
        pass.dispatchItems(bindTouch_[fetchesTouched_], std::max(nodes / 4 + 1, kAllCells), {}, {touchedRecords_, in});
        pass.barrier(Use::compute, Use::compute);
    }
    // Kernels go through what there is to do in strides: how much that is, a part's are the first to know.
    const auto groupsFor = [&](uint32_t items) {
        return std::array<uint32_t, 3>{partly ? 64u : std::min(items / 64 + 1, 65535u), 1, 1};
    };
    // The lookup knows branches too, which nobody asks for here.
    pass.dispatch(bindSpans_[fetches_], groupsFor(nodes), {},
                  {table, nodeRecords_, chunkRecords_, chunkRecords_, watch_, in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(bindStretches_, groupsFor(nodes), {}, {table, held_.spanTexels, in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(bindLeaves_[fetches_], groupsFor(leaves), {}, {table, leafRecords_, held_.spanTexels, watch_, in});
    pass.barrier(Use::compute, Use::compute);
    if (partly) {
        pass.dispatchItems(bindKeep_, kAllCells * cellLanes(*device_), {}, {in});
        pass.barrier(Use::compute, Use::compute);
    }
    const std::array<uint32_t, 3> groups = groupsFor(std::min(nodes + leaves, 4095u * 64));
    pass.dispatch(bindCount_, groups, {}, {table, held_.spanTexels, held_.leafTexels, in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchItems(bindCells_, kAllCells + 1, {}, {in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(bindOrder_, groups, {}, {in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchItems(bindSort_, kAllCells * sortLanes(*device_), {}, {held_.spanTexels, held_.leafTexels, in});
    pass.barrier(Use::compute, Use::compute | Use::vertex);
    return Done{};
}

}  // namespace espalier
