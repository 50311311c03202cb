#pragma once

// A plant and two edits of it, as growth leaves them in its buffers.

#include <doctest/doctest.h>

#include <utility>

#include "tests/emit/fixture.hpp"

namespace espalier::test {

// Chunks know those that they queued.
inline void linkChunks(PlantData& data) {
    for (Chunk& c : data.chunks) c.firstChild = c.nextSibling = kNoIndex;
    for (uint32_t c = 0; c < data.chunks.size(); ++c) {
        if (data.chunks[c].previousNode == kNoIndex) continue;
        Chunk& parent = data.chunks[data.nodes[data.chunks[c].previousNode].chunk];
        data.chunks[c].nextSibling = std::exchange(parent.firstChild, c);
    }
}

// A plant as it was and as an edit and another one left it, in the same buffers. Touched: by all edits up to each.
struct Edited {
    PlantData before, after, last;
    std::vector<uint32_t> touched, touchedLast;
};

// Moves and thickens nodes of which branches leave, takes a twig out with its leaves, adds one, moves leaves.
inline Edited edited() {
    Edited e{wallIvy(8, 2, 1.5f), {}, {}, {}, {}};
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

// What an edit leaves: `data` in the plant's buffers and `numbers` in the one of nodes that were written.
inline void rewrite(Device& device, Plant& plant, const Buffer& touched, const PlantData& data,
                    const std::vector<uint32_t>& numbers) {
    Result<Commands> commands = Commands::begin(device, "edit");
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
}

}  // namespace espalier::test
