// What a designer keeps from growing, or as it is: pruned branches and frozen plants, and the bytes of the latter.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/core/hash.hpp"
#include "shaders/shared/exact.h"
#include "shaders/shared/random.h"
#include "tests/expand/session.hpp"

using namespace espalier;
using namespace espalier::growthtest;

TEST_CASE("a pruned branch is gone with what follows from it, stays so, and comes back") {
    Session s(ball());
    s.scene.plantMany(20, 0, 1);
    s.scene.plantMany(10, 1, 2);
    s.check();
    const GrowthStats before = s.growth->stats();
    Result<GrowthRecords> records = s.growth->read();
    REQUIRE(records);
    // The branch of a seed that has most nodes follow from its first twig, and that twig.
    std::vector<uint32_t> following(records->chunks.size());
    for (const Chunk& c : records->chunks)
        for (uint32_t at = uint32_t(&c - records->chunks.data()); at != kNoIndex; at = records->chunks[at].parent)
            following[at] += chunkNodes(c.marks);
    const BranchRecord* twig = nullptr;
    for (const BranchRecord& b : records->branches)
        if ((records->chunks[b.firstChunk].depth & 0xFFFF) == 1 &&
            (!twig || following[b.firstChunk] > following[twig->firstChunk]))
            twig = &b;
    REQUIRE(twig);
    const uint64_t key = records->chunks[twig->firstChunk].key;
    REQUIRE(following[twig->firstChunk] > 20);

    s.scene.pruned = {key};
    s.check();
    CHECK(s.growth->stats().regrowths == 1);
    CHECK(s.growth->stats().derived == 0);
    CHECK(s.growth->stats().nodes == before.nodes - following[twig->firstChunk]);
    Result<GrowthRecords> after = s.growth->read();
    REQUIRE(after);
    for (const BranchRecord& b : after->branches) CHECK(after->chunks[b.firstChunk].key != key);
    s.dab(0, {0.2f, 0.3f}, 0.2f, 0);  // regrowth and full growth leave it out alike
    s.check();
    s.changes.everything = true;
    s.check();
    s.dab(0, {0.2f, 0.3f}, 0.2f, 1);
    s.check();
    s.scene.pruned.clear();
    s.check();
    CHECK(s.growth->stats().hash == before.hash);
    CHECK(s.growth->stats().derived == following[twig->firstChunk]);
    s.scene.pruned = {1, 2, 3};  // no branch's
    s.check();
    CHECK(s.growth->stats().hash == before.hash);
    s.scene.pruned = {3, 2};
    CHECK(!s.scene.growOnCpu());
}

// A chunk that begins a branch keeps its place as it loses its nodes and gets some again; the branch gets another each
// time.
TEST_CASE("branches that go and come back, over and over, leave no more than three gaps for each that stands") {
    for (const bool native : {false, true}) {
        CAPTURE(native);
        constexpr GrowthRoom kLittle{64, 256, 64, 256, 64};
        Session s(ball(), kLittle);
        s.scene.native = native;
        s.scene.plantMany(60, 0, 1);
        s.check();
        const GrowthStats before = s.growth->stats();
        Result<GrowthRecords> records = s.growth->read();
        REQUIRE(records);
        std::vector<uint64_t> twigs;
        for (const BranchRecord& b : records->branches) {
            const Chunk& c = records->chunks[b.firstChunk];
            if ((c.depth & 0xFFFF) > 0 && c.firstChild == kNoIndex) twigs.push_back(c.key);
        }
        std::ranges::sort(twigs);
        twigs.resize(std::min(twigs.size(), records->chunks.size() / 5));  // more would be too much for a regrowth
        REQUIRE(twigs.size() > 40);
        for (int i = 0; i < 80; ++i) {
            s.scene.pruned = i % 2 == 0 ? twigs : std::vector<uint64_t>();
            s.grow();
            const GrowthView view = s.growth->view();
            const GrowthStats now = s.growth->stats();
            CHECK(view.branchCount <= std::max(kLittle.branches, 4 * now.branches + 4) + twigs.size());
            CHECK(view.chunkCount <= std::max(kLittle.chunks, 4 * now.chunks + 4) + twigs.size());
        }
        CHECK(s.growth->stats().regrowths > 20);
        s.check();
        CHECK(s.growth->stats().hash == before.hash);
    }
}

