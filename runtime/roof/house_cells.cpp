// How many cells each house has drawn. In: grids and their rows' runs. Out: the town's counts without what has been
// replaced. Kernels count all that they write; what a house had before it grew anew is known only from its records,
// which are read back once after all houses have grown, when the first of them grows alone.
#include "runtime/roof/gpu_roofs.hpp"
#include "shaders/shared/roof_cells.h"

namespace espalier {

GpuRoofs::Cells GpuRoofs::cellsOf(const RoofGrid& grid, std::span<const RoofRun> runs) {
    if (grid.firstRow == kNoIndex) return {1, 1, 1};
    Cells cells;
    for (const RoofRun& run : runs.subspan(grid.firstRow, grid.cells >> 16)) {
        cells.touched += runCount(run.touched);
        cells.whole += runCount(run.whole);
    }
    return cells;
}

Status GpuRoofs::countHouses() {
    if (!houseCells_.empty()) return Done{};
    const Set& set = sets_[front_];
    auto grids = readVector<RoofGrid>(device_, set.grids, 0, last_.grids);
    if (!grids) return grids.failure();
    auto runs = readVector<RoofRun>(device_, set.runs, 0, last_.rows);
    if (!runs) return runs.failure();
    houseCells_.resize(generationOf_.size());
    for (const RoofGrid& grid : *grids) houseCells_[grid.house & 0xFFFFFFu] += cellsOf(grid, *runs);
    return Done{};
}

Status GpuRoofs::recount(std::span<const uint32_t> houses, Outcome& outcome) {
    if (outcome.grids.empty() && outcome.status.grids > last_.grids) {  // they grew on the GPU
        const Set& set = sets_[front_];
        auto grids = readVector<RoofGrid>(device_, set.grids, last_.grids, outcome.status.grids - last_.grids);
        if (!grids) return grids.failure();
        auto runs = readVector<RoofRun>(device_, set.runs, last_.rows, outcome.status.rows - last_.rows);
        if (!runs) return runs.failure();
        outcome.grids = std::move(*grids);
        outcome.runs = std::move(*runs);
    }
    for (uint32_t house : houses) replaced_ += std::exchange(houseCells_[house], {});
    for (RoofGrid grid : outcome.grids) {
        if (grid.firstRow != kNoIndex) grid.firstRow -= last_.rows;
        houseCells_[grid.house & 0xFFFFFFu] += cellsOf(grid, outcome.runs);
    }
    return Done{};
}

}  // namespace espalier
