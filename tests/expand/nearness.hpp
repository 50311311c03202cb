#pragma once

// How near stems come to each other, over pairs of spans in double precision: for tests of stems that keep a distance.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "runtime/expand/frozen.hpp"

namespace espalier::growthtest {

struct Span {
    glm::dvec3 from, to;
};

inline double distanceToSpan(glm::dvec3 p, const Span& s) {
    const glm::dvec3 along = s.to - s.from;
    const double length = glm::dot(along, along);
    const double t = length > 0 ? std::clamp(glm::dot(p - s.from, along) / length, 0.0, 1.0) : 0.0;
    return glm::length(p - (s.from + along * t));
}

// Where the lines cross between the ends, or else at one of four ends.
inline double distanceOf(const Span& a, const Span& b) {
    const double ends[] = {distanceToSpan(a.from, b), distanceToSpan(a.to, b), distanceToSpan(b.from, a),
                           distanceToSpan(b.to, a)};
    const double best = *std::ranges::min_element(ends);
    const glm::dvec3 u = a.to - a.from, v = b.to - b.from, across = glm::cross(u, v), w = b.from - a.from;
    const double area = glm::dot(across, across);
    if (area < 1e-24) return best;
    const double s = glm::dot(glm::cross(w, v), across) / area, t = glm::dot(glm::cross(w, u), across) / area;
    if (s <= 0 || s >= 1 || t <= 0 || t >= 1) return best;
    return std::min(best, std::abs(glm::dot(w, across)) / std::sqrt(area));
}

// Records with what is asked of them.
struct Plants {
    const GrowthRecords& r;

    uint32_t count(uint32_t chunk) const { return chunkNodes(r.chunks[chunk].marks); }
    Span span(uint32_t chunk, uint32_t index) const {
        const Chunk& c = r.chunks[chunk];
        const uint32_t node = c.firstNode + index, before = index > 0 ? node - 1 : c.previousNode;
        const glm::dvec3 to = r.nodes[node].position;
        return {before == kNoIndex ? to : glm::dvec3(r.nodes[before].position), to};
    }
    uint32_t joint(uint32_t branch) const { return r.chunks[r.branches[branch].firstChunk].previousNode; }
    uint32_t branchOf(uint32_t node) const { return r.chunks[r.nodes[node].chunk].branch; }
    // a leaves b, or both leave one node, and both spans have an end near it.
    bool leaves(uint32_t a, uint32_t b, const Span& one, const Span& other, double reach) const {
        const uint32_t node = joint(a);
        if (node == kNoIndex || (branchOf(node) != b && joint(b) != node)) return false;
        const glm::dvec3 at = r.nodes[node].position;
        const auto near = [&](const Span& s) {
            return std::min(glm::length(s.from - at), glm::length(s.to - at)) <= reach;
        };
        return near(one) && near(other);
    }
};

// How near spans of different branches come, but at joints, by all pairs that could be nearer than `distance`; infinity
// if none is.
inline double nearestOf(const GrowthRecords& records, double distance) {
    const Plants plants{records};
    struct Box {
        Span span;
        double low, high;  // along x
        uint32_t branch;
    };
    std::vector<Box> boxes;
    for (uint32_t c = 0; c < records.chunks.size(); ++c)
        for (uint32_t i = 0; i < plants.count(c); ++i) {
            const Span s = plants.span(c, i);
            boxes.push_back({s, std::min(s.from.x, s.to.x), std::max(s.from.x, s.to.x), records.chunks[c].branch});
        }
    std::ranges::sort(boxes, {}, &Box::low);
    double nearest = std::numeric_limits<double>::infinity();
    const double reach = 3.0001 * distance;
    for (size_t i = 0; i < boxes.size(); ++i)
        for (size_t k = i + 1; k < boxes.size() && boxes[k].low <= boxes[i].high + distance; ++k) {
            const Box &x = boxes[i], &y = boxes[k];
            if (x.branch == y.branch) continue;
            const double d = distanceOf(x.span, y.span);
            if (d >= std::min(nearest, distance)) continue;
            if (!plants.leaves(x.branch, y.branch, x.span, y.span, reach) &&
                !plants.leaves(y.branch, x.branch, y.span, x.span, reach))
                nearest = d;
        }
    return nearest;
}

}  // namespace espalier::growthtest