namespace {

// A plant's file as it was when read sets named an instance by 8 bits and had their level beside it.
std::vector<std::byte> packedBefore(const PlantRecords& plant) {
    constexpr size_t kHead = 32, kHash = 24;
    std::vector<std::byte> bytes = packPlant(plant);
    for (size_t i = 0; i < plant.chunks.size(); ++i) {
        Chunk chunk = plant.chunks[i];
        chunk.marks |= 6;
        chunk.reads[0] = 0xFFFF0907;
        std::memcpy(bytes.data() + kHead + plant.nodes.size() * sizeof(Node) + i * sizeof chunk, &chunk, sizeof chunk);
    }
    const uint64_t hash = hashBytes(std::span(bytes).subspan(kHead));
    std::memcpy(bytes.data() + kHash, &hash, sizeof hash);
    return bytes;
}

}  // namespace

TEST_CASE("a frozen plant stands as it was through every edit, and grows from what is there when it thaws") {
    Session s(ball());
    s.scene.plantMany(12, 0, 1);
    s.scene.plantMany(6, 1, 2);
    s.check();
    const GrowthStats before = s.growth->stats();
    Result<GrowthRecords> records = s.growth->read();
    REQUIRE(records);
    // What grows from the seed alone, by the CPU: plants know nothing of each other, so it is the frozen plant's share.
    std::vector<Seed>& seeds = s.scene.seeds();
    const std::vector<Seed> all = seeds;
    const Seed seed = seeds[3];
    seeds = {seed};
    Result<CpuGrowth> alone = s.scene.growOnCpu();
    REQUIRE(alone);
    REQUIRE(alone->stats.leaves > 10);
    seeds = all;
    seeds.erase(seeds.begin() + 3);
    s.scene.frozen = {{seed.key, std::make_shared<PlantRecords>(plantOf(*records, 3))}};
    const auto check = [&] {
        s.grow();
        Result<CpuGrowth> rest = s.scene.growOnCpu();
        REQUIRE(rest);
        const GrowthStats now = s.growth->stats(), &a = alone->stats, &b = rest->stats;
        const uint64_t low = uint32_t(a.hash) + uint32_t(b.hash), high = (a.hash >> 32) + (b.hash >> 32);
        CHECK(now.hash == ((high << 32) | uint32_t(low)));
        CHECK(now.seeds == a.seeds + b.seeds);
        CHECK(now.nodes == a.nodes + b.nodes);
        CHECK(now.chunks == a.chunks + b.chunks);
        CHECK(now.branches == a.branches + b.branches);
        CHECK(now.leaves == a.leaves + b.leaves);
        CHECK(now.steps == a.steps + b.steps);
        CHECK(now.inserted == a.inserted + b.inserted);
        CHECK(now.deadEnds == a.deadEnds + b.deadEnds);
        CHECK(now.stopped == a.stopped + b.stopped);
    };
    check();
    CHECK(s.growth->stats().hash == before.hash);
    CHECK(s.growth->stats().derived == 0);
    s.dab(0, seed.walk.uv, 0.2f, 0);
    check();
    CHECK(s.growth->stats().regrowths == 2);
    s.set(0, "leafSize", 0.05f);
    s.set(0, "twigs", 0.5f);
    check();
    s.changes.grammars = {0};
    check();
    s.scene.pruned = {seed.key};
    check();
    s.scene.plantMany(2, 0, 9);
    check();
    const uint32_t regrowths = s.growth->stats().regrowths;
    s.changes.everything = true;
    check();
    CHECK(s.growth->stats().regrowths == regrowths);
    CHECK(s.growth->stats().derived == s.growth->stats().nodes - alone->stats.nodes);
    s.dab(0, {0.5f, 0.5f}, 0.2f, 0);
    check();
    s.scene.limits.maxNodes = s.growth->stats().nodes;
    check();

    // As bytes and back, into a growth that has never seen it.
    const std::vector<std::byte> bytes = packPlant(*s.scene.frozen[0].records);
    Result<PlantRecords> again = unpackPlant(bytes, 1);
    REQUIRE(again);
    CHECK(packPlant(*again) == bytes);
    // A file of before, whose chunks hold what they have read as it was written then.
    Result<PlantRecords> old = unpackPlant(packedBefore(*again), 1);
    REQUIRE(old);
    CHECK(packPlant(*old) == bytes);
    s.scene.frozen[0].records = std::make_shared<PlantRecords>(std::move(*again));
    check();
    s.growth = s.gpu.growth({64, 64, 64, 64, 64});
    check();
    s.scene.frozen.push_back(s.scene.frozen[0]);
    seeds.clear();
    s.scene.frozen[1].key += 1;
    s.grow();
    CHECK(s.growth->stats().nodes == 2 * alone->stats.nodes);

    // It thaws into the present inputs; the pruning of its root holds until it is taken back.
    s.scene.limits.maxNodes = before.nodes * 2;
    s.scene.frozen.clear();
    seeds = all;
    s.check();
    CHECK(s.growth->stats().regrowths == 0);
    s.scene.pruned.clear();
    s.check();
    CHECK(s.growth->stats().regrowths == 1);
}

