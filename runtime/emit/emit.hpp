#pragma once

// Emission: growth's records -> what is to be drawn from one point of view, or triangles on request.

#include <array>

#include "runtime/emit/native_cull.hpp"
#include "runtime/emit/terminals.hpp"
#include "runtime/expand/growth.hpp"
#include "runtime/gpu/commands.hpp"

namespace espalier {

struct EmitInputs {
    GrowthView growth;
    SurfaceBuf surfaces{};          // indexed by surface instance
    uint64_t surfacesRevision = 0;  // another one when a surface stands elsewhere
    // Where things grow, more or less: space is divided there. What lies elsewhere costs more, no more than that.
    glm::vec3 low{-4}, high{4};
    // True: on a software device whose addresses are the process's own, native code binds growth if no recording that
    // looks at what was bound is in flight (native_bind.hpp), culls what stands already when a view is recorded
    // (native_cull.hpp), gathers what is to be written as triangles, and writes bark's (native_triangles.hpp). False:
    // shaders do there too.
    bool native = true;
};

// Triangles in GPU memory: TriangleVertex and 32-bit indices, in the world.
struct EmittedTriangles {
    Buffer vertices, indices;
    uint64_t vertexCount = 0, indexCount = 0;
    double milliseconds = 0;        // of writing them: GPU time; of native code, wall time
    double gatherMilliseconds = 0;  // of finding what there is, before, when all was bound
    bool native = false;            // native code wrote the bark
};

struct EmitStats {
    uint64_t drawnTriangles = 0;     // of the last cull whose results have come back
    uint64_t fullTriangles = 0;      // the same growth at full detail
    uint32_t spans = 0, leaves = 0;  // instances seen
    uint32_t overflow = 0;           // leaves left out for want of room
    uint32_t bound = 0;              // spans and leaves that the last binding looked at
    std::vector<uint32_t> buckets;   // instances of each
};

// When growth has changed, binds it: every span and leaf becomes an instance in the world, in a cell of space; after
// edits only those that they concerned. Culls and picks LODs in compute, by cells first, so that a view costs what is
// seen in it; no loop over instances runs on the CPU. One Emit serves several views in one recording, one after
// another: cull, draw, cull, draw. What is drawn is in the same order in every run. Its buffers grow as growth does.
// All that it is given are growths of one Growth, by whose numbers it knows what has changed.
class Emit {
  public:
    // `terminals` must outlive it.
    static Result<Emit> create(Device& device, const Terminals& terminals);

    // Records the culling of `inputs` for `view`; what an earlier cull left is lost. Timed as `passName`, binding as
    // "bind". With `counted` the figures come back in stats() once the work is done. A view that is the last one's over
    // the same growth costs nothing. Native code culls at once, if EmitInputs says so: once growth's binding is done,
    // and what the view's tiles say stands (kTilesStand), or it has none.
    Status cull(Commands& commands, const EmitInputs& inputs, const EmitView& view, std::string_view passName,
                bool counted);

    // When growth has changed, binds it; when it is known that some of it found no room, all of it anew. cull() does
    // so too.
    Status bind(Commands& commands, const EmitInputs& inputs);
    // How often everything was bound, and how often what was bound was carried over to other buffers, since growth had
    // closed gaps or there was too little room.
    uint64_t wholeBindings() const { return wholeBindings_; }
    uint64_t carries() const { return carries_; }

    // Recorded once all of `view`, a parallel one, was drawn: from now on the tiles of its picture are noted where
    // edits change it. takeChanges() is the view of what lies in these, once it is bound: in at most so many, the
    // others come next time. They count as drawn. Native code takes them at once, as it culls; the recording may look
    // at the view's tiles.
    Status watch(Commands& commands, const EmitView& view);
    EmitView takeChanges(Commands& commands, const EmitInputs& inputs, uint32_t mostTiles);

    // The last recording won't be submitted: nothing of it can be built on.
    void forget() {
        bound_ = {};
        watched_ = {};
    }

    // Drops what only the next growth or edit would use; where `growth`, which stands, needs far less than is held,
    // all, so that the next view binds it anew.
    void trim(const GrowthView& growth);

    // Where the draws of the last cull lie; bucket b has the commands 2b and 2b + 1.
    const Buffer& state() const { return culledNative() ? natives_[native_].state : state_; }
    bool culledNative() const { return native_ < natives_.size(); }
    // What it holds, once native code has culled the last view; null: shaders do, so nobody knows yet.
    const EmitState* knownState() const {
        return culledNative() ? reinterpret_cast<const EmitState*>(state().address()) : nullptr;
    }
    // Which instances are drawn, as DrawnItem: bucket b's from EmitState::starts[b] on.
    const Buffer& drawn() const { return culledNative() ? natives_[native_].drawn : drawn_; }
    const Buffer& spanInstances() const { return held_.spans; }   // [node]
    const Buffer& leafInstances() const { return held_.leaves; }  // [leaf]
    // The same as texels of four words, for vertex shaders.
    const TexelView& drawnTexels() const { return culledNative() ? natives_[native_].drawnTexels : drawnTexels_; }
    const TexelView& spanTexels() const { return held_.spanTexels; }
    const TexelView& leafTexels() const { return held_.leafTexels; }

    // Of the last counted cull that has finished. Call after waiting for it, or read an older one.
    EmitStats stats() const;

    // Writes all bark and loose terminals at full detail as triangles. Submits and waits.
    Result<EmittedTriangles> materialise(const EmitInputs& inputs);

