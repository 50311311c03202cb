// roof/structure-…: roof structures of all real outlines, beside CGAL's bare straight skeleton of the same outlines.
#include <glm/glm.hpp>

#include "runtime/roof/shapes.hpp"
#include "tools/bench/bench.hpp"
#ifdef ESPALIER_CGAL
#include "tests/roof/structure_cgal/skeleton.hpp"
#endif

namespace espalier {

namespace {

struct Outlines {
    std::vector<Footprint> given;
    std::vector<std::vector<std::vector<glm::dvec2>>> repaired;
};

void row(Bench& bench, const std::string& name, const std::string& figure, double houses, const Outlines& outlines,
         const std::vector<Footprint>& footprints) {
    size_t made = 0;
    auto ours = [&] {
        std::vector<Diagnostic> said;
        RoofStructure roof;
        made = 0;
        for (const Footprint& f : footprints) made += appendRoof(f, roof, said);
    };
    double other = 0;
    std::string otherName = "none";
    Pair pair;
#ifdef ESPALIER_CGAL
    size_t faces = 0;
    pair = medianSeconds(bench.options().repeats, ours, [&] {
        for (const auto& rings : outlines.repaired) faces += test::cgalFaces(rings);
    });
    other = 1e6 * pair.b / houses;
    otherName = "CGAL's bare skeleton, no check, unit weights";
#else
    (void)outlines;
    pair.a = seconds(ours);
#endif
    bench.add({name, figure, "us/house", 1e6 * pair.a / houses, otherName, other});
    if (made != footprints.size())
        bench.skip(name, std::to_string(footprints.size() - made) + " houses without a roof");
}

}  // namespace

void roofStructureCases(Bench& bench) {
    const std::string hip = "roof/structure-osm", gable = "roof/structure-gable";
    if (!bench.wants(hip) && !bench.wants(gable)) return;
    Outlines outlines;
    for (const char* file : {"north_bayreuth_DE", "monaco_west", "campo_grande_BR"}) {
        std::string path = bench.options().dataFolder + "/footprints/osm_" + file + "_local.json";
        Result<Town> town = readFootprints(path);
        if (!town) return bench.skip("roof/structure", "needs " + path);
        for (Footprint& f : town->footprints) outlines.given.push_back(std::move(f));
    }
    for (const Footprint& f : outlines.given) {
        std::vector<Diagnostic> said;
        for (RepairedOutline& o : repairOutline(f, said)) outlines.repaired.push_back(std::move(o.rings));
    }
    double houses = double(outlines.given.size());
    std::string count = std::to_string(outlines.given.size()) + " outlines, one core: repair, ";
    if (bench.wants(hip)) row(bench, hip, count + "hip roof, check", houses, outlines, outlines.given);
    if (!bench.wants(gable)) return;
    for (Footprint& f : outlines.given) f.shape = RoofShape::gable;
    row(bench, gable, count + "gabled roof, check", houses, outlines, outlines.given);
}

}  // namespace espalier
