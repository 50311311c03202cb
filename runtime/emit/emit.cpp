// Enters: bound growth (emit_bind.cpp) and a view. Leaves: what of it is drawn, sorted by bucket, with indirect draws.
// One kernel looks at cells, two list what these keep, two give each item of the list its bucket, one scans, one
// writes.
#include "runtime/emit/emit.hpp"

#include <algorithm>
#include <cstring>

#include "runtime/emit/cell_lanes.hpp"
#include "shaders/emit/glsl_names.h"

namespace espalier {
namespace {

// Far canopies are drawn with fewer, larger leaves: each goes on its own, by its hash, so that nothing pops at once.
constexpr float kWholePixels = 8, kLeastShare = 0.12f;

uint32_t tilesAlong(const EmitView& view, uint32_t pixels) {
    return (pixels + view.tilePixels - 1) / view.tilePixels;
}

// Where a group may have as many lanes, some of them share a bucket's blocks.
const char* scanShader(const Device& device) {
    const VkPhysicalDeviceLimits& limits = device.info().limits;
    const uint32_t most = std::min(limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]);
    return !device.info().cpu && most >= kScanShares * kMaxBuckets ? "emit/scan_wide.comp" : "emit/scan.comp";
}

// Wherever their tiles lie: `scene` tells whether these say the same.
bool sameView(const EmitView& a, EmitView b) {
    if (IS_GIVEN(a.tiles) == IS_GIVEN(b.tiles)) b.tiles = a.tiles;
    return std::memcmp(&a, &b, sizeof a) == 0;
}

// What is around the kernel's text.
struct TakeTiles {
    const TakePush& push;
#include "shaders/emit/take_tiles.h"

    void all() {
        takeRun(floatBitsToUint(push.taken.v[push.tiles]), 0, takePlaces(), 0);
    }
};

}  // namespace

Result<Emit> Emit::create(Device& device, const Terminals& terminals) {
    const SpecConstant lanes{5, cellLanes(device)};
    Emit emit;
    emit.device_ = &device;
    emit.terminals_ = &terminals;
    const struct {
        Program& program;
        const char* shader;
        std::vector<SpecConstant> constants;
        bool exact = false;
    } programs[] = {{emit.bindSpans_[0], "emit/bind_spans.comp", {{3, 1}}, true},
                    {emit.bindSpans_[1], "emit/bind_spans.comp", {{3, 0}}, true},
                    {emit.bindLeaves_[0], "emit/bind_leaves.comp", {{3, 1}}, true},
                    {emit.bindLeaves_[1], "emit/bind_leaves.comp", {{3, 0}}, true},
                    {emit.bindTouch_[0], "emit/bind_touch.comp", {{3, 1}}},
                    {emit.bindTouch_[1], "emit/bind_touch.comp", {{3, 0}}},
                    {emit.bindStretches_, "emit/bind_stretches.comp", {}, true},
                    {emit.bindKeep_, "emit/bind_keep.comp", {lanes}},
                    {emit.bindCount_, "emit/bind_count.comp", {}, true},
                    {emit.bindCells_, "emit/bind_cells.comp", {}},
                    {emit.bindOrder_, "emit/bind_order.comp", {}},
                    {emit.bindSort_, "emit/bind_sort.comp", {{5, sortLanes(device)}}},
                    {emit.cullCells_, "emit/cull_cells.comp", {}},
                    {emit.listBlocks_, "emit/list_blocks.comp", {}},
                    {emit.listItems_, "emit/list_items.comp", {lanes}},
                    {emit.classifySpans_, "emit/classify_spans.comp", {lanes}},
                    {emit.classifyLeaves_, "emit/classify_leaves.comp", {lanes}},
                    {emit.scan_, scanShader(device), {}},
                    {emit.writeDrawn_, "emit/write_drawn.comp", {}},
                    {emit.takeTiles_, "emit/take_tiles.comp", {}},
                    {emit.barkVertices_, "emit/bark_vertices.comp", {}, true},
                    {emit.barkIndices_, "emit/bark_indices.comp", {}},
                    {emit.looseTriangles_, "emit/loose_triangles.comp", {}}};
    for (const auto& p : programs) {
        Result<Program> made = Program::compute(device, p.shader, {.exact = p.exact, .constants = p.constants});
        if (!made) return made.failure();
        p.program = std::move(*made);
    }
    const struct {
        Buffer& buffer;
        const char* name;
        uint64_t bytes;
        BufferUse use = BufferUse::device;
    } buffers[] = {{emit.state_, "emit state", sizeof(EmitState)},
                   {emit.cells_, "emit cells", (kAllCells + 1) * sizeof(EmitCell)},
                   {emit.bins_, "emit bins", kAllCells * kCellBins * 4ull},
                   {emit.seen_, "emit seen cells", kAllCells * 8},
                   {emit.noTexels_, "emit no texels", 16},
                   {emit.watch_, "watched view", sizeof(EmitView)},
                   {emit.readback_, "emit counts", sizeof(EmitState), BufferUse::readback}};
    for (const auto& b : buffers) {
        Result<Buffer> made = Buffer::create(device, b.name, b.bytes, b.use);
        if (!made) return made.failure();
        b.buffer = std::move(*made);
    }
    for (size_t i = 0; i < emit.views_.size(); ++i) {
        Result<Buffer> view = Buffer::create(device, "emit view", sizeof(EmitView));
        if (!view) return view.failure();
        emit.views_[i] = std::move(*view);
        Result<Buffer> bind = Buffer::create(device, "bind inputs", sizeof(BindInputs));
        if (!bind) return bind.failure();
        emit.binds_[i] = std::move(*bind);
    }
    std::fill(emit.readback_.mappedAs<uint32_t>().begin(), emit.readback_.mappedAs<uint32_t>().end(), 0u);
    return emit;
}

