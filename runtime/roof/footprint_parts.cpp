// In: a town's footprints, parts of buildings among them. Out: those that are to be built. A sweep from west to east
// brings each part to the outlines whose bounds hold it.
#include "runtime/roof/footprint_parts.hpp"

#include <algorithm>
#include <cmath>

namespace espalier {

namespace {

using Ring = std::vector<glm::dvec2>;

constexpr double kCovered = 0.9;
constexpr uint64_t kMostTests = 20'000'000;  // pairs of a part and an outline, and edges of outlines

double areaOf(const Footprint& f) {
    double sum = 0;
    for (size_t r = 0; r < f.rings.size(); r++) {
        double twice = 0;
        const Ring& ring = f.rings[r];
        for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
            twice += ring[j].x * ring[i].y - ring[j].y * ring[i].x;
        sum += (r == 0 ? 0.5 : -0.5) * std::abs(twice);
    }
    return sum;
}

// Where a level line meets the outline, from west to east: between the first and the second lies the inside.
std::vector<double> crossings(const Footprint& f, double y) {
    std::vector<double> xs;
    for (const Ring& ring : f.rings)
        for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
            const glm::dvec2 a = ring[i], b = ring[j];
            if ((a.y > y) != (b.y > y)) xs.push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
        }
    std::sort(xs.begin(), xs.end());
    return xs;
}

struct Bounds {
    explicit Bounds(const Footprint& f) {
        for (glm::dvec2 p : f.rings[0]) low = glm::min(low, p), high = glm::max(high, p);
    }
    glm::dvec2 low{INFINITY}, high{-INFINITY};
};

// A point inside: in the widest stretch of a level line half way up, which meets no corner but by chance.
glm::dvec2 innerPoint(const Footprint& f) {
    const Bounds bounds(f);
    const double y = bounds.low.y + 0.4871 * (bounds.high.y - bounds.low.y);
    const std::vector<double> xs = crossings(f, y);
    glm::dvec2 best(f.rings[0][0].x, y);
    double widest = -1;
    for (size_t i = 0; i + 1 < xs.size(); i += 2)
        if (xs[i + 1] - xs[i] > widest) widest = xs[i + 1] - xs[i], best.x = (xs[i] + xs[i + 1]) / 2;
    return best;
}

bool holds(const Footprint& f, glm::dvec2 p) {
    const std::vector<double> xs = crossings(f, p.y);
    return (std::lower_bound(xs.begin(), xs.end(), p.x) - xs.begin()) % 2 == 1;
}

}  // namespace

void leaveOutlinesToParts(Town& town) {
    struct Part {
        glm::dvec2 inner;
        double area;
    };
    struct Outline {
        size_t index;
        Bounds bounds;
        double covered = 0;
    };
    std::vector<Part> parts;
    std::vector<Outline> outlines;
    for (size_t i = 0; i < town.footprints.size(); i++) {
        const Footprint& f = town.footprints[i];
        if (f.part)
            parts.push_back({innerPoint(f), areaOf(f)});
        else
            outlines.push_back({i, Bounds(f)});
    }
    if (parts.empty()) return;
    std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.inner.x < b.inner.x; });
    std::sort(outlines.begin(), outlines.end(),
              [](const Outline& a, const Outline& b) { return a.bounds.low.x < b.bounds.low.x; });
    std::vector<Outline*> near;  // those that begin west of the part and may reach it
    size_t next = 0;
    uint64_t tests = 0;
    for (const Part& part : parts) {
        while (next < outlines.size() && outlines[next].bounds.low.x <= part.inner.x) near.push_back(&outlines[next++]);
        near.erase(
            std::remove_if(near.begin(), near.end(), [&](const Outline* o) { return o->bounds.high.x < part.inner.x; }),
            near.end());
        tests += near.size();
        for (Outline* o : near) {
            if (part.inner.y < o->bounds.low.y || part.inner.y > o->bounds.high.y) continue;
            const Footprint& f = town.footprints[o->index];
            tests += f.rings[0].size();
            if (holds(f, part.inner)) o->covered += part.area;
        }
        if (tests > kMostTests) {
            town.diagnostics.push_back(
                {{}, 0, 0, "building:part", "too many overlap: outlines stay beside them", true});
            return;
        }
    }
    std::vector<bool> gone(town.footprints.size());
    for (const Outline& o : outlines) gone[o.index] = o.covered >= kCovered * areaOf(town.footprints[o.index]);
    size_t kept = 0;
    for (size_t i = 0; i < gone.size(); i++)
        if (!gone[i]) {
            if (kept != i) town.footprints[kept] = std::move(town.footprints[i]);
            kept++;
        }
    town.footprints.resize(kept);
}

}  // namespace espalier
