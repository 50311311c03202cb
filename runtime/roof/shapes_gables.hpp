#pragma once

// Which edges of an outline carry gables.

#include <optional>

#include "runtime/roof/footprint.hpp"
#include "runtime/roof/shapes_attempts.hpp"

namespace espalier {

// Where the outline's length lies: along the longer side of the smallest rectangle around it. Unit, plan.
glm::dvec2 lengthOf(const OutlineEdges& edges);

// Where the footprint asks its ridge to lead, by roof:direction (square to it) or roof:orientation. Unit.
std::optional<glm::dvec2> askedRidge(const Footprint& footprint, const OutlineEdges& edges);
// Whether it leads rather along the outline than across it, or the outline is as wide as long.
bool liesAlong(glm::dvec2 ridge, const OutlineEdges& edges);
// Whether no wall runs within 22.5 degrees of it, or square to it.
bool liesBetweenWalls(glm::dvec2 ridge, const OutlineEdges& edges);

class RoofGables {
  public:
    RoofGables(const RepairedOutline& outline, const OutlineEdges& edges, RoofAttempts& attempts)
        : outline_(outline), edges_(edges), attempts_(attempts), gable_(edges.corner.size()) {}

    bool has(size_t edge) const { return gable_[edge]; }

    // Gables on edges that face along the ridge, so that it leads there. False, and none: the ends of its wings give
    // such a ridge by themselves, or no edge faces there.
    bool lay(glm::dvec2 ridge);
    // Gables where neighbours close a wall, but not at both sides of a sharp corner.
    void endAt(const std::vector<bool>& closed);
    // Gables where a hip roof would be a triangle between two convex corners: at the end of a wing. Of two such
    // neighbours the shorter takes it. False: there is no gable at all.
    bool endWings();

  private:
    bool endsWing(size_t e) const;
    std::vector<size_t> wingEnds();
    // Whether the edge meets a gable at a sharp corner.
    bool besideGable(size_t e) const;
    std::vector<size_t> lineOf(size_t e) const;
    glm::dvec2 outward(size_t e) const;

    const RepairedOutline& outline_;
    const OutlineEdges& edges_;
    RoofAttempts& attempts_;
    std::vector<bool> gable_;
};

}  // namespace espalier
