// Enters: growth's records and a view. Leaves: instances sorted by bucket with their indirect draws (two kernels
// give each item its bucket and place, one scans, two write).
#include "runtime/emit/emit.hpp"

#include <algorithm>

namespace espalier {
namespace {

// At most so many visible instances; beyond, they are counted as overflow and left out.
constexpr uint64_t kMaxSpanInstances = 4'000'000, kMaxLeafInstances = 6'000'000;
static_assert(kMaxSpanInstances <= kLastPlace && kMaxLeafInstances <= kLastPlace);

// A buffer of at least `bytes`, with room for growth to come when it has to be made anew.
Status atLeast(Device& device, Buffer& buffer, std::string_view name, uint64_t bytes, uint64_t most) {
    if (buffer && buffer.size() >= bytes) return Done{};
    Result<Buffer> made = Buffer::create(device, name, std::min(std::max<uint64_t>(bytes + bytes / 2, 65536), most));
    if (!made) return made.failure();
    buffer = std::move(*made);
    return Done{};
}

}  // namespace

Result<Emit> Emit::create(Device& device, const Terminals& terminals) {
    Emit emit;
    emit.device_ = &device;
    emit.terminals_ = &terminals;
    const struct {
        Program& program;
        const char* shader;
    } programs[] = {{emit.classifySpans_, "emit/classify_spans.comp"},
                    {emit.classifyLeaves_, "emit/classify_leaves.comp"},
                    {emit.scan_, "emit/scan.comp"},
                    {emit.writeSpans_, "emit/write_spans.comp"},
                    {emit.writeLeaves_, "emit/write_leaves.comp"},
                    {emit.barkVertices_, "emit/bark_vertices.comp"},
                    {emit.barkIndices_, "emit/bark_indices.comp"},
                    {emit.looseTriangles_, "emit/loose_triangles.comp"}};
    for (const auto& p : programs) {
        Result<Program> made = Program::compute(device, p.shader);
        if (!made) return made.failure();
        p.program = std::move(*made);
    }
    const struct {
        Buffer& buffer;
        const char* name;
        uint64_t bytes;
        BufferUse use;
    } buffers[] = {{emit.state_, "emit state", sizeof(EmitState), BufferUse::device},
                   {emit.readback_, "emit counts", sizeof(EmitState), BufferUse::readback}};
    for (const auto& b : buffers) {
        Result<Buffer> made = Buffer::create(device, b.name, b.bytes, b.use);
        if (!made) return made.failure();
        b.buffer = std::move(*made);
    }
    for (Buffer& view : emit.views_) {
        Result<Buffer> made = Buffer::create(device, "emit view", sizeof(EmitView));
        if (!made) return made.failure();
        view = std::move(*made);
    }
    std::fill(emit.readback_.mappedAs<uint32_t>().begin(), emit.readback_.mappedAs<uint32_t>().end(), 0u);
    return emit;
}

Status Emit::reserve(Device& device, const GrowthView& growth) {
    const uint64_t nodes = std::min<uint64_t>(growth.nodeCount, kMaxSpanInstances);
    const uint64_t leaves = std::min<uint64_t>(growth.leafCount, kMaxLeafInstances);
    if (Status s = atLeast(device, kept_, "emit notes",
                           sizeof(KeptItem) * (uint64_t(growth.nodeCount) + growth.leafCount), ~0ull);
        !s)
        return s;
    const struct {
        Buffer& buffer;
        TexelView& texels;
        const char* name;
        uint64_t bytes, most;
    } rows[] = {
        {spans_, spanTexels_, "span instances", nodes * sizeof(SpanInstance), kMaxSpanInstances * sizeof(SpanInstance)},
        {leaves_, leafTexels_, "leaf instances", leaves * sizeof(LeafInstance),
         kMaxLeafInstances * sizeof(LeafInstance)}};
    for (const auto& row : rows) {
        if (row.buffer && row.buffer.size() >= row.bytes) continue;
        row.texels = {};
        if (Status s = atLeast(device, row.buffer, row.name, row.bytes, row.most); !s) return s;
        Result<TexelView> made = TexelView::create(device, row.buffer, VK_FORMAT_R32G32B32A32_UINT);
        if (!made) return made.failure();
        row.texels = std::move(*made);
    }
    return Done{};
}

Status Emit::record(Commands& commands, const EmitInputs& inputs, const EmitView& view, Pass& pass) {
    const GrowthView& growth = inputs.growth;
    if (Status s = reserve(*device_, growth); !s) return s;
    const Buffer& shown = views_[viewSlot_++ % views_.size()];
    const Buffer& table = terminals_->tableBuffer();
    commands.barrier(Use::compute | Use::vertex | Use::indirect | Use::transfer, Use::transfer | Use::compute);
    if (Status s = commands.upload(shown, std::as_bytes(std::span(&view, 1))); !s) return s;
    commands.fill(state_, 0);
    commands.barrier(Use::transfer, Use::compute);

    EmitPush push{};
    push.state.v = reinterpret_cast<EmitState*>(state_.address());
    push.kept.v = reinterpret_cast<KeptItem*>(kept_.address());
    push.nodes = growth.nodes;
    push.chunks = growth.chunks;
    push.leaves = growth.leaves;
    push.surfaces = inputs.surfaces;
    push.spanInstances.v = reinterpret_cast<SpanInstance*>(spans_.address());
    push.leafInstances.v = reinterpret_cast<LeafInstance*>(leaves_.address());
    push.nodeCount = growth.nodeCount;
    push.leafCount = growth.leafCount;
    push.spanCapacity = uint32_t(spans_.size() / sizeof(SpanInstance));
    push.leafCapacity = uint32_t(leaves_.size() / sizeof(LeafInstance));

    pass.dispatchItems(classifySpans_, growth.nodeCount, push, {table, shown});
    pass.dispatchItems(classifyLeaves_, growth.leafCount, push, {table, shown});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(scan_, {1, 1, 1}, push, {table});
    pass.barrier(Use::compute, Use::compute | Use::indirect);
    const uint64_t groups = offsetof(EmitState, writeGroups);
    pass.dispatchIndirect(writeSpans_, state_, groups, push, {table, shown});
    pass.dispatchIndirect(writeLeaves_, state_, groups + 12, push, {table, shown});
    return Done{};
}

Status Emit::cull(Commands& commands, const EmitInputs& inputs, const EmitView& view, std::string_view passName,
                  bool counted) {
    Pass pass(commands, passName);
    if (Status s = record(commands, inputs, view, pass); !s) return s;
    pass.barrier(Use::compute, Use::indirect | Use::vertex | Use::transfer);
    if (counted) {
        commands.copy(state_, readback_, sizeof(EmitState));
        commands.barrier(Use::transfer, Use::host);
    }
    return Done{};
}

EmitStats Emit::stats() const {
    const EmitState& state = *reinterpret_cast<const EmitState*>(readback_.mapped());
    EmitStats stats;
    stats.drawnTriangles = state.drawnTriangles;
    stats.fullTriangles = state.fullTriangles;
    stats.spans = state.spanCount;
    stats.leaves = state.leafCount;
    stats.overflow = state.overflow;
    stats.buckets.assign(state.counts, state.counts + kMaxBuckets);
    return stats;
}

EmitView perspectiveView(const glm::mat4& viewProjection, glm::vec3 eye, float pixelScale, float lodPixels) {
    EmitView view = parallelView(viewProjection, pixelScale, lodPixels);
    view.eye = eye;
    view.parallel = 0;
    return view;
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
    return view;
}

}  // namespace espalier