TEST_CASE("chunks of frozen plants count neither against those that grow anew nor against those that edits grow") {
    Session s(flatSquare());
    s.write(0, R"(
Stem(n) -> Marching(0.02, rand(-0.6, 0.6), n < 30) {Fork(n + 1), Bark}
Fork(n) -> Branch(3) {Tip, None, Stem(n)}
Tip -> Marching(0.01, 1, true) {NULL, Bark}
None -> Marching(0.01, 1, false) {NULL, Bark}
Bark -> S(0.001) Shape("bark", C1)
)");
    s.changes.everything = true;
    s.scene.plantMany(160, 0, 1);
    s.check();
    Result<GrowthRecords> records = s.growth->read();
    REQUIRE(records);
    std::vector<Seed>& seeds = s.scene.seeds();
    for (uint32_t i = 60; i < 160; ++i)
        s.scene.frozen.push_back({seeds[i].key, std::make_shared<PlantRecords>(plantOf(*records, i))});
    seeds.resize(60);
    s.scene.limits.maxNodes = s.growth->stats().nodes;
    s.changes.everything = true;
    s.grow();
    const GrowthStats before = s.growth->stats();
    REQUIRE(before.overflow == 0);
    REQUIRE(before.chunks > std::max(s.scene.limits.maxNodes / 2, 4096u));
    seeds[3].walk.direction = -seeds[3].walk.direction;
    s.grow();
    const GrowthStats edited = s.growth->stats();
    CHECK(edited.regrowths == before.regrowths + 1);
    s.changes.everything = true;
    s.grow();
    CHECK(s.growth->stats().hash == edited.hash);
}

TEST_CASE("plants grow beside frozen ones that have more nodes than passes have groups for") {
    Session s(ball());
    s.scene.plantMany(120, 0, 1);
    s.scene.native = true;
    s.grow();
    Result<GrowthRecords> records = s.growth->read();
    REQUIRE(records);
    const auto plant = std::make_shared<PlantRecords>(plantOf(*records, 0));
    while (s.scene.frozen.size() * plant->nodes.size() <= kLaneGroups * kNodesPerGroup)
        s.scene.frozen.push_back({mix64(s.scene.frozen.size()), plant});
    s.scene.limits.maxNodes = 1u << 22;
    uint64_t hashes[2];
    for (const bool native : {true, false}) {
        s.scene.native = native;
        s.changes.everything = true;
        s.grow();
        CHECK(s.growth->stats().native == native);
        hashes[native] = s.growth->stats().hash;
    }
    CHECK(hashes[0] == hashes[1]);
}

