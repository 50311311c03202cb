// In: an outline, a low edge or a direction, a slope. Out: one slope and a wall below it over every edge but the low
// one.
#include "runtime/roof/shapes_shed.hpp"

#include <cmath>

namespace espalier {
namespace {

constexpr double kAlike = 1e-9;  // of the cosine between edges that face alike
constexpr double kLower = 1e-6;  // metres

// Across the edge from corner i, into the house; unit.
glm::dvec2 inward(const std::vector<glm::dvec2>& ring, size_t i) {
    const glm::dvec2 d = ring[(i + 1) % ring.size()] - ring[i];
    return glm::dvec2(-d.y, d.x) / glm::length(d);
}

}  // namespace

uint32_t shedEave(const std::vector<std::vector<glm::dvec2>>& rings, std::optional<uint32_t> lowEdge,
                  std::optional<double> direction, const std::vector<bool>& kept) {
    glm::dvec2 fall(0), uphill(0);
    if (direction) fall = {std::sin(*direction), std::cos(*direction)};
    double best = -INFINITY, least = 0;
    uint32_t edge = 0, eave = 0;
    for (const auto& ring : rings)
        for (size_t i = 0; i < ring.size(); i++, edge++) {
            const glm::dvec2 in = inward(ring, i);
            const double length = glm::distance(ring[(i + 1) % ring.size()], ring[i]);
            double fit = direction ? -glm::dot(in, fall) + 1e-3 * length / (1 + length) : length;
            if (!direction && kept[edge]) fit -= 1e6;
            if (edge == lowEdge) fit = INFINITY;
            if (fit > best) best = fit, eave = edge, uphill = in, least = glm::dot(ring[i], in);
        }
    // A notch's or a courtyard's edge is higher up.
    edge = 0;
    for (const auto& ring : rings)
        for (size_t i = 0; i < ring.size(); i++, edge++) {
            const double height = glm::dot(ring[i], uphill);
            if (glm::dot(inward(ring, i), uphill) > 1 - kAlike && height < least - kLower) least = height, eave = edge;
        }
    return eave;
}

Facets shedFacets(const std::vector<std::vector<glm::dvec2>>& rings, uint32_t eaveEdge, double slope) {
    constexpr double kLow = 2e-5;  // metres above the eave that need no wall
    glm::dvec2 uphill(0);
    uint32_t edge = 0;
    for (const auto& ring : rings)
        for (size_t i = 0; i < ring.size(); i++, edge++)
            if (edge == eaveEdge) uphill = inward(ring, i);
    double lowest = INFINITY;
    for (const auto& ring : rings)
        for (glm::dvec2 p : ring) lowest = std::min(lowest, glm::dot(p, uphill));

    Facets f;
    f.facets.push_back({eaveEdge, 0, FaceKind::slope, slope, {}, {uphill.y, -uphill.x}, uphill, 0});
    edge = 0;
    for (const auto& ring : rings) {
        uint32_t count = uint32_t(ring.size()), firstPoint = uint32_t(f.points.size());
        // Corners at the wall's top, then those of the plane: the same where it is low.
        std::vector<uint32_t> top(count), sides(count), walls(count, kNone), uprights(count, kNone);
        for (glm::dvec2 p : ring) f.points.push_back(glm::dvec3(p, 0));
        for (uint32_t i = 0; i < count; i++) {
            double h = slope * (glm::dot(ring[i], uphill) - lowest);
            top[i] = firstPoint + i;
            if (h <= kLow) continue;
            top[i] = uint32_t(f.points.size());
            f.points.push_back(glm::dvec3(ring[i], h));
        }
        for (uint32_t i = 0; i < count; i++) {
            uint32_t j = (i + 1) % count, a = firstPoint + i, b = firstPoint + j;
            bool low = top[i] == a && top[j] == b;
            sides[i] = f.addSide(top[i], 0, low && edge + i == eaveEdge);
            if (edge + i == eaveEdge) f.facets[0].eave[0] = f.points[top[i]], f.facets[0].eave[1] = f.points[top[j]];
            if (low) continue;
            uint32_t wall = uint32_t(f.facets.size());
            glm::dvec2 along = glm::normalize(ring[j] - ring[i]);
            f.facets.push_back(
                {edge + i, 0, FaceKind::gable, 0, {f.points[a], f.points[b]}, along, {-along.y, along.x}, 0});
            uint32_t first = f.addSide(a, wall, true), last = first;
            f.facets[wall].side = first;
            auto add = [&](uint32_t from) {
                uint32_t s = f.addSide(from, wall, false);
                f.link(last, s);
                return last = s;
            };
            if (top[j] != b) uprights[j] = add(b);
            f.pair(add(top[j]), sides[i]);
            if (top[i] != a) walls[i] = add(top[i]);
            f.link(last, first);
        }
        // Uprights of neighbouring walls are twins: up at one's end, down at the other's beginning.
        for (uint32_t i = 0; i < count; i++) {
            f.link(sides[i], sides[(i + 1) % count]);
            if (uprights[i] != kNone && walls[i] != kNone) f.pair(uprights[i], walls[i]);
        }
        edge += count;
    }
    f.facets[0].side = 0;
    return f;
}

}  // namespace espalier
