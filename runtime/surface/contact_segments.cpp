// In: two triangles. Out: the stretches along which they touch. A corner within its reach of the other's plane lies
// in it, so that walls that stand on a floor, or a hair above it, touch it along their lower edge. Those that go
// through the floor by more than a hair touch it where they do, so that there are lines on both that close off what is
// below.
#include "runtime/surface/contact_segments.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace espalier {
namespace {

using glm::dvec3;

constexpr double kParallel = 0.995;  // cosine: planes that meet at less than 6° may count as one
constexpr double kHair = 1e-7;       // of an edge's length: rounding
constexpr double kThrough = 0.1;     // of the reach: what is farther beyond a plane goes through it

// What a triangle shares with a plane.
struct Trace {
    enum Kind { none, line, flat } kind = none;
    dvec3 a{0}, b{0};
    int edge = -1;
};

// share: of the corners' reach.
Trace trace(const ContactShape& s, const ContactShape& plane, double share) {
    std::array<double, 3> d;
    int zeros = 0, positive = 0;
    for (size_t k = 0; k < 3; ++k) {
        d[k] = glm::dot(plane.normal, s.p[k] - plane.p[0]);
        if (std::abs(d[k]) <= s.reach[k] * share) d[k] = 0;
        zeros += d[k] == 0;
        positive += d[k] > 0;
    }
    Trace out;
    if (zeros == 3) {
        out.kind = Trace::flat;
        return out;
    }
    if (zeros < 2 && (positive == 0 || positive == 3 - zeros)) return out;
    int found = 0;
    auto add = [&](dvec3 p) { (found++ == 0 ? out.a : out.b) = p; };
    for (size_t k = 0; k < 3; ++k) {
        size_t n = (k + 1) % 3;
        if (d[k] == 0) add(s.p[k]);
        if (d[k] == 0 && d[n] == 0) out.edge = int(k);
        if (d[k] * d[n] < 0) {
            // The same bits from both of an edge's triangles.
            bool swap = std::tie(s.p[k].x, s.p[k].y, s.p[k].z) > std::tie(s.p[n].x, s.p[n].y, s.p[n].z);
            size_t i = swap ? n : k, j = swap ? k : n;
            add(s.p[i] + (s.p[j] - s.p[i]) * (d[i] / (d[i] - d[j])));
        }
    }
    if (found == 2) out.kind = Trace::line;
    return out;
}

double reachOf(const ContactShape& s) {
    return std::max({s.reach[0], s.reach[1], s.reach[2]});
}

// The edge of t that a-b runs along; -1: none.
int edgeAlong(const ContactShape& t, dvec3 a, dvec3 b) {
    double reach = reachOf(t);
    for (size_t k = 0; k < 3; ++k) {
        dvec3 u = glm::normalize(t.p[(k + 1) % 3] - t.p[k]);
        dvec3 fa = a - t.p[k], fb = b - t.p[k];
        if (glm::length(fa - u * glm::dot(u, fa)) <= reach && glm::length(fb - u * glm::dot(u, fb)) <= reach)
            return int(k);
    }
    return -1;
}

// Outlines of s as far as they lie in t, whose plane is the same. `first`: s is side 0. Over an edge across which t's
// surface goes on flat, the next triangle has the rest; around others what is near touches too, and what runs along
// one, inside or outside, is put onto it, so that both ways lead over the same line. only: that edge, -1: all.
void clipOutlines(const ContactShape& s, const ContactShape& t, bool first, int only,
                  std::array<ContactSegment, 6>& out, int& count) {
    const double slack = std::max(reachOf(s), reachOf(t));
    std::array<dvec3, 3> inward;
    for (size_t e = 0; e < 3; ++e) inward[e] = glm::normalize(glm::cross(t.normal, t.p[(e + 1) % 3] - t.p[e]));
    for (size_t k = 0; k < 3; ++k) {
        if (!s.outline[k] || (only >= 0 && int(k) != only)) continue;
        const dvec3 a = s.p[k], d = s.p[(k + 1) % 3] - a;
        const double length = glm::length(d);
        double t0 = 0, t1 = 1;
        for (size_t e = 0; e < 3; ++e) {
            const double room = t.outline[e] ? slack : kHair * length;
            const double at = glm::dot(inward[e], a - t.p[e]) + room, rate = glm::dot(inward[e], d);
            if (std::abs(rate) < 1e-12 * length) {
                if (at < 0) t1 = -1;
            } else if (rate > 0) {
                t0 = std::max(t0, -at / rate);
            } else {
                t1 = std::min(t1, -at / rate);
            }
        }
        if ((t1 - t0) * length <= 2 * slack) continue;
        const dvec3 p = a + d * t0, q = a + d * t1;
        auto onto = [&](dvec3 x) { return x - t.normal * glm::dot(t.normal, x - t.p[0]); };
        ContactSegment::Side other{onto(p), onto(q), edgeAlong(t, onto(p), onto(q))};
        for (size_t e = 0; e < 3 && other.edge < 0; ++e)
            if (std::max(glm::dot(inward[e], p - t.p[e]), glm::dot(inward[e], q - t.p[e])) < 0) other.edge = int(e);
        if (other.edge >= 0) {
            const dvec3 n = inward[size_t(other.edge)], on = t.p[size_t(other.edge)];
            for (dvec3* x : {&other.a, &other.b}) *x -= n * glm::dot(n, *x - on);
        }
        ContactSegment& segment = out[size_t(count++)];
        segment.side[first ? 0 : 1] = {p, q, int(k)};
        segment.side[first ? 1 : 0] = other;
    }
}

// What the lines of two traces have in common, as it lies on each. Nothing: they lie apart along them.
std::optional<ContactSegment> alongLine(Trace (&of)[2]) {
    dvec3 u = of[0].b - of[0].a, v = of[1].b - of[1].a;
    double lu = glm::length(u), lv = glm::length(v);
    if (lu <= 0 || lv <= 0) return std::nullopt;
    // Along the longer of the two, whose direction is the surer.
    dvec3 d = lu >= lv ? u / lu : v / lv;
    dvec3 origin = lu >= lv ? of[0].a : of[1].a;
    double low = -1e300, high = 1e300;
    for (Trace& tr : of) {
        if (glm::dot(d, tr.b - tr.a) < 0) std::swap(tr.a, tr.b);
        low = std::max(low, glm::dot(d, tr.a - origin));
        high = std::min(high, glm::dot(d, tr.b - origin));
    }
    if (high - low <= 1e-6 * std::max(lu, lv)) return std::nullopt;
    ContactSegment out;
    for (int i = 0; i < 2; ++i) {
        const Trace& tr = of[i];
        double from = glm::dot(d, tr.a - origin), to = glm::dot(d, tr.b - origin);
        auto at = [&](double x) { return tr.a + (tr.b - tr.a) * ((x - from) / (to - from)); };
        out.side[i] = {at(low), at(high), tr.edge};
    }
    return out;
}

}  // namespace

