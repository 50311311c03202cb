#pragma once

// Growth in waves: plants and roofs alike queue shapes for the next wave until one is empty.

#include <algorithm>

#include "runtime/run/runner.hpp"

namespace espalier {

// Runs waves [0, most) until one is empty. Nobody knows when that will be, so waves are recorded ahead, which costs
// nothing where they turn out empty: `likely` of them at first, then twice as many each time. Native code knows.
//   add(run, first, last) -> Status         sends what waves read, if first is 0; adds waves [first, last) and what
//                                           follows them; asks for what is read back
//   goesOn(run, last) -> Result<bool>       takes that; whether there are more waves from `last` on, and a point in
//   them
template <class Add, class GoesOn>
Status runWaves(Runner& runner, const char* name, bool atOnce, uint32_t likely, uint32_t most, const Add& add,
                const GoesOn& goesOn) {
    uint32_t batch = atOnce ? most : likely;
    for (uint32_t first = 0;; batch *= 2) {
        const uint32_t last = first + std::min(batch, most - first);
        Result<Run> run = Run::begin(runner, name, atOnce);
        if (!run) return run.failure();
        if (Status added = add(*run, first, last); !added) return added;
        if (Status finished = run->finish(); !finished) return finished;
        Result<bool> more = goesOn(*run, last);
        if (!more) return more.failure();
        if (!*more || last == most) return Done{};
        first = last;
    }
}

}  // namespace espalier
