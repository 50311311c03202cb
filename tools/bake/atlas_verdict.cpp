// In: a flattened patch. Out: whether it can be a chart: its map is one to one if no triangle is turned over, none goes
// round a vertex twice, and borders are simple, the outer one to the left, holes to the right; and how stretched it is.
#include <algorithm>
#include <cmath>

#include "tools/bake/atlas.hpp"
#include "tools/bake/quantile.hpp"

namespace espalier::bakery {
namespace {

constexpr uint32_t kNearEdges = 12;   // of a border: what meets within so many edges is a local fault
constexpr size_t kFewSegments = 64;   // of a border: these are all compared with each other
constexpr double kLeastScale = 1e-3;  // of a triangle's area in UV to its own: below it counts as flipped

struct Segment {
    glm::dvec2 a, b;
    uint32_t from, to;  // vertices
    uint32_t loop;
};

// Whether two segments without a common end cross or touch. Of two on one line rounding can say so: their boxes are
// asked first.
bool meet(const Segment& s, const Segment& t) {
    for (int k = 0; k < 2; ++k)
        if (std::max(s.a[k], s.b[k]) < std::min(t.a[k], t.b[k]) || std::max(t.a[k], t.b[k]) < std::min(s.a[k], s.b[k]))
            return false;
    glm::dvec2 d = s.b - s.a, e = t.b - t.a;
    double a = cross(d, t.a - s.a), b = cross(d, t.b - s.a), c = cross(e, s.a - t.a), f = cross(e, s.b - t.a);
    return ((a > 0) != (b > 0)) && ((c > 0) != (f > 0));
}

double signedArea(const Patch& patch, const std::vector<uint32_t>& loop) {
    double sum = 0;
    glm::dvec2 first = patch.uv[patch.corner[loop[0] / 3][loop[0] % 3]];
    for (uint32_t h : loop) {
        uint32_t n = BakeMesh::next(h);
        sum += cross(patch.uv[patch.corner[h / 3][h % 3]] - first, patch.uv[patch.corner[n / 3][n % 3]] - first);
    }
    return sum / 2;
}

// Where segments may meet: calls pair(i, j), i < j, some pairs more than once. Many lie on a grid of cells about as
// large as they are, and only those in one cell are compared. low, side, length: of all.
template <class Pair>
void forNear(const std::vector<Segment>& segments, glm::dvec2 low, double side, double length, Pair&& pair) {
    const uint32_t count = uint32_t(segments.size());
    if (count <= kFewSegments) {
        for (uint32_t i = 0; i < count; ++i)
            for (uint32_t j = i + 1; j < count; ++j) pair(i, j);
        return;
    }
    double cell = std::max(length / double(count), side / 1024);
    if (!(cell > 0)) cell = 1;
    const uint64_t size = uint64_t(side / cell) + 2;
    std::vector<uint64_t> entries;  // cell, segment
    for (uint32_t i = 0; i < count; ++i)
        gridSegment((segments[i].a - low) / cell, (segments[i].b - low) / cell, 0.51, int64_t(size), 0, int64_t(size),
                    [&](int64_t y, int64_t x0, int64_t x1) {
                        for (int64_t x = x0; x <= x1; ++x)
                            entries.push_back((uint64_t(y) * size + uint64_t(x)) << 32 | i);
                    });
    std::sort(entries.begin(), entries.end());
    for (size_t i = 0, j; i < entries.size(); i = j)
        for (j = i + 1; j < entries.size() && entries[j] >> 32 == entries[i] >> 32; ++j)
            for (size_t k = i; k < j; ++k) pair(uint32_t(entries[k]), uint32_t(entries[j]));
}

// Where a hole meets something, its vertices are tangled; where the outer border (loop 0) meets itself, they are
// crossed.
void findMeetings(const Patch& patch, const std::vector<std::vector<uint32_t>>& loops, PatchVerdict& out) {
    std::vector<Segment> segments;
    glm::dvec2 low(1e300), high(-1e300);
    double length = 0;
    for (uint32_t l = 0; l < loops.size(); ++l)
        for (uint32_t h : loops[l]) {
            uint32_t n = BakeMesh::next(h), v = patch.corner[h / 3][h % 3], w = patch.corner[n / 3][n % 3];
            segments.push_back({patch.uv[v], patch.uv[w], v, w, l});
            low = glm::min(low, patch.uv[v]), high = glm::max(high, patch.uv[v]);
            length += glm::length(patch.uv[w] - patch.uv[v]);
        }
    std::vector<uint8_t> meets(loops.size(), 0);
    double side = std::max(high.x - low.x, high.y - low.y);
    forNear(segments, low, side, length, [&](uint32_t i, uint32_t j) {
        const Segment &s = segments[i], &t = segments[j];
        if (s.from == t.from || s.from == t.to || s.to == t.from || s.to == t.to || !meet(s, t)) return;
        if (s.loop == 0 && t.loop == 0) {
            const uint32_t apart = j - i, n = uint32_t(loops[0].size());
            if (std::min(apart, n - apart) > kNearEdges)
                out.overlapping = true;
            else
                out.crossed.insert(out.crossed.end(), {s.from, s.to, t.from, t.to});
        }
        meets[s.loop] = meets[t.loop] = 1;
    });
    for (uint32_t l = 1; l < loops.size(); ++l)
        if (meets[l] || signedArea(patch, loops[l]) > 0)
            for (uint32_t h : loops[l]) out.torn = true, out.tangled.push_back(patch.corner[h / 3][h % 3]);
    if (signedArea(patch, loops[0]) < 0) out.overlapping = true;
}

// A triangle's stretch: of its map the largest singular value, then the worst against the chart's mean.
struct Stretch {
    double value, least, area;
};

// Vertices around which triangles go more than once: they pass the ray along +u more than once.
void findWinding(const Patch& patch, PatchVerdict& out) {
    std::vector<uint8_t> passed(patch.point.size(), 0);
    for (const auto& c : patch.corner)
        for (size_t k = 0; k < 3; ++k) {
            double from = patch.uv[c[(k + 1) % 3]].y - patch.uv[c[k]].y;
            double to = patch.uv[c[(k + 2) % 3]].y - patch.uv[c[k]].y;
            if (from < 0 && to >= 0 && ++passed[c[k]] == 2) out.tangled.push_back(c[k]);
        }
}

}  // namespace

PatchVerdict judgePatch(const Patch& patch) {
    PatchVerdict out;
    std::vector<Stretch> all;
    all.reserve(patch.triangles.size());
    double area = 0, uvArea = 0;
    for (const auto& c : patch.corner) {
        glm::dvec3 e1 = patch.point[c[1]] - patch.point[c[0]], e2 = patch.point[c[2]] - patch.point[c[0]];
        glm::dvec2 u1 = patch.uv[c[1]] - patch.uv[c[0]], u2 = patch.uv[c[2]] - patch.uv[c[0]];
        double own = glm::length(glm::cross(e1, e2)) / 2, flat = cross(u1, u2) / 2;
        area += own;
        if (!(flat > own * kLeastScale)) {
            out.tangled.insert(out.tangled.end(), c.begin(), c.end());
            continue;
        }
        uvArea += flat;
        // Metres per UV along u and v.
        glm::dvec3 du = (e1 * u2.y - e2 * u1.y) / (2 * flat), dv = (e2 * u1.x - e1 * u2.x) / (2 * flat);
        double uu = glm::dot(du, du), vv = glm::dot(dv, dv), cosine = glm::dot(du, dv);
        double mean = (uu + vv) / 2, half = std::sqrt((uu - vv) * (uu - vv) / 4 + cosine * cosine);
        all.push_back({std::sqrt(mean + half), std::sqrt(std::max(mean - half, 0.0)), own});
    }
    if (all.empty()) return out;
    double scale = std::sqrt(area / uvArea);
    for (Stretch& s : all) {
        s.value = std::max(s.value / scale, scale / std::max(s.least, 1e-12));
        out.stretchMax = std::max(out.stretchMax, s.value);
    }
    out.stretch95 = quantile(all, 0.95 * area);
    if (out.tangled.empty()) findWinding(patch, out);
    if (out.tangled.empty()) findMeetings(patch, borderLoops(patch), out);
    return out;
}

}  // namespace espalier::bakery
