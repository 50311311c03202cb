// A scene or a surface in, PNG frames and figures out, without a window: for tests that compare pictures and counts.
// Frame 0 shows the scene's own view, the others follow on one turn around its target: the same on every run. With
// --replay the frames are those of a recorded run instead.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "plugin_api/espalier.hpp"
#include "tools/baking/graph_bakes.hpp"
#include "tools/capture/figures.hpp"
#include "tools/command_line.hpp"
#include "tools/document/document.hpp"
#include "tools/document/layer_files.hpp"
#include "tools/document/run.hpp"
#include "tools/scene/daylight.hpp"
#include "tools/scene/jitter.hpp"
#include "tools/scene/layers.hpp"
#include "tools/scene/moving.hpp"
#include "tools/scene/picture.hpp"
#include "tools/scene/scene.hpp"
#include "tools/scene/scene_file.hpp"
#include "tools/scene/text_file.hpp"
#include "tools/scene/user_folders.hpp"

using namespace espalier::scene;
using espalier::document::Document;
using espalier::document::Run;

namespace {

struct LayerFile {
    std::string layer, file;
};

constexpr double kFrameRate = 30;  // of films, for the wind

struct Options {
    Request request;
    std::vector<std::string> layersSaid, exportsSaid;  // as they were written
    std::vector<LayerFile> exports;
    uint32_t frames = 1;
    uint32_t width = 1280, height = 720;
    std::optional<float> hour;
    std::optional<std::string> ground;
    double clock = 0;
    std::string size, folder = "out", stats, view = "shaded", walk, camera, cache = cacheFolder(), replay;
    uint32_t every = 1, frame = 0, smooth = 1;
    long long seed = -1;
    uint32_t maxNodes = esp::defaults<EspGrowDef>().maxNodes;
    float leafCap = 0;
    bool sized = false, aimed = false;  // --size, --camera say something, be it nothing
    bool shaders = false, validation = false, moving = false, still = false;
};

void warn(const std::string& message) {
    std::fprintf(stderr, "espalier-capture: warning: %s\n", message.c_str());
}

int fail(const std::string& message) {
    std::fprintf(stderr, "espalier-capture: %s\n", message.c_str());
    return 1;
}

// A command line that says nothing that can be done.
int refuse(const std::string& message) {
    fail(message);
    return 2;
}

void addOptions(CLI::App& app, Options& options) {
    app.set_version_flag("--version", ESPALIER_VERSION);
    app.add_option("FILE", options.request.file,
                   "a scene (SCENE.json), a project's folder, a procedural graph (.graph) or what espalier-bake wrote "
                   "(SURFACE.glb)");
    app.add_option("--frame", options.frame, "that graphs show in the first picture; each picture is a frame later")
        ->check(CLI::Range(0u, 16000000u));
    app.add_flag("--still", options.still, "graphs show the same frame in all pictures");
    const auto replay = app.add_option(
        "--replay", options.replay,
        "a recorded run: opens what it was recorded on (or FILE), does what was done and writes its frames");
    app.add_option("--every", options.every, "of a run, writes each N-th frame and the last")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000000))
        ->needs(replay);
    const auto frames = app.add_option("--frames", options.frames, "how many; they go once around the scene's target")
                            ->capture_default_str()
                            ->check(CLI::Range(1, 100000));
    frames->excludes(replay);
    app.add_option("--size", options.size, "WIDTHxHEIGHT in pixels (default 1280x720, of a run its own)");
    app.add_option("-o,--out", options.folder, "folder for frame_0000.png ...")->capture_default_str();
    app.add_option("--stats", options.stats,
                   "writes counts, times, bytes, the growth's hash, the device and hashes of all inputs as JSON");
    app.add_option("--seed", options.seed, "the seeds' random numbers are N, N + 1 ... instead of the scene's")
        ->check(CLI::Range(0ll, 4294967295ll));
    app.add_option("--times", options.request.times, "plants each seed so many times, with other random numbers")
        ->check(CLI::Range(1, 1000))
        ->excludes(replay);
    app.add_option("--grammar", options.request.grammar, "takes the place of the scene's first grammar");
    app.add_option("--layer", options.layersSaid,
                   "NAME=FILE: a picture drawn in the model's UVs, or of a town's layer, seen from above")
        ->allow_extra_args(false);
    app.add_option(
           "--export", options.exportsSaid,
           "NAME=FILE: after the last frame writes a layer over the surface's walk UVs, or of a town's seen from "
           "above (.exr, .png)")
        ->allow_extra_args(false);
    app.add_option("--view", options.view, "shaded, charts, normals, lod, depth, overdraw, layer:NAME or field:NAME")
        ->capture_default_str()
        ->excludes(replay);
    app.add_option("--camera", options.camera, "EX,EY,EZ,TX,TY,TZ[,FOV]: eye, target, vertical angle in degrees")
        ->excludes(replay);
    app.add_option("--hour", options.hour, "light of this time of the day, 0 to 24, instead of the scene's")
        ->check(CLI::Range(0.0, 24.0))
        ->excludes(replay);
    app.add_option("--ground", options.ground, "none, meadow or studio under it all, instead of what the scene says")
        ->check(CLI::IsMember({"none", "meadow", "studio"}))
        ->excludes(replay);
    app.add_option("--clock", options.clock,
                   "seconds, of the scene's wind in the first frame; each frame is a thirtieth of a second later")
        ->check(CLI::Range(0.0, 1e9));
    app.add_option("--walk", options.walk, "intrinsic or paper, instead of what the scene says")
        ->check(CLI::IsMember({"intrinsic", "paper"}));
    app.add_option("--max-nodes", options.maxNodes, "growth stops there")
        ->capture_default_str()
        ->check(CLI::Range(1u, 4294967295u));
    app.add_option("--leaf-cap", options.leafCap, "leaves per square metre and seed at most, 0: no cap")
        ->capture_default_str();
    app.add_option("--cache", options.cache,
                   "folder that keeps compiled grammars and which devices have passed the self-check (default: in the "
                   "user's cache)");
    const auto moving =
        app.add_flag("--moving", options.moving,
                     "drawn as a window does on a slow device while its camera moves: coarser, and sooner done");
    app.add_option("--smooth", options.smooth,
                   "each frame is the mean of so many pictures, fractions of a pixel apart: smooth leaves and twigs")
        ->capture_default_str()
        ->check(CLI::Range(1, 64))
        ->excludes(moving);
    app.add_flag("--shaders", options.shaders, "growth by shaders on a software device too, not as native code");
    app.add_flag("--validation", options.validation, "with Vulkan's validation layer (also: ESPALIER_VALIDATION=1)");
}

