// In: an outline, what is asked of its ridge, walls that neighbours close. Out: edges that carry gables.
#include "runtime/roof/shapes_gables.hpp"

#include <algorithm>
#include <cmath>

namespace espalier {

namespace {

constexpr double kFaces = 0.766;        // cosine of 40 degrees: an edge faces along the ridge
constexpr double kSharp = 0.7;          // cosine of 45 degrees: corners that turn more
constexpr double kWidestGable = 16;     // metres; a wider wall beside a neighbour keeps its eave
constexpr size_t kMostDirections = 16;  // in which an outline's length is looked for

glm::dvec2 turned(glm::dvec2 v) {
    return {-v.y, v.x};
}

// The outline's extent along a direction.
double extent(const OutlineEdges& edges, glm::dvec2 direction) {
    double low = INFINITY, high = -INFINITY;
    for (glm::dvec2 p : edges.corner) {
        low = std::min(low, glm::dot(p, direction));
        high = std::max(high, glm::dot(p, direction));
    }
    return high - low;
}

std::vector<size_t> longestEdges(const OutlineEdges& edges) {
    std::vector<size_t> order(edges.corner.size());
    for (size_t e = 0; e < order.size(); ++e) order[e] = e;
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return edges.length(a) > edges.length(b) + 1e-6; });
    order.resize(std::min(order.size(), kMostDirections));
    return order;
}

}  // namespace

glm::dvec2 lengthOf(const OutlineEdges& edges) {
    double least = INFINITY;
    glm::dvec2 best(1, 0);
    for (size_t e : longestEdges(edges)) {
        const glm::dvec2 along = edges.along(e);
        const double length = extent(edges, along), width = extent(edges, turned(along));
        if (length * width >= least * (1 - 1e-6)) continue;
        least = length * width;
        best = length >= width ? along : turned(along);
    }
    return best;
}

std::optional<glm::dvec2> askedRidge(const Footprint& footprint, const OutlineEdges& edges) {
    if (footprint.direction) return turned({std::sin(*footprint.direction), std::cos(*footprint.direction)});
    if (!footprint.orientation) return {};
    const glm::dvec2 length = lengthOf(edges);
    return *footprint.orientation == RidgeOrientation::along ? length : turned(length);
}

bool liesAlong(glm::dvec2 ridge, const OutlineEdges& edges) {
    const glm::dvec2 length = lengthOf(edges);
    if (extent(edges, length) < 1.05 * extent(edges, turned(length))) return true;
    return std::abs(glm::dot(ridge, length)) > std::abs(glm::dot(ridge, turned(length)));
}

bool liesBetweenWalls(glm::dvec2 ridge, const OutlineEdges& edges) {
    constexpr double kNear = 0.924;  // cosine of 22.5 degrees
    for (size_t e : longestEdges(edges)) {
        const glm::dvec2 along = edges.along(e);
        if (std::max(std::abs(glm::dot(ridge, along)), std::abs(glm::dot(ridge, turned(along)))) > kNear) return false;
    }
    return true;
}

glm::dvec2 RoofGables::outward(size_t e) const {
    return -turned(edges_.along(e));
}

bool RoofGables::lay(glm::dvec2 ridge) {
    const size_t count = gable_.size();
    const auto faces = [&](size_t e) { return std::abs(glm::dot(outward(e), ridge)); };
    if (count == 4) {  // the pair of walls that faces there best
        const size_t first = faces(0) + faces(2) > faces(1) + faces(3) ? 0 : 1;
        gable_[first] = gable_[first + 2] = true;
        return true;
    }
    const std::vector<size_t> ends = liesAlong(ridge, edges_) ? wingEnds() : std::vector<size_t>();
    if (std::any_of(ends.begin(), ends.end(), [&](size_t e) { return faces(e) > kFaces; })) return false;
    bool any = false;
    for (size_t e = 0; e < count; ++e)
        if (faces(e) > kFaces) gable_[e] = any = true;
    return any;
}

