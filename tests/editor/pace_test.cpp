// When a change is grown: small ones at once, what takes long once it has been announced and the slider is let go.
#include <doctest/doctest.h>

#include "sample_game/growth_pace.hpp"

using sample::GrowthPace;
using Step = GrowthPace::Step;

namespace {

constexpr double kSlow = 2 * GrowthPace::kSlowMs, kQuick = GrowthPace::kSlowMs / 2;

}  // namespace

TEST_CASE("quick growth follows every step of a drag") {
    GrowthPace pace;
    for (int step = 0; step < 5; ++step) {
        CHECK(pace.next(true, true, true, false) == Step::grow);
        pace.grew(kQuick, true);
    }
    CHECK(pace.next(false, false, false, false) == Step::grow);
}

TEST_CASE("a drag whose step was slow waits to be let go, is announced then, and grows once") {
    GrowthPace pace;
    CHECK(pace.next(true, true, true, false) == Step::grow);
    pace.grew(kSlow, true);
    for (int frame = 0; frame < 5; ++frame) CHECK(pace.next(true, true, true, false) == Step::wait);
    CHECK(pace.next(true, true, false, false) == Step::announce);
    CHECK(pace.next(true, true, false, false) == Step::grow);
    pace.grew(kSlow, true);
    CHECK(pace.next(false, false, false, false) == Step::grow);
    // The next drag shows by its first step what it takes.
    CHECK(pace.next(true, true, true, false) == Step::announce);
    CHECK(pace.next(true, true, true, false) == Step::grow);
    pace.grew(kQuick, false);
    CHECK(pace.next(true, false, true, false) == Step::grow);
}

TEST_CASE("what reaches few plants, and a stroke's dabs, aren't put off") {
    GrowthPace pace;
    pace.grew(kSlow, true);
    CHECK(pace.next(true, false, false, false) == Step::grow);
    pace.grew(kSlow, true);
    CHECK(pace.next(true, true, true, true) == Step::grow);
}
