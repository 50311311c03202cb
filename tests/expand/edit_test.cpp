// After any edits, growing only what they concern gives what growing everything anew gives: by the structure's hash of
// the CPU reference, which knows nothing of edits, and by all counts.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "shaders/shared/exact.h"
#include "shaders/shared/random.h"
#include "tests/expand/scene.hpp"

using namespace espalier;
using namespace espalier::growthtest;

namespace {

// Stems that a mask leads, twigs of twigs; bark thins towards tips and so depends on where a branch ends; leaves read
// another layer than the rules do.
const char* kGuided = R"(
context mask = 1
context cover = 1
param reach = 40 [0 .. 1000] "steps" "Steps"
param stride = 0.04 [0.01 .. 1] "m" "Step"
param leafSize = 0.04 [0.01 .. 1] "m" "Leaves"
param twigs = 0.3 [0 .. 1] "" "Twigs"
Stem(n) -> Marching(stride, rand(-0.3, 0.3), mask(texCoord) > 0.5 and n < reach) {Fork(n + 1), Cover}
Fork(n) -> Branch(2) {Twig(0, rand(0, 12)), Stem(n)} : 0.3
Fork(n) -> Stem(n) : 0.7
Twig(n, k) -> Marching(stride * 0.7, rand(-0.6, 0.6), mask(texCoord) > 0.5 and n < k) {Bud(n + 1, k), Cover}
Bud(n, k) : rand() < twigs -> Branch(2) {Tip(0), Twig(n, k)}
Bud(n, k) -> Twig(n, k)
Tip(n) -> Marching(0.02, rand(-1, 1), n < 3) {Tip(n + 1), Cover}
Cover -> Bark Leaves
Bark -> S(0.002 + 0.01 * clamp(toTip / 0.5, 0, 1)) Shape("bark", C1)
Leaves -> Repeat(floor(rand(0, 3) * cover(texCoord))) { T(rand(), 0.01) R(rand(-1, 1), 0.4) S(leafSize * rand(0.6, 1)) Shape("leaf") }
)";

const char* kPlain = R"(
param reach = 25 [0 .. 1000] "steps" "Steps"
Stem(n) -> Marching(0.05, rand(-0.2, 0.2), n < reach) {Fork(n + 1), Bark}
Fork(n) -> Branch(2) {Twig(0), Stem(n)} : 0.2
Fork(n) -> Stem(n) : 0.8
Twig(n) -> Marching(0.03, rand(-0.5, 0.5), n < 6) {Twig(n + 1), Bark}
Bark -> S(0.01) Shape("bark", C1)
)";

// A scene that is edited, its growth, and notes of the edits since.
class Session {
  public:
    explicit Session(const Model& model, const GrowthRoom& room = {})
        : scene(Scene::baked(model)), growth(gpu.growth(room)) {
        changes.everything = false;
        scene.addGrammar(kGuided);
        scene.addGrammar(kPlain);
        for (auto& layer : layers) layer.assign(kSize * kSize, 1.0f);
    }
    ~Session() { growth.reset(); }

    // A round dab that is `value` inside; the texels that it touches are noted.
    void dab(uint32_t layer, glm::vec2 at, float radius, float value) {
        glm::ivec2 low = glm::max(glm::ivec2((at - radius) * float(kSize)), 0);
        glm::ivec2 high = glm::min(glm::ivec2((at + radius) * float(kSize)) + 1, int(kSize));
        for (int y = low.y; y < high.y; ++y)
            for (int x = low.x; x < high.x; ++x)
                if (glm::length((glm::vec2(x, y) + 0.5f) / float(kSize) - at) < radius)
                    layers[layer][size_t(y) * kSize + size_t(x)] = value;
        upload(layer);
        changes.markTexels(0, layer, kSize, uint32_t(low.x), uint32_t(low.y), uint32_t(high.x), uint32_t(high.y));
    }
    void set(uint32_t grammar, const char* name, float value) {
        RuleMap& map = scene.grammar(grammar);
        changes.markParams(grammar, map.setParam(*map.findParam(name), {&value, 1}));
    }
    void upload(uint32_t layer) {
        scene.paint(layer, kSize, [&](glm::vec2 uv) {
            return layers[layer][size_t(uv.y * float(kSize)) * kSize + size_t(uv.x * float(kSize))];
        });
    }
    void grow() {
        scene.changes = &changes;
        Status grown = scene.grow(gpu.device(), *growth);
        if (!grown) FAIL(grown.failure().text());
        changes = {.everything = false, .cells = {}, .params = {}, .grammars = {}};
    }
    void check() {
        grow();
        Result<CpuGrowth> whole = scene.growOnCpu();
        REQUIRE(whole);
        const GrowthStats s = growth->stats();
        const GrowthStats& w = whole->stats;
        CHECK(s.hash == w.hash);
        CHECK(s.nodes == w.nodes);
        CHECK(s.chunks == w.chunks);
        CHECK(s.branches == w.branches);
        CHECK(s.leaves == w.leaves);
        CHECK(s.steps == w.steps);
        CHECK(s.inserted == w.inserted);
        CHECK(s.deadEnds == w.deadEnds);
        CHECK(s.stopped == w.stopped);
        Result<GrowthRecords> records = growth->read();
        REQUIRE(records);
        CHECK(records->nodes.size() == w.nodes);
        CHECK(records->leaves.size() == w.leaves);
        const GrowthDifference difference = compareGrowth(*whole, *records);
        CHECK(difference.alike == difference.branches);
        for (const std::string& note : difference.notes) std::printf("  %s\n", note.c_str());
    }