bool parseCamera(const std::string& text, EspCamera& camera) {
    float v[7];
    int count = 0;
    const char *at = text.data(), *const end = at + text.size();
    for (bool more = true; more; ++count) {
        if (count == 7) return false;
        while (at != end && *at == ' ') ++at;
        auto [rest, wrong] = std::from_chars(at, end, v[count]);
        while (rest != end && *rest == ' ') ++rest;
        if (wrong != std::errc() || (rest != end && *rest != ',')) return false;
        more = rest != end;
        at = more ? rest + 1 : rest;
    }
    if (count < 6) return false;
    for (int i = 0; i < 3; ++i) {
        camera.eye[i] = v[i];
        camera.target[i] = v[3 + i];
    }
    if (count == 7) camera.fovY = v[6] * 3.14159265f / 180;
    if (!(camera.fovY >= fovOfDegrees(kLeastFov) && camera.fovY <= fovOfDegrees(kMostFov))) return false;
    return std::all_of(v, v + count, [](float x) { return std::isfinite(x); }) && !std::equal(v, v + 3, v + 3);
}

bool parseView(const std::string& text, EspLook& look) {
    const size_t colon = std::min(text.find(':'), text.size());
    if (!viewNamed(text.substr(0, colon), look.view)) return false;
    const bool named = look.view == ESP_VIEW_LAYER || look.view == ESP_VIEW_FIELD;
    if (named) look.viewLayer = text.c_str() + std::min(colon + 1, text.size());
    return named == (colon < text.size());
}

// Where frames go and how they look.
struct Film {
    EspContext* context;
    esp::DrawDef draw;
    std::string folder;
    bool moving = false;
    double clock = 0;   // of the first frame
    bool rests = true;  // growth does: shadows that lag make no picture depend on which others are taken
    std::vector<uint8_t> pixels;
    uint32_t smooth = 1;  // pictures of which a frame is the mean

