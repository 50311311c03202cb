#pragma once

// The plants as the CPU knows them, for picking and for showing a branch's way: read back once a growth, when asked.

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "runtime/expand/growth_data.hpp"

namespace espalier {

struct PlantHit {
    uint32_t branch = 0;  // index
    glm::vec3 position{0};
    float distance = 0;  // along the ray, metres
};

// Why a branch goes no further: see EspBranchEnd.
enum class BranchEnd { byRules, refused, noGround, byLimit };

// How many nodes a plant has, the box around them in the world, and how the seed's own branch ends.
struct PlantExtent {
    uint32_t nodes = 0;
    BranchEnd end = BranchEnd::byLimit;  // of a seed that has left no chunk
    glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
};

class Plants {
  public:
    Plants() = default;
    // toWorld: by surface instance.
    Plants(GrowthRecords records, std::span<const glm::mat4> toWorld);

    // The first span that the ray meets before `limit` metres. Spans thinner than a few thousandths of their distance
    // are taken to be that thick, so that a twig can be hit. direction: unit.
    std::optional<PlantHit> pick(glm::vec3 origin, glm::vec3 direction, float limit) const;

    const GrowthRecords& records() const { return records_; }
    // Index of the branch of this key.
    std::optional<uint32_t> findBranch(uint64_t key) const;
    uint64_t keyOf(uint32_t branch) const { return firstChunk(branch).key; }
    uint32_t seedOf(uint32_t branch) const { return records_.branches[branch].seed; }
    uint32_t depthOf(uint32_t branch) const { return firstChunk(branch).depth & 0xFFFFu; }
    BranchEnd endOf(uint32_t branch) const;  // by its last chunk
    // The branch that it leaves from; nothing: it is a seed's own.
    std::optional<uint32_t> parentOf(uint32_t branch) const;
    // Its nodes in order, beginning with the one that it leaves from, if any.
    std::vector<uint32_t> nodesOf(uint32_t branch) const;
    const Node& node(uint32_t index) const { return records_.nodes[index]; }
    glm::vec3 positionOf(uint32_t node) const { return positions_[node]; }  // world
    // Of a seed's plant, by its index in the growth.
    PlantExtent extentOf(uint32_t seed) const { return seed < extents_.size() ? extents_[seed] : PlantExtent{}; }

  private:
    const Chunk& firstChunk(uint32_t branch) const { return records_.chunks[records_.branches[branch].firstChunk]; }

    void noteBare();

    struct Span {
        uint32_t from, to;  // nodes
        uint32_t branch;
    };
    GrowthRecords records_;
    std::vector<glm::vec3> positions_;
    std::vector<Span> spans_;
    std::vector<PlantExtent> extents_;  // by seed
};

}  // namespace espalier
