// espalier-sample: reads the command line and runs the game.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "sample_game/additions.hpp"
#include "sample_game/app.hpp"
#include "sample_game/model_bake.hpp"
#include "tools/command_line.hpp"
#include "tools/scene/heap.hpp"

namespace {

int playAsAsked(int argc, char** argv) {
    CLI::App cli{"A window on a growing scene: paint with seeds, sliders and grammars.", "espalier-sample"};
    cli.set_version_flag("--version", ESPALIER_VERSION);
    sample::AppOptions options;
    std::vector<std::string> layers;
    std::string size = "1280x720";
    long long seed = -1;
    cli.add_option(
        "FILE", options.request.file,
        "a scene (SCENE.json), a project's folder, what espalier-bake wrote (SURFACE.glb), a recorded run "
        "(RUN.jsonl) to see again, or a model (.glb, .obj ...), which is baked first; default: the sample scene");
    cli.add_option("--layer", layers,
                   "NAME=FILE: a picture drawn in the model's UVs, or of a town's layer, seen from above")
        ->allow_extra_args(false);
    cli.add_option("--grammar", options.request.grammar, "takes the place of the scene's first grammar");
    cli.add_option("--seed", seed, "the seeds' random numbers are N, N + 1 ... instead of the scene's")
        ->check(CLI::Range(0ll, 4294967295ll));
    cli.add_option("--times", options.request.times, "plants each seed so many times, with other random numbers")
        ->check(CLI::Range(1, 1000));
    cli.add_option("--size", size, "WIDTHxHEIGHT of the window; default: as it was last, at first 1280x720");
    cli.add_option("--ui-scale", options.uiScale, "of letters and panels, 0.5 to 4; default: as the display says")
        ->check(CLI::Range(.5, 4.));
    cli.add_option("--frames", options.frames, "ends after so many frames; 0: when the window is closed")
        ->capture_default_str()
        ->check(CLI::Range(0, 1000000000));
    cli.add_flag("--turn", options.turn,
                 "turns the view by two degrees in each of --frames, as a drag does, and tells how long a frame takes");
    cli.add_option("--screenshot", options.screenshot, "writes the last of --frames as PNG");
    cli.add_flag("--editor", options.editor, "begins in the editor (Tab)");
    bool fresh = false;
    cli.add_flag("--new", fresh, "begins in the editor with an empty scene, to which models are added");
    cli.add_option("--record", options.record,
                   "records what is done into this file (RUN.jsonl), which mustn't exist yet")
        ->check(CLI::NonexistentPath);
    cli.add_option("--autosave", options.autosave, "seconds between two autosaves of what isn't saved")
        ->capture_default_str()
        ->check(CLI::Range(1., 86400.));
    cli.add_flag("--validation", options.validation, "with Vulkan's validation layer (also: ESPALIER_VALIDATION=1)");
    if (const auto ends = espalier::parseCommandLine(cli, argc, argv)) return *ends;
    const auto fail = [](const std::string& message) {
        std::fprintf(stderr, "espalier-sample: %s\n", message.c_str());
        return 2;
    };
    const auto window = espalier::sizeSaid(size, 64, 16384);
    if (!window) return fail("--size takes WIDTHxHEIGHT, 64 to 16384 each, not '" + size + "'");
    options.width = int(window->first);
    options.height = int(window->second);
    if (const std::string wrong = espalier::takeLayers(layers, options.request.layers); !wrong.empty())
        return fail(wrong);
    if (options.turn && options.frames < sample::AppOptions::kLeastTurn)
        return fail("--turn takes --frames of " + std::to_string(sample::AppOptions::kLeastTurn) + " or more");
    if (!options.screenshot.empty() && options.frames == 0)
        return fail("--screenshot takes --frames: the last is written");
    if (!std::isfinite(options.autosave) || !std::isfinite(options.uiScale))
        return fail("--autosave and --ui-scale take numbers");
    options.sized = cli.count("--size") > 0;
    if (seed >= 0) options.request.seed = uint32_t(seed);
    if (fresh && !options.request.file.empty()) return fail("--new takes no FILE");
    if (sample::isModel(options.request.file)) options.models = {options.request.file};
    if (fresh || !options.models.empty()) options.request.file = sample::emptyScene(), options.editor = true;
    if (options.request.file.empty()) options.request.file = espalier::scene::contentFolder() + "/sample.json";
    const char* wanted = std::getenv("ESPALIER_VALIDATION");
    options.validation = options.validation || (wanted && std::string(wanted) == "1");
    espalier::scene::keepHeap();
    return sample::runApp(options);
}

}  // namespace

int main(int argc, char** argv) {
    return espalier::runProgram(
        "espalier-sample", [&] { return playAsAsked(argc, argv); }, 2);
}
