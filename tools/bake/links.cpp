// In: the mesh's borders. Out: where each piece of border leads: to its twin by topology; for borders without one
// to the nearest border that runs along it the other way (T-junctions, cracks), or the same way where two share an
// edge, else nowhere (Buron 2015 §4).
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "runtime/surface/box_tree.hpp"
#include "shaders/shared/exact.h"
#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {
namespace {

constexpr double kMinPiece = 1e-4;  // of an edge's length: shorter pieces are not linked
constexpr double kAgainst = -0.9;   // cosine: linked borders run against each other
constexpr double kAlike = 1e-3;     // of the tolerance: distances that differ by less are alike
// Two open borders that run along each other, e over [e0, e1], f over the same points.
struct Neighbours {
    double distance, turn;  // turn: of a walk's, by the outside
    uint32_t e, f;
    double e0, e1;
};

struct Interval {
    double low, high;
};

struct Border {
    uint32_t half;
    glm::dvec3 a, b;
    std::vector<Interval> open;  // what isn't linked yet, ascending
    double at(glm::dvec3 p) const { return glm::dot(p - a, b - a) / glm::dot(b - a, b - a); }
    glm::dvec3 point(double t) const { return a + (b - a) * t; }
};

// Compares e with f: the part of e that f runs along within the tolerance.
bool runAlong(const Border& e, const Border& f, double tolerance, Neighbours& out) {
    glm::dvec3 u = e.b - e.a, v = f.b - f.a;
    double cosine = glm::dot(u, v) / (glm::length(u) * glm::length(v));
    if (cosine > kAgainst) return false;
    out.e0 = std::max(0.0, std::min(e.at(f.a), e.at(f.b)));
    out.e1 = std::min(1.0, std::max(e.at(f.a), e.at(f.b)));
    if (out.e1 - out.e0 < kMinPiece) return false;
    // Both ends and the middle must lie near.
    double sum = 0;
    for (double t : {out.e0, (out.e0 + out.e1) / 2, out.e1}) {
        glm::dvec3 p = e.point(t);
        double d = glm::length(p - f.point(std::clamp(f.at(p), 0.0, 1.0)));
        if (d > tolerance) return false;
        sum += d;
    }
    out.distance = sum;
    return true;
}

// The nearest first; of those alike, as a hull's wall and the floor within that both end at its bottom, whose outsides
// face each other most closely.
std::vector<Neighbours> findNeighbours(const BakeMesh& mesh, const std::vector<Border>& borders, double tolerance) {
    std::vector<Box> boxes(borders.size());
    for (size_t i = 0; i < boxes.size(); ++i) boxes[i].add(borders[i].a), boxes[i].add(borders[i].b);
    BoxTree tree(std::move(boxes), {});
    std::vector<Neighbours> found;
    tree.pairs(tolerance, [&](uint32_t i, uint32_t j) {
        uint32_t e = std::min(i, j), f = std::max(i, j);
        if (borders[f].half / 3 == borders[e].half / 3) return;
        Neighbours pair{0, 0, e, f, 0, 0};
        if (!runAlong(borders[e], borders[f], tolerance, pair)) return;
        pair.distance = std::floor(pair.distance / (kAlike * tolerance));
        pair.turn = outsideAngle(mesh, borders[e].half, borders[f].half);
        found.push_back(pair);
    });
    std::sort(found.begin(), found.end(), [](const Neighbours& x, const Neighbours& y) {
        return std::tie(x.distance, x.turn, x.e, x.f) < std::tie(y.distance, y.turn, y.e, y.f);
    });
    return found;
}

// The open interval of `list` that overlaps [low, high] most, cut to it.
Interval largestOpen(const std::vector<Interval>& list, double low, double high) {
    Interval best{0, 0};
    for (const Interval& i : list) {
        Interval cut{std::max(i.low, low), std::min(i.high, high)};
        if (cut.high - cut.low > best.high - best.low) best = cut;
    }
    return best;
}

void take(std::vector<Interval>& list, Interval taken) {
    std::vector<Interval> out;
    for (const Interval& i : list) {
        if (taken.low > i.low) out.push_back({i.low, std::min(i.high, taken.low)});
        if (taken.high < i.high) out.push_back({std::max(i.low, taken.high), i.high});
    }
    std::erase_if(out, [](const Interval& i) { return i.high - i.low <= 0; });
    list.swap(out);
}

// Links open borders pair by pair, nearest first; each stretch leads to one other, there and back alike.
void linkNearest(const BakeMesh& mesh, std::vector<Border>& borders, double tolerance, std::vector<Link>& links) {
    for (const Neighbours& pair : findNeighbours(mesh, borders, tolerance)) {
        Border& e = borders[pair.e];
        Border& f = borders[pair.f];
        Interval on = largestOpen(e.open, pair.e0, pair.e1);
        if (on.high - on.low < kMinPiece) continue;
        double g0 = std::clamp(f.at(e.point(on.high)), 0.0, 1.0), g1 = std::clamp(f.at(e.point(on.low)), 0.0, 1.0);
        Interval other = largestOpen(f.open, g0, g1);
        if (other.high - other.low < kMinPiece || g1 <= g0) continue;
        // Cut e to what is open of f, by the map between the two.
        double scale = (on.high - on.low) / (g1 - g0);
        Interval cut{on.high - (other.high - g0) * scale, on.high - (other.low - g0) * scale};
        if (cut.high - cut.low < kMinPiece) continue;
        take(e.open, cut);
        take(f.open, other);
        links.push_back({e.half, f.half, cut.low, cut.high, other.high, other.low, kCrossingNearest});
        links.push_back({f.half, e.half, other.low, other.high, cut.high, cut.low, kCrossingNearest});
    }
}

// Joins borders of one edge that run along it the same way: the only two there, whose outsides can't agree, as on a
// Möbius strip. Walks go on upon the other's back.
void linkBacks(const BakeMesh& mesh, std::vector<Border>& borders, std::vector<Link>& links) {
    std::map<std::pair<uint32_t, uint32_t>, std::vector<uint32_t>> edges;
    auto start = [&](uint32_t half) { return mesh.triangles[half / 3].point[half % 3]; };
    for (uint32_t i = 0; i < borders.size(); ++i) {
        const uint32_t a = start(borders[i].half), b = start(BakeMesh::next(borders[i].half));
        edges[std::minmax(a, b)].push_back(i);
    }
    for (const auto& [points, on] : edges) {
        if (on.size() != 2) continue;
        Border &e = borders[on[0]], &f = borders[on[1]];
        const auto whole = [](const Border& b) { return b.open.size() == 1 && b.open[0].high - b.open[0].low == 1; };
        if (start(e.half) != start(f.half) || !whole(e) || !whole(f)) continue;
        links.push_back({e.half, f.half, 0, 1, 0, 1, kCrossingNearest});
        links.push_back({f.half, e.half, 0, 1, 0, 1, kCrossingNearest});
        e.open.clear(), f.open.clear();
    }
}

}  // namespace

