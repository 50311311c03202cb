// At unit weights the roof is CGAL's.
#ifdef ESPALIER_CGAL
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "runtime/roof/shapes.hpp"
#include "tests/roof/structure_cases.hpp"
#include "tests/roof/structure_cgal/skeleton.hpp"
#include "tests/roof/structure_judge.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// Largest difference of height between the two, over samples; relative to the size.
double difference(const RoofStructure& roof, const CgalSkeleton& cgal) {
    const RoofHouse& house = roof.houses[0];
    glm::dvec2 low(INFINITY), high(-INFINITY);
    for (glm::dvec2 p : house.rings[0]) low = glm::min(low, p), high = glm::max(high, p);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> x(low.x, high.x), y(low.y, high.y);
    double worst = 0;
    for (int i = 0; i < 60; i++) {
        glm::dvec2 p(x(random), y(random));
        double ours = heightAt(roof, 0, p), theirs = cgal.heightAt(p);
        if (std::isfinite(ours) && std::isfinite(theirs)) worst = std::max(worst, std::abs(ours - theirs));
    }
    return worst / glm::distance(low, high);
}

}  // namespace

TEST_CASE("unit weights give CGAL's skeleton") {
    for (const char* file : {"osm_north_bayreuth_DE_local.json", "osm_monaco_west_local.json",
                             "osm_campo_grande_BR_local.json", "bpypolyskel_cases.json"}) {
        size_t compared = 0, failed = 0;
        for (Footprint& f : casesOf(file)) {
            f.slope = 1;
            std::vector<Diagnostic> said;
            RoofStructure roof = roofOf(f, said);
            REQUIRE(roof.houses.size() >= 1);
            std::vector<RepairedOutline> outlines = repairOutline(f, said);
            CgalSkeleton cgal = cgalSkeleton(outlines[0].rings);
            if (cgal.faces.empty()) {
                failed++;
                continue;
            }
            INFO(file << " " << f.id);
            CHECK(difference(roof, cgal) < 1e-4);
            compared++;
        }
        MESSAGE(std::string(file) << ": " << compared << " compared, CGAL failed on " << failed);
    }
}
#endif