// Native code reads and writes what kernels do.
bool Emit::sharesMemory() const {
    return device_->info().cpu && uintptr_t(state_.mapped()) == state_.address();
}

EmitPush Emit::cullPush() const {
    EmitPush push{};
    push.state = addressOf<EmitStateBuf>(state_);
    push.cells = addressOf<EmitCellBuf>(cells_);
    push.bins = addressOf<UintBuf>(bins_);
    push.order = addressOf<UintBuf>(held_.order);
    push.seen = addressOf<UintBuf>(seen_);
    push.list = addressOf<UintBuf>(list_);
    push.rows = addressOf<UintBuf>(rows_);
    push.notes = addressOf<DrawnBuf>(notes_);
    push.drawn = addressOf<DrawnBuf>(drawn_);
    push.grid = grid_;
    push.leafBase = held_.leafBase;
    return push;
}

Status Emit::record(Commands& commands, const EmitView& view, Pass& pass) {
    const Buffer& shown = views_[viewSlot_++ % views_.size()];
    const Buffer& table = terminals_->tableBuffer();
    commands.barrier(Use::compute | Use::vertex | Use::indirect | Use::transfer, Use::transfer | Use::compute);
    if (Status s = commands.upload(shown, std::as_bytes(std::span(&view, 1))); !s) return s;
    commands.barrier(Use::transfer, Use::compute);

    const EmitPush push = cullPush();
    pass.dispatchItems(cullCells_, kAllCells, push, {table, shown});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(listBlocks_, {1, 1, 1}, push);
    pass.barrier(Use::compute, Use::compute | Use::indirect);
    pass.dispatchItems(listItems_, kAllCells * cellLanes(*device_), push);
    pass.barrier(Use::compute, Use::compute);
    const uint64_t groups = offsetof(EmitState, groups);
    pass.dispatchIndirect(classifySpans_, state_, groups, push, {table, shown, held_.spanTexels});
    pass.dispatchIndirect(classifyLeaves_, state_, groups + 12, push, {table, shown, held_.leafTexels});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(scan_, {1, 1, 1}, push, {table, shown});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchIndirect(writeDrawn_, state_, groups + 24, push, {noteTexels_});
    return Done{};
}

Status Emit::cull(Commands& commands, const EmitInputs& inputs, const EmitView& view, std::string_view passName,
                  bool counted) {
    if (Status s = bind(commands, inputs); !s) return s;
    usedBy_ = commands.serial();
    const bool known = bound_ == culled_ && sameView(view, view_) && (counted_ || !counted);
    if (known && culledNative()) natives_[native_].serial = commands.serial();
    if (known) return Done{};
    culled_ = bound_;
    view_ = view;
    counted_ = counted;
    Pass pass(commands, passName);
    Result<bool> native = cullNative(inputs, view, commands.serial());
    if (!native) return native.failure();
    if (!*native) {
        if (Status s = record(commands, view, pass); !s) return s;
        pass.barrier(Use::compute, Use::indirect | Use::vertex | Use::transfer);
    }
    if (counted) {
        commands.copy(state(), readback_, sizeof(EmitState));
        commands.barrier(Use::transfer, Use::host);
    }
    return Done{};
}

// Into one of natives_ that no recording draws any more.
Result<bool> Emit::cullNative(const EmitInputs& inputs, const EmitView& view, uint64_t recording) {
    native_ = natives_.size();
    const bool stands = !IS_GIVEN(view.tiles) || (view.flags & kTilesStand) != 0;
    if (!inputs.native || !sharesMemory() || !stands || !device_->finished(boundBy_)) return false;
    const auto free =
        std::find_if(natives_.begin(), natives_.end(), [&](const Native& n) { return device_->finished(n.serial); });
    if (free == natives_.end()) return false;
    const EmitPush push = cullPush();
    const uint32_t seen = nativeCull_.look(push, view, terminals_->kernelTable(),
                                           reinterpret_cast<const SpanInstance*>(held_.spans.address()),
                                           reinterpret_cast<const LeafInstance*>(held_.leaves.address()));
    const uint64_t bytes = std::max<uint64_t>(seen, 1) * sizeof(DrawnItem);
    if (!free->drawn || free->drawn.size() < bytes) {
        Status made = makeRoom(free->drawn, "drawn instances, native", bytes + bytes / 4 / 16 * 16, &free->drawnTexels);
        if (!made) return made.failure();
    }
    if (!free->state) {
        Result<Buffer> made = Buffer::create(*device_, "emit state, native", sizeof(EmitState));
        if (!made) return made.failure();
        free->state = std::move(*made);
    }
    nativeCull_.write(push, terminals_->kernelTable(), reinterpret_cast<DrawnItem*>(free->drawn.address()),
                      *reinterpret_cast<EmitState*>(free->state.address()));
    free->serial = recording;
    native_ = size_t(free - natives_.begin());
    return true;
}

