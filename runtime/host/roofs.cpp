// In: the shapes of a wave. Out: shapes of the next wave, grids and their rows' runs.
#include "runtime/host/roofs.hpp"

#include "shaders/shared/roof_expand.h"

namespace espalier {
namespace {

constexpr size_t kShapesAtOnce = 256;

}  // namespace

void deriveRoofsNative(RoofEnv env, Crew& crew) {
    crew.overRange(shapesToDerive(env), kShapesAtOnce, [&](size_t begin, size_t end) {
        RoofTally tally = emptyTally();
        for (size_t i = begin; i < end; ++i) deriveShape(env, uint32_t(i), tally);
        addTally(env.status.v[0], tally);
    });
}

}  // namespace espalier