    bool begin(std::string& error) {
        std::error_code code;
        std::filesystem::create_directories(folder, code);
        if (code) error = folder + ": can't be made: " + code.message();
        pixels.resize(size_t(draw.width) * draw.height * 4);
        return !code;
    }
    bool take(uint32_t frame, std::string& error) {
        esp::DrawDef shown = draw;
        if (moving) espalier::scene::MovingDetail().apply(shown.look);
        shown.look.shadowsLag = moving && rests;
        shown.look.clock = clock + frame / kFrameRate;
        if (!drawMean(shown)) {
            error = espLastError(context);
            return false;
        }
        return writePng(file(frame), pixels.data(), draw.width, draw.height, error);
    }
    bool drawMean(esp::DrawDef& shown) {
        std::vector<uint32_t> sums(pixels.size(), smooth / 2);
        const EspCamera still = shown.camera;
        for (uint32_t i = 0; i < smooth; ++i) {
            shown.camera = espalier::scene::jittered(still, i, draw.width, draw.height);
            if (espDraw(context, &shown) != ESP_OK || espReadPixels(context, pixels.data(), pixels.size()) != ESP_OK)
                return false;
            for (size_t k = 0; k < pixels.size(); ++k) sums[k] += pixels[k];
        }
        for (size_t k = 0; k < pixels.size(); ++k) pixels[k] = uint8_t(sums[k] / smooth);
        return true;
    }
    std::string file(uint32_t frame) const {
        char name[32];
        std::snprintf(name, sizeof name, "frame_%04u.png", frame);
        return (std::filesystem::path(folder) / name).string();
    }
    // Of an earlier, longer film: who compares folders would compare it, too.
    void warnOfOld(uint32_t frames) const {
        std::error_code ignored;
        if (std::filesystem::exists(file(frames), ignored)) warn(file(frames) + " is there from before");
    }
};

// At the foot of all surfaces where the scene has no ground of its own.
void layGround(const Scene& scene, EspContext* context, const std::string& name, EspLook& look) {
    EspGround ground = ESP_GROUND_NONE;
    (void)groundNamed(name, ground);
    EspSurfaceInfo info;
    float lowest = std::numeric_limits<float>::infinity();
    for (const auto& surface : scene.surfaces)
        if (espSurfaceInfo(context, surface.id, &info) == ESP_OK) lowest = std::min(lowest, info.boundsMin[1]);
    if (!look.ground && std::isfinite(lowest)) look.groundLevel = lowest;
    look.ground = ground;
}

bool filmTurn(Scene& scene, const Options& options, Film& film, std::string& error) {
    const uint32_t frames = options.frames;
    for (uint32_t frame = 0; frame < frames; ++frame) {
        if (!scene.graphs.empty() && !(options.still && frame > 0)) {
            if (!setGraphTime(film.context, scene, options.frame + frame, scene.graphRate, error)) return false;
            if (espUpdate(film.context) != ESP_OK) {
                error = espLastError(film.context);
                return false;
            }
            if (!espalier::baking::bakeForGraphs(film.context, scene.graphs, error)) return false;
        }
        film.draw.camera = turned(scene.camera, 2 * 3.14159265f * float(frame) / float(frames));
        if (!film.take(frame, error)) return false;
    }
    return true;
}

// Tells mistakes in texts, whose last good ones go on growing: each when it is new.
class Mistakes {
  public:
    void tell(const Scene& scene, const std::string& where) {
        told_.resize(scene.grammars.size());
        for (size_t i = 0; i < told_.size(); ++i) {
            const std::string& error = scene.grammars[i].error;
            if (!error.empty() && error != told_[i]) warn(where + error);
            told_[i] = error;
        }
    }

  private:
    std::vector<std::string> told_;
};

// All frames are grown, so that each is what it was when it was recorded; some are drawn.
bool filmRun(const Run& run, const std::string& file, uint32_t every, Document& document, Film& film,
             Mistakes& mistakes, uint32_t& taken, std::string& error) {
    size_t next = 0;
    const uint32_t frames = run.frames();
    std::set<std::string> unread;  // layers that were warned of
    for (uint32_t frame = 0; frame < frames; ++frame) {
        for (; next < run.lines.size() && run.lines[next].frame == frame; ++next) {
            const std::string at = file + ":" + std::to_string(run.lines[next].number) + ": ";
            const std::string layer = layerOf(run.lines[next].action);
            if (!layer.empty() && !readsLayer(document.scene(), layer) && unread.insert(layer).second)
                warn(at + "no grammar reads the layer '" + layer + "'");
            if (!document.perform(run.lines[next].action, error, run.lines[next].gesture)) {
                error = "frame " + std::to_string(frame) + ", line " + std::to_string(run.lines[next].number) + ": " +
                        error;
                return false;
            }
            mistakes.tell(document.scene(), at);
        }
        const std::string of = "frame " + std::to_string(frame) + ": ";
        if (espUpdate(film.context) != ESP_OK) {
            error = of + espLastError(film.context);
            return false;
        }
        if (frame % every && frame + 1 < frames) continue;
        film.draw.camera = document.scene().camera;
        film.draw.camera.nearPlane = esp::frameAll(film.context).nearPlane;  // as of a scene that is opened like this
        film.draw.look = document.scene().look;
        film.draw.look.viewLayer = document.scene().viewLayer.c_str();
        if (!film.take(frame, error)) {
            error = of + error;
            return false;
        }
        ++taken;
    }
    return true;
}

