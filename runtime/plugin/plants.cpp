// In: a growth's records. Out: spans in world space, and which of them a ray meets.
#include "runtime/plugin/plants.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/core/jobs.hpp"

namespace espalier {
namespace {

constexpr float kLeastRadius = 3e-3f;  // of the distance
constexpr size_t kGrain = 8192;

// How near a ray comes to a segment, and where along the ray.
struct Approach {
    float along, gap;
};
Approach approach(glm::vec3 origin, glm::vec3 direction, glm::vec3 a, glm::vec3 b) {
    const glm::vec3 ab = b - a, oa = a - origin;
    const float length2 = glm::dot(ab, ab), across = glm::dot(ab, direction), to = glm::dot(oa, direction);
    const float sine2 = length2 - across * across;
    float s = sine2 > 1e-12f * length2 ? (across * to - glm::dot(ab, oa)) / sine2 : 0;
    s = std::clamp(s, 0.f, 1.f);
    const float along = std::max(to + s * across, 0.f);
    return {along, glm::length(oa + s * ab - along * direction)};
}

BranchEnd endBy(uint32_t marks) {
    if (marks & kChunkStopped) return BranchEnd::byLimit;
    if (!(marks & kChunkDeadEnd)) return BranchEnd::byRules;
    return marks & kChunkTurnedBack ? BranchEnd::refused : BranchEnd::noGround;
}

}  // namespace

Plants::Plants(GrowthRecords records, std::span<const glm::mat4> toWorld) : records_(std::move(records)) {
    positions_.resize(records_.nodes.size());
    for (size_t i = 0; i < positions_.size(); ++i) {
        const Node& node = records_.nodes[i];
        const uint32_t instance = node.place >> 16;
        const glm::mat4 m = instance < toWorld.size() ? toWorld[instance] : glm::mat4(1);
        positions_[i] = glm::vec3(m * glm::vec4(node.position, 1));
    }
    spans_.reserve(records_.nodes.size());
    for (uint32_t b = 0; b < records_.branches.size(); ++b) {
        const std::vector<uint32_t> nodes = nodesOf(b);
        for (size_t i = 1; i < nodes.size(); ++i) spans_.push_back({nodes[i - 1], nodes[i], b});
        const bool joined = firstChunk(b).previousNode != kNoIndex;
        const uint32_t seed = seedOf(b);
        if (seed >= extents_.size()) extents_.resize(seed + 1);
        extents_[seed].nodes += uint32_t(nodes.size()) - (joined ? 1 : 0);
        if (!joined) extents_[seed].end = endOf(b);
        for (uint32_t node : nodes) {
            extents_[seed].low = glm::min(extents_[seed].low, positions_[node]);
            extents_[seed].high = glm::max(extents_[seed].high, positions_[node]);
        }
    }
    noteBare();
}

BranchEnd Plants::endOf(uint32_t branch) const {
    const Chunk* last = &firstChunk(branch);
    while (last->next != kNoIndex) last = &records_.chunks[last->next];
    return endBy(last->marks);
}

// Seeds whose only chunk is without nodes: they have found no ground, or are pruned.
void Plants::noteBare() {
    for (const Chunk& chunk : records_.chunks) {
        if (chunk.parent != kNoIndex || chunk.branch != kNoIndex) continue;
        if (chunk.firstNode >= extents_.size()) extents_.resize(chunk.firstNode + 1);
        extents_[chunk.firstNode].end = endBy(chunk.marks);
    }
}

std::optional<uint32_t> Plants::parentOf(uint32_t branch) const {
    const uint32_t from = firstChunk(branch).previousNode;
    if (from == kNoIndex) return std::nullopt;
    return records_.chunks[records_.nodes[from].chunk].branch;
}

std::vector<uint32_t> Plants::nodesOf(uint32_t branch) const {
    std::vector<uint32_t> nodes;
    const Chunk& first = firstChunk(branch);
    if (first.previousNode != kNoIndex) nodes.push_back(first.previousNode);
    for (uint32_t c = records_.branches[branch].firstChunk; c != kNoIndex; c = records_.chunks[c].next) {
        const Chunk& chunk = records_.chunks[c];
        for (uint32_t i = 0; i < chunkNodes(chunk.marks); ++i) nodes.push_back(chunk.firstNode + i);
    }
    return nodes;
}

std::optional<uint32_t> Plants::findBranch(uint64_t key) const {
    for (uint32_t b = 0; b < records_.branches.size(); ++b)
        if (keyOf(b) == key) return b;
    return std::nullopt;
}

std::optional<PlantHit> Plants::pick(glm::vec3 origin, glm::vec3 direction, float limit) const {
    struct Best {
        float score = std::numeric_limits<float>::infinity();
        float along = 0;
        size_t span = 0;
    };
    std::vector<Best> pieces((spans_.size() + kGrain - 1) / kGrain);
    parallelFor(spans_.size(), kGrain, [&](size_t begin, size_t end) {
        Best best;
        for (size_t i = begin; i < end; ++i) {
            const Span& span = spans_[i];
            const Approach near = approach(origin, direction, positions_[span.from], positions_[span.to]);
            const float radius = std::max(records_.nodes[span.to].radius, kLeastRadius * near.along);
            // Of spans that lie about as far, the one that is hit best.
            const float score = near.along + 4 * near.gap;
            if (near.gap <= radius && near.along < limit && score < best.score) best = {score, near.along, i};
        }
        pieces[begin / kGrain] = best;
    });
    Best best;
    for (const Best& piece : pieces)
        if (piece.score < best.score) best = piece;
    if (!std::isfinite(best.score)) return std::nullopt;
    return PlantHit{spans_[best.span].branch, origin + best.along * direction, best.along};
}

}  // namespace espalier