Status Emit::watch(Commands& commands, const EmitView& view) {
    const uint64_t bytes = 4ull * tilesOf(view);
    watched_ = {};
    if (!watchTiles_ || watchTiles_.size() != bytes) {
        Result<Buffer> watched = Buffer::create(*device_, "watched tiles", bytes);
        if (!watched) return watched.failure();
        Result<Buffer> taken = Buffer::create(*device_, "taken tiles", bytes + 4);
        if (!taken) return taken.failure();
        watchTiles_ = std::move(*watched);
        takenTiles_ = std::move(*taken);
    }
    usedBy_ = tilesBy_ = commands.serial();
    EmitView watched = view;
    watched.tiles = addressOf<FloatBuf>(watchTiles_);
    commands.barrier(Use::compute, Use::transfer);
    if (Status s = commands.upload(watch_, std::as_bytes(std::span(&watched, 1))); !s) return s;
    watched_ = watched;
    commands.barrier(Use::compute | Use::vertex, Use::transfer);
    commands.fill(watchTiles_, kKeptTile);
    commands.fill(takenTiles_, 0);
    commands.barrier(Use::transfer, Use::compute | Use::vertex);
    return Done{};
}

EmitView Emit::takeChanges(Commands& commands, const EmitInputs& inputs, uint32_t mostTiles) {
    const bool atOnce = inputs.native && sharesMemory() && device_->finished(boundBy_) && device_->finished(tilesBy_);
    usedBy_ = tilesBy_ = commands.serial();
    EmitView view = watched_;
    view.tiles = addressOf<FloatBuf>(takenTiles_);
    view.scene = ++timesTaken_;  // others each time
    TakePush push{};
    push.watched = watched_.tiles;
    push.taken = view.tiles;
    push.tiles = tilesOf(view);
    push.columns = tilesAlong(view, view.width);
    push.most = mostTiles;
    if (atOnce) {
        TakeTiles{push}.all();
        view.flags |= kTilesStand;
        return view;
    }
    Pass pass(commands, "shadow emit");
    pass.barrier(Use::compute | Use::vertex, Use::compute);
    pass.dispatch(takeTiles_, {1, 1, 1}, push);
    pass.barrier(Use::compute, Use::compute | Use::vertex);
    return view;
}

EmitStats Emit::stats() const {
    const EmitState& state = *reinterpret_cast<const EmitState*>(readback_.mapped());
    EmitStats stats;
    stats.drawnTriangles = state.drawnTriangles;
    stats.fullTriangles = state.fullTriangles;
    stats.spans = state.spanCount;
    stats.leaves = state.leafCount;
    stats.overflow = overflow_;
    stats.bound = state.boundItems;
    stats.buckets.assign(state.counts, state.counts + kMaxBuckets);
    return stats;
}

uint32_t tilesOf(const EmitView& view) {
    return tilesAlong(view, view.width) * tilesAlong(view, view.height);
}

EmitView perspectiveView(const glm::mat4& viewProjection, glm::vec3 eye, float pixelScale, float lodPixels) {
    EmitView view = parallelView(viewProjection, pixelScale, lodPixels);
    view.eye = eye;
    view.parallel = 0;
    return view;
}

void thinOut(EmitView& view, float leafPixels) {
    const float coarser = std::max(leafPixels / kWholePixels, 1.0f);
    view.wholePixels = std::max(leafPixels, 1e-3f);
    view.leastShare = kLeastShare / (coarser * coarser);
    view.leastPixels = 0.5f * std::min(coarser, 2.0f);
    if (coarser > 1) view.flags |= kStretches;
}

EmitView parallelView(const glm::mat4& m, float pixelsPerMetre, float lodPixels) {
    EmitView view{};
    auto row = [&](int i) { return glm::vec4(m[0][i], m[1][i], m[2][i], m[3][i]); };
    const glm::vec4 planes[6] = {row(3) + row(0), row(3) - row(0), row(3) + row(1),
                                 row(3) - row(1), row(2),          row(3) - row(2)};
    for (int i = 0; i < 6; ++i) {
        // A plane without a normal (the far one, at infinity) lets everything through.
        float length = glm::length(glm::vec3(planes[i]));
        view.planes[i] = length > 1e-12f ? planes[i] / length : glm::vec4(0, 0, 0, 1);
    }
    view.pixelScale = pixelsPerMetre;
    view.lodPixels = std::max(lodPixels, 1e-3f);
    view.parallel = 1;
    view.leastPixels = 0.5f;
    view.tilePixels = kDepthTile;
    view.wholePixels = kWholePixels;
    view.leastShare = kLeastShare;
    return view;
}

}  // namespace espalier
