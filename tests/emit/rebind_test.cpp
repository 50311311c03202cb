// After edits only what they concern is bound anew, and what is drawn is what binding everything gives: by an emission
// that has never seen the growth before.
#include <doctest/doctest.h>

#include <cstring>

#include "tests/emit/pipeline.hpp"

using namespace espalier;

namespace {

// Chunks know those that they queued.
void linkChunks(test::PlantData& data) {
    for (Chunk& c : data.chunks) c.firstChild = c.nextSibling = kNoIndex;
    for (uint32_t c = 0; c < data.chunks.size(); ++c) {
        if (data.chunks[c].previousNode == kNoIndex) continue;
        Chunk& parent = data.chunks[data.nodes[data.chunks[c].previousNode].chunk];
        data.chunks[c].nextSibling = std::exchange(parent.firstChild, c);
    }
}

// A plant as it was and as an edit and another one left it, in the same buffers. Touched: by all edits up to each.
struct Edited {
    test::PlantData before, after, last;
    std::vector<uint32_t> touched, touchedLast;
};

// Moves and thickens nodes of which branches leave, takes a twig out with its leaves, adds one, moves leaves.
Edited edited() {
    Edited e{test::wallIvy(8, 2, 1.5f), {}, {}, {}, {}};
    linkChunks(e.before);
    e.after = e.before;
    e.touched.assign(e.before.nodes.size(), 1);
    std::vector<uint32_t> joints;
    for (const BranchRecord& branch : e.before.branches)
        if (uint32_t joint = e.before.chunks[branch.firstChunk].previousNode; joint != kNoIndex)
            joints.push_back(joint);
    REQUIRE(joints.size() > 9);
    for (size_t j = 0; j < 3; ++j) {
        Node& node = e.after.nodes[joints[j * 3]];
        node.position.z += 0.01f * float(j + 1);
        node.radius *= 1.7f;
        e.touched[joints[j * 3]] = 2;
    }
    const Chunk& gone = e.after.chunks[e.after.branches.back().firstChunk];
    for (uint32_t n = gone.firstNode; n < gone.firstNode + chunkNodes(gone.marks); ++n) {
        e.after.nodes[n].flags &= 0x1F00u;
        e.after.nodes[n].radius = -1;
        e.touched[n] = 2;
        for (Leaf& leaf : e.after.leaves)
            if (leaf.node == n) leaf.node = kNoIndex;
    }
    std::vector<glm::vec3> points, normals;
    for (int i = 1; i < 50; ++i) {
        points.push_back(e.after.nodes[joints[1]].position + 0.03f * float(i) * glm::vec3(0.6f, 0.8f, 0));
        normals.emplace_back(0, 0, 1);
    }
    const uint32_t first = e.after.addBranch(points, normals, joints[1], [](float s) { return 0.004f * (1.2f - s); });
    for (uint32_t i = 0; i < 40; i += 2) e.after.addLeaf(first + i, 1, 0.07f, i % 4 ? 1.0f : -1.0f, 0.02f, 77 * i);
    linkChunks(e.after);
    // Again, some of the same nodes: of every second one the leaves go, and one gets another.
    e.last = e.after;
    e.touched.resize(e.after.nodes.size(), 2);
    e.touched.resize((e.touched.size() + 3) / 4 * 4);
    e.touchedLast = e.touched;
    for (size_t j = 0; j < 3; ++j) {
        const uint32_t node = joints[j * 3];
        e.last.nodes[node].radius *= 0.8f;
        e.touchedLast[node] = 3;
    }
    for (uint32_t node = first; node < first + 20; node += 4) {
        e.touchedLast[node] = 3;
        for (Leaf& leaf : e.last.leaves)
            if (leaf.node == node) leaf.node = kNoIndex;
    }
    e.last.addLeaf(first, 1, 0.05f, -1.0f, 0.02f, 4711);
    return e;
}

template <class T>
void overwrite(Commands& commands, const Buffer& buffer, const std::vector<T>& values) {
    REQUIRE(commands.upload(buffer, values));
}

// The same draws of the same instances.
void compare(Device& device, test::EmitPipeline& often, const EmitState& part, test::EmitPipeline& once,
             const EmitState& whole) {
    CHECK(part.fullTriangles == whole.fullTriangles);
    CHECK(std::memcmp(part.counts, whole.counts, sizeof part.counts) == 0);
    CHECK(std::memcmp(part.draws, whole.draws, sizeof part.draws) == 0);
    const auto drawn = [&](test::EmitPipeline& p) {
        return *readVector<DrawnItem>(device, p.emit.drawn(), 0, whole.spanCount + whole.leafCount);
    };
    const auto a = drawn(often), b = drawn(once);
    CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(DrawnItem)) == 0);
    const auto sameInstances = [&](const Buffer& x, const Buffer& y, size_t bytes, bool spans) {
        const auto p = *readVector<std::byte>(device, x, 0, x.size());
        const auto q = *readVector<std::byte>(device, y, 0, y.size());
        size_t others = 0;
        for (size_t i = 0; i < a.size(); ++i)
            if ((i < whole.spanCount) == spans)
                others += std::memcmp(&p[a[i].item * bytes], &q[a[i].item * bytes], bytes) != 0;
        return others == 0;
    };
    CHECK(sameInstances(often.emit.spanInstances(), once.emit.spanInstances(), sizeof(SpanInstance), true));
    CHECK(sameInstances(often.emit.leafInstances(), once.emit.leafInstances(), sizeof(LeafInstance), false));
}

}  // namespace

