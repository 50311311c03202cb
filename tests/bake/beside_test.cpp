// Two halves of a bake at once: what either throws, want of memory say, is thrown when both are done.
#include "tools/bake/beside.hpp"

#include <doctest/doctest.h>

#include <new>
#include <stdexcept>

using namespace espalier::bakery;

TEST_CASE("what one of two throws ends the other no earlier, and this program not at all") {
    int done = 0;
    CHECK_NOTHROW(beside([&] { done += 1; }, [] {}));
    CHECK(done == 1);
    CHECK_THROWS_AS(beside([] { throw std::bad_alloc(); }, [&] { done += 1; }), std::bad_alloc);
    CHECK(done == 2);
    CHECK_THROWS_AS(beside([&] { done += 1; }, [] { throw std::bad_alloc(); }), std::bad_alloc);
    CHECK(done == 3);
    CHECK_THROWS_AS(beside([] { throw std::logic_error("first"); }, [] { throw std::bad_alloc(); }), std::bad_alloc);
}