TEST_CASE("frozen plants with more leaves than the limit are refused by name, and what stood before stands") {
    Session s(ball());
    s.scene.plantMany(2, 0, 1);
    s.check();
    Result<GrowthRecords> records = s.growth->read();
    REQUIRE(records);
    const PlantRecords plant = plantOf(*records, 0);
    const uint32_t leaves = uint32_t(plant.leaves.size());
    REQUIRE(leaves > 1);
    const std::vector<Seed> seeds = s.scene.seeds();
    s.scene.clearSeeds();
    s.scene.limits.maxLeaves = leaves;
    s.grow();
    const uint64_t hash = s.growth->stats().hash;

    const auto refused = [&](uint32_t most) {
        s.scene.changes = &s.changes;
        const Status grown = s.scene.grow(s.gpu.device(), *s.growth);
        REQUIRE_FALSE(grown);
        CHECK(grown.failure().text().find("more than " + std::to_string(most) + " leaves") != std::string::npos);
        CHECK(s.growth->stats().hash == hash);
    };
    // Put into what stands, and with all grown anew.
    s.scene.frozen = {{seeds[0].key, std::make_shared<PlantRecords>(plant)},
                      {seeds[1].key, std::make_shared<PlantRecords>(plant)}};
    s.changes.frozen = {seeds[0].key, seeds[1].key};
    refused(leaves);
    s.changes.everything = true;
    refused(leaves);
    s.scene.frozen.pop_back();
    s.scene.limits.maxLeaves = leaves - 1;
    refused(leaves - 1);
    s.scene.limits.maxLeaves = leaves;
    s.grow();
    CHECK(s.growth->stats().leaves == leaves);
}

TEST_CASE("plants with the paper's tangents grow beside frozen ones as they would alone") {
    for (const bool native : {false, true}) {
        CAPTURE(native);
        Session s(ball());
        s.scene.native = native;
        s.scene.plantMany(60, 0, 1);
        s.grow();
        Result<GrowthRecords> records = s.growth->read();
        REQUIRE(records);
        std::vector<Seed>& seeds = s.scene.seeds();
        for (uint32_t i = 0; i < 55; ++i)
            s.scene.frozen.push_back({seeds[i].key, std::make_shared<PlantRecords>(plantOf(*records, i))});
        const FrozenSum kept = sumOf(s.scene.frozen, 0);
        seeds.erase(seeds.begin(), seeds.begin() + 55);
        s.scene.limits.tangents = TangentMode::paper;
        Result<CpuGrowth> alone = s.scene.growOnCpu();
        REQUIRE(alone);
        REQUIRE(kept.records.nodes.size() > 4 * alone->stats.nodes);
        s.growth = s.gpu.growth({64, alone->stats.nodes, 64, 64, 64});
        for (int round = 0; round < 3; ++round) {
            s.changes.everything = true;
            s.grow();
            const uint64_t low = uint32_t(alone->stats.hash) + kept.hash[0],
                           high = (alone->stats.hash >> 32) + kept.hash[1];
            CHECK(s.growth->stats().hash == ((high << 32) | uint32_t(low)));
        }
    }
}