int touch(const ContactShape& s, const ContactShape& t, std::array<ContactSegment, 6>& out) {
    Trace of[2];
    bool flat = false;
    auto traceBoth = [&](double share) {
        of[0] = trace(s, t, share);
        of[1] = of[0].kind == Trace::none ? Trace{} : trace(t, s, share);
        flat = of[0].kind == Trace::flat || of[1].kind == Trace::flat;
        return of[1].kind != Trace::none;
    };
    int count = 0;
    const auto take = [&](const std::optional<ContactSegment>& segment) {
        if (segment) out[size_t(count++)] = *segment;
        return count;
    };
    // A corner that was taken to lie in the other's plane may have gone through it.
    if (!traceBoth(1)) return traceBoth(0) && !flat ? take(alongLine(of)) : 0;
    // A shingle may lie within reach of the roof that it comes out of, and aslant all the same.
    if (flat && std::abs(glm::dot(s.normal, t.normal)) < kParallel && (!traceBoth(0) || flat)) return 0;
    if (flat) {
        clipOutlines(s, t, true, -1, out, count);
        clipOutlines(t, s, false, -1, out, count);
        return count;
    }
    // Planes that meet at a small angle may have lines far from each other: where an edge that was taken to lie in the
    // other's plane has in truth gone through it, both meet where it did.
    const double reach = std::max(reachOf(s), reachOf(t));
    const auto joins = [&](const std::optional<ContactSegment>& c) {
        return c && glm::length((c->side[0].a + c->side[0].b - c->side[1].a - c->side[1].b) * 0.5) <= reach;
    };
    const std::array<int, 2> edge{of[0].edge, of[1].edge};
    const std::optional<ContactSegment> near = alongLine(of);
    std::optional<ContactSegment> through = traceBoth(kThrough) ? alongLine(of) : std::nullopt;
    if (joins(through) && (of[0].edge != edge[0] || of[1].edge != edge[1])) {
        // Nor does the triangle beyond the edge touch along it.
        take(through);
        if (!joins(near)) return count;
        take(near);
        for (size_t i = 0; i < 2; ++i) through->side[i].edge = edge[i];
        through->gone = true;
        return take(through);
    }
    if (joins(near)) return take(near);
    const std::optional<ContactSegment> exact = traceBoth(0) && !flat ? alongLine(of) : std::nullopt;
    if (joins(exact)) return take(exact);
    // Edges that come near without going through lie where they are nearest.
    if (edge[0] >= 0) clipOutlines(s, t, true, edge[0], out, count);
    if (edge[1] >= 0) clipOutlines(t, s, false, edge[1], out, count);
    return count;
}

}  // namespace espalier
