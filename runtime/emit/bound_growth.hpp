#pragma once

// Bound growth: every span and leaf as an instance in the world, in a cell of space.

#include <array>
#include <vector>

#include "runtime/emit/emit_inputs.hpp"
#include "runtime/emit/terminals.hpp"
#include "runtime/emit/tile_watch.hpp"
#include "runtime/gpu/commands.hpp"

namespace espalier {

// When growth has changed, or surfaces have moved, binds it; after edits and moves only what they concerned. Its
// buffers grow as growth does. All that it is given are growths of one Growth, by whose numbers it knows what has
// changed.
class BoundGrowth {
  public:
    // `terminals` must outlive it.
    static Result<BoundGrowth> create(Device& device, const Terminals& terminals);

    // When growth or where it stands has changed, or `counted`, the figures of the last counted view, say that cells
    // had no room for some of it. What an edit changes is noted in the tiles of `watch`. Timed as "bind".
    Status bind(Commands& commands, const EmitInputs& inputs, const TileWatch& watch, EmitState& counted);

    // Another number when something else is bound, or nothing.
    uint64_t version() const { return version_; }
    // How often everything was bound, and how often what was bound was carried over to other buffers, since growth had
    // closed gaps or there was too little room.
    uint64_t wholeBindings() const { return wholeBindings_; }
    uint64_t carries() const { return carries_; }
    uint32_t overflow() const { return overflow_; }  // leaves left out for want of room

    // A recording looks at what is bound.
    void lookedAt(uint64_t recording) { usedBy_ = recording; }
    // Whether what is bound stands in memory, and not only once a recording is done.
    bool stands() const { return device_->finished(boundBy_); }

    // The last recording won't be submitted: what it has bound isn't.
    void forget();
    // Drops what only the next growth or edit would use; where `growth`, which stands, needs far less than is held,
    // all, and returns true.
    bool trim(const GrowthView& growth);

    const Buffer& spans() const { return held_.spans; }    // SpanInstance[node]
    const Buffer& leaves() const { return held_.leaves; }  // LeafInstance[leaf]
    // The same as texels of four words.
    const TexelView& spanTexels() const { return held_.spanTexels; }
    const TexelView& leafTexels() const { return held_.leafTexels; }
    uint64_t numbers() const { return held_.numbers(); }  // of items that there is room for

    // What is bound of a kernel's push data, and what kernels leave to each other while nothing is being bound.
    void tell(EmitPush& push) const;
    const TexelView& noteTexels() const { return noteTexels_; }  // of EmitPush::notes

  private:
    // What the instances were made from.
    struct Source {
        uint64_t nodes = 0, leaves = 0, revision = 0;
        uint32_t nodeCount = 0, leafCount = 0, number = 0;
        glm::vec3 low{0}, high{0};  // of the grid
        bool operator==(const Source&) const = default;
    };
    // What of it has a place for each node and leaf.
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
    struct HeldRoom {
        uint64_t spans = 0, leaves = 0;
    };
    HeldRoom roomFor(const GrowthView& growth, uint32_t leaves) const;
    Result<Held> makeHeld(const GrowthView& growth, uint32_t leaves);  // but for the order
    Status makeOrder(Buffer& order, const Held& held);
    void hold(Held held);
    Status reserve();
    bool crowded(const EmitState& counted) const;
    bool staysBound(const Source& wanted, const GrowthView& growth) const;
    // Surfaces that stand elsewhere than when something was bound on them.
    struct Moved {
        std::array<uint32_t, kMovedWords> bits{};
        uint32_t words = 0;  // as BindInputs::movedWords
        bool whole = false;  // binding all anew is what there is to do, or costs less
        bool any() const { return words > 0 || whole; }
    };
    Moved movedSince(const EmitInputs& inputs) const;
    BindInputs bindInputs(const EmitInputs& inputs, const Source& wanted) const;
    // bound_growth_kernels.cpp
    Status bindByKernels(Commands& commands, const TileWatch& watch, const BindInputs& given);
    void dispatchBinding(Pass& pass, const TileWatch& watch, const BindInputs& given, const Buffer& in);
    // bound_growth_carry.cpp
    bool nearlyCrowded(const EmitState& counted) const;
    Status makeCarrying(bool moved);
    Status carryByKernels(Commands& commands, const CarryPush& push, bool all);
    Status carry(Commands& commands, const EmitInputs& inputs, uint32_t leaves, Source& source);

    Device* device_ = nullptr;
    const Terminals* terminals_ = nullptr;
    Program bindTouch_, bindSpans_, bindLeaves_, bindStretches_, bindKeep_, bindCount_, bindCells_, bindOrder_,
        bindSort_;
    struct Carrying {
        Program spans, leaves, cells;
    };
    std::array<Carrying, 2> carrying_;  // [1] to other numbers; made when first asked for
    std::array<Buffer, 8> inputs_;      // that recordings in flight may still read
    Held held_;
    Buffer spareOrder_;  // that the last carrying left
    Buffer cells_, bins_;
    Buffer flags_, list_, notes_;
    TexelView noteTexels_;  // of these; after them
    EmitGrid grid_{};
    Source source_;
    std::vector<Version> placed_;        // [instance], likewise
    uint64_t boundBy_ = 0, usedBy_ = 0;  // the recordings that bound it and that looked at it last
    uint64_t version_ = 1, wholeBindings_ = 0, carries_ = 0;
    uint32_t overflow_ = 0, inputSlot_ = 0;
};

}  // namespace espalier
