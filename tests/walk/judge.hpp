#pragma once

// Runs walks over a surface and compares their ends with an oracle's.

#include "shaders/shared/paper_walk.h"
#include "tests/walk/shapes.hpp"

namespace espalier::walktest {

// One walk to judge: a start in the surface's terms and where the true geodesic of that length ends.
struct Trial {
    uint place = 0;
    vec2 uv{0};
    vec3 direction{0};
    float length = 0;
    Vec3 end{0};
};

// Drift in % of the length walked.
struct Drift {
    double median = 0, p95 = 0;
    int walks = 0, lost = 0;
    double nanoseconds = 0;  // a step
};

enum class Scheme { intrinsic, paper };

// Walks each trial in steps of `step` metres. A walk that stops before its length is used up counts as lost and
// as infinite drift.
Drift judge(const SurfaceData& surface, const std::vector<Trial>& trials, uint level, float step, Scheme scheme);

// `count` walks of `length` on a shape, those left out whose geodesic leaves it.
std::vector<Trial> shapeTrials(const Shape& shape, const SurfaceData& surface, int count, double length, uint64_t seed);

// The chart of the texel at uv that lies nearest to `position`, looked for in a ring; kNoIndex: none.
uint chartAt(const SurfaceData& surface, vec2 uv, Vec3 position);

}  // namespace espalier::walktest
