// In: a town's footprints, parts of buildings among them. Out: those that are to be built. A sweep from west to east
// brings each part to the outlines whose bounds hold it.
#include "runtime/roof/footprint_parts.hpp"

#include <algorithm>

#include "runtime/roof/footprint_plan.hpp"

namespace espalier {

namespace {

constexpr double kCovered = 0.9;
constexpr uint64_t kMostTests = 20'000'000;  // pairs of a part and an outline, and edges of outlines

}  // namespace

void leaveOutlinesToParts(Town& town) {
    struct Part {
        glm::dvec2 inner;
        double area;
    };
    struct Outline {
        size_t index;
        PlanBounds bounds;
        double covered = 0;
    };
    std::vector<Part> parts;
    std::vector<Outline> outlines;
    for (size_t i = 0; i < town.footprints.size(); i++) {
        const Footprint& f = town.footprints[i];
        if (f.part)
            parts.push_back({innerPoint(f), areaOf(f)});
        else
            outlines.push_back({i, PlanBounds(f)});
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
            addMessages(town.diagnostics,
                        {{{}, 0, 0, "building:part", "too many overlap: outlines stay beside them", true}});
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
