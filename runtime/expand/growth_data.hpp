#pragma once

// What growth takes and gives: seeds × rule maps × layers become chunks, nodes and leaves.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "runtime/core/growth_watch.hpp"
#include "runtime/core/result.hpp"
#include "runtime/expand/changes.hpp"
#include "runtime/expand/frozen.hpp"
#include "runtime/gpu/buffer.hpp"
#include "shaders/shared/growth_records.h"
#include "shaders/shared/rule_map.h"

namespace espalier {

enum class WalkMode : uint32_t { intrinsic = 0, paper = 1 };
enum class TangentMode : uint32_t { stem = 0, paper = 1 };

struct GrowthLimits {
    WalkMode walk = WalkMode::intrinsic;
    TangentMode tangents = TangentMode::stem;
    // Growth that would exceed this is cut at whole waves, and of the last one by a share that the keys draw: the
    // same plants in every run. It is counted in GrowthStats::overflow and ::stopped. Chunks are limited to half of
    // it (and 4,096).
    uint32_t maxNodes = 4'000'000;
    uint32_t maxDepth = 4096;       // chunks one after another along one path, 1 to 65,534
    uint32_t maxLeaves = 1u << 30;  // with those of frozen plants, at most 2^31; growth that would have more fails
    float leafDensityCap = 0;       // leaves per m² and seed, 0: none
};

// Everything that growth depends on. Addresses are device addresses (for growOnCpu: pointers) and stay valid during
// grow(). Charts are numbers that the surface has, else the seed is lost (and counted as a dead end).
struct GrowthInputs {
    SurfaceBuf surfaces{};  // indexed by surface instance
    uint32_t surfaceCount = 0;
    // True: on a software device whose addresses are the process's own, growth runs as native code on its cores
    // (runtime/host), with the same result. False: as shaders there too.
    bool native = true;
    LayerBuf layers{};  // surfaceCount * kMaxLayers
    std::span<const RuleMapRef> grammars;
    // One a grammar, metres, or empty: shapes of this width grow on the coarsest level whose texels are no wider.
    // 0: on the finest.
    std::span<const float> widths;
    // The same: how far its stems stay away from stems of such grammars and from frozen ones. 0: they don't. Where any
    // does, each edit grows all anew.
    std::span<const float> avoid;
    std::span<const Seed> seeds;
    // Keys of branches (their first chunk's) that are cut away with all that would follow from them; ascending, none
    // twice. One that no branch has does nothing.
    std::span<const uint64_t> pruned;
    // Plants that stand as they are; BranchRecord::seed counts them after the seeds. One that last time's growth grew
    // stays in its place; it counts against maxNodes, but not against the density cap.
    std::span<const FrozenPlant> frozen;
    GrowthLimits limits;
    // What is different from the inputs of the last grow() that succeeded. Null: everything.
    const GrowthChanges* changes = nullptr;
    // Null: nobody waits. It outlives grow().
    GrowthWatch* watch = nullptr;
};

// Where a growth that only closed gaps moved what there was.
struct GrowthMove {
    // [as it was numbered]: its number now, kNoIndex: it is no more. Null: there was no such move.
    const Buffer *nodes = nullptr, *leaves = nullptr;
    uint32_t nodesBefore = 0, leavesBefore = 0;  // with the gaps
    uint32_t nodesAfter = 0, leavesAfter = 0;
};

// What the later stages read. Buffers belong to Growth and change only in grow() and trim(). Counts include the gaps
// that edits left: nodes without bark and with a radius below 0, chunks without marks, branches and leaves of kNoIndex.
struct GrowthView {
    NodeBuf nodes{};
    ChunkBuf chunks{};
    BranchBuf branches{};
    LeafBuf leaves{};
    uint32_t nodeCount = 0, chunkCount = 0, branchCount = 0, leafCount = 0;
    // The whole buffers that these lie in, from their beginnings on. Null: nobody knows how large they are.
    const Buffer *nodeBuffer = nullptr, *chunkBuffer = nullptr, *leafBuffer = nullptr;
    uint64_t revision = 0;  // grows with every grow() that changed anything
    // Growths have numbers. Those after `renewed` only added nodes and leaves at the end, and wrote the nodes (and took
    // away, or added, their leaves) whose touched[node] is their number, or a later one; `renewed` wrote all, but if it
    // only moved what there was, `moved` says where to. touched null: all growths did.
    const Buffer* touched = nullptr;
    uint32_t number = 0, renewed = 0;
    GrowthMove moved;
};

struct GrowthStats {
    uint32_t seeds = 0, chunks = 0, branches = 0, nodes = 0, steps = 0, leaves = 0;
    uint32_t inserted = 0;    // nodes that seams, creases and split spans put in
    uint32_t waves = 0;       // of the queue, in the latest grow()
    uint32_t expansions = 0;  // grow() calls since creation that had something to do
    uint32_t regrowths = 0;   // of these, those that grew only what an edit concerned
    uint32_t derived = 0;     // nodes that the latest grow() derived
    uint32_t enlarged = 0;    // times that buffers were too small and were enlarged, in the latest grow()
    uint32_t overflow = 0;    // times that a limit cut growth, in the latest grow(); 0: it stands whole
    uint32_t stopped = 0;     // shapes that a limit ended
    uint32_t deadEnds = 0;    // branches that found no direction that their condition allows
    uint64_t nodeBytes = 0, leafBytes = 0,
             chunkBytes = 0;     // of records; chunkBytes counts branches too, leafBytes the links from nodes
    uint64_t reservedBytes = 0;  // of all buffers held: both sets of records, queues, scratch
    uint64_t hash = 0;           // canonical: positions, radii and all terminals, independent of order
    bool native = false;         // it ran as native code
    uint32_t dispatches = 0;     // of kernels that wait for each other, in the latest grow(); none of native code
    double expandMs = 0;         // GPU time of the attempt that succeeded; of native code, wall time
    double marchMs = 0, terminalsMs = 0, fitMs = 0;
};

// Room to begin with, in records; it grows by need and is kept.
struct GrowthRoom {
    uint32_t chunks = 8192, nodes = 65536, branches = 8192, leaves = 65536, items = 4096;
    uint32_t avoid = 0;   // places of spans in the grid of stems that keep a distance
    uint32_t rounds = 6;  // in which each wave decides about these; what is left then is for a single group
    float grid = 0;       // metres: GrowStatus::gridReach at least
};

}  // namespace espalier