std::vector<Link> findLinks(const BakeMesh& mesh, double tolerance) {
    std::vector<Link> links;
    std::vector<Border> borders;
    for (uint32_t h = 0; h < mesh.joined.size(); ++h) {
        if (mesh.joined[h]) continue;
        if (mesh.twin[h] != kNone)
            links.push_back({h, mesh.twin[h], 0, 1, 1, 0, kCrossingSeam});
        else
            borders.push_back({h, mesh.pointAt(h), mesh.pointAt(BakeMesh::next(h)), {{0, 1}}});
    }
    // What faces the same way comes first: a hull's bottom that misses its walls by a hair, before the floor inside.
    if (borders.size() > 1 && tolerance > 0) linkNearest(mesh, borders, tolerance, links);
    linkBacks(mesh, borders, links);
    for (const Border& b : borders)
        for (const Interval& i : b.open) links.push_back({b.half, kNone, i.low, i.high, 0, 0, kCrossingOpen});
    std::sort(links.begin(), links.end(),
              [](const Link& x, const Link& y) { return std::tie(x.from, x.from0) < std::tie(y.from, y.from0); });
    return links;
}

std::vector<Crossing> makeCrossings(const BakeMesh& mesh, const std::vector<Link>& links) {
    std::vector<Crossing> out;
    out.reserve(links.size());
    for (const Link& link : links) {
        uint32_t h = link.from, n = BakeMesh::next(h);
        glm::dvec2 a = mesh.uvAt(h), d = mesh.uvAt(n) - a;
        Crossing c{};
        c.a = glm::vec2(a + d * link.from0);
        c.b = glm::vec2(a + d * link.from1);
        c.edge = packOct(glm::vec3(glm::normalize(mesh.pointAt(n) - mesh.pointAt(h))));
        c.targetEdge = c.edge;
        c.target = 0xFFFF0000u | mesh.chartOf(h);
        c.ta = c.a;
        c.tb = c.b;
        if (link.to != kNone) {
            uint32_t th = link.to, tn = BakeMesh::next(th);
            glm::dvec2 ta = mesh.uvAt(th), td = mesh.uvAt(tn) - ta;
            c.ta = glm::vec2(ta + td * link.to0);
            c.tb = glm::vec2(ta + td * link.to1);
            c.target = 0xFFFF0000u | mesh.chartOf(th);
            if (link.to1 > link.to0) {
                c.targetEdge = packOct(glm::vec3(glm::normalize(mesh.pointAt(tn) - mesh.pointAt(th))));
                c.flags = kCrossingTurned;
            } else if (link.kind != kCrossingSeam) {
                c.targetEdge = packOct(glm::vec3(glm::normalize(mesh.pointAt(th) - mesh.pointAt(tn))));
            }
        }
        c.flags |= link.kind | (mesh.orientation[mesh.chartOf(h)] > 0 ? 4u : 0u) | mesh.chartOf(h) << 16;
        out.push_back(c);
    }
    return out;
}

}  // namespace espalier::bakery
