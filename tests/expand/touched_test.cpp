// What regrowths note of the nodes that they write is all that has changed in what lay there before.
#include <doctest/doctest.h>

#include <cstring>

#include "tests/expand/session.hpp"

using namespace espalier;
using namespace espalier::growthtest;

namespace {

struct Raw {
    GrowthView view;
    std::vector<Node> nodes;
    std::vector<Chunk> chunks;
    std::vector<Leaf> leaves;
};
Raw rawOf(Session& s) {
    Raw raw{s.growth->view(), {}, {}, {}};
    raw.nodes = *readVector<Node>(s.gpu.device(), *raw.view.nodeBuffer, 0, raw.view.nodeCount);
    raw.chunks = *readVector<Chunk>(s.gpu.device(), *raw.view.chunkBuffer, 0, raw.view.chunkCount);
    raw.leaves = *readVector<Leaf>(s.gpu.device(), *raw.view.leafBuffer, 0, raw.view.leafCount);
    return raw;
}

}  // namespace

TEST_CASE("every node that an edit has written says so, few others do") {
    Session s(flatSquare());
    for (int i = 0; i < 40; ++i) s.scene.plant({-0.75f, 0, -0.78f + 0.04f * float(i)}, {1, 0, 0}, 0, uint64_t(i));
    s.grow();
    CHECK(s.growth->view().renewed == s.growth->view().number);
    Raw before = rawOf(s);
    for (int stroke = 0; stroke < 6; ++stroke) {
        CAPTURE(stroke);
        s.dab(uint32_t(stroke == 3), {0.3f + 0.08f * float(stroke), 0.5f}, 0.04f, stroke % 2 ? 1.0f : 0.3f);
        s.grow();
        const Raw after = rawOf(s);
        if (after.view.renewed != before.view.renewed) {  // gaps were closed
            before = after;
            continue;
        }
        CHECK(after.view.number == before.view.number + 1);
        REQUIRE(after.view.touched != nullptr);
        const auto touched = *readVector<uint32_t>(s.gpu.device(), *after.view.touched, 0, before.view.nodeCount);
        const auto wrote = [&](uint32_t node) {
            return node >= before.view.nodeCount || touched[node] > before.view.number;
        };
        uint32_t missed = 0, changed = 0, marked = 0;
        for (uint32_t i = 0; i < before.view.nodeCount; ++i) {
            const bool other = std::memcmp(&before.nodes[i], &after.nodes[i], sizeof(Node)) != 0;
            changed += other;
            marked += wrote(i);
            missed += other && !wrote(i);
        }
        for (uint32_t i = 0; i < before.view.leafCount; ++i)
            missed += before.leaves[i].node != after.leaves[i].node && !wrote(before.leaves[i].node);
        for (uint32_t c = 0; c < before.view.chunkCount; ++c) {
            const Chunk &a = before.chunks[c], &b = after.chunks[c];
            if (chunkNodes(b.marks) == 0 || a.firstNode != b.firstNode || b.branch == kNoIndex) continue;
            missed += a.previousNode != b.previousNode && !wrote(b.previousNode);
        }
        CHECK(missed == 0);
        CHECK(changed > 0);
        CHECK(marked < 3 * changed + 100);
        CHECK(marked < before.view.nodeCount / 2);
        before = after;
    }
}
