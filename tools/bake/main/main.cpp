// espalier-bake: a model becomes a surface that plants can grow on, or a folder of models a folder of surfaces.
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <new>
#include <string>

#include "runtime/core/file.hpp"
#include "tools/bake/bake.hpp"
#include "tools/bake/main/beforehand.hpp"
#include "tools/bake/main/carry_layers.hpp"
#include "tools/bake/main/folder.hpp"
#include "tools/bake/main/options.hpp"
#include "tools/bake/main/palette.hpp"
#include "tools/bake/pictures.hpp"
#include "tools/command_line.hpp"

using namespace espalier;

namespace {

// While one lives, signals that would end the program wait: what is being written gets whole or not there.
class Uninterrupted {
  public:
    Uninterrupted() {
        sigset_t blocked;
        sigemptyset(&blocked);
        for (int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&blocked, signal);
        ::sigprocmask(SIG_BLOCK, &blocked, &before_);
    }
    ~Uninterrupted() { ::sigprocmask(SIG_SETMASK, &before_, nullptr); }

  private:
    sigset_t before_;
};

int fail(const Failure& failure) {
    std::fprintf(stderr, "espalier-bake: %s\n", failure.text().c_str());
    return 1;
}

// A command line that says nothing that can be done.
int refuse(const Failure& failure) {
    fail(failure);
    return 2;
}

InputKind kindOf(const std::string& path) {
    if (isTown(path)) return InputKind::town;
    std::error_code ignored;
    return std::filesystem::is_directory(path, ignored) ? InputKind::folder : InputKind::model;
}

void showProgress(float done, const char* stage) {
    if (isatty(STDERR_FILENO)) {
        std::fprintf(stderr, "\r\x1b[K%3d %% %s", int(done * 100), stage);
        if (done >= 1) std::fputc('\n', stderr);
    } else {
        std::fprintf(stderr, "%3d %% %s\n", int(done * 100), stage);
    }
}

int runModel(Arguments& arguments) {
    if (!arguments.quiet) showProgress(0, "read");
    std::vector<std::string> reads{arguments.model, arguments.weights, arguments.carry.from, arguments.carry.seeds};
    reads.insert(reads.end(), arguments.carry.layers.begin(), arguments.carry.layers.end());
    if (const auto lost = writtenOver(reads, {arguments.output, arguments.report}))
        return refuse(Failure(*lost, "would overwrite what is read, or another file that is written"));
    auto model = importModel(arguments.model, arguments.importing);
    if (!model) return fail(model.failure());
    if (!arguments.quiet)
        arguments.bake.progress = [](float done, const char* stage) { showProgress(0.1f + done * 0.7f, stage); };
    if (!arguments.weights.empty()) {
        auto weights = readLayer(arguments.weights);
        if (!weights) return fail(weights.failure());
        arguments.bake.weights = std::move(*weights);
    }
    auto baked = bake(*model, arguments.bake);
    if (!baked) return fail(baked.failure());
    if (!arguments.images.empty()) {
        if (!arguments.quiet) showProgress(0.82f, "pictures");
        Status drawn = writePictures(baked->surface, arguments.images);
        if (!drawn) return fail(drawn.failure());
    }
    if (!arguments.quiet && !arguments.carry.from.empty()) showProgress(0.84f, "layers");
    auto layers = carryLayers(arguments.carry, baked->surface, arguments.output, baked->report.warnings);
    if (!layers) return fail(layers.failure());
    if (!arguments.quiet) showProgress(0.85f, "write");
    Uninterrupted writing;
    // The surface last: one that exists is one that is complete.
    Beforehand others;
    for (const CarriedFile& layer : *layers)
        if (Status written = others.write(layer.path, layer.bytes); !written) return fail(written.failure());
    if (!arguments.report.empty()) {
        const std::string report = baked->report.json();
        Status written = others.write(arguments.report, std::as_bytes(std::span(report)));
        if (!written) return fail(written.failure());
    }
    if (Status written = writeSurface(baked->surface, arguments.output); !written) return fail(written.failure());
    others.keep();
    if (!arguments.quiet) showProgress(1, "done");
    for (const Diagnostic& d : baked->report.warnings) std::fprintf(stderr, "%s\n", toString(d).c_str());
    return 0;
}

int runFolder(const Arguments& arguments, const CLI::App& app) {
    folder::Options options;
    options.folder = arguments.model;
    options.out = arguments.output;
    options.importing = arguments.importing;
    options.bake = arguments.bake;
    options.jobs = arguments.jobs;
    options.quiet = arguments.quiet;
    if (!arguments.shard.empty()) {
        char rest = 0;
        if (std::sscanf(arguments.shard.c_str(), "%u/%u%c", &options.shard, &options.shards, &rest) != 2 ||
            options.shard < 1 || options.shard > options.shards)
            return refuse(Failure("--shard " + arguments.shard, "is not i/n with i from 1 to n"));
    }
    // What changes a surface is all but where things lie and how the work is spread.
    for (const CLI::Option* option : app.get_options()) {
        std::string name = option->get_name();
        if (option->count() == 0 || name == "MODEL" || name == "--output" || name == "--shard" || name == "--jobs" ||
            name == "--quiet")
            continue;
        options.asked += (options.asked.empty() ? "" : " ") + name;
        for (const std::string& value : option->results()) options.asked += "=" + value;
    }
    return folder::run(options);
}

int runTown(Arguments& arguments) {
    std::error_code ignored;
    if (const auto lost =
            writtenOver({arguments.model, arguments.town.grammar, arguments.town.meshes}, {arguments.output}))
        return refuse(Failure(*lost, "the town would overwrite what it is made of"));
    arguments.town.footprints = arguments.model;
    arguments.town.output = arguments.output;
    arguments.town.quiet = arguments.quiet;
    if (arguments.town.meshes.empty())
        arguments.town.meshes =
            (std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path().parent_path() / "content/roofs.glb")
                .string();
    Status baked = bakeTown(arguments.town);
    return baked ? 0 : fail(baked.failure());
}

int runPalette(const Arguments& arguments) {
    if (const auto lost = writtenOver({arguments.model}, {arguments.output}))
        return refuse(Failure(*lost, "the palette would overwrite what it is made of"));
    const auto bake = arguments.terminal ? bakeTerminal : bakePalette;
    const Status baked = bake({arguments.model, arguments.output, arguments.importing}, [&](const std::string& line) {
        if (!arguments.quiet) std::fprintf(stderr, "%s\n", line.c_str());
    });
    return baked ? 0 : fail(baked.failure());
}

int bakeAsAsked(int argc, char** argv) {
    CLI::App app("Bakes a model, or all models of a folder, into surfaces that plants can grow on; or a town.",
                 "espalier-bake");
    Arguments arguments;
    app.set_version_flag("--version", std::string("espalier-bake ") + ESPALIER_VERSION);
    addOptions(app, arguments);
    if (const auto ends = espalier::parseCommandLine(app, argc, argv)) return *ends;
    try {
        const InputKind kind = kindOf(arguments.model);
        if (const auto mistake = mistakeIn(app, arguments, kind)) return refuse(*mistake);
        arguments.bake.nearestTolerance = float(arguments.tolerance);
        if (const auto& o = arguments.origin; o.size() == 3) arguments.importing.origin = glm::dvec3(o[0], o[1], o[2]);
        if (arguments.pieces || arguments.terminal) return runPalette(arguments);
        if (kind == InputKind::town) return runTown(arguments);
        return kind == InputKind::folder ? runFolder(arguments, app) : runModel(arguments);
    } catch (const std::bad_alloc&) {
        return fail(Failure(arguments.model, "baking it at this resolution takes more memory than there is"));
    } catch (const std::exception& e) {  // of the file system, say
        return fail(Failure(arguments.model, e.what()));
    }
}

}  // namespace

int main(int argc, char** argv) {
    return runProgram("espalier-bake", [&] { return bakeAsAsked(argc, argv); });
}
