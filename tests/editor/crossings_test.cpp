// Where a walk jumps in the atlas.
#include "sample_game/crossings.hpp"

#include <doctest/doctest.h>

using sample::crossingsOf;

namespace {

// A sample every decimetre along x, a centimetre of the model being a thousandth of the atlas.
EspPathSample sampleAt(float metres, float u, uint32_t chart = 0, uint32_t surface = 1) {
    return {{metres, 0, 0}, {u, .5f}, chart, {surface}, 0};
}

}  // namespace

TEST_CASE("a walk crosses to other charts and surfaces, and over a seam of a chart with itself") {
    CHECK(crossingsOf({}).empty());
    CHECK(crossingsOf({sampleAt(0, 0)}).empty());
    const std::vector<EspPathSample> path{sampleAt(0, .97f),        sampleAt(.1f, .98f),   sampleAt(.2f, .99f),
                                          sampleAt(.3f, .02f),  // around a column, over the cut of its shaft
                                          sampleAt(.4f, .03f),      sampleAt(.5f, .6f, 3), sampleAt(.6f, .61f, 3),
                                          sampleAt(.7f, .61f, 3, 2)};
    const std::vector<bool> wanted{false, false, true, false, true, false, true};
    CHECK(crossingsOf(path) == wanted);
    // One whose steps differ in length as seams and creases put samples in between.
    CHECK(crossingsOf({sampleAt(0, .1f), sampleAt(.1f, .11f), sampleAt(.101f, .1101f), sampleAt(.2f, .12f)}) ==
          std::vector<bool>{false, false, false});
}