    static constexpr uint32_t kSize = 256;
    TestDevice gpu;
    Scene scene;
    std::unique_ptr<Growth> growth;
    GrowthChanges changes;
    std::array<std::vector<float>, 2> layers;
};

// Cuts a branch away, or lets one that was cut grow again.
void prune(Session& s, uint64_t draw) {
    std::vector<uint64_t>& pruned = s.scene.pruned;
    Result<GrowthRecords> records = s.growth->read();
    REQUIRE(records);
    if (!pruned.empty() && draw % 3 == 0) {
        pruned.erase(pruned.begin() + long(draw / 3 % pruned.size()));
    } else if (!records->branches.empty()) {
        const BranchRecord& b = records->branches[draw / 3 % records->branches.size()];
        const uint64_t key = records->chunks[b.firstChunk].key;
        const auto at = std::lower_bound(pruned.begin(), pruned.end(), key);
        if (at == pruned.end() || *at != key) pruned.insert(at, key);
    }
}

}  // namespace

TEST_CASE("a dab regrows what read it and what follows, and nothing else") {
    Session s(flatSquare());
    for (int i = 0; i < 40; ++i) s.scene.plant({-0.75f, 0, -0.78f + 0.04f * float(i)}, {1, 0, 0}, 0, uint64_t(i));
    s.check();
    const GrowthStats before = s.growth->stats();
    REQUIRE(before.nodes > 1000);
    s.dab(0, {0.5f, 0.5f}, 0.05f, 0);
    s.check();
    CHECK(s.growth->stats().hash != before.hash);
    CHECK(s.growth->stats().regrowths == 1);
    CHECK(s.growth->stats().derived < before.nodes / 2);
    s.dab(0, {0.5f, 0.5f}, 0.05f, 1);
    s.check();
    CHECK(s.growth->stats().hash == before.hash);
    CHECK(s.growth->stats().regrowths == 2);
}

TEST_CASE("a dab where nothing is read does nothing, one that paints what is there ends where it began") {
    Session s(flatSquare());
    for (int i = 0; i < 40; ++i) s.scene.plant({-0.75f, 0, -0.78f + 0.04f * float(i)}, {1, 0, 0}, 0, uint64_t(i));
    s.check();
    const GrowthStats before = s.growth->stats();
    s.dab(0, {0.05f, 0.95f}, 0.01f, 0);
    s.check();
    CHECK(s.growth->stats().derived == 0);
    CHECK(s.growth->stats().expansions == before.expansions);
    s.dab(0, {0.5f, 0.5f}, 0.02f, 1);
    s.check();
    CHECK(s.growth->stats().hash == before.hash);
    CHECK(s.growth->stats().derived > 0);
    CHECK(s.growth->stats().derived < before.nodes / 4);
}

