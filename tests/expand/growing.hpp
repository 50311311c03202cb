#pragma once

#include <doctest/doctest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "tests/expand/scene.hpp"

// Grammars that tests grow, and what is to be true of whatever grows.
namespace espalier::growthtest {

inline constexpr const char* kStraight = R"(
param reach = 20 [0 .. 100000] "steps" "Steps"
Stem(n) -> Marching(0.05, 0, n < reach) {Stem(n + 1), Bark}
Bark -> S(0.01) Shape("bark", C1)
)";

// Stems with side branches of side branches, bark that thins towards tips, leaves in random number.
inline constexpr const char* kBranching = R"(
param reach = 30 [0 .. 1000] "steps" "Steps"
Stem(n) -> Marching(0.04, rand(-0.3, 0.3), n < reach) {Fork(n + 1), Cover}
Fork(n) -> Branch(2) {Twig(0, rand(0, 12)), Stem(n)}
Twig(n, k) -> Marching(0.03, rand(-0.6, 0.6), n < k) {Bud(n + 1, k), Cover}
Bud(n, k) -> Branch(2) {Tip(0), Twig(n, k)} : 0.2
Bud(n, k) -> Twig(n, k) : 0.8
Tip(n) -> Marching(0.02, rand(-1, 1), n < 3) {Tip(n + 1), Cover}
Cover -> Bark Leaves
Bark -> S(0.002 + 0.01 * clamp(toTip / 0.5, 0, 1)) Shape("bark", C1)
Leaves -> Repeat(floor(rand(0, 3))) { T(rand(), 0.01) R(rand(-1, 1), 0.4) S(0.04 * rand(0.6, 1)) Tint(rand()) Shape("leaf") }
)";

inline constexpr const char* kMasked = R"(
context mask = 1
param reach = 200 [0 .. 1000] "steps" "Steps"
Stem(n) -> Marching(0.04, rand(-0.2, 0.2), mask(texCoord) > 0.5 and n < reach) {Stem(n + 1), Bark}
Bark -> S(0.01) Shape("bark", C1)
)";

inline std::string grammarText(const char* name) {
    std::ifstream file(std::string("content/grammars/") + name);
    std::stringstream all;
    all << file.rdbuf();
    return all.str();
}

inline void mustGrow(Scene& scene, TestDevice& gpu, Growth& growth) {
    Status grown = scene.grow(gpu.device(), growth);
    if (!grown) FAIL(grown.failure().text());
}

inline void checkAlike(Scene& scene, Growth& growth) {
    Result<CpuGrowth> cpu = scene.growOnCpu();
    Result<GrowthRecords> records = growth.read();
    REQUIRE(cpu);
    REQUIRE(records);
    GrowthDifference d = compareGrowth(*cpu, *records);
    for (const std::string& note : d.notes) std::printf("  differs: %s\n", note.c_str());
    CHECK(d.alike * 100ull >= d.branches * 99ull);
    CHECK(growth.stats().nodes == cpu->stats.nodes);
    CHECK(growth.stats().leaves == cpu->stats.leaves);
    CHECK(growth.stats().hash == cpu->stats.hash);
}

// What any growth must be: links that lead where they should, unit vectors, finite numbers.
inline void checkSound(const GrowthRecords& g) {
    bool sound = true;
    std::set<uint64_t> keys;
    for (size_t i = 0; i < g.nodes.size(); ++i) {
        const Node& n = g.nodes[i];
        REQUIRE(n.chunk < g.chunks.size());
        const Chunk& c = g.chunks[n.chunk];
        sound = sound && i >= c.firstNode && i < c.firstNode + chunkNodes(c.marks) &&
                ((n.flags >> 8) & 31) == i - c.firstNode;
        sound = sound && std::isfinite(n.position.x + n.position.y + n.position.z + n.radius + n.arc) && n.radius >= 0;
    }
    for (size_t i = 0; i < g.chunks.size(); ++i) {
        const Chunk& c = g.chunks[i];
        keys.insert(c.key);
        sound = sound && (c.marks & kChunkPublished) && chunkNodes(c.marks) <= kChunkNodes;
        if (c.next != kNoIndex) sound = sound && g.chunks[c.next].parent == i && g.chunks[c.next].branch == c.branch;
        if (c.previousNode != kNoIndex) sound = sound && c.previousNode < g.nodes.size();
    }
    CHECK(keys.size() == g.chunks.size());
    for (const BranchRecord& b : g.branches) {
        sound = sound && g.chunks[b.firstChunk].branch == uint32_t(&b - g.branches.data());
        sound = sound && b.thickness > 0 && b.thickness <= 1;
        uint32_t parent = g.chunks[b.firstChunk].previousNode;
        if (parent == kNoIndex) continue;
        const Node& joint = g.nodes[parent];
        const Node& first = g.nodes[g.chunks[b.firstChunk].firstNode];
        sound = sound && g.chunks[joint.chunk].branch != kNoIndex && first.radius <= joint.radius * 1.00001f;
    }
    for (const Leaf& l : g.leaves) sound = sound && l.node < g.nodes.size();
    CHECK(sound);
}

}  // namespace espalier::growthtest
