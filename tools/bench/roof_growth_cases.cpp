// roof/expand-...: all roofs of a town with a full covering, as native code on a software device, the CPU reference on
// two threads beside it; native code and shaders; one house beside the town; bytes a tile.
#include <fstream>
#include <sstream>

#include "runtime/roof/shapes.hpp"
#include "runtime/roof_growth/roof_growth.hpp"
#include "tools/bench/bench.hpp"

namespace espalier {
namespace {

// Ten tiles a square metre.
const char* kCovering =
    "House -> Extrude(wallHeight) {NULL, TopWall}\n"
    "TopWall -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, TopWall}\n"
    "Cover : faceKind == gableFace -> NULL\n"
    "Cover -> Repeat(XY, vec2(0.4, 0.25), bond) {Shape(\"slate\")}\n";

}  // namespace

void roofGrowthCases(Bench& bench) {
    const std::string name = "roof/expand-bayreuth",
                      path = bench.options().dataFolder + "/footprints/osm_north_bayreuth_DE.geojson";
    if (!bench.wants(name)) return;
    Result<Town> town = readFootprints(path);
    if (!town) return bench.skip(name, "needs " + path);
    Result<std::unique_ptr<Device>> device = Device::create();
    if (!device) return bench.skip(name, device.failure().text());
    auto growth = RoofGrowth::create(**device);
    CompileOptions options;
    options.roofMeshes = {{"slate", false}};
    Result<RuleMap> map = compileGrammar(kCovering, options);
    if (!growth || !map) return bench.skip(name, "the grammar doesn't compile");
    std::vector<Diagnostic> diagnostics;
    const RoofStructure structure = roofsOf(town->footprints, diagnostics);
    RoofTables tables = makeAtoms(structure);
    const std::vector<RoofMesh> meshes(1, RoofMesh{{0, 0, 0}, {1, 1.1f, 0.02f}});
    RoofInputs inputs;
    inputs.town = &tables;
    inputs.townRevision = 1;
    inputs.grammar = &*map;
    inputs.meshes = meshes;
    // As after an edit of a parameter: the town stands, the grammar is sent and applied anew.
    auto growTown = [&] {
        inputs.grammarRevision += 1;
        (void)(*growth)->grow(inputs);
    };
    growTown();  // loads the town into one of two sets of buffers,
    growTown();  // and into the other
    const Pair whole = medianSeconds(bench.options().repeats, growTown, [&] { (void)growRoofsOnCpu(inputs, 2); });
    std::vector<double> ours, theirs, shaders;
    for (int i = 0; i < bench.options().repeats; ++i) {
        ours.push_back(cpuSeconds(growTown));
        theirs.push_back(cpuSeconds([&] { (void)growRoofsOnCpu(inputs, 2); }));
    }
    const bool native = (*growth)->stats().native;
    inputs.native = false;
    growTown();  // makes the kernels
    for (int i = 0; i < bench.options().repeats; ++i) shaders.push_back(cpuSeconds(growTown));
    const RoofStats stats = (*growth)->stats();
    inputs.native = true;
    growTown();
    bench.add({name + "/cpu", "all roofs anew, CPU time", "ms", 1e3 * median(ours), "the same in C++ on two threads",
               1e3 * median(theirs)});
    bench.add(
        {name, "all roofs anew, wall clock", "ms", 1e3 * whole.a, "the same in C++ on two threads", 1e3 * whole.b});
    if (native)
        bench.add({name + "/native", "all roofs anew as native code, CPU time", "ms", 1e3 * median(ours), "as shaders",
                   1e3 * median(shaders)});
    bench.add({name + "/gpu", "GPU time of it as shaders", "ms", stats.expandMs, "bound on a graphics card", 10});
    bench.add({name + "/tiles", "tiles", "tiles", double(stats.tiles), "asked for", 9.5e6});
    bench.add({name + "/memory", "bytes of a tile", "B", double(stats.bytes) / double(stats.tiles), "bound", 8});
    uint32_t house = 0;
    const Pair one = medianSeconds(
        bench.options().repeats * 3,
        [&] {
            house = (house + 997) % uint32_t(tables.houses.size());
            (void)(*growth)->growHouses(inputs, std::span(&house, 1));
        },
        [] {});
    std::vector<double> houseSeconds;
    for (int i = 0; i < bench.options().repeats * 3; ++i) {
        house = (house + 997) % uint32_t(tables.houses.size());
        houseSeconds.push_back(cpuSeconds([&] { (void)(*growth)->growHouses(inputs, std::span(&house, 1)); }));
    }
    bench.add({name + "/house-cpu", "one house anew, CPU time", "ms", 1e3 * median(houseSeconds), "a 200th of the town",
               1e3 * median(ours) / 200});
    bench.add(
        {name + "/house", "one house anew, wall clock", "ms", 1e3 * one.a, "a 200th of the town", 1e3 * whole.a / 200});
}

}  // namespace espalier
