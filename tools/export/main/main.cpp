// A scene in, what grows in it out as glTF: for engines that Espalier doesn't run in.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cinttypes>
#include <cstdio>
#include <memory>

#include "tools/command_line.hpp"
#include "tools/document/document.hpp"
#include "tools/export/export.hpp"
#include "tools/scene/scene.hpp"
#include "tools/scene/text_file.hpp"
#include "tools/scene/user_folders.hpp"

using namespace espalier;
using exporting::Gathered;
using exporting::WindChannel;
using exporting::Written;

namespace {

struct CommandLine {
    scene::Request request;
    std::string out, cache = scene::cacheFolder(), wind = "_WIND";
    std::vector<std::string> only, layers;
    exporting::Options options;
    bool quiet = false, surfaces = false;
};

int fail(const std::string& message) {
    std::fprintf(stderr, "espalier-export: %s\n", message.c_str());
    return 1;
}

void addOptions(CLI::App& app, CommandLine& line) {
    app.set_version_flag("--version", ESPALIER_VERSION);
    app.add_option("SCENE", line.request.file,
                   "a scene (SCENE.json), a project's folder or what espalier-bake wrote (SURFACE.glb)")
        ->required();
    app.add_option("-o,--out", line.out, "the file to write (OUT.glb)")->required();
    app.add_option("--only", line.only, "of ivy, roofs and patterns these alone, with commas between them")
        ->delimiter(',')
        ->check(CLI::IsMember({"ivy", "roofs", "patterns"}));
    app.add_flag("--instancing", line.options.instancing,
                 "leaves, tiles and pieces by EXT_mesh_gpu_instancing in place of a node each: smaller, and not "
                 "read by every importer");
    app.add_flag("--lods", line.options.lods, "coarser levels of detail too, as MSFT_lod");
    app.add_flag("--collision", line.options.collision,
                 "also meshes to collide with, of stems, houses and pieces, below a node of this name");
    app.add_flag("--surfaces", line.surfaces, "also the models that it grows on, packed by Draco as their files are");
    app.add_option("--wind", line.wind,
                   "the attribute of stems and leaves that tells how they move and how old they are: _WIND, COLOR_0 "
                   "or none")
        ->capture_default_str()
        ->check(CLI::IsMember({"_WIND", "COLOR_0", "none"}));
    app.add_option(
           "--stem-error", line.options.stemError,
           "by which stems may differ from their curves, as a share of the radius of the plant's thickest; 0: not at "
           "all, with 216 triangles for each node")
        ->capture_default_str()
        ->check(CLI::Range(0.0f, 10.0f));
    app.add_option("--grammar", line.request.grammar, "takes the place of the scene's first grammar");
    app.add_option("--layer", line.layers,
                   "NAME=FILE: a picture drawn in the model's UVs, or of a town's layer, seen from above")
        ->allow_extra_args(false);
    app.add_option("--cache", line.cache, "folder that keeps compiled grammars (default: in the user's cache)");
    app.add_flag("-q,--quiet", line.quiet, "says nothing but mistakes");
}

// On a terminal only: a line that is written over.
class ProgressLine {
  public:
    explicit ProgressLine(bool quiet) : shown_(!quiet && isatty(STDERR_FILENO) != 0) {}
    ~ProgressLine() { clear(); }
    void at(const char* what, float share) {
        if (!shown_) return;
        std::fprintf(stderr, "\r\033[K%s %.0f%%", what, double(100 * share));
        std::fflush(stderr);
    }
    void clear() {
        if (shown_) std::fprintf(stderr, "\r\033[K");
    }

  private:
    bool shown_;
};

std::unique_ptr<EspContext, void (*)(EspContext*)> makeContext(const CommandLine& line) {
    EspContextDef def = esp::defaults<EspContextDef>();
    if (!line.cache.empty()) def.cacheFolder = line.cache.c_str();
    def.log = [](void*, EspLogLevel level, const char* message) {
        if (level == ESP_LOG_WARNING) std::fprintf(stderr, "espalier-export: warning: %s\n", message);
    };
    EspContext* made = nullptr;
    (void)espCreate(ESP_VERSION, &def, &made);
    return {made, espDestroy};
}

bool readSurfaces(const scene::Scene& scene, Gathered& gathered, std::string& error) {
    for (const scene::LoadedSurface& surface : scene.surfaces) {
        if (!surface.drawn) continue;
        exporting::ExportSurface& out = gathered.surfaces.emplace_back();
        out.name = surface.file;
        out.place = surface.placing.transform();
        if (surface.kept ? !surface.kept->read(out.bytes) : !scene::readText(surface.file, out.bytes, error)) {
            if (error.empty()) error = surface.file + ": can't be read any more as it was when the scene was opened";
            return false;
        }
    }
    return true;
}

int run(CommandLine line) {
    ProgressLine progress(line.quiet);
    const auto context = makeContext(line);
    if (!context) return fail(espLastError(nullptr));
    std::string error;
    document::Document document(context.get());
    line.request.told = [&](const std::string&, float share) { progress.at("opening the scene", share); };
    if (!document.open(line.request, error)) return progress.clear(), fail(error);
    progress.at("growing", 0);
    if (espUpdate(context.get()) != ESP_OK) return progress.clear(), fail(espLastError(context.get()));
    progress.at("gathering", 0);
    Gathered gathered;
    if (!exporting::gather(context.get(), line.options, gathered, error))
        return progress.clear(), fail(line.request.file + ": " + error);
    if (line.surfaces && !readSurfaces(document.scene(), gathered, error)) return progress.clear(), fail(error);
    std::string bytes;
    Written written;
    const auto goOn = [&](float share) { return progress.at("encoding", share), true; };
    if (!exporting::encode(gathered, line.options, goOn, bytes, written, error))
        return progress.clear(), fail(line.out + ": " + error);
    progress.at("writing", 0);
    if (!scene::writeText(line.out, bytes, error)) return progress.clear(), fail(error);
    progress.clear();
    if (!line.quiet)
        std::printf("%s: %" PRIu64 " triangles of %" PRIu64 " instances, %" PRIu64 " meshes, %" PRIu64
                    " materials, %" PRIu64 " nodes, %.1f MB\n",
                    line.out.c_str(), written.triangles, written.instances, written.meshes, written.materials,
                    written.nodes, double(written.bytes) * 1e-6);
    return 0;
}

int exportAsAsked(int argc, char** argv) {
    CLI::App app{"Writes what grows in a scene as glTF, for engines and Blender.", "espalier-export"};
    CommandLine line;
    addOptions(app, line);
    if (const auto ends = parseCommandLine(app, argc, argv)) return *ends;
    if (!line.only.empty()) {
        const auto has = [&](const char* kind) { return std::ranges::find(line.only, kind) != line.only.end(); };
        line.options.ivy = has("ivy"), line.options.roofs = has("roofs"), line.options.patterns = has("patterns");
    }
    line.options.wind = line.wind == "none"      ? WindChannel::none
                        : line.wind == "COLOR_0" ? WindChannel::colour
                                                 : WindChannel::own;
    if (const std::string wrong = takeLayers(line.layers, line.request.layers); !wrong.empty()) return fail(wrong), 2;
    std::vector<std::string> reads{line.request.file, line.request.grammar};
    for (const auto& [layer, file] : line.request.layers) reads.push_back(file);
    if (const auto lost = writtenOver(reads, {line.out})) return fail(*lost + " would overwrite what is read"), 2;
    return run(std::move(line));
}

}  // namespace

int main(int argc, char** argv) {
    return espalier::runProgram("espalier-export", [&] { return exportAsAsked(argc, argv); });
}
