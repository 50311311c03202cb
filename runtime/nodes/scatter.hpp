#pragma once

// Shapes at places, as a step of a program: nothing is written for each instance. What a step alone can't say, which of
// the places there are and which shape each of them has, is a list of places' numbers.

#include "runtime/nodes/node_work.hpp"

namespace espalier {

class Scattering {
  public:
    static constexpr uint32_t kNowhere = ~0u;

    // Of the places at a node's input "points". Fails where those have no positions of their own.
    static Result<Scattering> create(NodeWork& work);

    uint32_t places() const { return count_; }
    // Each place gets one of so many variants: with as many as there are places its own, otherwise any, by chance. A
    // further place leaves the others their variants.
    void vary(uint32_t variants);
    // The first place with a variant; kNowhere: no place has it.
    uint32_t firstOf(uint32_t variant) const { return firsts_[variant]; }

    // Gives the node's output: a shape for each variant, `most` instances at most. Of more, what stands at some places
    // is left away, by chance. A larger `most` keeps all that stands and adds to it.
    Status give(std::span<const Geometry> shapes, uint64_t most);

  private:
    struct Places {
        DeformOp op;
        std::vector<BlockRef> held;
    };
    // Where what is left of `most` ends: all that stands at places before it, and so many instances at `last`.
    struct Cut {
        std::vector<bool> stands;  // [place]
        uint32_t last = kNowhere;
        uint64_t rest = 0;
    };

    explicit Scattering(NodeWork& work) : work_(work) {}
    uint32_t variantOf(uint32_t place) const { return variants_.empty() ? 0 : variants_[place]; }
    Cut cutAt(std::span<const uint64_t> weights, uint64_t most) const;
    Status giveLists(std::span<const Geometry> shapes, const Cut& cut);
    Status firstInstances(const GeometryPart& part, uint64_t instances, Geometry& out);
    Status put(GeometryPart part, const Places& at);

    NodeWork& work_;
    uint32_t count_ = 0, seed_ = 0;
    std::vector<Places> parts_;
    std::vector<uint32_t> variants_;   // [place]; empty: all have the same one
    std::vector<uint32_t> firsts_{0};  // [variant]
    Geometry out_;
};

// Inputs of a node that scatters, without what is scattered where.
std::vector<NodePort> scatterPorts();

}  // namespace espalier
