#include <doctest/doctest.h>

#include "runtime/plugin/context.hpp"

using namespace espalier;

TEST_CASE("twins of a number are told apart, and a number that nothing has any more is forgotten") {
    TwinTable twins;
    uint32_t twin = 0;
    for (uint32_t wanted = 1; wanted <= 3; ++wanted) {
        CHECK(twins.take(7, 0, twin));
        CHECK(twin == wanted);
    }
    CHECK_FALSE(twins.take(7, 2, twin));
    twins.release(7, 3);
    twins.release(7, 1);
    CHECK(twins.take(7, 0, twin));
    CHECK(twin == 1);
    CHECK(twins.take(7, 3, twin));
    CHECK_FALSE(twins.take(8, (1u << 20) + 1, twin));
    CHECK(twins.numbers() == 1);
    for (uint32_t number = 100; number < 1100; ++number) {
        REQUIRE(twins.take(number, 5, twin));
        twins.release(number, twin);
    }
    CHECK(twins.numbers() == 1);
    for (uint32_t taken : {1u, 2u, 3u}) twins.release(7, taken);
    CHECK(twins.numbers() == 0);
    CHECK(twins.take(7, 0, twin));
    CHECK(twin == 1);
}
