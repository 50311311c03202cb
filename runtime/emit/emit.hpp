#pragma once

// Emission: growth's records -> what is to be drawn from one point of view, or triangles on request.

#include <array>

#include "runtime/emit/terminals.hpp"
#include "runtime/expand/growth.hpp"
#include "runtime/gpu/commands.hpp"

namespace espalier {

struct EmitInputs {
    GrowthView growth;
    SurfaceBuf surfaces;  // indexed by surface instance
};

// Triangles in GPU memory: TriangleVertex and 32-bit indices, in the world.
struct EmittedTriangles {
    Buffer vertices, indices;
    uint64_t vertexCount = 0, indexCount = 0;
    double milliseconds = 0;  // GPU time of writing them
};

struct EmitStats {
    uint64_t drawnTriangles = 0;     // of the last cull whose results have come back
    uint64_t fullTriangles = 0;      // the same growth at full detail
    uint32_t spans = 0, leaves = 0;  // instances seen
    uint32_t overflow = 0;           // instances left out for want of room
    std::vector<uint32_t> buckets;   // instances of each
};

// Culls and picks LODs in compute; no loop over instances runs on the CPU. One Emit serves several views in one
// recording, one after another: cull, draw, cull, draw. Its buffers grow as growth does.
class Emit {
  public:
    // `terminals` must outlive it.
    static Result<Emit> create(Device& device, const Terminals& terminals);

    // Records the culling of `inputs` for `view`; what an earlier cull left is lost. Timed as `passName`.
    // With `counted` the figures come back in stats() once the work is done.
    Status cull(Commands& commands, const EmitInputs& inputs, const EmitView& view, std::string_view passName,
                bool counted);

    // Where the draws of the last cull lie; bucket b has the commands 2b and 2b + 1.
    const Buffer& state() const { return state_; }
    const Buffer& spanInstances() const { return spans_; }
    const Buffer& leafInstances() const { return leaves_; }
    // The same as texels of four words, for vertex shaders.
    const TexelView& spanTexels() const { return spanTexels_; }
    const TexelView& leafTexels() const { return leafTexels_; }

    // Of the last counted cull that has finished. Call after waiting for it, or read an older one.
    EmitStats stats() const;

    // Writes all bark and loose terminals at full detail as triangles. Submits and waits.
    Result<EmittedTriangles> materialise(const EmitInputs& inputs);

  private:
    Status reserve(Device& device, const GrowthView& growth);
    Status record(Commands& commands, const EmitInputs& inputs, const EmitView& view, Pass& pass);

    Device* device_ = nullptr;
    const Terminals* terminals_ = nullptr;
    Program classifySpans_, classifyLeaves_, scan_, writeSpans_, writeLeaves_;
    Program barkVertices_, barkIndices_, looseTriangles_;
    std::array<Buffer, 8> views_;  // that recordings in flight may still read
    Buffer state_, kept_, spans_, leaves_, readback_;
    TexelView spanTexels_, leafTexels_;  // of these; after them
    uint32_t viewSlot_ = 0;
};

// The six planes of a view-projection matrix with reversed depth (near at 1, far at 0), and the rest of a view.
EmitView perspectiveView(const glm::mat4& viewProjection, glm::vec3 eye, float pixelScale, float lodPixels);
EmitView parallelView(const glm::mat4& viewProjection, float pixelsPerMetre, float lodPixels);

}  // namespace espalier
