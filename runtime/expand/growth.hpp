#pragma once

// Expansion: seeds × rule maps × layers become chunks, nodes and leaves in GPU buffers.

#include <cstdint>
#include <memory>
#include <span>

#include "runtime/core/result.hpp"
#include "runtime/gpu/device.hpp"
#include "shaders/shared/growth_records.h"
#include "shaders/shared/rule_map.h"

namespace espalier {

enum class WalkMode : uint32_t { intrinsic = 0, paper = 1 };
enum class TangentMode : uint32_t { stem = 0, paper = 1 };

struct GrowthLimits {
    WalkMode walk = WalkMode::intrinsic;
    TangentMode tangents = TangentMode::stem;
    uint32_t maxNodes = 4'000'000;
    uint32_t maxDepth = 4096;         // chunks one after another along one path
    float leafDensityCap = 0;         // leaves per m² and seed, 0: none
};

// Everything that growth depends on; addresses are device addresses and stay valid during grow().
struct GrowthInputs {
    SurfaceBuf surfaces;              // indexed by surface instance
    uint32_t surfaceCount = 0;
    LayerBuf layers;                  // surfaceCount * kMaxLayers
    std::span<const RuleMapRef> grammars;
    std::span<const Seed> seeds;
    GrowthLimits limits;
};

// What the later stages read. Buffers belong to Growth and change only in grow().
struct GrowthView {
    NodeBuf nodes;
    ChunkBuf chunks;
    BranchBuf branches;
    LeafBuf leaves;
    uint32_t nodeCount = 0, chunkCount = 0, branchCount = 0, leafCount = 0;
    uint64_t revision = 0;            // grows with every grow() that changed anything
};

struct GrowthStats {
    uint32_t seeds = 0, chunks = 0, branches = 0, nodes = 0, steps = 0, leaves = 0, spans = 0;
    uint32_t expansions = 0, overflow = 0, stopped = 0, deadEnds = 0;
    uint64_t nodeBytes = 0, leafBytes = 0, chunkBytes = 0;
    uint64_t hash = 0;                // canonical: positions, radii and all terminals, independent of order
    double expandMs = 0;
};

class Growth {
  public:
    static Result<std::unique_ptr<Growth>> create(Device& device);
    virtual ~Growth() = default;

    // Grows everything anew and publishes it when complete; until then, and on failure, the last growth stands.
    virtual Status grow(const GrowthInputs& inputs) = 0;
    virtual GrowthView view() const = 0;
    virtual GrowthStats stats() const = 0;
};

}  // namespace espalier