int run(Options options) {
    std::string error;
    Run recorded;
    const bool replays = !options.replay.empty();
    if (replays) {
        if (!readRun(options.replay, recorded, error)) return fail(error);
        if (!recorded.note.empty()) warn(recorded.note);
        if (options.request.file.empty()) options.request.file = recorded.head.scene;
        if (options.size.empty()) options.width = recorded.head.width, options.height = recorded.head.height;
    }
    EspContextDef def = esp::defaults<EspContextDef>();
    const char* wanted = std::getenv("ESPALIER_VALIDATION");
    def.validation = options.validation || (wanted && std::string(wanted) == "1");
    if (!options.cache.empty()) def.cacheFolder = options.cache.c_str();
    // Errors come back from calls; what else is worth telling is told here.
    def.log = [](void*, EspLogLevel level, const char* message) {
        if (level == ESP_LOG_WARNING) warn(message);
    };
    EspContext* made = nullptr;
    if (espCreate(ESP_VERSION, &def, &made) != ESP_OK) return fail(espLastError(nullptr));
    const std::unique_ptr<EspContext, void (*)(EspContext*)> context(made, espDestroy);

    EspGrowDef& grow = options.request.grow;
    grow.maxNodes = options.maxNodes;
    grow.leafDensityCap = options.leafCap;
    grow.shadersOnly = options.shaders;
    if (EspWalkMode walk; walkNamed(options.walk, walk)) options.request.walk = walk;
    Document document(made);
    if (!document.open(options.request, error))
        return fail(error + (replays && options.request.file == recorded.head.scene
                                 ? "; " + options.replay + ":1 names it, FILE takes its place"
                                 : ""));
    for (const std::string& note : document.scene().notes) warn(note);
    Mistakes mistakes;
    mistakes.tell(document.scene(), "");
    if (espUpdate(made) != ESP_OK) return fail(espLastError(made));
    if (!espalier::baking::bakeForGraphs(made, document.scene().graphs, error)) return fail(error);

    Scene scene = document.scene();
    Film film{made, esp::DrawDef(), options.folder, options.moving, options.clock, !replays, {}, options.smooth};
    film.draw.width = options.width;
    film.draw.height = options.height;
    film.draw.look = scene.look;
    (void)parseView(options.view, film.draw.look);
    if (options.hour) applyDaylight(*options.hour, film.draw.look);
    if (options.ground) layGround(scene, made, *options.ground, film.draw.look);
    (void)parseCamera(options.camera, scene.camera);
    for (const LayerFile& asked : options.exports)
        if (!readsLayer(document.scene(), asked.layer))
            return fail("--export: this scene has no layer '" + asked.layer + "'");
    if (!film.begin(error)) return fail(error);
    uint32_t taken = replays ? 0 : options.frames;
    if (!(replays ? filmRun(recorded, options.replay, options.every, document, film, mistakes, taken, error)
                  : filmTurn(scene, options, film, error)))
        return fail(replays ? options.replay + ": " + error : error);
    for (const LayerFile& asked : options.exports)
        if (!exportLayer(document, asked.layer, asked.file, error)) return fail(error);
    espalier::capture::Figures figures;
    if (espReadStats(made, &figures.growth) != ESP_OK || espReadRoofStats(made, &figures.roofs) != ESP_OK ||
        espPatternStats(made, &figures.patterns) != ESP_OK)
        return fail(espLastError(made));
    const auto& [stats, roofs, patterns] = figures;
    if (stats.cut > 0)
        warn("growth was cut at its limit of " + std::to_string(grow.maxNodes) + " nodes");
    else if (stats.stopped > 0)
        warn("a limit of depth or recursion ended " + std::to_string(stats.stopped) + " branches");
    if (roofs.stopped > 0) warn("a limit ended " + std::to_string(roofs.stopped) + " shapes of roofs");
    if (const size_t planted = document.scene().seeds.size(), grown = stats.seeds + patterns.seeds; grown < planted)
        warn(std::to_string(planted - grown) + " of " + std::to_string(planted) +
             " seeds don't grow: they stand on bare ground, or another surface lies upon theirs");
    film.warnOfOld(replays ? recorded.frames() : options.frames);
    if (!options.stats.empty()) {
        const auto inputs = espalier::capture::inputsOf(options.request, document.scene(), {options.replay});
        if (!writeText(options.stats, espalier::capture::figuresJson(made, figures, inputs), error)) return fail(error);
    }
    std::printf("%u frames in %s: %u seeds, %" PRIu64 " nodes, %u branches, %" PRIu64 " leaves, %" PRIu64
                " polygons (%s)\n",
                taken, options.folder.c_str(), stats.seeds, stats.nodes, stats.branches, stats.leaves, stats.polygons,
                espDeviceName(made));
    if (patterns.seeds > 0)
        std::printf("patterns: %u pieces stand of %u tried, %u sets fell, in %u waves and %u rounds; %.1f ms\n",
                    patterns.pieces, patterns.tried, patterns.fallen, patterns.waves, patterns.rounds, patterns.ms);
    for (const LoadedGraph& graph : document.scene().graphs) {
        EspGraphStats told;
        if (espGraphStats(context.get(), graph.id, &told) != ESP_OK) continue;
        std::printf("%s: %u nodes, %" PRIu64 " vertices, %" PRIu64 " triangles in %" PRIu64
                    " instances; last evaluation: %u nodes, %.2f ms\n",
                    graph.file.c_str(), told.nodes, told.vertices, told.triangles, told.instances, told.evaluated,
                    told.ms);
    }
    if (roofs.houses > 0)
        std::printf("%u houses: %" PRIu64 " tiles (%" PRIu64
                    " clipped) in %u records, %.2f bytes a tile; "
                    "structure %.0f ms, expand %.1f ms; drawn: %u tiles, %u far grids, %" PRIu64 " triangles\n",
                    roofs.houses, roofs.tiles, roofs.clippedTiles, roofs.grids,
                    double(roofs.bytes) / double(std::max<uint64_t>(roofs.tiles, 1)), roofs.structureMs, roofs.expandMs,
                    roofs.drawnTiles, roofs.drawnRectangles, roofs.drawnTriangles);
    return 0;
}

