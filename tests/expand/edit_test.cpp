// After any edits, growing only what they concern gives what growing everything anew gives.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "runtime/gpu/commands.hpp"
#include "shaders/shared/exact.h"
#include "shaders/shared/expand_again.h"
#include "shaders/shared/random.h"
#include "tests/expand/session.hpp"

using namespace espalier;
using namespace espalier::growthtest;

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
            return readsCells({changes.cells[0].bits.data()}, 0, unpackUv(packUv(uv)));
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
            // Beyond these nothing need be marked: half a texel or cell, a cell that holds the last part of what is
            // marked, and what is allowed for nodes' places.
            const float cell = float(size) / kLayerCells, texels = std::max(0.5f, 0.5f * cell) + 1.02f * cell;
            const bool far = uv.x * float(size) < float(x0) - texels || uv.x * float(size) > float(x1) + texels ||
                             uv.y * float(size) < float(y0) - texels;
            spare += far && marked(uv) ? 1 : 0;
        }
        CAPTURE(size);
        CHECK(wrong == 0);
        CHECK(spare == 0);
    }
}

namespace {

// Long steps on a coarse ball: edges of triangles lie between their ends. Leaves alone read the layer.
constexpr const char* kLongSteps = R"(
context mask = 1
Stem(n) -> Marching(rand(0.1, 0.22), rand(-0.5, 0.5), n < 3) {Fork(n + 1), Cover}
Fork(n) -> Branch(2) {Twig(0), Stem(n)}
Twig(n) -> Marching(rand(0.1, 0.22), rand(-0.6, 0.6), n < 3) {Twig(n + 1), Cover}
Cover -> Bark Leaf
Bark -> S(0.005) Shape("bark", C1)
Leaf -> S(0.01 + 0.1 * mask(texCoord)) Shape("leaf")
)";

// Whether the tile of a place is among those that the chunk has read.
bool hasRead(const Chunk& chunk, glm::vec2 uv) {
    const uint32_t level = readLevelOf(chunk.marks);
    if (level > kMaxReadLevel) return true;
    const glm::uvec2 tile = glm::min(glm::uvec2(uv * float(kLayerTiles)), kLayerTiles - 1) >> level;
    bool found = false;
    for (uint32_t i = 1; i <= kReadTiles; ++i)
        found = found || ((chunk.reads[i >> 1] >> (16 * (i & 1))) & 0xFFFF) == (tile.y << 8 | tile.x);
    return found;
}

}  // namespace