std::vector<size_t> RoofGables::lineOf(size_t e) const {
    size_t first = e;
    while (edges_.continues(first) && edges_.previous[first] != e) first = edges_.previous[first];
    std::vector<size_t> line{first};
    while (edges_.continues(edges_.next[line.back()]) && edges_.next[line.back()] != first)
        line.push_back(edges_.next[line.back()]);
    return line;
}

bool RoofGables::besideGable(size_t e) const {
    const auto sharp = [&](size_t corner) {
        return glm::dot(edges_.along(edges_.previous[corner]), edges_.along(corner)) < kSharp;
    };
    const std::vector<size_t> line = lineOf(e);
    const size_t before = edges_.previous[line.front()], behind = edges_.next[line.back()];
    return (gable_[before] && sharp(line.front())) || (gable_[behind] && sharp(behind));
}

// Longest first, of those that face the way in which most is closed: a house in a row ends at both its neighbours,
// whatever stands behind it.
void RoofGables::endAt(const std::vector<bool>& closed) {
    std::vector<std::vector<size_t>> lines;
    std::vector<double> lengths;
    for (size_t e = 0; e < closed.size(); ++e) {
        if (!closed[e] || edges_.continues(e)) continue;
        lines.push_back(lineOf(e));
        double length = 0;
        for (size_t i : lines.back()) length += edges_.length(i);
        lengths.push_back(length);
    }
    std::vector<size_t> order;
    std::vector<double> alike(lines.size());
    constexpr size_t kMany = 1000;  // more of them would take long, and be no house
    for (size_t i = 0; i < lines.size(); ++i) {
        for (size_t j = 0; j < lines.size() && lines.size() < kMany; ++j)
            if (std::abs(glm::dot(outward(lines[i][0]), outward(lines[j][0]))) > kFaces) alike[i] += lengths[j];
        if (lengths[i] <= kWidestGable) order.push_back(i);
    }
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
        return std::abs(alike[a] - alike[b]) > 0.01 ? alike[a] > alike[b] : lengths[a] > lengths[b] + 0.01;
    });
    for (size_t i : order)
        if (!besideGable(lines[i][0]))
            for (size_t e : lines[i]) gable_[e] = true;
}

// Both corners are convex and not blunt, as those of an octagon or a bay are.
bool RoofGables::endsWing(size_t e) const {
    const auto sharp = [&](size_t corner) {
        return edges_.turn(corner) > 0 && glm::dot(edges_.along(edges_.previous[corner]), edges_.along(corner)) < 0.45;
    };
    return sharp(e) && sharp(edges_.next[e]);
}

std::vector<size_t> RoofGables::wingEnds() {
    RoofPlan hips;
    hips.input.rings = outline_.rings;
    for (bool gable : gable_) hips.input.speeds.push_back(gable ? 0 : 1);
    std::vector<size_t> ends;
    attempts_.attempt(hips, [&](Facets& facets) {
        ends.clear();
        for (const Facets::Facet& f : facets.facets) {
            if (f.side == kNone || gable_[f.edge]) continue;
            const uint32_t third = facets.sides[facets.sides[f.side].next].next;
            const bool triangle = facets.sides[third].next == f.side;
            if (triangle && endsWing(f.edge)) ends.push_back(f.edge);
        }
        return true;
    });
    return ends;
}

bool RoofGables::endWings() {
    std::vector<size_t> ends = wingEnds();
    std::stable_sort(ends.begin(), ends.end(),
                     [&](size_t a, size_t b) { return edges_.length(a) - edges_.length(b) < -0.01; });
    for (size_t e : ends)
        if (!gable_[edges_.next[e]] && !gable_[edges_.previous[e]]) gable_[e] = true;
    return std::find(gable_.begin(), gable_.end(), true) != gable_.end();
}

}  // namespace espalier
