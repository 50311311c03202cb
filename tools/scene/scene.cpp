// What a user asks for -> a scene in a context; and what scenes are asked about or change later.
#include "tools/scene/scene.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <utility>

#include "plugin_api/espalier.hpp"
#include "tools/scene/carried.hpp"
#include "tools/scene/daylight.hpp"
#include "tools/scene/json_tree.hpp"
#include "tools/scene/layers.hpp"
#include "tools/scene/picture.hpp"
#include "tools/scene/scene_file.hpp"
#include "tools/scene/scene_parts.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::scene {

bool fromContext(const EspContext* context, EspResult result, std::string& error) {
    if (result == ESP_OK) return true;
    error = espLastError(context);
    if (error.empty()) error = "error " + std::to_string(int(result));
    return false;
}

bool compile(EspContext* context, LoadedGrammar& grammar, const std::string& text, std::string& error) {
    const EspGrammarDef def = esp::grammarDef(grammar.file.c_str(), text);
    if (!fromContext(context, espCompileGrammar(context, &def, &grammar.id), error)) return false;
    grammar.text = grammar.grows = text;
    grammar.warnings = espGrammarWarnings(context, grammar.id);
    return true;
}

bool compileFile(EspContext* context, LoadedGrammar& grammar, std::string& error) {
    std::string text;
    return readText(grammar.file, text, error) && compile(context, grammar, text, error);
}

namespace {

bool isTown(const std::string& file) {
    if (std::filesystem::path(file).extension() == ".geojson") return true;
    std::string text, ignored;
    if (std::filesystem::path(file).extension() != ".json" || !readText(file, text, ignored)) return false;
    const auto has = [&](const char* word) { return text.find(word) != std::string::npos; };
    if (!has("\"buildings\"") && !has("\"FeatureCollection\"")) return false;
    // Layers and parameters of scenes may have any names.
    Json json;
    return !has("\"grammars\"") || !readJson(text, json, ignored) || !json.find("grammars");
}

}  // namespace

std::string contentFolder() {
    std::error_code ignored;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    return (program.parent_path().parent_path() / "content").string();
}

EspTransform Placing::transform() const {
    const float c = scale * std::cos(turn), s = scale * std::sin(turn), side = mirror ? -1.0f : 1.0f;
    return {{{side * c, 0, s, position[0]}, {0, scale, 0, position[1]}, {side * -s, 0, c, position[2]}}};
}

std::array<float, 3> carried(const std::array<float, 3>& v, const Placing& from, const Placing& to, bool isPoint) {
    // A mirror turns the way of what turns before it.
    const double side = from.mirror == to.mirror ? 1 : -1, turn = double(to.turn) - side * from.turn;
    const double c = std::cos(turn), s = std::sin(turn), scale = isPoint ? double(to.scale) / from.scale : 1;
    double at[3];
    for (size_t i = 0; i < 3; ++i) at[i] = scale * (double(v[i]) - (isPoint ? from.position[i] : 0));
    at[0] *= side;
    const double turned[3] = {c * at[0] + s * at[2], at[1], c * at[2] - s * at[0]};
    std::array<float, 3> out;
    for (size_t i = 0; i < 3; ++i) out[i] = float(turned[i] + (isPoint ? to.position[i] : 0));
    return out;
}

namespace {

// Frozen plants are what they are.
void plantMore(uint32_t times, std::vector<Seed>& seeds) {
    constexpr uint32_t kApart = 1000;  // numbers of one seed: a scene's count from 1
    const size_t own = seeds.size();
    for (uint32_t i = 1; i < times; ++i)
        for (size_t s = 0; s < own; ++s)
            if (seeds[s].frozenFile.empty()) {
                seeds.push_back(seeds[s]);
                seeds.back().number += kApart * i;
            }
}

// In place of a folder, its project.
bool takeProject(std::string& file, std::string& error) {
    namespace fs = std::filesystem;
    std::error_code failed;
    if (!fs::is_directory(file, failed)) return true;
    const fs::path project = fs::path(file) / kProjectFile;
    if (!fs::exists(project, failed)) {
        error = file + (failed ? ": can't be read: " + failed.message()
                               : std::string(": is a folder without a project.json, so no project"));
        return false;
    }
    file = project.string();
    return true;
}

bool isGraph(const std::string& file) {
    return std::filesystem::path(file).extension() == ".graph";
}

bool isDescribed(const std::string& file) {
    return std::filesystem::path(file).extension() == ".json";
}

}  // namespace

