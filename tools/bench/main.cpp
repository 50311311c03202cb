// espalier-bench: rows of figures, each with its other side measured in the same run.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>

#include "runtime/gpu/device.hpp"
#include "tools/bench/bench.hpp"
#include "tools/command_line.hpp"
#include "tools/scene/heap.hpp"

using namespace espalier;

namespace {

int measureAsAsked(int argc, char** argv) {
    scene::keepHeap();
    BenchOptions options;
    std::string csv;
    const char* data = std::getenv("ESPALIER_DATA");
    options.dataFolder = data ? data : "../shared/data";
    options.contentFolder = ESPALIER_CONTENT;
    options.modulesFolder = ESPALIER_NODE_MODULES;
    CLI::App app("Espalier's benchmark: medians; every row names the other side and the ratio ours / other.",
                 "espalier-bench");
    app.set_version_flag("--version", ESPALIER_VERSION);
    app.add_option("--filter", options.filter,
                   "only cases whose name contains this: growth/, edit/, emit/, frame/, render/, paint/, bake/, "
                   "surface/, contact/, move/, roof/, pattern/, field/, load/, graph/");
    app.add_option("--csv", csv, "also write the rows to this file");
    app.add_option("--data", options.dataFolder, "folder of further models")->capture_default_str();
    app.add_option("--modules", options.modulesFolder,
                   "folder of node's modules: with watlas in it, bake/atlas is compared with xatlas [default: "
                   "xatlas/node_modules in the build's folder]");
    app.add_option("--repeats", options.repeats, "measured runs of each")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    if (const auto ends = espalier::parseCommandLine(app, argc, argv)) return *ends;

    if (Result<std::unique_ptr<Device>> device = Device::create())
        std::printf("device: %s (%s)\n", (*device)->info().name.c_str(), (*device)->info().driver.c_str());
    Bench bench(options);
    growthCases(bench);
    fieldCases(bench);
    patternCases(bench);
    graphCases(bench);
    editCases(bench);
    emitCases(bench);
    exportCases(bench);
    frameCases(bench);
    placeCases(bench);
    bakeCases(bench);
    atlasCases(bench);
    contactCases(bench);
    moveCases(bench);
    paintCases(bench);
    surfaceCases(bench);
    loadCases(bench);
    lodCases(bench);
    roofStructureCases(bench);
    roofGrowthCases(bench);
    if (!bench.told()) {
        std::fprintf(stderr, "espalier-bench: no case whose name contains '%s'\n", options.filter.c_str());
        return 2;
    }
    if (csv.empty()) return 0;
    Status written = bench.writeCsv(csv);
    if (!written) std::fprintf(stderr, "espalier-bench: %s\n", written.failure().text().c_str());
    return written ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    return runProgram("espalier-bench", [&] { return measureAsAsked(argc, argv); });
}