TEST_CASE("an edit binds what it concerns, and leaves what binding everything leaves") {
    const std::shared_ptr<Device> device = test::validatedDevice();
    Edited e = edited();
    test::Plant plant = test::upload(*device, e.last);
    const Buffer touched = std::move(*makeBuffer(*device, "touched", e.touchedLast));
    EmitView views[2] = {};
    views[0].flags = kFullDetail;
    views[0].lodPixels = 1;
    views[1] = parallelView(glm::mat4(1), 120, 1);  // thinned out
    for (glm::vec4& plane : views[1].planes) plane = glm::vec4(0, 0, 0, 1);
    for (int way = 0; way < 4; ++way) {
        const bool texels = way / 2 != 0;  // records by address; on software devices as texels
        const EmitView& view = views[way % 2];
        CAPTURE(way);
        plant.view.nodeBuffer = texels ? &plant.nodes : nullptr;
        plant.view.chunkBuffer = texels ? &plant.chunks : nullptr;
        plant.view.leafBuffer = texels ? &plant.leaves : nullptr;
        plant.view.touched = &touched;
        test::EmitPipeline often(device);
        const auto write = [&](const test::PlantData& data, const std::vector<uint32_t>& numbers) {
            Result<Commands> commands = Commands::begin(*device, "edit");
            REQUIRE(commands);
            overwrite(*commands, plant.nodes, data.nodes);
            overwrite(*commands, plant.chunks, data.chunks);
            overwrite(*commands, plant.leaves, data.leaves);
            overwrite(*commands, touched, numbers);
            REQUIRE(commands->finish());
            plant.view.nodeCount = uint32_t(data.nodes.size());
            plant.view.chunkCount = uint32_t(data.chunks.size());
            plant.view.leafCount = uint32_t(data.leaves.size());
            plant.view.revision += 1;
        };
        write(e.before, e.touched);
        plant.view.number = plant.view.renewed = 1;
        often.cull(plant.inputs(), view);
        CHECK(often.emit.stats().bound == plant.view.nodeCount + plant.view.leafCount);
        for (const bool again : {false, true}) {
            CAPTURE(again);
            write(again ? e.last : e.after, again ? e.touchedLast : e.touched);
            plant.view.number += 1;
            test::EmitPipeline once(device);
            const EmitState part = often.cull(plant.inputs(), view);
            const uint32_t bound = often.emit.stats().bound;
            CHECK(bound > 0);
            CHECK(bound < (plant.view.nodeCount + plant.view.leafCount) / 2);
            const EmitState whole = once.cull(plant.inputs(), view);
            CHECK(once.emit.stats().bound == plant.view.nodeCount + plant.view.leafCount);
            CHECK(whole.spanCount > 300);
            compare(*device, often, part, once, whole);
        }
        // Nodes elsewhere: all again.
        plant.view.renewed = plant.view.number += 1;
        plant.view.revision += 1;
        often.cull(plant.inputs(), view);
        CHECK(often.emit.stats().bound == plant.view.nodeCount + plant.view.leafCount);
    }
}
