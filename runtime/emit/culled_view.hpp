#pragma once

// What of bound growth a view sees.

#include <array>
#include <string_view>

#include "runtime/emit/bound_growth.hpp"
#include "runtime/run/emission.hpp"

namespace espalier {

// Culls and picks LODs in compute, by cells first, so that a view costs what is seen in it; no loop over instances runs
// on the CPU. Serves several views in one recording, one after another: cull, draw, cull, draw. What is drawn is in the
// same order in every run.
class CulledView {
  public:
    // `terminals` must outlive it.
    static Result<CulledView> create(Device& device, const Terminals& terminals);

    // Records the culling of what is bound for `view`; what an earlier cull left is lost. Timed as `passName`. With
    // `counted` the figures come back in counts() once the work is done. A view that is the last one's over the same
    // growth costs nothing. Native code culls at once, if `native` says so: once growth's binding is done, and what the
    // view's tiles say stands (kTilesStand), or it has none.
    Status cull(Commands& commands, const BoundGrowth& bound, const EmitView& view, std::string_view passName,
                bool counted, bool native);
    // Native code culls bound growth, which stands, into drawn(), and says what it found. For devices that share
    // memory.
    Result<EmitState> cullNow(const BoundGrowth& bound, const EmitView& view);

    // Of the last cull: where its draws lie; bucket b has the commands 2b and 2b + 1.
    const Buffer& state() const { return culledNative() ? natives_[native_].state : state_; }
    bool culledNative() const { return native_ < natives_.size(); }
    // What is drawn, as DrawnItem: bucket b's from EmitState::starts[b] on.
    const Buffer& drawn() const { return culledNative() ? natives_[native_].drawn : drawn_; }
    const TexelView& drawnTexels() const { return culledNative() ? natives_[native_].drawnTexels : drawnTexels_; }

    // Of the last counted cull that has finished. Binding reads there whether cells had room.
    const EmitState& counts() const { return *reinterpret_cast<const EmitState*>(readback_.mapped()); }
    EmitState& counts() { return *reinterpret_cast<EmitState*>(readback_.mapped()); }

    // What was culled is lost, and the room for it.
    void drop();

  private:
    // What native code has left for a recording to draw.
    struct Native {
        Buffer state, drawn;
        TexelView drawnTexels;  // of it; after it
        uint64_t serial = 0;    // of the last recording that draws it
    };
    EmitPush pushFor(const BoundGrowth& bound) const;
    Status reserve(const BoundGrowth& bound);
    Status record(Commands& commands, const BoundGrowth& bound, const EmitView& view, Pass& pass);
    // False: shaders have to.
    Result<bool> cullNative(const BoundGrowth& bound, const EmitView& view, uint64_t recording);
    uint32_t look(const BoundGrowth& bound, const EmitView& view);

    Device* device_ = nullptr;
    const Terminals* terminals_ = nullptr;
    Program cullCells_, listBlocks_, listItems_, classifySpans_, classifyLeaves_, scan_, writeDrawn_;
    std::array<Buffer, 8> views_;  // that recordings in flight may still read
    Buffer state_, seen_, rows_, drawn_, readback_;
    TexelView drawnTexels_;  // of these; after them
    NativeCull nativeCull_;
    std::array<Native, 6> natives_;
    size_t native_ = ~size_t(0);  // of these, the last view's; beyond: shaders have culled it
    EmitView view_{};
    uint64_t of_ = 0;  // BoundGrowth::version() of the last view; 0: none
    bool counted_ = false;
    uint32_t slot_ = 0;
};

}  // namespace espalier
