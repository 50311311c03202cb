// Enters: growth's records. Leaves: all of it as triangles in memory. The instances are gathered by the culling
// kernels at full detail; then a thread a ring, a thread a strip of quads, a thread a leaf write whole runs. On
// software devices native code gathers them and writes the bark.
#include <algorithm>
#include <chrono>

#include "runtime/emit/emit.hpp"
#include "runtime/emit/native_triangles.hpp"

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

struct Block {
    uint32_t bucket = 0, instances = 0;
    uint64_t firstVertex = 0, firstIndex = 0;
};

// Where each loose bucket's triangles go, behind the bark. Index blocks begin at even numbers.
std::vector<Block> layOut(const EmitState& state, const TerminalTable& table, uint64_t& vertices, uint64_t& indices) {
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

}  // namespace

// What full detail draws, in `drawn_`. milliseconds: what it took once all was bound.
Result<EmitState> Emit::gather(const EmitInputs& inputs, bool native, double& milliseconds) {
    Result<Commands> commands = Commands::begin(*device_, "materialise gather");
    if (!commands) return commands.failure();
    EmitView view{};
    view.flags = kFullDetail;
    view.lodPixels = 1;
    Status recorded = native ? bind(*commands, inputs) : cull(*commands, inputs, view, "materialise gather", true);
    if (recorded) recorded = commands->finish();
    if (!recorded) {
        forget();
        return recorded.failure();
    }
    EmitState& counted = *reinterpret_cast<EmitState*>(readback_.mapped());
    EmitState state = counted;
    if (native) {
        const Clock::time_point start = Clock::now();
        const EmitPush push = cullPush();
        nativeCull_.look(push, view, terminals_->kernelTable(), at<SpanInstance>(held_.spans),
                         at<LeafInstance>(held_.leaves));
        nativeCull_.write(push, terminals_->kernelTable(), at<DrawnItem>(drawn_), state);
        counted.crowded = state.crowded;
        culled_ = {};
        milliseconds = millisecondsSince(start);
    } else {
        device_->collect();
        milliseconds = device_->milliseconds("materialise gather");
    }
    return state;
}

Result<EmittedTriangles> Emit::materialise(const EmitInputs& inputs) {
    const bool native = inputs.native && sharesMemory();
    EmittedTriangles out;
    Result<EmitState> gathered = gather(inputs, native, out.gatherMilliseconds);
    if (!gathered) return gathered.failure();
    const EmitState& state = *gathered;
    const TerminalTable& table = terminals_->table();
    const std::vector<Block> blocks = layOut(state, table, out.vertexCount, out.indexCount);
    if (overflow_ > 0 || out.vertexCount > 0x7FFFFFFFu || out.indexCount > 0xFFFFFFFFu)
        return deviceFailure("growth", "it has too many triangles to be written at once");
    Result<Buffer> vertices = Buffer::create(*device_, "growth vertices", out.vertexCount * sizeof(TriangleVertex));
    if (!vertices) return vertices.failure();
    Result<Buffer> indices = Buffer::create(*device_, "growth indices", out.indexCount * sizeof(uint32_t));
    if (!indices) return indices.failure();
    out.vertices = std::move(*vertices);
    out.indices = std::move(*indices);

    const Clock::time_point start = Clock::now();
    if (native)
        writeBarkNative(at<SpanInstance>(held_.spans), at<DrawnItem>(drawn_), state.spanCount,
                        at<TriangleVertex>(out.vertices), at<uint32_t>(out.indices));
    const double nativeMs = millisecondsSince(start);
    out.native = native && state.spanCount > 0;
    out.milliseconds = nativeMs;
    if (native && blocks.empty()) return out;
    Result<Commands> commands = Commands::begin(*device_, "materialise");
    if (!commands) return commands.failure();
    {
        Pass pass(*commands, "materialise");
        TrianglesPush push{};
        push.drawn = addressOf<DrawnBuf>(drawn_);
        push.leaves = addressOf<LeafInstanceBuf>(held_.leaves);
        push.meshVertices = addressOf<TerminalVertexBuf>(terminals_->vertices());
        push.meshIndices = addressOf<UintBuf>(terminals_->indices());
        push.vertices.v = reinterpret_cast<uint64_t*>(out.vertices.address());
        push.indices.v = reinterpret_cast<uint64_t*>(out.indices.address());
        push.count = native ? 0 : state.spanCount;
        pass.dispatchItems(barkVertices_, push.count * kBarkRings, push, {held_.spanTexels, drawnTexels_});
        pass.dispatchItems(barkIndices_, push.count * (kBarkRings - 1), push);
        for (const Block& block : blocks) {
            const BucketRecord& bucket = table.buckets[block.bucket];
            const TerminalLod& lod = terminals_->lodOfBucket(block.bucket);
            push.count = block.instances;
            push.firstInstance = state.starts[block.bucket];
            push.firstVertex = uint32_t(block.firstVertex);
            push.firstIndexPair = uint32_t(block.firstIndex / 2);
            push.meshFirstVertex = bucket.firstVertex;
            push.meshVertexCount = bucket.vertexCount;
            push.meshFirstIndex = lod.firstIndex;
            push.meshIndexCount = bucket.indexCount;
            const uint64_t end = block.firstIndex + uint64_t(block.instances) * bucket.indexCount;
            if (end % 2) commands->fill(out.indices, 0, end * 4, 12);
            pass.dispatchItems(looseTriangles_, block.instances, push);
        }
        pass.barrier(Use::compute | Use::transfer, Use::all);
    }
    if (Status s = commands->finish(); !s) return s.failure();
    device_->collect();
    out.milliseconds = device_->milliseconds("materialise") + (native ? nativeMs : 0);
    return out;
}

}  // namespace espalier
