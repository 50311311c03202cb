#pragma once

#include <span>
#include <vector>

#include "runtime/emit/culled_view.hpp"

namespace espalier {

// Triangles in GPU memory: TriangleVertex and 32-bit indices, in the world.
struct EmittedTriangles {
    Buffer vertices, indices;
    uint64_t vertexCount = 0, indexCount = 0;
    double milliseconds = 0;        // of writing them: GPU time; of native code, wall time
    double gatherMilliseconds = 0;  // of finding what there is, before, when all was bound
    bool native = false;            // native code wrote the bark
};

// Writes what a full detailed view has drawn as triangles.
class TriangleWriter {
  public:
    // `terminals` must outlive it.
    static Result<TriangleWriter> create(Device& device, const Terminals& terminals);

    // state: of the view, which has been culled at full detail. Submits and waits. native: native code writes bark, on
    // devices that share memory.
    Result<EmittedTriangles> write(const BoundGrowth& bound, const CulledView& view, const EmitState& state,
                                   bool native);

  private:
    // A loose bucket's.
    struct Block {
        uint32_t bucket = 0, instances = 0;
        uint64_t firstVertex = 0, firstIndex = 0;
    };
    std::vector<Block> layOut(const EmitState& state, uint64_t& vertices, uint64_t& indices) const;
    void record(Commands& commands, const BoundGrowth& bound, const CulledView& view, const EmitState& state,
                std::span<const Block> blocks, uint32_t spans, const EmittedTriangles& out);

    Device* device_ = nullptr;
    const Terminals* terminals_ = nullptr;
    Program barkVertices_, barkIndices_, looseTriangles_;
};

}  // namespace espalier