// What options say in words of their own; else what is wrong with it.
std::string readTexts(Options& options) {
    if (const auto size = espalier::sizeSaid(options.size, 1, 16384); size)
        std::tie(options.width, options.height) = *size;
    else if (options.sized)
        return "--size takes WIDTHxHEIGHT, 1 to 16384 each, not '" + options.size + "'";
    EspLook look{};
    if (!parseView(options.view, look)) return "--view: no such view: " + options.view;
    EspCamera camera = esp::defaults<EspCamera>();
    if (options.aimed && !parseCamera(options.camera, camera))
        return "--camera takes six or seven numbers with commas between them, eye and target apart, an angle as a "
               "scene's, not '" +
               options.camera + "'";
    if (options.hour && !std::isfinite(*options.hour)) return "--hour takes 0 to 24";
    if (!std::isfinite(options.leafCap) || options.leafCap < 0) return "--leaf-cap takes 0 or more";
    if (const std::string wrong = espalier::takeLayers(options.layersSaid, options.request.layers); !wrong.empty())
        return wrong;
    for (const std::string& said : options.exportsSaid) {
        const auto written = espalier::namedFileSaid(said);
        if (!written) return "--export takes NAME=FILE, not '" + said + "'";
        const auto ending = std::filesystem::path(written->second).extension();
        if (ending != ".png" && ending != ".exr") return "--export writes .png or .exr, not '" + written->second + "'";
        options.exports.push_back({written->first, written->second});
    }
    std::vector<std::string> reads{options.request.file, options.request.grammar, options.replay};
    for (const auto& [layer, file] : options.request.layers) reads.push_back(file);
    std::vector<std::string> writes{(std::filesystem::path(options.folder) / "frame_0000.png").string(), options.stats};
    for (const LayerFile& layer : options.exports) writes.push_back(layer.file);
    if (const auto lost = espalier::writtenOver(reads, writes))
        return *lost + " would overwrite what is read, or another file that is written";
    return {};
}

int captureAsAsked(int argc, char** argv) {
    CLI::App app{"Grows a scene and writes frames and figures, without a window.", "espalier-capture"};
    Options options;
    addOptions(app, options);
    if (const auto ends = espalier::parseCommandLine(app, argc, argv)) return *ends;
    options.sized = app.count("--size") > 0;
    options.aimed = app.count("--camera") > 0;
    if (options.seed >= 0) options.request.seed = uint32_t(options.seed);
    if (options.request.file.empty() && options.replay.empty())
        return refuse("FILE or --replay says what to show; see --help");
    if (const std::string wrong = readTexts(options); !wrong.empty()) return refuse(wrong);
    return run(std::move(options));
}

}  // namespace

int main(int argc, char** argv) {
    return espalier::runProgram("espalier-capture", [&] { return captureAsAsked(argc, argv); });
}
