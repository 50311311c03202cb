// What a dab derives again is what it invalidates, and hardly more.
#include <algorithm>

#include "shaders/shared/random.h"
#include "tests/expand/session.hpp"
#include "tools/bench/census.hpp"

using namespace espalier;
using namespace espalier::growthtest;

namespace {

constexpr float kTexel = 1.0f / Session::kSize;
// Nodes that a single dab may derive beside those: some chunks, which are derived as a whole.
constexpr uint32_t kChunks = 5 * 32;

}  // namespace

TEST_CASE("dabs derive at most half as many nodes again as they invalidate") {
    const std::pair<const char*, Model> models[] = {{"a square", flatSquare()}, {"a ball", ball()}, {"a cube", cube()}};
    for (const auto& [name, model] : models) {
        CAPTURE(name);
        Session s(model);
        s.scene.plantMany(60);
        s.check();
        Result<GrowthRecords> records = s.growth->read();
        REQUIRE(records);
        const Census census(*records);
        REQUIRE(census.uvs.size() > 3000);
        uint64_t key = 7;
        double derived = 0, invalidated = 0;
        for (int i = 0; i < 40; ++i) {
            key = mix64(key);
            const auto& nodes =
                census.branches[census.order[size_t(double(uniformRandom(key, 1)) * double(census.order.size()))]];
            if (nodes.empty()) continue;
            const uint32_t node = nodes[size_t(double(uniformRandom(key, 2)) * double(nodes.size()))];
            const Dab dab{census.uvs[node], (2 + 20 * uniformRandom(key, 3) * uniformRandom(key, 4)) * kTexel};
            s.dab(0, dab.at, dab.radius, 0);
            s.grow();
            // Letting it grow again derives what the records foretell.
            s.dab(0, dab.at, dab.radius, 1);
            s.grow();
            const double these = census.invalidatedBy(dab, kTexel);
            CAPTURE(these);
            CHECK(s.growth->stats().derived <= 1.5 * these + kChunks);
            derived += s.growth->stats().derived;
            invalidated += these;
        }
        CHECK(derived > 1000);
        CHECK(derived <= 1.5 * invalidated);
        s.check();
    }
}