TEST_CASE("every place whose read takes in a changed texel is marked, and few others") {
    uint64_t key = 3;
    for (uint32_t size : {8u, 64u, 200u, 256u, 1024u, 4096u}) {
        const uint32_t x0 = size / 3, x1 = x0 + 1 + size / 16, y0 = size - size / 8, y1 = size;
        GrowthChanges changes;
        changes.markTexels(0, 0, size, x0, y0, x1, y1);
        REQUIRE(changes.cells.size() == 1);
        const auto marked = [&](glm::vec2 uv) {
            const glm::uvec2 cell = glm::min(glm::uvec2(unpackUv(packUv(uv)) * float(kLayerCells)), kLayerCells - 1);
            const uint32_t bit = cell.y * kLayerCells + cell.x;
            return (changes.cells[0].bits[bit / 32] >> (bit % 32) & 1) != 0;
        };
        uint32_t wrong = 0, spare = 0;
        for (int i = 0; i < 20000; ++i) {
            key = mix64(key);
            const glm::vec2 middle = glm::vec2(x0 + x1, y0 + y1) * 0.5f / float(size);
            const glm::vec2 uv = glm::clamp(
                middle + (glm::vec2(uniformRandom(key, 1), uniformRandom(key, 2)) - 0.5f) * 0.2f, 0.0f, 1.0f);
            // The texels of a bilinear read that is clamped at the edge.
            const auto met = [&](float at, uint32_t low, uint32_t end) {
                const float g = std::clamp(at * float(size) - 0.5f, 0.0f, float(size - 1));
                const uint32_t t = uint32_t(g), next = std::min(t + (g > float(t) ? 1u : 0u), size - 1);
                return (t >= low && t < end) || (next >= low && next < end);
            };
            const bool read = met(uv.x, x0, x1) && met(uv.y, y0, y1);
            wrong += read && !marked(uv) ? 1 : 0;
            const float texels = 1.0f + float(size) * 3 / kLayerCells;  // beyond these nothing need be marked
            const bool far = uv.x * float(size) < float(x0) - texels || uv.x * float(size) > float(x1) + texels ||
                             uv.y * float(size) < float(y0) - texels;
            spare += far && marked(uv) ? 1 : 0;
        }
        CAPTURE(size);
        CHECK(wrong == 0);
        CHECK(spare == 0);
    }
}

TEST_CASE("where a condition fails for what isn't asked of the place, no other direction is tried") {
    const char* text = R"(
context mask = 1
Stem(n, k) -> Marching(0.05, rand(-0.3, 0.3), %s) {Fork(n + 1, k), Bark}
Fork(n, k) -> Branch(2) {Stem(0, k / 2), Stem(n, k)} : 0.3
Fork(n, k) -> Stem(n, k) : 0.7
Start -> Stem(0, 12)
Bark -> S(0.01) Shape("bark", C1)
)";
    const auto grown = [&](const char* condition) {
        Scene scene = Scene::baked(ball());
        char rules[1024];
        std::snprintf(rules, sizeof rules, text, condition);
        scene.addGrammar(rules);
        scene.plantMany(12);
        for (Seed& seed : scene.seeds()) seed.symbol = *scene.grammar(0).findSymbol("Start");
        Result<CpuGrowth> growth = scene.growOnCpu();
        REQUIRE(growth);
        return growth->stats;
    };
    const GrowthStats plain = grown("n < k");
    CHECK(plain.deadEnds == 0);
    REQUIRE(plain.nodes > 200);
    for (const char* condition :
         {"mask(texCoord) > 0.5 and n < k", "n < k and mask(texCoord)", "n < 99 and (mask(texCoord) > 0.5 and n < k)",
          "arc < 100 and n < k and height > -9"}) {
        CAPTURE(condition);
        const GrowthStats stats = grown(condition);
        CHECK(stats.hash == plain.hash);
        CHECK(stats.deadEnds == 0);
    }
    // One that asks the place in either part tries them all.
    CHECK(grown("n < k or mask(texCoord) < 0.5").deadEnds > 0);
}

TEST_CASE("gaps are closed in passing: however many edits, none grows everything anew") {
    Session s(flatSquare(), GrowthRoom{64, 256, 64, 256, 64});
    s.scene.plantMany(60, 0, 1);
    s.check();
    const uint64_t hash = s.growth->stats().hash;
    uint32_t derived = 0;
    for (int i = 0; i < 24; ++i) {
        const glm::vec2 at(0.3f + 0.02f * float(i), 0.5f);
        s.dab(0, at, 0.1f, 0);
        s.grow();
        s.dab(0, at, 0.1f, 1);
        s.grow();
        derived += s.growth->stats().derived;
        CHECK(s.growth->view().nodeCount < 2 * s.growth->stats().nodes);
        CHECK(s.growth->view().leafCount < 2 * s.growth->stats().leaves);
    }
    CHECK(derived > 2 * s.growth->stats().nodes);
    CHECK(s.growth->stats().regrowths == 48);
    s.check();
    CHECK(s.growth->stats().hash == hash);
    s.changes.everything = true;
    s.check();
}

TEST_CASE("nothing changed: nothing is done") {
    Session s(cube());
    s.scene.plantMany(9, 0);
    s.check();
    const GrowthStats before = s.growth->stats();
    const uint64_t revision = s.growth->view().revision;
    for (int i = 0; i < 3; ++i) s.grow();
    CHECK(s.growth->stats().expansions == before.expansions);
    CHECK(s.growth->view().revision == revision);
    CHECK(s.growth->stats().derived == 0);
}

