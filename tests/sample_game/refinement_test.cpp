#include <doctest/doctest.h>

#include "sample_game/refinement.hpp"

using sample::Refinement;

TEST_CASE("a picture becomes the mean of sixteen and is left alone then") {
    Refinement refinement;
    CHECK_FALSE(refinement.due());
    refinement.drew(false);
    uint32_t more = 0;
    for (; refinement.due() && more < 100; ++more) refinement.refined();
    CHECK(more == 15);
    CHECK(refinement.pictures() == 16);
    refinement.drew(false);  // of another view
    CHECK(refinement.pictures() == 1);
    CHECK(refinement.due());
}

TEST_CASE("a coarse picture fades into the whole one, and is never refined itself") {
    Refinement refinement;
    refinement.begin(1);
    refinement.drew(true);
    CHECK_FALSE(refinement.due());
    CHECK(refinement.before(1) == 0);
    refinement.begin(1.5);
    refinement.drew(false);
    // However long the whole picture takes to be drawn.
    CHECK(refinement.before(1.5) == 1);
    CHECK(refinement.before(5) == 1);
    refinement.begin(5);
    CHECK(refinement.before(5) == 1);
    refinement.begin(5.1);
    CHECK(refinement.before(5.1) == doctest::Approx(.5));
    CHECK(refinement.before(5.3) == 0);
    CHECK(refinement.due());
    SUBCASE("shadows that come late don't end that") {
        refinement.drew(false);
        CHECK(refinement.before(5.1) == doctest::Approx(.5));
    }
    SUBCASE("a camera that moves on does") {
        refinement.drew(true);
        CHECK(refinement.before(5.1) == 0);
    }
    SUBCASE("as does another size") {
        refinement.cut();
        CHECK(refinement.before(5) == 0);
    }
    SUBCASE("and pictures that are drawn frame after frame don't hold it up") {
        refinement.drew(true);
        refinement.drew(false);
        refinement.begin(6);
        refinement.drew(false);
        refinement.begin(6.5);
        CHECK(refinement.before(6.5) == 0);
    }
}
