#pragma once

// The weighted straight skeleton of a polygon with holes, as a plane graph of arcs between faces.

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "runtime/core/result.hpp"

namespace espalier {

// One piece of the border between two faces. Heights never fall from `from` to `to` where a corner of the wavefront
// drew it; ridges and breaks are level.
struct SkeletonArc {
    uint32_t from, to;     // nodes
    uint32_t left, right;  // faces beside it, seen along from -> to
};

struct SkeletonFace {
    uint32_t edge;              // of the input: running number over its rings
    uint32_t tier;              // 1: above the break
    uint32_t eaveFrom, eaveTo;  // nodes, in the ring's direction
};

// What moves in: rings as in RoofHouse (simple, disjoint, no repeated corners), and how far each edge goes inwards
// while the roof rises by a metre (the cotangent of its pitch). 0: a gable, whose edge stays where it is.
struct SkeletonInput {
    std::vector<std::vector<glm::dvec2>> rings;
    std::vector<double> speeds;  // an edge each, >= 0, not all 0
    // From this height on edges go by speedsAbove; those whose speed differs then begin a face of tier 1.
    double breakHeight = std::numeric_limits<double>::infinity();
    std::vector<double> speedsAbove;
    bool breakAll = false;  // at the break every edge begins a face of tier 1
};

struct Skeleton {
    std::vector<glm::dvec3> nodes;    // x, y, height; the first are the rings' corners in order
    std::vector<SkeletonFace> faces;  // the first are the edges' in order
    std::vector<SkeletonArc> arcs;
};

// How the wavefront is computed. Every way treats ties by the same rules; what it returns is only as good as its
// numbers, so the caller checks it and goes on to the next.
enum class Precision { fast /* double */, high /* 113 bits */ };

// None: the events contradicted each other (the next precision, or corners moved by a hair, may do).
// Any thread; about 0.5 us a corner for small polygons, O(corners * reflex corners) for large ones. work: edges that
// reflex corners may look at, a high precision one counting for several; what was used is taken off, and none is made
// once it is 0.
bool straightSkeleton(const SkeletonInput& input, Precision precision, Skeleton& out, uint64_t& work);

}  // namespace espalier
