// In: rings as someone drew them. Out: outlines that the wavefront can start from. Sound rings are only put on the grid
// and rid of needless corners; others go through Clipper, which takes coordinates on the same grid.
#include <algorithm>
#include <clipper.hpp>
#include <cmath>
#include <utility>

#include "runtime/roof/footprint.hpp"

namespace espalier {

namespace {

using ClipperLib::IntPoint;
using ClipperLib::Path;
using ClipperLib::Paths;

constexpr double kNear = 0.005;                    // metres: corners nearer than this are one
constexpr double kStraight = 0.002;                // metres off the line between its neighbours: no corner
constexpr double kLeastArea = 0.05;                // square metres
constexpr double kLargest = 100000;                // metres from the house's first corner
constexpr size_t kManyGone = 64, kMostGone = 256;  // corners without a turn between two that stay
constexpr size_t kMostCrossings = 1000;            // pairs of edges that cross or touch, of what is mended

double areaOf(const std::vector<glm::dvec2>& ring) {
    double twice = 0;
    for (size_t i = 0; i < ring.size(); i++) {
        glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return twice / 2;
}

double distanceToSegment(glm::dvec2 p, glm::dvec2 a, glm::dvec2 b) {
    glm::dvec2 d = b - a;
    double l = glm::dot(d, d), t = l > 0 ? glm::clamp(glm::dot(p - a, d) / l, 0.0, 1.0) : 0;
    return glm::length(p - a - t * d);
}

// Only the outermost of many points: none lies farther from an edge than the farthest of these. Their convex hull, by
// its lower and its upper side.
void keepOutermost(std::vector<glm::dvec2>& points) {
    if (points.size() < kManyGone) return;
    std::ranges::sort(points, [](glm::dvec2 a, glm::dvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<glm::dvec2> hull;
    for (const bool upper : {false, true}) {
        const size_t begin = hull.size();
        for (size_t k = 0; k < points.size(); ++k) {
            const glm::dvec2 p = upper ? points[points.size() - 1 - k] : points[k];
            const auto turns = [&] {
                const glm::dvec2 a = hull.back() - hull[hull.size() - 2], b = p - hull.back();
                return a.x * b.y - a.y * b.x > 0;
            };
            while (hull.size() >= begin + 2 && !turns()) hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();  // where the other side begins
    }
    if (!hull.empty()) points = std::move(hull);
}

// Drops corners that repeat the one before, end a spike or don't turn. Corners dropped between two kept ones stay
// within kStraight of the new edge, so that curved walls don't melt; after kMostGone that bound it, one stays, so that
// an outline of very many corners without a turn is done in time.
void simplifyRing(std::vector<glm::dvec2>& ring) {
    struct Corner {
        size_t before, after;
        std::vector<glm::dvec2> gone;  // between it and the one after
    };
    const size_t count = ring.size();
    std::vector<Corner> corners(count);
    for (size_t i = 0; i < count; ++i) corners[i] = {(i + count - 1) % count, (i + 1) % count, {}};
    size_t first = 0, left = count;
    for (bool again = true; again && left >= 3;) {
        again = false;
        size_t i = first;
        for (size_t visits = left; visits > 0 && left >= 3; --visits) {
            const auto& [before, after, gone] = corners[i];
            std::vector<glm::dvec2>& goneBefore = corners[before].gone;
            const glm::dvec2 a = ring[before], p = ring[i], b = ring[after], in = p - a, out = b - p;
            const bool near = glm::length(in) < kNear;
            bool drop = near || distanceToSegment(p, a, b) < kStraight;
            // A spike: there and back along one line.
            const double sine = in.x * out.y - in.y * out.x;
            const bool spike =
                glm::dot(in, out) < 0 && std::abs(sine) < kStraight * std::max(glm::length(in), glm::length(out));
            if (drop && !near && !spike) {
                drop = goneBefore.size() + gone.size() < kMostGone;
                for (const std::vector<glm::dvec2>* list : {&std::as_const(goneBefore), &gone})
                    for (size_t k = 0; k < list->size() && drop; ++k)
                        drop = distanceToSegment((*list)[k], a, b) < kStraight;
            }
            const size_t next = after;
            if (drop || spike) {
                if (!spike && !near) goneBefore.push_back(p);
                goneBefore.insert(goneBefore.end(), gone.begin(), gone.end());
                if (spike) goneBefore.clear();
                keepOutermost(goneBefore);
                corners[before].after = next;
                corners[next].before = before;
                if (i == first) first = next;
                --left;
                again = true;
            }
            i = next;
        }
    }
    std::vector<glm::dvec2> kept;
    for (size_t i = first; left >= 3 && kept.size() < left; i = corners[i].after) kept.push_back(ring[i]);
    ring = std::move(kept);
}

struct Segment {
    glm::dvec2 a, b;
    size_t ring, index, count;
};

int side(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    // Exact: corners hold 24 bits, so that their differences give products of 50, held by the 64 of long double.
    long double d = (long double)(b.x - a.x) * (c.y - a.y) - (long double)(b.y - a.y) * (c.x - a.x);
    return d > 0 ? 1 : d < 0 ? -1 : 0;
}

bool meet(const Segment& s, const Segment& t) {
    if (std::max(s.a.x, s.b.x) < std::min(t.a.x, t.b.x) || std::max(t.a.x, t.b.x) < std::min(s.a.x, s.b.x) ||
        std::max(s.a.y, s.b.y) < std::min(t.a.y, t.b.y) || std::max(t.a.y, t.b.y) < std::min(s.a.y, s.b.y))
        return false;
    // Corners that come within half the least length of an edge touch it.
    double gap = std::min(std::min(distanceToSegment(s.a, t.a, t.b), distanceToSegment(s.b, t.a, t.b)),
                          std::min(distanceToSegment(t.a, s.a, s.b), distanceToSegment(t.b, s.a, s.b)));
    if (gap < kNear / 2) return true;
    return side(s.a, s.b, t.a) * side(s.a, s.b, t.b) < 0 && side(t.a, t.b, s.a) * side(t.a, t.b, s.b) < 0;
}

// How many pairs of edges meet, counted no further than one above `most`. A sweep over the edges sorted by their left
// ends.
size_t crossings(const std::vector<std::vector<glm::dvec2>>& rings, size_t most) {
    size_t count = 0;
    std::vector<Segment> segments;
    for (size_t r = 0; r < rings.size(); r++)
        for (size_t i = 0; i < rings[r].size(); i++)
            segments.push_back({rings[r][i], rings[r][(i + 1) % rings[r].size()], r, i, rings[r].size()});
    auto left = [](const Segment& s) { return std::min(s.a.x, s.b.x); };
    std::sort(segments.begin(), segments.end(), [&](const Segment& s, const Segment& t) { return left(s) < left(t); });
    for (size_t i = 0; i < segments.size(); i++) {
        const Segment& s = segments[i];
        double right = std::max(s.a.x, s.b.x) + kNear;
        for (size_t j = i + 1; j < segments.size() && left(segments[j]) <= right; j++) {
            const Segment& t = segments[j];
            bool neighbours =
                s.ring == t.ring && (t.index == (s.index + 1) % s.count || s.index == (t.index + 1) % t.count);
            if (!neighbours && meet(s, t) && ++count > most) return count;
        }
    }
    return count;
}

// Simple and disjoint?
bool sound(const std::vector<std::vector<glm::dvec2>>& rings) {
    return crossings(rings, 0) == 0;
}

bool inside(glm::dvec2 p, const std::vector<glm::dvec2>& ring) {
    bool in = false;
    for (size_t i = 0; i < ring.size(); i++) {
        glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) in = !in;
    }
    return in;
}

// Grid lines a metre: a power of two, such that floats hold every corner. The finest is about 1/1000 mm.
double gridFor(double radius) {
    return std::exp2(std::min(20.0, 23 - std::ceil(std::log2(std::max(radius, 1.0)))));
}

Path toPath(const std::vector<glm::dvec2>& ring, double grid) {
    Path path;
    for (glm::dvec2 p : ring) path.push_back({std::llround(p.x * grid), std::llround(p.y * grid)});
    return path;
}
std::vector<glm::dvec2> toRing(const Path& path, double grid) {
    std::vector<glm::dvec2> ring;
    for (IntPoint p : path) ring.push_back({double(p.X) / grid, double(p.Y) / grid});
    return ring;
}

using Rings = std::vector<std::vector<glm::dvec2>>;

// The outer ring without the holes, as parts that neither cross nor touch themselves: the result is drawn in by a hair
// and out again, which opens what only touches.
std::vector<Rings> clipRings(const Rings& rings, double grid) {
    Paths outer, holes, area;
    ClipperLib::SimplifyPolygon(toPath(rings[0], grid), outer, ClipperLib::pftEvenOdd);
    for (size_t i = 1; i < rings.size(); i++) holes.push_back(toPath(rings[i], grid));
    ClipperLib::SimplifyPolygons(holes, ClipperLib::pftEvenOdd);
    ClipperLib::Clipper clipper;
    clipper.AddPaths(outer, ClipperLib::ptSubject, true);
    clipper.AddPaths(holes, ClipperLib::ptClip, true);
    clipper.Execute(ClipperLib::ctDifference, area, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
    ClipperLib::CleanPolygons(area, kNear / 4 * grid);
    ClipperLib::ClipperOffset offset(4);
    Paths shrunk;
    offset.AddPaths(area, ClipperLib::jtMiter, ClipperLib::etClosedPolygon);
    offset.Execute(shrunk, -kNear * grid);
    offset.Clear();
    offset.AddPaths(shrunk, ClipperLib::jtMiter, ClipperLib::etClosedPolygon);
    ClipperLib::PolyTree tree;
    offset.Execute(tree, kNear * 0.4 * grid);
    std::vector<Rings> parts;
    for (ClipperLib::PolyNode* node = tree.GetFirst(); node; node = node->GetNext()) {
        if (node->IsHole()) continue;
        Rings part{toRing(node->Contour, grid)};
        for (ClipperLib::PolyNode* hole : node->Childs) part.push_back(toRing(hole->Contour, grid));
        parts.push_back(std::move(part));
    }
    return parts;
}

// Orientation as the contract asks; needless corners dropped; rings that are nothing then, too.
bool tidy(Rings& rings) {
    for (size_t i = 0; i < rings.size(); i++) {
        simplifyRing(rings[i]);
        if ((areaOf(rings[i]) > 0) != (i == 0)) std::reverse(rings[i].begin(), rings[i].end());
    }
    if (rings[0].empty() || areaOf(rings[0]) < kLeastArea) return false;
    auto nothing = [](const std::vector<glm::dvec2>& ring) { return ring.empty() || areaOf(ring) > -kLeastArea; };
    rings.erase(std::remove_if(rings.begin() + 1, rings.end(), nothing), rings.end());
    return true;
}

// The edge as given that the middle of a-b lies nearest to, of those that run its way.
uint32_t sourceEdge(glm::dvec2 a, glm::dvec2 b, const Rings& given) {
    uint32_t edge = 0, best = 0;
    double least = INFINITY;
    glm::dvec2 d = glm::normalize(b - a), middle = (a + b) / 2.0;
    for (const auto& ring : given)
        for (size_t i = 0; i < ring.size(); i++, edge++) {
            glm::dvec2 p = ring[i], q = ring[(i + 1) % ring.size()], e = q - p;
            double length = glm::length(e);
            if (!(length > 0)) continue;
            double turn = std::abs(d.x * e.y - d.y * e.x) / length;
            double distance = distanceToSegment(middle, p, q) + turn * kNear;
            if (distance < least) least = distance, best = edge;
        }
    return best;
}

}  // namespace

std::vector<RepairedOutline> repairOutline(const Footprint& footprint, std::vector<Diagnostic>& diagnostics) {
    auto say = [&](const std::string& what, bool warning) {
        diagnostics.push_back({{}, 0, 0, footprint.id, what, warning});
        return std::vector<RepairedOutline>();
    };
    if (footprint.rings.empty() || footprint.rings[0].size() < 3)
        return say("the outline has fewer than three corners: left out", false);
    size_t corners = 0;
    glm::dvec2 low(INFINITY), high(-INFINITY);
    for (const auto& ring : footprint.rings)
        for (glm::dvec2 p : ring) {
            if (!std::isfinite(p.x) || !std::isfinite(p.y))
                return say("the outline has a coordinate that is no number: left out", false);
            low = glm::min(low, p), high = glm::max(high, p);
            corners++;
        }
    if (corners > kMostCorners)
        return say("the outline has " + std::to_string(corners) + " corners, more than " +
                       std::to_string(kMostCorners) + ": left out",
                   false);
    if (glm::length(high - low) > kLargest) return say("the outline is larger than 100 km: left out", false);

    glm::dvec2 origin = glm::round((low + high) / 2.0);
    double grid = gridFor(glm::length(high - low) / 2 + 1);
    Rings given, rings;
    for (const auto& ring : footprint.rings) {
        given.emplace_back();
        for (glm::dvec2 p : ring) given.back().push_back(glm::round((p - origin) * grid) / grid);
    }
    rings = given;
    bool whole = tidy(rings);
    std::vector<Rings> parts;
    bool holesInside = whole;
    for (size_t i = 1; holesInside && i < rings.size(); i++) holesInside = inside(rings[i][0], rings[0]);
    for (size_t i = 1; holesInside && i < rings.size(); i++)
        for (size_t j = 1; j < rings.size(); j++)
            if (i != j && inside(rings[i][0], rings[j])) holesInside = false;
    if (whole && holesInside && sound(rings)) {
        parts.push_back(std::move(rings));
    } else {
        // What is mended falls into as many parts: a scribble would take minutes and be no building.
        if (crossings(rings, kMostCrossings) > kMostCrossings)
            return say("the outline crosses or touches itself more than " + std::to_string(kMostCrossings) +
                           " times: left out",
                       false);
        for (Rings& part : clipRings(given, grid))
            if (tidy(part) && sound(part)) parts.push_back(std::move(part));
        if (parts.empty()) return say("the outline has no area that could carry a roof: left out", false);
        say(parts.size() == 1
                ? "the outline crossed or touched itself: mended"
                : "the outline crossed or touched itself: mended, " + std::to_string(parts.size()) + " parts",
            true);
    }
    std::sort(parts.begin(), parts.end(), [](const Rings& a, const Rings& b) { return areaOf(a[0]) > areaOf(b[0]); });
    std::vector<RepairedOutline> out;
    for (Rings& part : parts) {
        RepairedOutline outline{origin, std::move(part), {}};
        bool needEdges = !footprint.edges.empty();
        for (const auto& ring : outline.rings)
            for (size_t i = 0; i < ring.size(); i++)
                outline.sourceEdges.push_back(needEdges ? sourceEdge(ring[i], ring[(i + 1) % ring.size()], given) : 0);
        out.push_back(std::move(outline));
    }
    return out;
}

}  // namespace espalier
