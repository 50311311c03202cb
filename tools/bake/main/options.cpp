// In: a command line. Out: what it asks for, and whether that can be done.
#include "tools/bake/main/options.hpp"

#include <cmath>

namespace espalier {
namespace {

// Each option stands in one of these groups, or is for all inputs.
constexpr const char *kOfModel = "Of one model", *kOfModels = "Of a model, or of all models of a folder",
                     *kOfFolder = "Of a folder of models", *kOfTown = "Of a town";

const char* nameOf(InputKind kind) {
    return kind == InputKind::model ? "a model" : kind == InputKind::folder ? "a folder of models" : "a town";
}

bool fits(const std::string& group, InputKind kind) {
    if (group == kOfModel) return kind == InputKind::model;
    if (group == kOfModels) return kind != InputKind::town;
    if (group == kOfFolder) return kind == InputKind::folder;
    return group != kOfTown || kind == InputKind::town;
}

bool hasOneSceneAndUvs(const std::string& model) {
    return model.ends_with(".obj") || model.ends_with(".ply") || model.ends_with(".ply.gz") || model.ends_with(".stl");
}

void addPlaces(CLI::App& app, Arguments& arguments) {
    app.add_option(
           "MODEL", arguments.model,
           ".gltf, .glb, .obj, .ply or .stl, or .fbx and others through the program assimp; a folder of such; or "
           "footprints: .geojson, or a plan in .json")
        ->required();
    app.add_option("-o,--output", arguments.output,
                   "the surface to write (.glb); or the folder for surfaces and their report; or the town (.glb)")
        ->required();
    app.add_flag("-q,--quiet", arguments.quiet, "no progress, warnings only");
}

void addPieces(CLI::App& app, Arguments& arguments) {
    app.add_flag(
           "--pieces", arguments.pieces,
           "makes no surface, but a palette (.glb) of the model, or of all models of a folder, for patterns to place "
           "(docs/patterns.md); of the other options those of importing count")
        ->group(kOfModels);
    app.add_flag("--terminal", arguments.terminal,
                 "makes no surface, but the mesh (.glb) that plants draw in place of a leaf or blossom "
                 "(docs/scene_format.md); of the other options those of importing count")
        ->excludes(app.get_option("--pieces"))
        ->group(kOfModel);
}

void addModelOptions(CLI::App& app, Arguments& arguments) {
    app.add_option("--report", arguments.report, "write the report (JSON) here")->group(kOfModel);
    app.add_option("--images", arguments.images, "write charts, links, contacts and stretch as .png into this folder")
        ->group(kOfModel);
    auto* from = app.add_option("--from", arguments.carry.from,
                                "the model's surface before its change (.glb): with --layer or --seeds")
                     ->group(kOfModel);
    app.add_option("--layer", arguments.carry.layers,
                   "a layer that was painted over that surface's walk UVs (.png); written beside the new surface")
        ->allow_extra_args(false)
        ->needs(from)
        ->group(kOfModel);
    app.add_option("--seeds", arguments.carry.seeds,
                   "a scene (.json) or a project's folder: lists its seeds that lose their ground")
        ->needs(from)
        ->group(kOfModel);
    app.add_option(
           "--weights", arguments.weights,
           "a picture drawn in the model's UVs: white charts get the most texels a metre, grey ones that share, at "
           "least an eighth")
        ->group(kOfModel);
}

void addBakeOptions(CLI::App& app, Arguments& arguments) {
    app.add_option("--resolution", arguments.bake.resolution,
                   "texels a side of the finest level, a power of two, 64 to 8192")
        ->capture_default_str()
        ->group(kOfModels);
    app.add_option("--levels", arguments.bake.levels,
                   "levels, each half as fine as the one before; 0: down to 64 texels")
        ->capture_default_str()
        ->check(CLI::Range(0, 8))
        ->group(kOfModels);
    app.add_option(
           "--tolerance", arguments.tolerance,
           "metres within which borders without a twin are linked; 0: one texel's footprint, a centimetre at most")
        ->check(CLI::Range(0.0, 1e6))
        ->group(kOfModels);
    app.add_option("--uv-set", arguments.importing.uvSet, "the TEXCOORD set that is unwrapped")
        ->capture_default_str()
        ->check(CLI::Range(0, 7))
        ->group(kOfModels);
    app.add_option("--scene", arguments.importing.scene, "which of a glTF file's scenes, from 0; else its default one")
        ->check(CLI::Range(0, 65535))
        ->group(kOfModels);
    app.add_option("--origin", arguments.origin,
                   "X Y Z, metres: what is taken off all positions (default: nothing, but for models so far away that "
                   "single precision can't hold them)")
        ->expected(3)
        ->check(CLI::Range(-1e9, 1e9))
        ->group(kOfModels);
    app.add_option("--bare", arguments.importing.bare,
                   "nothing grows on materials of this name, as '*window*', small and capital letters alike; may be "
                   "repeated. Nor does it on transparent ones")
        ->allow_extra_args(false)
        ->group(kOfModels);
    app.add_option(
           "--ground", arguments.importing.ground,
           "it does on materials of this name, though they are transparent or --bare names them; may be repeated")
        ->allow_extra_args(false)
        ->group(kOfModels);
    app.add_flag("--keep-layout", arguments.bake.keepLayout, "never move charts apart; not with --weights")
        ->excludes(app.get_option("--weights"))
        ->group(kOfModels);
}

void addFolderOptions(CLI::App& app, Arguments& arguments) {
    app.add_option("--jobs", arguments.jobs, "models at once; 0: as many as there are cores")->group(kOfFolder);
    app.add_option("--shard", arguments.shard, "i/n bakes every nth model from the ith on")->group(kOfFolder);
}

void addTownOptions(CLI::App& app, Arguments& arguments) {
    auto* grammar = app.add_option("--grammar", arguments.town.grammar,
                                   "writes all that this grammar of roofs makes, as triangles; else walls and roof "
                                   "planes")
                        ->group(kOfTown);
    app.add_flag("--walls", arguments.town.walls,
                 "its walls alone, without windows and doors, which the grammar tells: bake that as ground for plants")
        ->needs(grammar)
        ->group(kOfTown);
    app.add_option("--house", arguments.town.houses, "only these, by id; may be repeated")
        ->take_all()
        ->allow_extra_args(false)
        ->group(kOfTown);
    app.add_option("--meshes", arguments.town.meshes, "the grammar's terminals (default: roofs.glb of the content)")
        ->needs(grammar)
        ->group(kOfTown);
}

}  // namespace

void addOptions(CLI::App& app, Arguments& arguments) {
    addPlaces(app, arguments);
    addPieces(app, arguments);
    addModelOptions(app, arguments);
    addBakeOptions(app, arguments);
    addFolderOptions(app, arguments);
    addTownOptions(app, arguments);
}

std::optional<Failure> mistakeIn(const CLI::App& app, const Arguments& arguments, InputKind kind) {
    for (const CLI::Option* option : app.get_options())
        if (option->count() > 0 && !fits(option->get_group(), kind))
            return Failure(option->get_name(), std::string("is not for ") + nameOf(kind) + ", and '" + arguments.model +
                                                   "' is taken for one");
    if (kind == InputKind::model && hasOneSceneAndUvs(arguments.model))
        for (const char* option : {"--scene", "--uv-set"})
            if (app.count(option) > 0)
                return Failure(option, "is of glTF models, which '" + arguments.model + "' isn't");
    if (!arguments.carry.from.empty() && arguments.carry.layers.empty() && arguments.carry.seeds.empty())
        return Failure("--from", "needs --layer or --seeds: what is to be carried");
    if (!std::isfinite(float(arguments.tolerance))) return Failure("--tolerance", "is not a number of metres");
    BakeOptions asked = arguments.bake;
    if (Status possible = checkOptions(arguments.model, asked); !possible) return possible.failure();
    return std::nullopt;
}

}  // namespace espalier
