// espalier-bake: a model becomes a surface that plants can grow on.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <new>
#include <string>

#include "runtime/core/file.hpp"
#include "tools/bake/bake.hpp"
#include "tools/bake/pictures.hpp"

using namespace espalier;

namespace {

struct Arguments {
    std::string model, output, report, images;
    uint32_t resolution = 1024, levels = 0;
    int uvSet = 0;
    double tolerance = 0;
    bool keepLayout = false, quiet = false;
};

int fail(const Failure& failure) {
    std::fprintf(stderr, "espalier-bake: %s\n", failure.text().c_str());
    return 1;
}

void showProgress(float done, const char* stage) {
    if (isatty(STDERR_FILENO)) {
        std::fprintf(stderr, "\r\x1b[K%3d %% %s", int(done * 100), stage);
        if (done >= 1) std::fputc('\n', stderr);
    } else {
        std::fprintf(stderr, "%3d %% %s\n", int(done * 100), stage);
    }
}

int run(const Arguments& arguments) {
    if (!arguments.quiet) showProgress(0, "read");
    std::error_code ignored;
    if (std::filesystem::equivalent(arguments.model, arguments.output, ignored))
        return fail(Failure(arguments.output, "the surface would overwrite its model"));
    auto model = importModel(arguments.model, arguments.uvSet);
    if (!model) return fail(model.failure());
    BakeOptions options;
    options.resolution = arguments.resolution;
    options.levels = arguments.levels;
    options.nearestTolerance = float(arguments.tolerance);
    options.keepLayout = arguments.keepLayout;
    if (!arguments.quiet)
        options.progress = [](float done, const char* stage) { showProgress(0.1f + done * 0.7f, stage); };
    auto baked = bake(*model, options);
    if (!baked) return fail(baked.failure());
    if (!arguments.images.empty()) {
        if (!arguments.quiet) showProgress(0.82f, "pictures");
        Status drawn = writePictures(baked->surface, arguments.images);
        if (!drawn) return fail(drawn.failure());
    }
    if (!arguments.quiet) showProgress(0.85f, "write");
    // The report first: a surface that exists is one that is complete.
    if (!arguments.report.empty()) {
        Status written = writeFile(arguments.report, baked->report.json());
        if (!written) return fail(written.failure());
    }
    Status written = writeSurface(baked->surface, arguments.output);
    if (!written) {
        if (!arguments.report.empty()) std::filesystem::remove(arguments.report, ignored);
        return fail(written.failure());
    }
    if (!arguments.quiet) showProgress(1, "done");
    for (const Diagnostic& d : baked->report.warnings) std::fprintf(stderr, "%s\n", toString(d).c_str());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Bakes a glTF model into a surface that plants can grow on.", "espalier-bake");
    Arguments arguments;
    app.set_version_flag("--version", std::string("espalier-bake ") + ESPALIER_VERSION);
    app.add_option("MODEL", arguments.model, ".gltf or .glb with unwrapped UVs")->required();
    app.add_option("-o,--output", arguments.output, "the surface to write (.glb)")->required();
    app.add_option("--resolution", arguments.resolution,
                   "texels a side of the finest level, a power of two, 64 to 8192")
        ->capture_default_str();
    app.add_option("--levels", arguments.levels, "levels, each half as fine as the one before; 0: down to 64 texels")
        ->capture_default_str()
        ->check(CLI::Range(0, 8));
    app.add_option("--report", arguments.report, "write the report (JSON) here");
    app.add_option("--images", arguments.images, "write charts, links, contacts and stretch as .png into this folder");
    app.add_option("--tolerance", arguments.tolerance,
                   "metres within which borders without a twin are linked; 0: one texel's footprint")
        ->check(CLI::NonNegativeNumber);
    app.add_option("--uv-set", arguments.uvSet, "the TEXCOORD set that is unwrapped")
        ->capture_default_str()
        ->check(CLI::Range(0, 1));
    app.add_flag("--keep-layout", arguments.keepLayout, "never move charts apart");
    app.add_flag("-q,--quiet", arguments.quiet, "no progress, warnings only");
    CLI11_PARSE(app, argc, argv);
    try {
        return run(arguments);
    } catch (const std::bad_alloc&) {
        return fail(Failure(arguments.model, "baking it at this resolution takes more memory than there is"));
    }
}
