#pragma once

// What the growth of roofs takes and gives: a town's atoms and a grammar become grids of terminals (Buron 2013 §3).

#include <array>
#include <memory>

#include "runtime/core/result.hpp"
#include "runtime/gpu/buffer.hpp"
#include "runtime/grammar/grammar.hpp"
#include "runtime/roof_growth/atoms.hpp"

namespace espalier {

constexpr uint32_t kRoofWaves = kMaxRoofDepth + 2;

// Everything that roofs grow from. Pointers stay valid during the call.
struct RoofInputs {
    const RoofTables* town = nullptr;
    uint64_t townRevision = 0;  // changes with tables that are made anew; replaceAtoms() keeps it. 0: not known
    const RuleMap* grammar = nullptr;
    uint64_t grammarRevision = 1;      // changes with rules and parameters, which are uploaded anew then
    std::span<const RoofMesh> meshes;  // by the numbers that the grammar was compiled with
    RoofSite site{{0, 0}, 1, 1};       // that layers lie over
    struct Layer {
        const float* texels = nullptr;          // site.size² of them; null: nothing is painted
        uint32_t firstRow = 0, rowCount = ~0u;  // that have changed since they were sent to the GPU
    };
    std::array<Layer, kRoofLayers> layers;  // as the grammar counts its contexts
    std::span<const float> means;           // [house * kRoofLayers + layer]; empty: nothing is painted

    // The value where nothing is painted.
    float fill(uint32_t layer) const {
        const auto& contexts = grammar->contexts();
        return layer < contexts.size() ? contexts[layer].fill : 0;
    }
    // `means`, or what stands for them.
    using Means = std::array<float, kRoofLayers>;
    Means meansOf(size_t house) const;
    std::vector<float> filledMeans(size_t houses) const;
    // True: on a software device whose addresses are the process's own, roofs grow as native code on its cores, with
    // the same result. False: as shaders there too.
    bool native = true;
};

// What drawing reads. Buffers belong to RoofGrowth and change only in its calls.
struct RoofView {
    RoofGridBuf grids{};
    RoofRunBuf runs{};
    RoofRegionBuf regions{};
    RoofPartBuf parts{};
    Vec4Buf planes{};
    RoofMeshBuf meshes{};
    RoofPlotBuf plots{};  // [house]
    RoofLayerBuf layers{};
    RoofSite site{};
    uint32_t shownLayer = kNoIndex;  // by the view of a layer: the grammar's number, or colourLayers
    uint32_t gridCount = 0, rowCount = 0;
    uint64_t tileCount = 0, clippedCount = 0;
    uint64_t revision = 0;
    glm::vec3 low{0}, high{0};  // of the town
};

struct RoofStats {
    uint32_t houses = 0, atoms = 0;
    uint32_t grids = 0, terminals = 0;  // records, also of houses that grew anew since; drawn ones of one cell
    uint64_t tiles = 0, clipped = 0;    // cells that are drawn; those of them that an outline crosses
    uint32_t waves = 0, stopped = 0;    // of the latest expansion; shapes that a limit ended
    uint32_t expansions = 0;
    uint64_t housesGrown = 0;  // by all expansions together
    uint64_t bytes = 0;        // of grids, runs and the regions that Join made
    uint64_t reservedBytes = 0;
    uint64_t hash = 0;    // of all grids that are drawn, independent of their order: what a growth of all would give
    bool native = false;  // the latest expansion of all houses, or of many, ran as native code
    double expandMs = 0;  // GPU time of the latest expansion; of native code, its time
};

struct RoofRecords {
    std::vector<RoofGrid> grids;
    std::vector<RoofRun> runs;
    std::vector<RoofRegion> regions;
    std::vector<RoofPart> parts;
    std::vector<vec4> planes;
    std::vector<RoofPlot> plots;  // [house], as RoofView's
};

// The same on the CPU, from the same text; `status` tells what was made.
struct CpuRoofs {
    Status complete = Done{};  // or why not all has been made
    RoofRecords records;
    RoofStatus status{};
    uint32_t waves = 0;
    std::vector<uint32_t> reads;  // [house], see RoofEnv
};
CpuRoofs growRoofsOnCpu(const RoofInputs& inputs, unsigned threads = 1);

// Room for expansion, in records; grown by what a status asks for.
struct RoofRoom {
    uint32_t scopes = 1u << 14, grids = 1u << 14, rows = 1u << 16, regions = 1024, parts = 1024, planes = 3072;
    // True if `status` fitted; else the room is larger now. Fails where none would do. starts: shapes of the first
    // wave.
    Result<bool> hold(const RoofStatus& status, uint32_t widestWave, uint32_t starts);
};

// Tells that no room has done.
Failure tooManyShapes();

}  // namespace espalier
