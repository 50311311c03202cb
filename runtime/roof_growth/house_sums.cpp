// How many cells each house has drawn, and their hash. In: grids and their rows' runs. Out: the town's sums without
// what has been replaced. Kernels count all that they write; what a house had before it grew anew is known only from
// its records, which are read back once after all houses have grown, when the first of them grows alone.
#include "runtime/roof_growth/roof_growth.hpp"
#include "shaders/shared/roof_rows.h"

namespace espalier {

RoofGrowth::Sums RoofGrowth::sumsOf(const RoofGrid& grid, std::span<const RoofRun> runs) const {
    const u64 hash = hashOfGrid(grid, plots_[grid.house & 0xFFFFFFu].at);
    Sums sums{0, 0, 0, {uint32_t(hash), uint32_t(hash >> 32)}};
    if (grid.firstRow == kNoIndex) return sums.touched = sums.whole = sums.terminals = 1, sums;
    for (const RoofRun& run : runs.subspan(grid.firstRow, grid.cells >> 16)) {
        sums.touched += runCount(run.touched);
        sums.whole += runCount(run.whole);
    }
    return sums;
}

Status RoofGrowth::countHouses() {
    if (!houseSums_.empty()) return Done{};
    const Set& set = sets_.drawn();
    auto grids = readVector<RoofGrid>(device_, set.grids, 0, last_.grids);
    if (!grids) return grids.failure();
    auto runs = readVector<RoofRun>(device_, set.runs, 0, last_.rows);
    if (!runs) return runs.failure();
    houseSums_.resize(plots_.size());
    for (const RoofGrid& grid : *grids) houseSums_[grid.house & 0xFFFFFFu] += sumsOf(grid, *runs);
    return Done{};
}

Status RoofGrowth::recount(std::span<const uint32_t> houses, Outcome& outcome) {
    if (outcome.grids.empty() && outcome.status.grids > last_.grids) {  // they grew on the GPU
        const Set& set = sets_.drawn();
        auto grids = readVector<RoofGrid>(device_, set.grids, last_.grids, outcome.status.grids - last_.grids);
        if (!grids) return grids.failure();
        auto runs = readVector<RoofRun>(device_, set.runs, last_.rows, outcome.status.rows - last_.rows);
        if (!runs) return runs.failure();
        outcome.grids = std::move(*grids);
        outcome.runs = std::move(*runs);
    }
    for (uint32_t house : houses) replaced_ += std::exchange(houseSums_[house], {});
    for (RoofGrid grid : outcome.grids) {
        if (grid.firstRow != kNoIndex) grid.firstRow -= last_.rows;
        houseSums_[grid.house & 0xFFFFFFu] += sumsOf(grid, outcome.runs);
    }
    return Done{};
}

}  // namespace espalier
