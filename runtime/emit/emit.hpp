#pragma once

// Emission: growth's records -> what is to be drawn from one point of view, or triangles on request.

#include <string_view>
#include <vector>

#include "runtime/emit/triangle_writer.hpp"

namespace espalier {

struct EmitStats {
    uint64_t drawnTriangles = 0;     // of the last cull whose results have come back
    uint64_t fullTriangles = 0;      // the same growth at full detail
    uint32_t spans = 0, leaves = 0;  // instances seen
    uint32_t overflow = 0;           // leaves left out for want of room
    uint32_t bound = 0;              // spans and leaves that the last binding looked at
    std::vector<uint32_t> buckets;   // instances of each
};

// Binds growth (BoundGrowth) when a view asks for it (CulledView), tells which parts of a kept picture edits have
// changed (TileWatch), and writes triangles (TriangleWriter).
class Emit {
  public:
    // `terminals` must outlive it.
    static Result<Emit> create(Device& device, const Terminals& terminals);

    // As CulledView::cull(), of growth that is bound first if it has changed. With `counted` the figures come back in
    // stats() once the work is done.
    Status cull(Commands& commands, const EmitInputs& inputs, const EmitView& view, std::string_view passName,
                bool counted);

    // When growth has changed, binds it; when it is known that some of it found no room, all of it anew.
    Status bind(Commands& commands, const EmitInputs& inputs);
    uint64_t wholeBindings() const { return bound_.wholeBindings(); }
    uint64_t carries() const { return bound_.carries(); }

    // As TileWatch::watch() and take(): takeChanges() is the view of what lies in changed tiles, once it is bound.
    Status watch(Commands& commands, const EmitView& view);
    EmitView takeChanges(Commands& commands, const EmitInputs& inputs, uint32_t mostTiles);

    // The last recording won't be submitted: nothing of it can be built on.
    void forget();
    // Drops what only the next growth or edit would use; where `growth`, which stands, needs far less than is held,
    // all, so that the next view binds it anew.
    void trim(const GrowthView& growth);

    // Of the last cull: see CulledView.
    const Buffer& state() const { return view_.state(); }
    bool culledNative() const { return view_.culledNative(); }
    const Buffer& drawn() const { return view_.drawn(); }
    const TexelView& drawnTexels() const { return view_.drawnTexels(); }
    // What state() holds, once native code has culled the last view; null: shaders do, so nobody knows yet.
    const EmitState* knownState() const {
        return culledNative() ? reinterpret_cast<const EmitState*>(state().address()) : nullptr;
    }
    // What is bound: see BoundGrowth.
    const Buffer& spanInstances() const { return bound_.spans(); }
    const Buffer& leafInstances() const { return bound_.leaves(); }
    const TexelView& spanTexels() const { return bound_.spanTexels(); }
    const TexelView& leafTexels() const { return bound_.leafTexels(); }

    // Of the last counted cull that has finished. Call after waiting for it, or read an older one.
    EmitStats stats() const;

    // Writes all bark and loose terminals at full detail as triangles. Submits and waits.
    Result<EmittedTriangles> materialise(const EmitInputs& inputs);

  private:
    bool mayBeNative(const EmitInputs& inputs) const;
    Result<EmitState> gather(const EmitInputs& inputs, double& milliseconds);

    Device* device_ = nullptr;
    BoundGrowth bound_;
    CulledView view_;
    TileWatch tiles_;
    TriangleWriter triangles_;
};

// The six planes of a view-projection matrix with reversed depth (near at 1, far at 0), and the rest of a view.
EmitView perspectiveView(const glm::mat4& viewProjection, glm::vec3 eye, float pixelScale, float lodPixels);
// Fewer and larger leaves, of at least `leafPixels` where there are leaves to leave out; beyond 8 fewer twigs, too, and
// spans that follow each other may be drawn as one.
void thinOut(EmitView& view, float leafPixels);
EmitView parallelView(const glm::mat4& viewProjection, float pixelsPerMetre, float lodPixels);

}  // namespace espalier
