// Order within bins: what it costs where many items share one.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "shaders/emit/cells.h"

namespace espalier {
namespace {

// What is around the kernels' text there, as in native_bind.cpp; counts what it reads.
struct Sorting {
    EmitPush push{};
    std::vector<uint32_t> order;
    std::vector<uvec4> places;
    size_t reads = 0;

    uvec4 spanTexel(uint i) { return ++reads, places[i / 6]; }
    uvec4 leafTexel(uint i) { return ++reads, places[i / 4]; }
#include "shaders/emit/sort_bins.h"
};

Sorting shuffled(uint32_t count) {
    Sorting s;
    std::mt19937 random(count + 1);
    for (uint32_t i = 0; i < count; ++i) {
        s.places.emplace_back(random(), random(), random(), random());
        s.order.push_back(i);
    }
    std::shuffle(s.order.begin(), s.order.end(), random);
    return s;
}

}  // namespace

TEST_CASE("bins come in one order, and long ones aren't gone through once for each item") {
    for (uint32_t count : {0u, 1u, 2u, 3u, 63u, 64u, 65u, 66u, 127u, 1000u, 20'000u})
        for (uint32_t kind : {0u, kLeafClass}) {
            CAPTURE(count);
            CAPTURE(kind);
            Sorting s = shuffled(count);
            s.push.order.v = s.order.data();
            s.sortRun(0, count, kind);
            const size_t reads = s.reads;
            std::vector<uint32_t> wanted(count);
            for (uint32_t i = 0; i < count; ++i) wanted[i] = i;
            std::ranges::sort(wanted, {}, [&](uint32_t i) { return s.rankOf(i, kind); });
            CHECK(s.order == wanted);
            CHECK(double(reads) <= count * std::max(66.0, 4 * std::log2(count + 1.0)));
        }
}

}  // namespace espalier