TEST_CASE("what a leaf reads between the ends of a step is known of, and regrown when it is painted") {
    Session s(ball());
    s.write(0, kLongSteps);
    s.changes.everything = true;
    s.scene.plantMany(200, 0, 1);
    s.check();
    Result<GrowthRecords> records = s.growth->read();
    REQUIRE(records);
    uint32_t inserted = 0, unread = 0;
    for (const Node& node : records->nodes) {
        if ((node.flags & kNodeInserted) == 0) continue;
        const glm::vec2 uv = unpackUv(node.uv);
        const bool known = hasRead(records->chunks[node.chunk], uv);
        unread += known ? 0 : 1;
        if (++inserted % 16 != 0 && (known || unread > 40)) continue;
        constexpr uint32_t kSide = Session::kSize;
        const glm::uvec2 texel(uv * float(kSide));  // the nearest of those that a bilinear read takes in
        s.layers[0][texel.y * kSide + texel.x] = 0.25f;
        s.upload(0);
        s.changes.markTexels(0, 0, kSide, texel.x, texel.y, texel.x + 1, texel.y + 1);
        s.grow();
        CHECK(s.growth->stats().derived > 0);
    }
    CHECK(inserted > 100);
    CHECK(unread == 0);
    s.check();
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

namespace {

std::vector<Node> nodesOf(Session& s) {
    const GrowthView view = s.growth->view();
    return *readVector<Node>(s.gpu.device(), *view.nodeBuffer, 0, view.nodeCount);
}
void overwrite(Session& s, uint32_t index, const Node& node) {
    Result<Commands> commands = Commands::begin(s.gpu.device(), "overwrite");
    REQUIRE(commands);
    REQUIRE(commands->upload(*s.growth->view().nodeBuffer, std::vector<Node>{node}, index * sizeof(Node)));
    REQUIRE(commands->finish());
}

// Whether nothing that the chunk has read lies near `at`.
bool isFarFrom(glm::vec2 at, const Chunk& chunk, const std::vector<Node>& nodes) {
    constexpr float kNear = 0.05f;
    bool far = glm::distance(chunk.entry.uv, at) > kNear;
    for (uint32_t i = 0; i < chunkNodes(chunk.marks); ++i)
        far = far && glm::distance(unpackUv(nodes[chunk.firstNode + i].uv), at) > kNear;
    return far;
}

}  // namespace

// What a node is laid on is known only when the next step goes on from it, so that one may move it. A step that does is
// rare: here the node has been elsewhere before.
TEST_CASE("a kept branch's first node is finished again when the node that it starts from comes to lie elsewhere") {
    for (const bool native : {false, true}) {
        CAPTURE(native);
        Session s(flatSquare());
        s.scene.native = native;
        for (int i = 0; i < 8; ++i) s.scene.plant({-0.75f, 0, -0.7f + 0.2f * float(i)}, {1, 0, 0}, 0, uint64_t(i));
        s.grow();
        const GrowthView view = s.growth->view();
        const std::vector<Node> nodes = nodesOf(s);
        const std::vector<Chunk> chunks = *readVector<Chunk>(s.gpu.device(), *view.chunkBuffer, 0, view.chunkCount);
        // A branch, and the last node of the chunk that it leaves, which is to be grown again.
        const Chunk* branch = nullptr;
        glm::vec2 at(0);
        for (const Chunk& c : chunks) {
            if (c.parent == kNoIndex || chunkNodes(c.marks) == 0 || c.branch == chunks[c.parent].branch) continue;
            const Chunk& parent = chunks[c.parent];
            if (nodes[c.previousNode].chunk != c.parent) continue;
            at = unpackUv(nodes[parent.firstNode + chunkNodes(parent.marks) - 1].uv);
            branch = &c;
            if (isFarFrom(at, c, nodes)) break;
            branch = nullptr;
        }
        REQUIRE(branch);
        Node foot = nodes[branch->previousNode], first = nodes[branch->firstNode];
        foot.position.y += 1e-4f;
        first.tangent ^= 0x00700070u;
        overwrite(s, branch->previousNode, foot);
        overwrite(s, branch->firstNode, first);

        s.dab(0, at, 0.004f, 1);  // as it is
        s.grow();
        CHECK(s.growth->stats().regrowths == 1);
        REQUIRE(s.growth->view().renewed == view.renewed);
        const std::vector<Node> now = nodesOf(s);
        CHECK(now[branch->previousNode].radius < 0);
        CHECK(now[branch->firstNode].radius >= 0);
        CHECK(now[branch->firstNode].tangent == nodes[branch->firstNode].tangent);
    }
}

TEST_CASE("gaps are closed in passing: however many edits, none grows everything anew") {
    for (const bool native : {false, true}) {
        CAPTURE(native);
        Session s(flatSquare(), GrowthRoom{64, 256, 64, 256, 64});
        s.scene.native = native;
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
}

// Copying all that has grown into more room would be the longest wait of a stroke.
TEST_CASE("native edits find the room that they need before gaps are closed") {
    GrowthRoom barely{4096, 0, 4096, 0, 4096};
    {
        Session s(flatSquare());
        s.scene.plantMany(60, 0, 1);
        s.grow();
        barely.nodes = s.growth->stats().nodes;
        barely.leaves = s.growth->stats().leaves;
    }
    Session s(flatSquare(), barely);
    if (!s.gpu.device().info().cpu) return;
    s.scene.native = true;
    s.scene.plantMany(60, 0, 1);
    s.check();
    CHECK(s.growth->stats().enlarged == 0);
    const Buffer *nodes = s.growth->view().nodeBuffer, *leaves = s.growth->view().leafBuffer;
    const uint32_t renewed = s.growth->view().renewed;
    for (int i = 0; i < 48; ++i) {
        s.dab(0, {0.3f + 0.01f * float(i), 0.5f}, 0.1f, float(i % 2));
        s.grow();
        CHECK(s.growth->view().nodeBuffer == nodes);
        CHECK(s.growth->view().leafBuffer == leaves);
    }
    CHECK(s.growth->view().renewed > renewed);  // gaps were closed
    s.check();
}

TEST_CASE("native edits of a sixteenth and less close gaps where little room is left, and don't move all") {
    constexpr glm::vec2 kAway(0.5f, 0.75f);
    constexpr float kWide = 0.17f, kBit = 0.04f;
    const auto masked = [&](Session& s) {
        s.scene.native = true;
        s.scene.plantMany(60, 0, 1);
        s.dab(0, kAway, kWide, 0);
        s.changes.everything = true;
        s.grow();
    };
    GrowthRoom barely{4096, 0, 4096, 0, 4096};
    {
        Session s(flatSquare());
        masked(s);
        barely.nodes = s.growth->stats().nodes;
        barely.leaves = s.growth->stats().leaves;
    }
    Session s(flatSquare(), barely);
    if (!s.gpu.device().info().cpu) return;
    masked(s);
    const Buffer *nodes = s.growth->view().nodeBuffer, *leaves = s.growth->view().leafBuffer;
    // Brought back bit by bit.
    for (float y = -kWide; y <= kWide; y += kBit)
        for (float x = -kWide; x <= kWide; x += kBit) {
            s.dab(0, kAway + glm::vec2(x, y), kBit, 1);
            s.grow();
        }
    REQUIRE(s.growth->view().nodeBuffer == nodes);
    const double room = double(nodes->size() / sizeof(Node)) / s.growth->stats().nodes;
    CAPTURE(room);
    REQUIRE(room > 1.14);
    REQUIRE(room < 1.25);
    for (int i = 0; i < 48; ++i) {
        s.dab(0, {0.3f + 0.01f * float(i), 0.15f}, 0.02f, float(i % 2));
        s.grow();
        REQUIRE(s.growth->stats().derived < s.growth->stats().nodes / 16);
        CHECK(s.growth->view().nodeBuffer == nodes);
        CHECK(s.growth->view().leafBuffer == leaves);
    }
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

namespace {

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

// number: of the seed that may be planted.
template <class Draw>
void randomEdit(Session& s, Draw&& draw, uint64_t number) {
    const float kind = draw(0, 1);
    std::vector<Seed>& seeds = s.scene.seeds();
    if (kind < 0.7f) {
        const uint32_t layer = draw(0, 1) < 0.8f ? 0 : 1;
        const glm::vec2 at(draw(0, 1), draw(0, 1));
        const float radius = draw(0.005f, 0.08f);
        s.dab(layer, at, radius, draw(0, 1) < 0.6f ? 0.0f : 1.0f);
    } else if (kind < 0.8f && !seeds.empty()) {
        seeds.erase(seeds.begin() + long(draw(0, float(seeds.size()) - 0.01f)));
    } else if (kind < 0.83f) {
        prune(s, mix64(number));
    } else if (kind < 0.9f) {
        s.scene.plantMany(1, draw(0, 1) < 0.7f ? 0 : 1, number);
    } else if (kind < 0.93f) {
        // Toggles one of these between its two texts.
        const char* const kTwists[][2] = {{"n < 3) {Tip(n + 1)", "n < 5) {Tip(n + 1)"},
                                          {"Branch(2) {Tip(0), Twig(n, k)}", "Branch(2) {Twig(n + 3, k), Twig(n, k)}"},
                                          {"rand(-0.6, 0.6)", "rand(-0.4, 0.8)"},
                                          {"Fork(n) -> Stem(n) : 0.7", "Fork(n) -> Stem(n) : 0.9"},
                                          {"Bark Leaves\n", "Leaves Bark\n"},
                                          {"rand(0, 3) * cover", "rand(1, 2) * cover"}};
        const auto& twist = kTwists[mix64(number) % std::size(kTwists)];
        const bool there = s.text.find(twist[0]) != std::string::npos;
        s.rewrite(twist[there ? 0 : 1], twist[there ? 1 : 0]);
    } else if (kind < 0.96f) {
        const char* name = draw(0, 1) < 0.5f ? "leafSize" : "twigs";
        s.set(0, name, draw(0.02f, 0.6f));
    } else {
        s.set(1, "reach", floorExact(draw(3, 40)));
    }
}

}  // namespace

// By shaders, and by the native code that software devices run instead.
TEST_CASE("random edits in any order end in what a full growth gives") {
    const Model models[] = {flatSquare(), cube(), ball()};
    for (uint32_t run = 0; run < 6; ++run) {
        const uint32_t m = run % 3;
        const bool native = run >= 3;
        CAPTURE(m);
        CAPTURE(native);
        Session s(models[m], m == 1 ? GrowthRoom{256, 4096, 256, 4096, 64} : GrowthRoom{});
        if (native && !s.gpu.device().info().cpu) break;
        s.scene.native = native;
        s.scene.plantMany(25, 0, 1);
        s.scene.plantMany(8, 1, 2);
        s.check();
        uint64_t key = mix64(77 + run);
        auto draw = [&](float low, float high) {
            key = mix64(key);
            return low + (high - low) * uniformRandom(key, 1);
        };
        for (uint32_t i = 0; i < 40; ++i) {
            CAPTURE(i);
            const uint32_t edits = uint32_t(draw(1, 4));
            for (uint32_t k = 0; k < edits; ++k) randomEdit(s, draw, 100 + i * 4 + k);
            s.check();
            if (native) CHECK(s.growth->stats().native);
        }
        std::printf("model %u, %s: %u expansions, %u of them regrowths\n", m, native ? "native" : "shaders",
                    s.growth->stats().expansions, s.growth->stats().regrowths);
        CHECK(s.growth->stats().regrowths > 20);
    }
}
