// Enters: bound growth culled at full detail. Leaves: all of it as triangles in memory. A thread a ring, a thread a
// strip of quads, a thread a leaf write whole runs; on software devices native code writes the bark.
#include "runtime/emit/triangle_writer.hpp"

#include <chrono>

namespace espalier {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// A buffer's memory where addresses are the process's own.
template <class T>
T* at(const Buffer& buffer) {
    return reinterpret_cast<T*>(buffer.address());
}

}  // namespace

Result<TriangleWriter> TriangleWriter::create(Device& device, const Terminals& terminals) {
    TriangleWriter out;
    out.device_ = &device;
    out.terminals_ = &terminals;
    Status programs = makeCompute(device, {{out.barkVertices_, "emit/bark_vertices.comp", exactly()},
                                           {out.barkIndices_, "emit/bark_indices.comp"},
                                           {out.looseTriangles_, "emit/loose_triangles.comp"}});
    if (!programs) return programs.failure();
    return out;
}

// Where each loose bucket's triangles go, behind the bark. Index blocks begin at even numbers.
std::vector<TriangleWriter::Block> TriangleWriter::layOut(const EmitState& state, uint64_t& vertices,
                                                          uint64_t& indices) const {
    const TerminalTable& table = terminals_->table();
    vertices = uint64_t(state.spanCount) * kBarkVertices;
    indices = uint64_t(state.spanCount) * kBarkIndices;
    std::vector<Block> blocks;
    for (uint32_t b = table.barkBuckets; b < table.buckets.size(); ++b) {
        if (state.counts[b] == 0) continue;
        blocks.push_back({b, state.counts[b], vertices, indices});
        vertices += uint64_t(state.counts[b]) * table.buckets[b].vertexCount;
        indices += uint64_t(state.counts[b]) * table.buckets[b].indexCount;
        if (indices % 2) indices += 3;  // an empty triangle, so that the next block may be written in pairs
    }
    return blocks;
}

Result<EmittedTriangles> TriangleWriter::write(const BoundGrowth& bound, const CulledView& view, const EmitState& state,
                                               bool native) {
    EmittedTriangles out;
    const std::vector<Block> blocks = layOut(state, out.vertexCount, out.indexCount);
    if (bound.overflow() > 0 || out.vertexCount > 0x7FFFFFFFu || out.indexCount > 0xFFFFFFFFu)
        return deviceFailure("growth", "it has too many triangles to be written at once");
    Result<Buffer> vertices = Buffer::create(*device_, "growth vertices", out.vertexCount * sizeof(TriangleVertex));
    if (!vertices) return vertices.failure();
    Result<Buffer> indices = Buffer::create(*device_, "growth indices", out.indexCount * sizeof(uint32_t));
    if (!indices) return indices.failure();
    out.vertices = std::move(*vertices);
    out.indices = std::move(*indices);

    const Clock::time_point start = Clock::now();
    if (native)
        writeBarkNative(at<SpanInstance>(bound.spans()), at<DrawnItem>(view.drawn()), state.spanCount,
                        at<TriangleVertex>(out.vertices), at<uint32_t>(out.indices));
    out.milliseconds = millisecondsSince(start);
    out.native = native && state.spanCount > 0;
    if (native && blocks.empty()) return out;
    Result<Commands> commands = Commands::begin(*device_, "materialise");
    if (!commands) return commands.failure();
    record(*commands, bound, view, state, blocks, native ? 0 : state.spanCount, out);
    if (Status s = commands->finish(); !s) return s.failure();
    device_->collect();
    out.milliseconds = device_->milliseconds("materialise") + (native ? out.milliseconds : 0);
    return out;
}

// spans: of bark that kernels write.
void TriangleWriter::record(Commands& commands, const BoundGrowth& bound, const CulledView& view,
                            const EmitState& state, std::span<const Block> blocks, uint32_t spans,
                            const EmittedTriangles& out) {
    Pass pass(commands, "materialise");
    TrianglesPush push{};
    push.drawn = addressOf<DrawnBuf>(view.drawn());
    push.leaves = addressOf<LeafInstanceBuf>(bound.leaves());
    push.meshVertices = addressOf<TerminalVertexBuf>(terminals_->vertices());
    push.meshIndices = addressOf<UintBuf>(terminals_->indices());
    push.vertices.v = reinterpret_cast<uint64_t*>(out.vertices.address());
    push.indices.v = reinterpret_cast<uint64_t*>(out.indices.address());
    push.count = spans;
    pass.dispatchItems(barkVertices_, push.count * kBarkRings, push, {bound.spanTexels(), view.drawnTexels()});
    pass.dispatchItems(barkIndices_, push.count * (kBarkRings - 1), push);
    for (const Block& block : blocks) {
        const BucketRecord& bucket = terminals_->table().buckets[block.bucket];
        push.count = block.instances;
        push.firstInstance = state.starts[block.bucket];
        push.firstVertex = uint32_t(block.firstVertex);
        push.firstIndexPair = uint32_t(block.firstIndex / 2);
        push.meshFirstVertex = bucket.firstVertex;
        push.meshVertexCount = bucket.vertexCount;
        push.meshFirstIndex = terminals_->lodOfBucket(block.bucket).firstIndex;
        push.meshIndexCount = bucket.indexCount;
        const uint64_t end = block.firstIndex + uint64_t(block.instances) * bucket.indexCount;
        if (end % 2) commands.fill(out.indices, 0, end * 4, 12);
        pass.dispatchItems(looseTriangles_, block.instances, push);
    }
    pass.barrier(Use::compute | Use::transfer, Use::all);
}

}  // namespace espalier