  private:
    // What the instances were made from.
    struct Bound {
        uint64_t nodes = 0, leaves = 0, surfaces = 0, surfacesRevision = 0, revision = 0;
        uint32_t nodeCount = 0, leafCount = 0, number = 0;
        glm::vec3 low{0}, high{0};
        bool operator==(const Bound&) const = default;
    };

    // Bound growth: what of it has a place for each node and leaf.
    struct Held {
        Buffer spans, leaves, keys, order, leafHeads, leafNext;
        TexelView spanTexels, leafTexels;  // of these; after them
        uint32_t leafBase = 0;             // number of the first leaf among items

        uint64_t numbers() const { return leafBase + leaves.size() / sizeof(LeafInstance); }
        bool fits(uint32_t nodeCount, uint32_t leafCount) const {
            return spans && spans.size() / sizeof(SpanInstance) >= nodeCount &&
                   leaves.size() / sizeof(LeafInstance) >= leafCount;
        }
    };

    // emit_bind.cpp
    struct HeldRoom {
        uint64_t spans = 0, leaves = 0;
    };
    HeldRoom roomFor(const GrowthView& growth, uint32_t leaves) const;
    Result<Held> makeHeld(const GrowthView& growth, uint32_t leaves);  // but for the order
    Status makeOrder(Buffer& order, const Held& held);
    void hold(Held held);
    Status reserve();
    Status makeRoom(Buffer& buffer, const char* name, uint64_t bytes, TexelView* texels);
    Status viewRecords(const GrowthView& growth, uint32_t nodesBefore);
    bool crowded() const;
    bool staysBound(const Bound& wanted, const GrowthView& growth) const;
    Status bindByKernels(Commands& commands, const GrowthView& growth, const BindInputs& given);
    // emit_carry.cpp
    bool nearlyCrowded() const;
    Status makeCarrying(bool moved);
    Status carryByKernels(Commands& commands, const CarryPush& push, bool all);
    Status carry(Commands& commands, const EmitInputs& inputs, uint32_t leaves, Bound& bound);

    // What native code has left for a recording to draw.
    struct Native {
        Buffer state, drawn;
        TexelView drawnTexels;  // of it; after it
        uint64_t serial = 0;    // of the last recording that draws it
    };

    Status record(Commands& commands, const EmitView& view, Pass& pass);
    EmitPush cullPush() const;
    bool sharesMemory() const;
    // False: shaders have to.
    Result<bool> cullNative(const EmitInputs& inputs, const EmitView& view, uint64_t recording);
    Result<EmitState> gather(const EmitInputs& inputs, bool native, double& milliseconds);  // materialise.cpp

    Device* device_ = nullptr;
    const Terminals* terminals_ = nullptr;
    std::array<Program, 2> bindTouch_, bindSpans_, bindLeaves_;  // [1] fetches records as texels
    Program bindStretches_, bindKeep_, bindCount_, bindCells_, bindOrder_, bindSort_;
    struct Carrying {
        Program spans, leaves, cells;
    };
    std::array<Carrying, 2> carrying_;  // [1] to other numbers; made when first asked for
    Program cullCells_, listBlocks_, listItems_, classifySpans_, classifyLeaves_, scan_, writeDrawn_;
    Program barkVertices_, barkIndices_, looseTriangles_;
    std::array<Buffer, 8> views_, binds_;  // that recordings in flight may still read
    Held held_;
    Buffer spareOrder_;    // that the last carrying left
    Buffer cells_, bins_;  // bound growth, too
    Buffer flags_, list_;
    Buffer state_, seen_, rows_, notes_, drawn_, readback_;  // of a view
    TexelView noteTexels_, drawnTexels_;                     // of these; after them
    Buffer noTexels_;
    TexelView nodeRecords_, chunkRecords_, leafRecords_, touchedRecords_;
    EmitGrid grid_{};
    Bound bound_, culled_;               // and what the last view was of
    uint64_t boundBy_ = 0, usedBy_ = 0;  // the recordings that bound it and that looked at it last
    NativeCull nativeCull_;
    std::array<Native, 6> natives_;
    size_t native_ = ~size_t(0);  // of these, the last view's; beyond: shaders have culled it
    EmitView view_{};
    Program takeTiles_;
    Buffer watch_, watchTiles_, takenTiles_;
    EmitView watched_{};    // and its tiles; width 0: none
    uint64_t tilesBy_ = 0;  // the recording that looked at them last
    uint64_t wholeBindings_ = 0, carries_ = 0, timesTaken_ = 0;
    bool counted_ = false;
    bool fetches_ = false, fetchesTouched_ = false;
    uint32_t overflow_ = 0;
    uint32_t viewSlot_ = 0, bindSlot_ = 0;
};

// The six planes of a view-projection matrix with reversed depth (near at 1, far at 0), and the rest of a view.
EmitView perspectiveView(const glm::mat4& viewProjection, glm::vec3 eye, float pixelScale, float lodPixels);
// Fewer and larger leaves, of at least `leafPixels` where there are leaves to leave out; beyond 8 fewer twigs, too, and
// spans that follow each other may be drawn as one.
void thinOut(EmitView& view, float leafPixels);
EmitView parallelView(const glm::mat4& viewProjection, float pixelsPerMetre, float lodPixels);
// How many tiles of tilePixels the picture has.
uint32_t tilesOf(const EmitView& view);

}  // namespace espalier
