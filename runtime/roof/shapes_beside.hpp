#pragma once

// Neighbours along the edges of a house's outline.

#include <algorithm>
#include <functional>

#include "runtime/roof/footprint.hpp"
#include "runtime/roof/shapes_attempts.hpp"

namespace espalier {

// What stands against an edge of an outline.
struct Beside {
    double top = 0;                        // metres above the ground that a neighbour reaches; 0: none stands there
    bool endsRoof = false, alike = false;  // as of SharedWall

    void add(const Beside& other) {
        top = std::max(top, other.top);
        endsRoof |= other.endsRoof;
        alike |= other.alike;
    }
};

// An outline whose edges are divided where the neighbour beside them begins or ends.
struct DividedOutline {
    std::vector<std::vector<glm::dvec2>> rings;
    std::vector<uint32_t> edges;  // of each edge: which it was
    std::vector<Beside> beside;   // of each edge
};

class OutlineNeighbours {
  public:
    OutlineNeighbours(const std::vector<SharedWall>& shared, glm::dvec2 origin, const OutlineEdges& edges);

    // Whether the roof ends there in a gable if it can. Walls in one line are closed as a whole, where houses of one
    // row stand against at least half of them.
    bool closes(size_t edge) const;
    // whole(edge): it isn't divided; a neighbour at any part of it counts for all of it.
    DividedOutline divide(const std::vector<std::vector<glm::dvec2>>& rings,
                          const std::function<bool(size_t)>& whole) const;

  private:
    struct Stretch {  // of an edge, from one place along it to another
        double from, to;
        Beside beside;
    };
    std::vector<Stretch> stretchesOn(size_t edge, glm::dvec2 origin, const std::vector<SharedWall>& shared) const;
    void closeLines();

    const OutlineEdges& edges_;
    std::vector<std::vector<Stretch>> along_;  // an edge each, in order, without overlaps
};

}  // namespace espalier
