#pragma once

// Which texels a line passes: by this rule texels list crossings, whoever makes the lists.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace espalier {

constexpr double kCrossingGrow = 0.51;  // a texel's half side and the hundredth that lists are grown by

// As whole numbers, within their range; std::floor and std::ceil are calls where the processor is an unknown one.
inline int64_t floorWhole(double x) {
    const int64_t whole = int64_t(x);
    return whole - (double(whole) > x);
}
inline int64_t ceilWhole(double x) {
    const int64_t whole = int64_t(x);
    return whole + (double(whole) < x);
}

// Rows of a texel grid that a segment, grown by the box of half-width `grow`, touches: calls
// row(y, x0, x1) with whole texel numbers, x0 <= x1, for texels as unit squares shrunk to their centres
// (centre (x + .5, y + .5) lies in the grown segment), clipped to [0, size) and to rows [yBegin, yEnd).
template <class Row>
void gridSegment(glm::dvec2 a, glm::dvec2 b, double grow, int64_t size, int64_t yBegin, int64_t yEnd, Row&& row) {
    if (a.y > b.y) std::swap(a, b);
    double dx = b.x - a.x, dy = b.y - a.y;
    int64_t y0 = std::max(yBegin, ceilWhole(a.y - grow - 0.5));
    int64_t y1 = std::min(yEnd - 1, floorWhole(b.y + grow - 0.5));
    for (int64_t y = y0; y <= y1; ++y) {
        double low = double(y) + 0.5 - grow, high = double(y) + 0.5 + grow;
        double t0 = dy > 1e-12 ? std::max(0.0, (low - a.y) / dy) : 0.0;
        double t1 = dy > 1e-12 ? std::min(1.0, (high - a.y) / dy) : 1.0;
        double xa = a.x + dx * t0, xb = a.x + dx * t1;
        int64_t x0 = std::max(int64_t(0), ceilWhole(std::min(xa, xb) - grow - 0.5));
        int64_t x1 = std::min(size - 1, floorWhole(std::max(xa, xb) + grow - 0.5));
        if (x0 <= x1) row(y, x0, x1);
    }
}

}  // namespace espalier
