#pragma once

// How much of a growth a dab of the brush invalidates, told by its records and by other means than growth's own: the
// nodes whose place lies in the dab, all after them on their branches, and all branches that leave these.

#include <algorithm>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "runtime/expand/growth_data.hpp"
#include "shaders/shared/exact.h"

namespace espalier {

// A round one over the layer's square.
struct Dab {
    glm::vec2 at{0};  // uv
    float radius = 0;
    bool touches(glm::vec2 uv, float reach) const { return glm::length(uv - at) < radius + reach; }
};

// A growth's nodes in the order of their branches, to count what follows from a place.
struct Census {
    std::vector<std::vector<uint32_t>> branches;  // nodes in order
    std::vector<uint32_t> joints, order;          // of each branch; branches, parents first
    std::vector<glm::vec2> uvs;
    std::vector<uint32_t> branchOf, placeOf;  // of each node

    explicit Census(const GrowthRecords& g) {
        branches.resize(g.branches.size());
        joints.assign(g.branches.size(), kNoIndex);
        branchOf.assign(g.nodes.size(), kNoIndex);
        placeOf.assign(g.nodes.size(), 0);
        for (const Node& node : g.nodes) uvs.push_back(unpackUv(node.uv));
        for (uint32_t b = 0; b < g.branches.size(); ++b) {
            if (g.branches[b].firstChunk == kNoIndex) continue;
            order.push_back(b);
            joints[b] = g.chunks[g.branches[b].firstChunk].previousNode;
            for (uint32_t c = g.branches[b].firstChunk; c != kNoIndex; c = g.chunks[c].next)
                for (uint32_t i = 0; i < chunkNodes(g.chunks[c].marks); ++i) {
                    branchOf[g.chunks[c].firstNode + i] = b;
                    placeOf[g.chunks[c].firstNode + i] = uint32_t(branches[b].size());
                    branches[b].push_back(g.chunks[c].firstNode + i);
                }
        }
        // Where branches lie in the buffers differs from run to run: by their keys, every run draws the same dabs.
        const auto rank = [&](uint32_t b) {
            const Chunk& first = g.chunks[g.branches[b].firstChunk];
            return std::pair(first.depth & 0xFFFF, first.key);
        };
        std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return rank(a) < rank(b); });
    }

    // reach: how far beside a node's place its growth reads, uv.
    uint32_t invalidatedBy(const Dab& dab, float reach) const {
        std::vector<uint32_t> from(branches.size(), kNoIndex);  // the first node of it that is invalidated
        uint32_t count = 0;
        for (uint32_t b : order) {
            const uint32_t joint = joints[b];
            bool whole = joint != kNoIndex && from[branchOf[joint]] <= placeOf[joint];
            uint32_t first = 0;
            while (!whole && first < branches[b].size() && !dab.touches(uvs[branches[b][first]], reach)) ++first;
            if (first < branches[b].size()) {
                from[b] = first;
                count += uint32_t(branches[b].size()) - first;
            }
        }
        return count;
    }
};

}  // namespace espalier
