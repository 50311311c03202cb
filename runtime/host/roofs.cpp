// In: the shapes of a wave. Out: shapes of the next wave, grids and their rows' runs.
#include "runtime/host/kernels.hpp"
#include "shaders/shared/roof_expand.h"

namespace espalier {
namespace {

constexpr size_t kShapesAtOnce = 256;

// env.shapes are this wave's shapes, and env.next has room for the next wave's.
bool derive(RoofEnv env, const HostRun& run) {
    run.crew.overRange(shapesToDerive(env), kShapesAtOnce, [&](size_t begin, size_t end) {
        RoofTally tally = emptyTally();
        for (size_t i = begin; i < end; ++i) deriveShape(env, uint32_t(i), tally);
        addTally(env.status.v[0], tally);
    });
    return env.waves.v[env.wave].count > 0;
}

constexpr HostRow kRows[] = {{"roof_growth/derive.comp", waveOf<RoofEnv, derive>}};

}  // namespace

const std::span<const HostRow> kRoofRows = kRows;

}  // namespace espalier
