// When a change is grown: small ones at once, what takes long once it has been announced and the slider is let go.
#include <doctest/doctest.h>

#include "sample_game/growth_pace.hpp"

using sample::GrowthPace;
using Step = GrowthPace::Step;

TEST_CASE("quick growth follows every step of a drag") {
    GrowthPace pace;
    CHECK(pace.next(true, true, true, false) == Step::grow);
    pace.grewWhole(GrowthPace::kSlowMs / 2);
    CHECK(pace.next(true, true, true, false) == Step::grow);
    CHECK(pace.next(false, false, false, false) == Step::grow);
}

TEST_CASE("slow growth waits for the slider to be let go, is announced, and grows once") {
    GrowthPace pace;
    pace.grewWhole(2 * GrowthPace::kSlowMs);
    for (int frame = 0; frame < 5; ++frame) CHECK(pace.next(true, true, true, false) == Step::wait);
    CHECK(pace.next(true, true, false, false) == Step::announce);
    CHECK(pace.next(true, true, false, false) == Step::grow);
    CHECK(pace.next(true, true, false, false) == Step::announce);
}

TEST_CASE("what reaches few plants, and a stroke's dabs, aren't put off") {
    GrowthPace pace;
    pace.grewWhole(2 * GrowthPace::kSlowMs);
    CHECK(pace.next(true, false, true, false) == Step::grow);
    CHECK(pace.next(true, true, false, true) == Step::grow);
}