std::string lastPart(const std::string& file) {
    namespace fs = std::filesystem;
    const fs::path whole = absolutePath(file).lexically_normal();
    return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

bool mayOpen(const std::string& asked, std::string& error) {
    std::string file = absolutePath(asked).string(), text;
    if (!takeProject(file, error)) return false;
    const bool town = isTown(file) || isGraph(file);
    if (!town && !isDescribed(file)) return isSurface(file, error);
    SceneFile read;
    return readText(file, text, error) && (town || readSceneText(file, text, read, error));
}

bool openScene(EspContext* context, const Request& asked, Scene& out, std::string& error) {
    Request request = asked;
    // What is named from there stays what it is, wherever the program is told to work later.
    request.file = absolutePath(request.file).string();
    if (!request.grammar.empty()) request.grammar = absolutePath(request.grammar).string();
    if (!takeProject(request.file, error)) return false;
    out = Scene{};
    out.name = lastPart(asked.file);
    out.ownLook = esp::defaults<EspLook>();
    out.grow = request.grow;
    const auto open = isGraph(request.file)       ? openGraph
                      : isTown(request.file)      ? openTown
                      : isDescribed(request.file) ? openDescription
                                                  : openSurface;
    if (!open(context, request, out, error)) return false;
    plantMore(request.times, out.seeds);
    out.grow.walk = request.walk.value_or(out.grow.walk);
    if (!fromContext(context, espSetGrow(context, &out.grow), error)) return false;
    noteLayers(context, out);
    for (const auto& [name, picture] : request.layers) {
        if (!readsLayer(out, name)) {
            error = picture + ": no grammar of this scene reads a layer '" + name + "'";
            return false;
        }
        Carrying none;
        if (!layLayer(context, out, {name, picture, -1}, none, error)) return false;
    }
    out.look = out.ownLook;
    if (out.hour != kOwnSun) applyDaylight(out.hour, out.look);
    uint32_t key = 0;
    for (Seed& seed : out.seeds) {
        seed.key = ++key;
        if (!seed.frozen && !seed.frozenFile.empty()) out.unreadPlants[key] = seed.frozenFile;
    }
    return true;
}

EspResult walkLayer(EspContext* context, EspSurface surface, const std::string& name, const GreyPicture& picture,
                    EspLayerDef& out) {
    uint32_t side = 0;
    if (EspResult asked = espReadLayer(context, surface, name.c_str(), nullptr, &side); asked != ESP_OK) return asked;
    out = esp::defaults<EspLayerDef>();
    out.surface = surface;
    out.name = name.c_str();
    out.space = picture.width == side && picture.height == side ? ESP_LAYER_TEXELS : ESP_LAYER_WALK_UV;
    out.texels = picture.texels.data();
    out.width = picture.width;
    out.height = picture.height;
    return ESP_OK;
}

namespace {

bool plantOne(EspContext* context, Scene& scene, Seed& seed, std::string& error) {
    EspSeedDef def = esp::defaults<EspSeedDef>();
    def.grammar = scene.grammars[seed.grammar].id;
    std::copy(seed.position.begin(), seed.position.end(), def.position);
    std::copy(seed.direction.begin(), seed.direction.end(), def.direction);
    def.number = seed.number;
    seed.planted = {};
    if (!fromContext(context, espPlant(context, &def, &seed.planted), error)) return false;
    for (const ParamValue& own : seed.params)
        if (!fromContext(context, espSetSeedParam(context, seed.planted, own.name.c_str(), own.value.data(), own.count),
                         error)) {
            (void)espRemoveSeed(context, seed.planted);
            seed.planted = {};
            return false;
        }
    if (seed.frozen && espFreezeAs(context, seed.planted, seed.frozen->data(), seed.frozen->size()) != ESP_OK) {
        const std::string why =
            (seed.frozenFile.empty() ? "a frozen plant" : seed.frozenFile) + ": " + espLastError(context);
        if (!scene.project) {
            error = why;
            (void)espRemoveSeed(context, seed.planted);
            seed.planted = {};
            return false;
        }
        scene.notes.push_back(why + "; the plant grows again");
        seed.frozen = nullptr;
        if (!seed.frozenFile.empty()) scene.unreadPlants[seed.key] = seed.frozenFile;
    }
    return !seed.hidden || fromContext(context, espHideSeed(context, seed.planted, 1), error);
}

}  // namespace

bool plantAll(EspContext* context, Scene& scene, std::string& error) {
    if (!fromContext(context, espRemoveAllSeeds(context), error)) return false;
    size_t missing = 0;
    std::string first, why;
    for (size_t i = 0; i < scene.seeds.size(); ++i) {
        Seed& seed = scene.seeds[i];
        if (plantOne(context, scene, seed, why) || missing++ > 0) continue;
        char place[96];
        std::snprintf(place, sizeof place, "seed %zu at %g, %g, %g", i + 1, double(seed.position[0]),
                      double(seed.position[1]), double(seed.position[2]));
        first = place + (" of " + scene.grammars[seed.grammar].file + ": " + why);
    }
    if (missing == 0) return true;
    error = missing == 1 ? first : std::to_string(missing) + " seeds aren't planted; the first is " + first;
    return false;
}

bool setText(EspContext* context, LoadedGrammar& grammar, const std::string& text) {
    grammar.text = text;
    grammar.error.clear();
    grammar.warnings.clear();
    const EspGrammarDef def = esp::grammarDef(grammar.file.c_str(), text);
    if (!fromContext(context, espRecompileGrammar(context, grammar.id, &def), grammar.error)) return false;
    grammar.grows = text;
    grammar.warnings = espGrammarWarnings(context, grammar.id);
    return true;
}

std::vector<ParamValue> changedParams(const EspContext* context, EspGrammar grammar) {
    std::vector<ParamValue> changed;
    for (uint32_t i = 0; i < espParamCount(context, grammar); ++i) {
        EspParamInfo info;
        if (espParamInfo(context, grammar, i, &info) != ESP_OK) continue;
        ParamValue value{info.name, {}, info.kind == ESP_PARAM_COLOUR ? 3u : 1u};
        std::copy(info.value, info.value + value.count, value.value.begin());
        if (!std::equal(info.value, info.value + value.count, info.initial)) changed.push_back(value);
    }
    return changed;
}

EspCamera turned(const EspCamera& camera, float radians) {
    EspCamera out = camera;
    const float x = camera.eye[0] - camera.target[0], z = camera.eye[2] - camera.target[2];
    const float c = std::cos(radians), s = std::sin(radians);
    out.eye[0] = camera.target[0] + c * x + s * z;
    out.eye[2] = camera.target[2] - s * x + c * z;
    return out;
}

}  // namespace espalier::scene