TEST_CASE("seeds that come and go touch their own plants only") {
    Session s(ball());
    s.scene.plantMany(20, 0, 1);
    s.scene.plantMany(20, 1, 2);
    s.check();
    const uint32_t nodes = s.growth->stats().nodes;
    s.scene.seeds().erase(s.scene.seeds().begin() + 7);
    s.check();
    CHECK(s.growth->stats().derived == 0);
    s.scene.plantMany(1, 0, 3);
    s.check();
    CHECK(s.growth->stats().derived > 0);
    CHECK(s.growth->stats().derived < nodes / 8);
    std::swap(s.scene.seeds()[2], s.scene.seeds()[30]);
    s.check();
    CHECK(s.growth->stats().derived == 0);
    Result<GrowthRecords> records = s.growth->read();
    REQUIRE(records);
    for (const BranchRecord& b : records->branches) {
        if (b.firstChunk == kNoIndex) continue;
        uint32_t root = b.firstChunk;
        while (records->chunks[root].parent != kNoIndex) root = records->chunks[root].parent;
        CHECK(s.scene.seeds()[b.seed].key == records->chunks[root].key);
    }
    s.scene.seeds()[3].walk.direction = {0.3f, -0.2f, 0.9f};
    s.check();
    s.scene.clearSeeds();
    s.check();
    CHECK(s.growth->stats().nodes == 0);
}

TEST_CASE("a parameter regrows what uses it: rules, terminals, or another grammar's plants not at all") {
    Session s(ball());
    s.scene.plantMany(15, 0, 1);
    s.scene.plantMany(15, 1, 2);
    s.check();
    s.set(0, "leafSize", 0.05f);
    s.check();
    CHECK(s.growth->stats().derived == 0);
    CHECK(s.growth->stats().regrowths == 1);
    s.set(0, "twigs", 0.5f);
    s.check();
    s.set(1, "reach", 12);
    s.check();
    CHECK(s.growth->stats().derived > 0);
}

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

TEST_CASE("bytes that aren't a plant are refused") {
    Session s(flatSquare());
    s.scene.plantMany(4, 0, 1);
    s.check();
    Result<GrowthRecords> records = s.growth->read();
    REQUIRE(records);
    const PlantRecords plant = plantOf(*records, 0);
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
}

TEST_CASE("random edits in any order end in what a full growth gives") {
    const Model models[] = {flatSquare(), cube(), ball()};
    for (uint32_t m = 0; m < 3; ++m) {
        CAPTURE(m);
        Session s(models[m], m == 1 ? GrowthRoom{256, 4096, 256, 4096, 64} : GrowthRoom{});
        s.scene.fetch = m != 1;
        s.scene.plantMany(25, 0, 1);
        s.scene.plantMany(8, 1, 2);
        s.check();
        uint64_t key = mix64(77 + m);
        auto draw = [&](float low, float high) {
            key = mix64(key);
            return low + (high - low) * uniformRandom(key, 1);
        };
        for (uint32_t i = 0; i < 40; ++i) {
            CAPTURE(i);
            const uint32_t edits = uint32_t(draw(1, 4));
            for (uint32_t k = 0; k < edits; ++k) {
                const float kind = draw(0, 1);
                std::vector<Seed>& seeds = s.scene.seeds();
                if (kind < 0.7f) {
                    const uint32_t layer = draw(0, 1) < 0.8f ? 0 : 1;
                    s.dab(layer, {draw(0, 1), draw(0, 1)}, draw(0.005f, 0.08f), draw(0, 1) < 0.6f ? 0.0f : 1.0f);
                } else if (kind < 0.8f && !seeds.empty()) {
                    seeds.erase(seeds.begin() + long(draw(0, float(seeds.size()) - 0.01f)));
                } else if (kind < 0.83f) {
                    prune(s, mix64(key));
                } else if (kind < 0.9f) {
                    s.scene.plantMany(1, draw(0, 1) < 0.7f ? 0 : 1, 100 + i * 4 + k);
                } else if (kind < 0.95f) {
                    s.set(0, draw(0, 1) < 0.5f ? "leafSize" : "twigs", draw(0.02f, 0.6f));
                } else {
                    s.set(1, "reach", floorExact(draw(3, 40)));
                }
            }
            s.check();
        }
        std::printf("model %u: %u expansions, %u of them regrowths\n", m, s.growth->stats().expansions,
                    s.growth->stats().regrowths);
        CHECK(s.growth->stats().regrowths > 20);
    }
}
