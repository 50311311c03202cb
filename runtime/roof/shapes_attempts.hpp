#pragma once

// Making a skeleton of a house's plan, by ways each surer and slower than the one before.

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "runtime/roof/skeleton.hpp"
#include "runtime/roof/structure_facets.hpp"

namespace espalier {

// The corners and edges of an outline's rings by running number; edge e goes from corner e to corner next[e]. Metres.
struct OutlineEdges {
    explicit OutlineEdges(const std::vector<std::vector<glm::dvec2>>& rings);

    glm::dvec2 along(size_t e) const { return glm::normalize(corner[next[e]] - corner[e]); }
    double length(size_t e) const { return glm::length(corner[next[e]] - corner[e]); }
    // Sine of the turn at the edge's first corner; > 0: convex.
    double turn(size_t e) const;
    // The edge goes on in the line of the one before.
    bool continues(size_t e) const;

    std::vector<glm::dvec2> corner;
    std::vector<size_t> next, previous;
};

// A skeleton to make, and what becomes of it.
struct RoofPlan {
    SkeletonInput input;
    bool level = false;  // flat: heights count for nothing
};

// All attempts at one house share its work limit, so that no outline takes more than about two seconds. One thread.
class RoofAttempts {
  public:
    // Tries one way after another until `use` is content with the plan's facets. Whether it was with any.
    bool attempt(const RoofPlan& plan, const std::function<bool(Facets&)>& use);

    bool exhausted() const { return work_ == 0; }

  private:
    uint64_t work_ = 150'000'000;  // that is left, see straightSkeleton
};

}  // namespace espalier
