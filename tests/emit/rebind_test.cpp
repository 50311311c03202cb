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

// A plant as it was and as an edit left it, in the same buffers.
struct Edited {
    test::PlantData before, after;
    std::vector<uint32_t> touched;
};

// Moves and thickens nodes of which branches leave, takes a twig out with its leaves, adds one, moves leaves.
Edited edited() {
    Edited e{test::wallIvy(8, 2, 1.5f), {}, {}};
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
    return e;
}

template <class T>
void overwrite(Commands& commands, const Buffer& buffer, const std::vector<T>& values) {
    REQUIRE(commands.upload(buffer, values));
}

}  // namespace

TEST_CASE("an edit binds what it concerns, and leaves what binding everything leaves") {
    const std::shared_ptr<Device> device = test::validatedDevice();
    Edited e = edited();
    test::Plant plant = test::upload(*device, e.after);
    const Buffer touched = std::move(*makeBuffer(*device, "touched", e.touched));
    EmitView views[2] = {};
    views[0].flags = kFullDetail;
    views[0].lodPixels = 1;
    views[1] = parallelView(glm::mat4(1), 120, 1);  // thinned out
    for (glm::vec4& plane : views[1].planes) plane = glm::vec4(0, 0, 0, 1);
    for (const EmitView& view : views) {
        test::EmitPipeline often(device), once(device);
        const auto write = [&](const test::PlantData& data) {
            Result<Commands> commands = Commands::begin(*device, "edit");
            REQUIRE(commands);
            overwrite(*commands, plant.nodes, data.nodes);
            overwrite(*commands, plant.chunks, data.chunks);
            overwrite(*commands, plant.leaves, data.leaves);
            REQUIRE(commands->finish());
            plant.view.nodeCount = uint32_t(data.nodes.size());
            plant.view.chunkCount = uint32_t(data.chunks.size());
            plant.view.leafCount = uint32_t(data.leaves.size());
            plant.view.revision += 1;
        };
        write(e.before);
        plant.view.number = plant.view.renewed = 1;
        plant.view.touched = &touched;
        often.cull(plant.inputs(), view);
        CHECK(often.emit.stats().bound == plant.view.nodeCount + plant.view.leafCount);
        write(e.after);
        plant.view.number = 2;
        const EmitState part = often.cull(plant.inputs(), view);
        const uint32_t bound = often.emit.stats().bound;
        CHECK(bound > 0);
        CHECK(bound < (plant.view.nodeCount + plant.view.leafCount) / 2);
        const EmitState whole = once.cull(plant.inputs(), view);
        CHECK(once.emit.stats().bound == plant.view.nodeCount + plant.view.leafCount);
        CHECK(whole.spanCount > 300);
        CHECK(part.fullTriangles == whole.fullTriangles);
        CHECK(std::memcmp(part.counts, whole.counts, sizeof part.counts) == 0);
        CHECK(std::memcmp(part.draws, whole.draws, sizeof part.draws) == 0);
        const auto drawn = [&](test::EmitPipeline& p) {
            return *readVector<DrawnItem>(*device, p.emit.drawn(), 0, whole.spanCount + whole.leafCount);
        };
        const auto a = drawn(often), b = drawn(once);
        CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(DrawnItem)) == 0);
        const auto sameInstances = [&](const Buffer& x, const Buffer& y, size_t bytes, size_t count) {
            const auto p = *readVector<std::byte>(*device, x, 0, bytes * count);
            const auto q = *readVector<std::byte>(*device, y, 0, bytes * count);
            size_t others = 0;
            for (size_t i = 0; i < a.size(); ++i) {
                if ((i < whole.spanCount) != (bytes == sizeof(SpanInstance))) continue;
                others += std::memcmp(&p[a[i].item * bytes], &q[a[i].item * bytes], bytes) != 0;
            }
            return others == 0;
        };
        CHECK(sameInstances(often.emit.spanInstances(), once.emit.spanInstances(), sizeof(SpanInstance),
                            plant.view.nodeCount));
        CHECK(sameInstances(often.emit.leafInstances(), once.emit.leafInstances(), sizeof(LeafInstance),
                            plant.view.leafCount));
        // Nodes elsewhere: all again.
        plant.view.number = plant.view.renewed = 3;
        plant.view.revision += 1;
        often.cull(plant.inputs(), view);
        CHECK(often.emit.stats().bound == plant.view.nodeCount + plant.view.leafCount);
    }
}