TEST_CASE("a plant that is put in and taken out, over and over, leaves nothing behind") {
    for (const bool native : {false, true}) {
        CAPTURE(native);
        Session s(ball());
        s.scene.native = native;
        s.scene.plantMany(12, 0, 1);
        s.check();
        const GrowthStats whole = s.growth->stats();
        Result<GrowthRecords> records = s.growth->read();
        REQUIRE(records);
        const std::vector<Seed> all = s.scene.seeds();
        const std::vector<FrozenPlant> plant = {{all[3].key, std::make_shared<PlantRecords>(plantOf(*records, 3))}};
        for (int round = 0; round < 4; ++round) {
            s.scene.seeds().erase(s.scene.seeds().begin() + 3);
            s.scene.frozen = plant;
            s.changes.frozen = {all[3].key};  // what stands there isn't asked
            s.grow();
            CHECK(s.growth->stats().hash == whole.hash);
            CHECK(s.growth->stats().leaves == whole.leaves);
            s.scene.seeds() = all;
            s.scene.frozen.clear();
            s.check();
            CHECK(s.growth->stats().hash == whole.hash);
        }
        CHECK(s.growth->stats().regrowths == 8);
    }
}

TEST_CASE("bytes that aren't a plant are refused") {
    Session s(flatSquare());
    s.scene.plantMany(4, 0, 1);
    s.check();
    Result<GrowthRecords> records = s.growth->read();
    REQUIRE(records);
    PlantRecords plant;  // the largest
    for (uint32_t seed = 0; seed < 4; ++seed)
        if (PlantRecords other = plantOf(*records, seed); other.nodes.size() > plant.nodes.size())
            plant = std::move(other);
    REQUIRE(plant.branches.size() > 1);
    const std::vector<std::byte> bytes = packPlant(plant);
    CHECK(unpackPlant(bytes, 1));
    CHECK(!unpackPlant(bytes, 0));
    for (size_t size : {size_t(0), size_t(7), size_t(31), bytes.size() - 1})
        CHECK(!unpackPlant(std::span(bytes).first(size), 1));
    for (size_t at = 0; at < bytes.size(); at += 13) {
        std::vector<std::byte> other = bytes;
        other[at] ^= std::byte(64);
        CHECK(!unpackPlant(other, 1));
    }
    // Well packed, and yet no plant.
    const auto refused = [&](auto&& spoil) {
        PlantRecords spoilt = plant;
        spoil(spoilt);
        CHECK(!unpackPlant(packPlant(spoilt), 1));
    };
    refused([](PlantRecords& p) { p.nodes[0].chunk = 9999; });
    refused([](PlantRecords& p) { p.nodes[0].position.x = NAN; });
    refused([](PlantRecords& p) { p.nodes[0].radius = -1; });
    refused([](PlantRecords& p) { p.chunks[0].next = 0; });
    refused([](PlantRecords& p) { p.chunks[0].firstNode = 9999; });
    refused([](PlantRecords& p) { p.chunks[0].firstChild = 0; });
    refused([](PlantRecords& p) { p.chunks.back().nextSibling = uint32_t(p.chunks.size() - 1); });
    refused([](PlantRecords& p) { p.branches[0].firstChunk = kNoIndex; });
    refused([](PlantRecords& p) { p.leaves[0].node = uint32_t(p.nodes.size()); });
    refused([](PlantRecords& p) { p.nodes[0].flags ^= 7u << 8; });    // not its index in its chunk
    refused([](PlantRecords& p) { p.nodes.push_back(p.nodes[0]); });  // of no chunk
    refused([](PlantRecords& p) { p.nodes[0].position.x = 1e30f; });
    refused([](PlantRecords& p) { p.nodes[0].radius = 1e30f; });
    refused([](PlantRecords& p) { p.chunks[0].entry.uv.x = NAN; });
    refused([](PlantRecords& p) { p.branches.push_back(p.branches[0]); });
    refused([](PlantRecords& p) { p.branches[0].firstChunk = p.branches[1].firstChunk; });
    refused([](PlantRecords& p) {  // starts from a node of its own
        Chunk& first = p.chunks[p.branches[0].firstChunk];
        first.previousNode = first.firstNode;
    });
    refused([](PlantRecords& p) {  // another branch carries it on
        for (Chunk& c : p.chunks)
            for (uint32_t at = c.firstChild; at != kNoIndex; at = p.chunks[at].nextSibling)
                if (p.chunks[at].branch != c.branch) c.next = at;
    });
}
