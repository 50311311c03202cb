// Growth that is given up: what stood before stands, and what was asked for grows the next time.
#include <doctest/doctest.h>

#include <chrono>

#include "tests/expand/session.hpp"

using namespace espalier;
using namespace espalier::growthtest;

namespace {

// The structure's hash, as stats() should have it.
uint64_t hashOf(const GrowthRecords& records) {
    const FrozenPlant all{1, std::make_shared<PlantRecords>(records)};
    const FrozenSum sum = sumOf({&all, 1}, 0);
    return uint64_t(sum.hash[1]) << 32 | sum.hash[0];
}

// Some long branches, in more waves than one submission of shaders has.
struct LongGrowth : Session {
    explicit LongGrowth(bool native) : Session(ball()) {
        scene.native = native;
        scene.plantMany(6, 0, 1);
        set(0, "reach", 1000);
        set(0, "twigs", 0);
    }
    // Grows until the watch has been asked so many times. Returns how many times it was.
    int stopAt(int most) {
        int asked = 0;
        uint64_t before = 0;
        GrowthWatch watch(
            [&](uint64_t nodes) {
                CHECK(nodes >= before);
                before = nodes;
                return ++asked < most;
            },
            std::chrono::milliseconds(0));
        scene.watch = &watch;
        scene.changes = &changes;
        const Status grown = scene.grow(gpu.device(), *growth);
        scene.watch = nullptr;
        REQUIRE(bool(grown) == (asked < most));
        if (!grown) CHECK(grown.failure().text().find("stopped") != std::string::npos);
        return asked;
    }
    // After an edit: stopped there nothing has changed, and a stop costs the edit nothing.
    void checkStop(int most) {
        CAPTURE(most);
        const GrowthStats before = growth->stats();
        CHECK(stopAt(most) == most);
        CHECK(growth->stats().hash == before.hash);
        CHECK(growth->stats().nodes == before.nodes);
        CHECK(growth->stats().expansions == before.expansions);
        Result<GrowthRecords> records = growth->read();
        REQUIRE(records);
        CHECK(records->nodes.size() == before.nodes);
        CHECK(records->leaves.size() == before.leaves);
        CHECK(records->chunks.size() == before.chunks);
        CHECK(records->branches.size() == before.branches);
        CHECK(hashOf(*records) == before.hash);
    }
};

}  // namespace

TEST_CASE("growth that is given up leaves what stood, and what was asked for grows later") {
    for (const bool native : {false, true}) {
        CAPTURE(native);
        LongGrowth s(native);
        if (native && !s.gpu.device().info().cpu) continue;
        s.changes.everything = true;
        s.checkStop(1);
        s.check();
        const uint64_t whole = s.growth->stats().hash;
        REQUIRE(s.growth->stats().waves > 30);
        s.dab(0, {0.5f, 0.5f}, 0.1f, 0);
        s.check();
        REQUIRE(s.growth->stats().hash != whole);
        // All of an edit's work, and a full growth's, may be stopped at its beginning and in its midst. Shaders' next
        // growths are one submission, as long as they have no more waves than the last.
        s.dab(0, {0.5f, 0.5f}, 0.1f, 1);
        for (int most : {1, 2})
            if (native) s.checkStop(most);
        s.check();
        CHECK(s.growth->stats().hash == whole);
        for (int most : {1, 2}) {
            s.changes.everything = true;
            s.set(0, "stride", 0.05f);
            if (native) s.checkStop(most);
        }
        s.check();
        CHECK(s.growth->stats().hash != whole);
    }
}

TEST_CASE("frozen plants that an edit puts in are gone again when it is given up") {
    LongGrowth s(true);
    if (!s.gpu.device().info().cpu) return;
    s.dab(0, {0.5f, 0.5f}, 0.1f, 0);
    s.check();
    Result<GrowthRecords> records = s.growth->read();
    REQUIRE(records);
    const uint64_t key = s.scene.seeds()[3].key;
    s.scene.seeds().erase(s.scene.seeds().begin() + 3);
    s.scene.frozen = {{key, std::make_shared<PlantRecords>(plantOf(*records, 3))}};
    s.changes.frozen = {key};  // what has grown there isn't asked
    s.dab(0, {0.5f, 0.5f}, 0.1f, 1);
    for (int most : {1, 2}) s.checkStop(most);
    s.grow();
    const GrowthStats stats = s.growth->stats();
    CHECK(stats.regrowths == 1);
    s.changes.everything = true;
    s.grow();
    CHECK(s.growth->stats().hash == stats.hash);
    CHECK(s.growth->stats().nodes == stats.nodes);
    CHECK(s.growth->stats().leaves == stats.leaves);
}

TEST_CASE("growth that was given up leaves nothing of its tables to the next") {
    LongGrowth s(true);
    if (!s.gpu.device().info().cpu) return;
    s.check();
    s.scene.widths = {1, 1};
    s.checkStop(1);
    s.scene.widths.clear();
    s.dab(0, {0.5f, 0.5f}, 0.1f, 0);
    s.check();
    CHECK(s.growth->stats().regrowths == 1);
}

TEST_CASE("who watches and lets growth go on changes nothing") {
    LongGrowth s(true), unwatched(true);
    s.changes.everything = unwatched.changes.everything = true;
    const int asked = s.stopAt(1 << 30);
    if (s.gpu.device().info().cpu) CHECK(asked > 10);
    unwatched.grow();
    CHECK(s.growth->stats().hash == unwatched.growth->stats().hash);
}
