#pragma once

// What a site's layout keeps clear of: houses, streets, paths to doors, the court.

#include "tools/content/doors.hpp"
#include "tools/content/site.hpp"

namespace espalier::content {

constexpr float kLevel = -0.06f;  // of the meadow, as in sample.json
constexpr float kHalfMap = 104;   // metres
const glm::vec2 kCourt{0.35f, 1.7f}, kCourtHalf{5.2f, 4.0f};
constexpr float kSill = -0.95f;          // z where the setts of the court's path end, beneath its older flags
const glm::vec2 kSquare{-0.8f, -46.0f};  // before the school, with the well
constexpr float kSquareRadius = 4.8f;

// A street's middle.
using Line = std::vector<glm::vec2>;
// A Catmull-Rom curve through the points, in pieces of half a metre or so.
Line curve(const Line& points, bool closed = false);

// Metres from an outline's sides.
float outlineDistance(const Outline& o, glm::vec2 p);

struct Plan {
    std::vector<Outline> houses;
    std::vector<std::pair<Line, float>> streets;  // line and half width
    std::vector<Door> doors;
    std::vector<Door> fronts;  // doors that a path leads to
    std::vector<Line> tracks;  // trodden over the grass

    Plan(const std::vector<Outline>& of, const std::vector<Door>& with);

    // Metres into a street, negative beside it.
    float paved(glm::vec2 p) const;
    // Metres into a track, negative beside it.
    float trodden(glm::vec2 p) const;
    // Metres from the nearest house, negative within.
    float toHouse(glm::vec2 p) const;
    const Outline& nearestHouse(glm::vec2 p) const;
    glm::vec2 nearestStreet(glm::vec2 p) const;
    static float toCourt(glm::vec2 p);

  private:
    void layPaths();
};

}  // namespace espalier::content
