// Enters: bound growth and a view. Leaves: what of it is drawn, sorted by bucket, with indirect draws. One kernel looks
// at cells, two list what these keep, two give each item of the list its bucket, one scans, one writes.
#include "runtime/emit/culled_view.hpp"

#include <algorithm>
#include <cstring>

#include "runtime/emit/emit_memory.hpp"

namespace espalier {
namespace {

// Where a group may have as many lanes, some of them share a bucket's blocks.
const char* scanShader(const Device& device) {
    const VkPhysicalDeviceLimits& limits = device.info().limits;
    const uint32_t most = std::min(limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]);
    return device.info().traits.wideGroups && most >= kScanShares * kMaxBuckets ? "emit/scan_wide.comp"
                                                                                : "emit/scan.comp";
}

// Wherever their tiles lie: `scene` tells whether these say the same.
bool sameView(const EmitView& a, EmitView b) {
    if (IS_GIVEN(a.tiles) == IS_GIVEN(b.tiles)) b.tiles = a.tiles;
    return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

Result<CulledView> CulledView::create(Device& device, const Terminals& terminals) {
    CulledView out;
    out.device_ = &device;
    out.terminals_ = &terminals;
    const ProgramOptions lanes{.constants = {{kConstantLanes, device.info().traits.cellLanes}}};
    Status programs = makeCompute(device, {{out.cullCells_, "emit/cull_cells.comp"},
                                           {out.listBlocks_, "emit/list_blocks.comp"},
                                           {out.listItems_, "emit/list_items.comp", lanes},
                                           {out.classifySpans_, "emit/classify_spans.comp", lanes},
                                           {out.classifyLeaves_, "emit/classify_leaves.comp", lanes},
                                           {out.scan_, scanShader(device)},
                                           {out.writeDrawn_, "emit/write_drawn.comp"}});
    if (!programs) return programs.failure();
    if (Status s = allDone({makeRoom(device, out.state_, "emit state", sizeof(EmitState)),
                            makeRoom(device, out.seen_, "emit seen cells", kAllCells * 8)});
        !s)
        return s.failure();
    for (Buffer& view : out.views_)
        if (Status s = makeRoom(device, view, "emit view", sizeof(EmitView)); !s) return s.failure();
    Result<Buffer> readback = Buffer::create(device, "emit counts", sizeof(EmitState), BufferUse::readback);
    if (!readback) return readback.failure();
    out.readback_ = std::move(*readback);
    std::fill(out.readback_.mappedAs<uint32_t>().begin(), out.readback_.mappedAs<uint32_t>().end(), 0u);
    return out;
}

EmitPush CulledView::pushFor(const BoundGrowth& bound) const {
    EmitPush push{};
    bound.tell(push);
    push.state = addressOf<EmitStateBuf>(state_);
    push.seen = addressOf<UintBuf>(seen_);
    push.rows = addressOf<UintBuf>(rows_);
    push.drawn = addressOf<DrawnBuf>(drawn_);
    return push;
}

// As much room as bound growth has.
Status CulledView::reserve(const BoundGrowth& bound) {
    const uint64_t drawn = bound.numbers() * sizeof(DrawnItem),
                   rows = (bound.numbers() / kBlockItems + 2) * kMaxBuckets * 4;
    if (!rows_ || rows_.size() < rows)
        if (Status s = makeRoom(*device_, rows_, "emit rows", rows); !s) return s;
    if (drawn_ && drawn_.size() >= drawn) return Done{};
    return makeRoom(*device_, drawn_, "drawn instances", (drawn + 15) / 16 * 16, &drawnTexels_);
}

void CulledView::drop() {
    of_ = 0;
    drawnTexels_ = {};  // no view outlives its buffer
    for (Buffer* buffer : {&rows_, &drawn_}) *buffer = {};
    for (Native& native : natives_) {
        native.drawnTexels = {};
        native = {};
    }
    native_ = ~size_t(0);
}

Status CulledView::record(Commands& commands, const BoundGrowth& bound, const EmitView& view, Pass& pass) {
    const Buffer& shown = views_[slot_++ % views_.size()];
    const Buffer& table = terminals_->tableBuffer();
    commands.barrier(Use::compute | Use::vertex | Use::indirect | Use::transfer, Use::transfer | Use::compute);
    if (Status s = commands.upload(shown, std::as_bytes(std::span(&view, 1))); !s) return s;
    commands.barrier(Use::transfer, Use::compute);

    const EmitPush push = pushFor(bound);
    pass.dispatchItems(cullCells_, kAllCells, push, {table, shown});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(listBlocks_, {1, 1, 1}, push);
    pass.barrier(Use::compute, Use::compute | Use::indirect);
    pass.dispatchItems(listItems_, kAllCells * device_->info().traits.cellLanes, push);
    pass.barrier(Use::compute, Use::compute);
    const uint64_t groups = offsetof(EmitState, groups);
    pass.dispatchIndirect(classifySpans_, state_, groups, push, {table, shown, bound.spanTexels()});
    pass.dispatchIndirect(classifyLeaves_, state_, groups + 12, push, {table, shown, bound.leafTexels()});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(scan_, {1, 1, 1}, push, {table, shown});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchIndirect(writeDrawn_, state_, groups + 24, push, {bound.noteTexels()});
    pass.barrier(Use::compute, Use::indirect | Use::vertex | Use::transfer);
    return Done{};
}

Status CulledView::cull(Commands& commands, const BoundGrowth& bound, const EmitView& view, std::string_view passName,
                        bool counted, bool native) {
    const bool known = of_ == bound.version() && sameView(view, view_) && (counted_ || !counted);
    if (known && culledNative()) natives_[native_].serial = commands.serial();
    if (known) return Done{};
    of_ = 0;
    if (Status s = reserve(bound); !s) return s;
    Pass pass(commands, passName);
    native_ = natives_.size();
    Result<bool> culled = native ? cullNative(bound, view, commands.serial()) : false;
    if (!culled) return culled.failure();
    if (!*culled)
        if (Status s = record(commands, bound, view, pass); !s) return s;
    if (counted) {
        commands.copy(state(), readback_, sizeof(EmitState));
        commands.barrier(Use::transfer, Use::host);
    }
    of_ = bound.version();
    view_ = view;
    counted_ = counted;
    return Done{};
}

uint32_t CulledView::look(const BoundGrowth& bound, const EmitView& view) {
    return nativeCull_.look(pushFor(bound), view, terminals_->kernelTable(),
                            reinterpret_cast<const SpanInstance*>(bound.spans().address()),
                            reinterpret_cast<const LeafInstance*>(bound.leaves().address()));
}

// Into one of natives_ that no recording draws any more.
Result<bool> CulledView::cullNative(const BoundGrowth& bound, const EmitView& view, uint64_t recording) {
    const bool stands = !IS_GIVEN(view.tiles) || (view.flags & kTilesStand) != 0;
    if (!stands || !bound.stands()) return false;
    const auto free =
        std::find_if(natives_.begin(), natives_.end(), [&](const Native& n) { return device_->finished(n.serial); });
    if (free == natives_.end()) return false;
    const uint64_t bytes = std::max<uint64_t>(look(bound, view), 1) * sizeof(DrawnItem);
    if (!free->drawn || free->drawn.size() < bytes) {
        Status made =
            makeRoom(*device_, free->drawn, "drawn instances, native", bytes + bytes / 4 / 16 * 16, &free->drawnTexels);
        if (!made) return made.failure();
    }
    if (!free->state)
        if (Status s = makeRoom(*device_, free->state, "emit state, native", sizeof(EmitState)); !s) return s.failure();
    nativeCull_.write(pushFor(bound), terminals_->kernelTable(), reinterpret_cast<DrawnItem*>(free->drawn.address()),
                      *reinterpret_cast<EmitState*>(free->state.address()));
    free->serial = recording;
    native_ = size_t(free - natives_.begin());
    return true;
}

Result<EmitState> CulledView::cullNow(const BoundGrowth& bound, const EmitView& view) {
    of_ = 0;
    native_ = natives_.size();
    if (Status s = reserve(bound); !s) return s.failure();
    look(bound, view);
    EmitState state = counts();
    nativeCull_.write(pushFor(bound), terminals_->kernelTable(), reinterpret_cast<DrawnItem*>(drawn_.address()), state);
    counts().crowded = state.crowded;
    return state;
}

}  // namespace espalier
