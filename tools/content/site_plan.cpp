// Streets and paths about the houses. In: outlines, doors. Out: how far a place is from each.

#include "tools/content/site_plan.hpp"

#include <algorithm>
#include <cmath>

#include "tools/content/maths.hpp"

namespace espalier::content {
namespace {

using glm::vec2;
constexpr float kHalfPath = 0.62f, kLongestPath = 17;  // from a door to its street

struct Street {
    Line points;
    float half;  // of its paved width
    bool closed = false;
};
// Around the village past the houses' fronts, ways out, which cross the map's border straight, as it goes on beyond,
// and the path to the court's arch.
const Street kStreets[] = {
    {{{-31, 52},   {-27, 40}, {-34, 28}, {-37, 14},   {-40.5f, 0}, {-37, -13}, {-29, -21.5f}, {-16, -24},
      {-6, -27},   {3, -34},  {13, -35}, {24, -33},   {34, -29},   {44, -21},  {49, -9},      {43.5f, 3},
      {41.5f, 13}, {34, 22},  {27, 32},  {15, 38.5f}, {3, 45},     {-12, 47},  {-23, 52}},
     2.3f,
     true},
    {{{24, -33}, {25.5f, -48}, {20, -66}, {22, -90}, {22, -130}}, 2.0f},
    {{{-29, 51}, {-40, 66}, {-44, 90}, {-44, 130}}, 2.0f},
    {{{3, -34}, {-0.5f, -42}, {-0.8f, -49}}, 1.8f},
    {{{-6, -27}, {-7.5f, -20}, {-4.5f, -13}, {-0.2f, -8}, {0.6f, -3.2f}, {0.6f, -0.6f}}, 1.05f},
};

// Short ways over the grass: from the south to the court and round it, and from the path to the street's bends.
const Line kTracks[] = {{{3, 43}, {6.5f, 30}, {4.5f, 20}, {2.6f, 12.5f}, {1.0f, 7.4f}, {0.7f, 5.6f}},
                        {{2.0f, 10.6f}, {5.6f, 8.2f}, {7.4f, 4.5f}, {7.2f, -1.0f}, {4.2f, -4.9f}, {0.6f, -6.6f}},
                        {{-6.3f, -15.2f}, {-12, -14.2f}, {-20, -16.6f}, {-29, -19.6f}},
                        {{-2.2f, -10.4f}, {5, -11.4f}, {13, -18}, {23, -23.6f}, {34, -27.5f}}};
constexpr float kHalfTrack = 0.36f;

}  // namespace

float outlineDistance(const Outline& o, vec2 p) {
    float d = 1e9f;
    for (size_t i = 0, j = o.size() - 1; i < o.size(); j = i++) d = std::min(d, segmentDistance(p, o[i], o[j]));
    return d;
}

Line curve(const Line& points, bool closed) {
    Line line;
    const int n = int(points.size()), spans = closed ? n : n - 1;
    const auto at = [&](int i) { return points[size_t(closed ? (i + n) % n : std::clamp(i, 0, n - 1))]; };
    for (int i = 0; i < spans; ++i) {
        const vec2 a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
        for (int k = 0; k < 12; ++k) {
            const float t = float(k) / 12;
            line.push_back(0.5f * (2.0f * b + (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * t * t +
                                   (3.0f * b - a - 3.0f * c + d) * t * t * t));
        }
    }
    line.push_back(at(spans));
    return line;
}

Plan::Plan(const std::vector<Outline>& of, const std::vector<Door>& with) : houses(of), doors(with) {
    for (const Street& s : kStreets) streets.emplace_back(curve(s.points, s.closed), s.half);
    for (const Line& track : kTracks) tracks.push_back(curve(track));
    layPaths();
}

float Plan::paved(vec2 p) const {
    float inside = kSquareRadius - glm::distance(p, kSquare);
    for (const auto& [line, half] : streets)
        for (size_t i = 0; i + 1 < line.size(); ++i)
            inside = std::max(inside, half - segmentDistance(p, line[i], line[i + 1]));
    return toCourt(p) < 2 ? std::min(inside, kSill - p.y) : inside;
}

float Plan::trodden(vec2 p) const {
    float inside = -1e9f;
    for (const Line& line : tracks)
        for (size_t i = 0; i + 1 < line.size(); ++i)
            inside = std::max(inside, kHalfTrack - segmentDistance(p, line[i], line[i + 1]));
    return inside;
}

float Plan::toHouse(vec2 p) const {
    float nearest = 1e9f;
    for (const Outline& o : houses) {
        bool inside = false;
        const float d = outlineDistance(o, p);
        for (size_t i = 0, j = o.size() - 1; i < o.size(); j = i++)
            if ((o[i].y > p.y) != (o[j].y > p.y) &&
                p.x < (o[j].x - o[i].x) * (p.y - o[i].y) / (o[j].y - o[i].y) + o[i].x)
                inside = !inside;
        nearest = std::min(nearest, inside ? -d : d);
    }
    return nearest;
}

const Outline& Plan::nearestHouse(vec2 p) const {
    return *std::min_element(houses.begin(), houses.end(), [&](const Outline& a, const Outline& b) {
        return outlineDistance(a, p) < outlineDistance(b, p);
    });
}

vec2 Plan::nearestStreet(vec2 p) const {
    vec2 best(1e9f);
    for (const auto& [line, half] : streets)
        for (vec2 q : line)
            if (glm::distance(p, q) < glm::distance(p, best)) best = q;
    return best;
}

// From each door that faces a street near by, straight out and then over to it.
void Plan::layPaths() {
    std::vector<std::pair<Line, float>> paths;
    for (const Door& door : doors) {
        const vec2 from = door.at + 0.8f * door.out, bend = door.at + 2.2f * door.out, to = nearestStreet(bend);
        if (glm::distance(bend, to) > kLongestPath || glm::dot(to - bend, door.out) < 0) continue;
        const Line line = curve({from, bend, glm::mix(bend, to, 0.6f) + 0.6f * door.out, to});
        if (std::any_of(line.begin(), line.end(), [&](vec2 p) { return toHouse(p) < 0.7f; })) continue;
        paths.emplace_back(line, kHalfPath);
        fronts.push_back(door);
    }
    streets.insert(streets.end(), paths.begin(), paths.end());
}

float Plan::toCourt(vec2 p) {
    const vec2 d = glm::abs(p - kCourt) - kCourtHalf;
    return glm::length(glm::max(d, vec2(0))) + std::min(std::max(d.x, d.y), 0.0f);
}

}  // namespace espalier::content
