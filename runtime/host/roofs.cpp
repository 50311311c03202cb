// In: the shapes of a wave. Out: shapes of the next wave, grids and their rows' runs. Shapes of a wave are taken by
// whichever thread is free, so that records' order differs between runs of several threads, as on a GPU.
#include "runtime/host/kernels.hpp"
#include "shaders/shared/roof_expand.h"
#include "shaders/shared/roof_rows.h"

namespace espalier {
namespace {

constexpr size_t kAtOnce = 256;

bool derive(RoofEnv env, const HostRun& run) {
    RoofLane any;
    any.env = env;
    run.crew.overRange(shapesToDerive(any), kAtOnce, [&](size_t begin, size_t end) {
        RoofLane lane;
        lane.env = env;
        for (size_t i = begin; i < end; ++i) deriveShape(lane, uint32_t(i));
    });
    return env.waves.v[env.wave].count > 0;
}

void finishRows(RoofEnv env, const HostRun& run) {
    run.crew.overRange(gridsToFinish(env), kAtOnce, [&](size_t begin, size_t end) {
        LoneLane lane;
        finishGrids(lane, env, uint(begin), uint(end), 1);
    });
}

constexpr HostRow kRows[] = {{"roof_growth/derive.comp", waveOf<RoofEnv, derive>},
                             {"roof_growth/rows.comp", passOf<RoofEnv, finishRows>}};

}  // namespace

const std::span<const HostRow> kRoofRows = kRows;

}  // namespace espalier
