// A scene file or a bare surface -> surface, grammars, layers in a context, and what to plant and how to look.
#include "tools/scene/scene.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "tools/scene/daylight.hpp"
#include "tools/scene/picture.hpp"
#include "tools/scene/scene_file.hpp"
#include "tools/scene/site.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

constexpr float kPi = 3.14159265f;
const char* kSurfaceExtension = "\"ESPALIER_";  // how docs/surface_format.md names it

bool fromContext(const EspContext* context, EspResult result, std::string& error) {
    if (result == ESP_OK) return true;
    error = espLastError(context);
    if (error.empty()) error = "error " + std::to_string(int(result));
    return false;
}

bool compile(EspContext* context, LoadedGrammar& grammar, const std::string& text, std::string& error) {
    const EspGrammarDef def{grammar.file.c_str(), text.data(), text.size()};
    if (!fromContext(context, espCompileGrammar(context, &def, &grammar.id), error)) return false;
    grammar.text = grammar.grows = text;
    grammar.warnings = espGrammarWarnings(context, grammar.id);
    return true;
}

bool compileFile(EspContext* context, LoadedGrammar& grammar, std::string& error) {
    std::string text;
    return readText(grammar.file, text, error) && compile(context, grammar, text, error);
}

bool layLayer(EspContext* context, const Scene& scene, const SceneLayer& layer, std::string& error) {
    GreyPicture picture;
    if (!readGrey(layer.file, picture, error)) return false;
    if (layer.surface == SceneLayer::kTown)
        return fromContext(
            context,
            espSetTownLayer(context, layer.name.c_str(), picture.texels.data(), picture.width, picture.height, nullptr),
            error);
    for (size_t i = 0; i < scene.surfaces.size(); ++i) {
        if (layer.surface >= 0 && size_t(layer.surface) != i) continue;
        EspLayerDef def;
        if (!fromContext(context, walkLayer(context, scene.surfaces[i].id, layer.name, picture, def), error))
            return false;
        if (layer.surface < 0) def.space = ESP_LAYER_MATERIAL_UV;
        if (!fromContext(context, espSetLayer(context, &def), error)) return false;
    }
    return true;
}

// Numbers of 0 to 1 that are the same on every machine.
float chance(uint32_t seed, uint32_t index) {
    uint32_t x = seed * 747796405u + index * 2891336453u + 12345u;
    x = ((x >> ((x >> 28) + 4)) ^ x) * 277803737u;
    x = (x >> 22) ^ x;
    return float(x >> 8) / 16777216.f;
}

// Seeds where rays from all around meet the model's lower part. They are aimed at places spread evenly over its ground
// plan, so that of pieces that lie apart each gets its share; what leads through a gap is aimed at the middle.
void plantAround(const EspContext* context, const EspSurfaceInfo& info, uint32_t number, Scene& scene) {
    constexpr uint32_t kSeeds = 16;
    constexpr float kPlanX = .7548777f, kPlanZ = .5698403f;  // of the evenest sequence of points in a square
    float centre[3], size[3];
    for (int i = 0; i < 3; ++i) {
        centre[i] = (info.boundsMin[i] + info.boundsMax[i]) / 2;
        size[i] = info.boundsMax[i] - info.boundsMin[i];
    }
    const float far = std::sqrt(size[0] * size[0] + size[1] * size[1] + size[2] * size[2]);
    for (uint32_t i = 0; i < kSeeds; ++i) {
        const float angle = 2 * kPi * (float(i) + .7f * chance(number, 3 * i)) / kSeeds;
        const float height = info.boundsMin[1] + size[1] * (.04f + .12f * chance(number, 3 * i + 1));
        const float outX = std::sin(angle), outZ = std::cos(angle), inward[3] = {-outX, 0, -outZ};
        const auto aimAt = [&](float x, float z, EspHit& hit) {
            const float origin[3] = {x + far * outX, height, z + far * outZ};
            return espPick(context, origin, inward, &hit) == ESP_OK;
        };
        const float planX = std::fmod(.5f + float(i) * kPlanX, 1.f) - .5f,
                    planZ = std::fmod(.5f + float(i) * kPlanZ, 1.f) - .5f;
        const float aside[3] = {centre[0] + .5f * size[0] * outX, height, centre[2] + .5f * size[2] * outZ};
        EspHit hit;
        if (!aimAt(centre[0] + size[0] * planX, centre[2] + size[2] * planZ, hit) &&
            !aimAt(centre[0], centre[2], hit) && espNearest(context, aside, &hit) != ESP_OK)
            continue;
        Seed seed;
        std::memcpy(seed.position.data(), hit.position, sizeof hit.position);
        seed.direction = {chance(number, 3 * i + 2) - .5f, 1, 0};
        seed.number = number + i;
        scene.seeds.push_back(seed);
    }
}

float largestSide(const EspSurfaceInfo& info) {
    float size = 0;
    for (int i = 0; i < 3; ++i) size = std::max(size, info.boundsMax[i] - info.boundsMin[i]);
    return size;
}

constexpr float kSunken = .002f;  // of its size, that a model stands in the ground, so that no gap shows

// Lengths of the default ivy suit a wall of some metres. What is smaller is a model of something large: its leaves are
// smaller, never larger than life; and stems are to get half-way up whatever it is.
void fitToModel(EspContext* context, const EspSurfaceInfo& info, const LoadedGrammar& grammar) {
    const float scale = std::min(1.f, largestSide(info) / 12);
    for (uint32_t i = 0; i < espParamCount(context, grammar.id); ++i) {
        EspParamInfo param;
        if (espParamInfo(context, grammar.id, i, &param) != ESP_OK) continue;
        const float reach = .5f * (info.boundsMax[1] - info.boundsMin[1]) / scale;
        if (!std::strcmp(param.name, "scale")) espSetParam(context, grammar.id, "scale", &scale, 1);
        if (!std::strcmp(param.name, "reach") && reach > param.value[0]) {
            const float most = std::min(reach, param.high);
            espSetParam(context, grammar.id, "reach", &most, 1);
        }
    }
}

// A glTF model as modelling programs write it: what a user may well try first.
bool isUnbakedModel(const std::string& path) {
    std::string text, ignored;
    const std::string ending = std::filesystem::path(path).extension().string();
    if ((ending != ".glb" && ending != ".gltf") || !readText(path, text, ignored)) return false;
    const bool model = text.rfind("glTF", 0) == 0 || text.find("\"asset\"") != std::string::npos;
    return model && text.find(kSurfaceExtension) == std::string::npos;
}

// glTF's unit is the metre, but many scans come in another: a statue of a centimetre, or of a kilometre, is shown as
// one of two metres, so that ivy on it is ivy.
bool loadAtLivingSize(EspContext* context, LoadedSurface& surface, EspSurfaceInfo& info, std::string& error) {
    constexpr float kSmallest = .1f, kLargest = 500, kUsual = 2;
    for (int attempt = 0; attempt < 2; ++attempt) {
        const EspTransform place = surface.placing.transform();
        if (!fromContext(context, espLoadSurface(context, surface.file.c_str(), &place, &surface.id), error) ||
            !fromContext(context, espSurfaceInfo(context, surface.id, &info), error))
            return false;
        const float size = largestSide(info);
        if (attempt == 1 || (size >= kSmallest && size <= kLargest) || !(size > 0)) return true;
        surface.placing.scale = kUsual / size;
        if (!fromContext(context, espDestroySurface(context, surface.id), error)) return false;
    }
    return true;
}

// What stands alone gets something to stand on; the eye is not to be below it.
void layGround(float level, Scene& scene) {
    scene.ownLook.ground = 1;
    scene.ownLook.groundLevel = level;
    scene.camera.eye[1] = std::max(scene.camera.eye[1], level + .02f * std::abs(scene.camera.eye[2]));
}

bool openSurface(EspContext* context, const Request& request, Scene& out, std::string& error) {
    if (isUnbakedModel(request.file)) {
        error = request.file + ": isn't baked yet: espalier-bake " + request.file +
                " -o SURFACE.glb (tools/run does it for you)";
        return false;
    }
    EspSurfaceInfo info;
    LoadedSurface& surface = out.surfaces.emplace_back();
    surface.file = request.file;
    if (!loadAtLivingSize(context, surface, info, error)) return false;
    const char* standard = request.layers.empty() ? "ivy_free.grammar" : "ivy_guided.grammar";
    LoadedGrammar grammar;
    grammar.file = request.grammar.empty() ? contentFolder() + "/grammars/" + standard : request.grammar;
    if (!compileFile(context, grammar, error)) return false;
    out.grammars.push_back(grammar);
    fitToModel(context, info, grammar);
    plantAround(context, info, request.seed.value_or(1), out);
    out.camera = espFrameAll(context);
    layGround(info.boundsMin[1] + kSunken * largestSide(info), out);
    return true;
}

// Loads out.town, which grows by the grammar that it names or the first that makes roofs.
bool loadTown(EspContext* context, Scene& out, std::string& error) {
    const SceneTown& town = *out.town;
    std::string text;
    if (!readText(town.file, text, error)) return false;
    EspTownDef def = espDefaultTownDef();
    def.name = town.file.c_str();
    def.text = text.data();
    def.length = text.size();
    std::copy(town.placing.position.begin(), town.placing.position.end(), def.position);
    def.turn = town.placing.turn;
    def.ground = town.ground ? 1 : 0;
    if (town.groundColour) std::copy(town.groundColour->begin(), town.groundColour->end(), def.groundColour);
    if (!fromContext(context, espLoadTown(context, &def), error)) return false;
    for (const House& house : town.houses)
        if (!setHouse(context, house, error)) {
            error = town.file + ": house " + std::to_string(house.index) + " of the scene: " + error;
            return false;
        }
    if (town.grammar >= 0)
        return fromContext(context, espSetTownGrammar(context, out.grammars[size_t(town.grammar)].id), error);
    for (const LoadedGrammar& grammar : out.grammars)
        if (espSetTownGrammar(context, grammar.id) == ESP_OK) return true;
    error = town.file + ": none of the scene's grammars makes roofs; town.grammar does";
    return false;
}

// A town on its own, by the grammar of all kinds of roofs unless another is asked for.
bool openTown(EspContext* context, const Request& request, Scene& out, std::string& error) {
    LoadedGrammar grammar;
    grammar.file = request.grammar.empty() ? contentFolder() + "/grammars/town.grammar" : request.grammar;
    if (!compileFile(context, grammar, error)) return false;
    out.grammars.push_back(grammar);
    out.town = SceneTown{request.file, -1, {}, true, {}};
    if (!loadTown(context, out, error)) return false;
    out.camera = espFrameAll(context);
    return true;
}

bool isTown(const std::string& file) {
    if (std::filesystem::path(file).extension() == ".geojson") return true;
    std::string text, ignored;
    return std::filesystem::path(file).extension() == ".json" && readText(file, text, ignored) &&
           (text.find("\"buildings\"") != std::string::npos || text.find("\"FeatureCollection\"") != std::string::npos);
}

bool loadGrammar(EspContext* context, const SceneGrammar& described, LoadedGrammar& grammar, std::string& error) {
    const bool good = described.text ? compile(context, grammar, described.grows.value_or(*described.text), error)
                                     : compileFile(context, grammar, error);
    if (!good) return false;
    // A project may have been saved with a mistake in its text: it stands there with its message, as it was.
    if (described.grows) setText(context, grammar, *described.text);
    for (const SceneParam& param : described.params) {
        const ParamValue& v = param.value;
        if (fromContext(context, espSetParam(context, grammar.id, v.name.c_str(), v.value.data(), v.count), error))
            continue;
        error = param.place + ": " + error;
        return false;
    }
    return true;
}

bool readFrozen(Seed& seed, std::string& error) {
    std::string bytes;
    if (!readText(seed.frozenFile, bytes, error)) return false;
    const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
    seed.frozen = std::make_shared<std::vector<std::byte>>(first, first + bytes.size());
    return true;
}

bool openDescription(EspContext* context, const Request& request, Scene& out, std::string& error) {
    SceneFile file;
    if (!readSceneFile(request.file, file, error)) return false;
    for (const SceneSurface& described : file.surfaces) {
        LoadedSurface& surface =
            out.surfaces.emplace_back(LoadedSurface{described.file, described.placing, described.drawn, {}});
        const EspTransform place = surface.placing.transform();
        const auto load = surface.drawn ? espLoadSurface : espLoadGround;
        if (!fromContext(context, load(context, surface.file.c_str(), &place, &surface.id), error)) return false;
    }
    uint32_t number = request.seed.value_or(0);
    for (size_t i = 0; i < file.grammars.size(); ++i) {
        SceneGrammar described = file.grammars[i];
        LoadedGrammar grammar;
        if (i == 0 && !request.grammar.empty()) {
            described.file = request.grammar;
            described.text.reset();
            described.grows.reset();
        }
        grammar.file = described.file;
        if (!loadGrammar(context, described, grammar, error)) return false;
        out.grammars.push_back(grammar);
        for (Seed seed : described.seeds) {
            seed.grammar = uint32_t(i);
            if (request.seed) seed.number = number++;
            if (!seed.frozenFile.empty() && !readFrozen(seed, error)) return false;
            out.seeds.push_back(seed);
        }
    }
    for (uint64_t branch : file.pruned)
        if (!fromContext(context, espPruneBranch(context, branch, 1), error)) return false;
    out.town = file.town;
    if (out.town && !loadTown(context, out, error)) return false;
    out.site = file.site;
    if (!out.site.empty() && !furnish(context, out.site, error)) return false;
    noteLayers(context, out);
    for (const SceneLayer& layer : file.layers) {
        // What was painted before a grammar's text lost its layer stays in a project; a scene may paint layers that
        // only some grammar, given in place of its own, doesn't read.
        const bool read = std::ranges::find(out.layers, layer.name) != out.layers.end();
        if (!read && !file.project) continue;
        if (!layLayer(context, out, layer, error)) return false;
    }
    out.camera = espFrameAll(context);
    if (file.hasCamera) {
        std::copy(file.eye.begin(), file.eye.end(), out.camera.eye);
        std::copy(file.target.begin(), file.target.end(), out.camera.target);
    }
    if (file.fov > 0) out.camera.fovY = file.fov * kPi / 180;
    file.applyLook(out.ownLook);
    out.hour = file.hour;
    return true;
}

}  // namespace

std::string contentFolder() {
    std::error_code ignored;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    return (program.parent_path().parent_path() / "content").string();
}

EspTransform Placing::transform() const {
    const float c = scale * std::cos(turn), s = scale * std::sin(turn);
    return {{{c, 0, s, position[0]}, {0, scale, 0, position[1]}, {-s, 0, c, position[2]}}};
}

void noteLayers(const EspContext* context, Scene& scene) {
    scene.layers.clear();
    const auto note = [&](const std::string& name) {
        if (std::ranges::find(scene.layers, name) == scene.layers.end()) scene.layers.push_back(name);
    };
    for (const LoadedGrammar& grammar : scene.grammars)
        for (uint32_t i = 0; i < espLayerCount(context, grammar.id); ++i) note(espLayerName(context, grammar.id, i));
    for (uint32_t i = 0; i < espPaintedLayerCount(context); ++i) note(espPaintedLayerName(context, i));
    for (uint32_t i = 0; i < espTownLayerCount(context); ++i) note(espTownLayerName(context, i));
}

bool openScene(EspContext* context, const Request& asked, Scene& out, std::string& error) {
    namespace fs = std::filesystem;
    Request request = asked;
    std::error_code ignored;
    if (fs::is_directory(request.file, ignored) && fs::exists(fs::path(request.file) / "project.json", ignored))
        request.file = (fs::path(request.file) / "project.json").string();
    out = Scene{};
    out.name = fs::path(asked.file).filename().string();
    out.ownLook = espDefaultLook();
    const bool described = fs::path(request.file).extension() == ".json";
    const auto open = isTown(request.file) ? openTown : described ? openDescription : openSurface;
    if (!open(context, request, out, error)) return false;
    noteLayers(context, out);
    for (const auto& [name, picture] : request.layers) {
        if (std::ranges::find(out.layers, name) == out.layers.end()) {
            error = picture + ": no grammar of this scene reads a layer '" + name + "'";
            return false;
        }
        if (!layLayer(context, out, {name, picture, -1}, error)) return false;
    }
    out.look = out.ownLook;
    if (out.hour != kOwnSun) applyDaylight(out.hour, out.look);
    uint32_t key = 0;
    for (Seed& seed : out.seeds) seed.key = ++key;
    return true;
}

EspResult walkLayer(EspContext* context, EspSurface surface, const std::string& name, const GreyPicture& picture,
                    EspLayerDef& out) {
    uint32_t side = 0;
    if (EspResult asked = espReadLayer(context, surface, name.c_str(), nullptr, &side); asked != ESP_OK) return asked;
    out = espDefaultLayerDef();
    out.surface = surface;
    out.name = name.c_str();
    out.space = picture.width == side && picture.height == side ? ESP_LAYER_TEXELS : ESP_LAYER_WALK_UV;
    out.texels = picture.texels.data();
    out.width = picture.width;
    out.height = picture.height;
    return ESP_OK;
}

bool plantAll(EspContext* context, Scene& scene, std::string& error) {
    if (!fromContext(context, espRemoveAllSeeds(context), error)) return false;
    for (Seed& seed : scene.seeds) {
        EspSeedDef def = espDefaultSeedDef();
        def.grammar = scene.grammars[seed.grammar].id;
        std::copy(seed.position.begin(), seed.position.end(), def.position);
        std::copy(seed.direction.begin(), seed.direction.end(), def.direction);
        def.number = seed.number;
        if (!fromContext(context, espPlant(context, &def, &seed.planted), error)) return false;
        for (const ParamValue& own : seed.params)
            if (!fromContext(context,
                             espSetSeedParam(context, seed.planted, own.name.c_str(), own.value.data(), own.count),
                             error))
                return false;
        if (seed.frozen && espFreezeAs(context, seed.planted, seed.frozen->data(), seed.frozen->size()) != ESP_OK) {
            scene.notes.push_back("a frozen plant grows again: " + std::string(espLastError(context)));
            seed.frozen = nullptr;
        }
    }
    return true;
}

bool setText(EspContext* context, LoadedGrammar& grammar, const std::string& text) {
    grammar.text = text;
    grammar.error.clear();
    grammar.warnings.clear();
    const EspGrammarDef def{grammar.file.c_str(), text.data(), text.size()};
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

namespace {
constexpr const char* kViews[] = {"shaded", "charts", "normals", "lod", "layer", "depth", "overdraw"};
}

bool viewNamed(const std::string& name, EspView& out) {
    const auto found = std::find(std::begin(kViews), std::end(kViews), name);
    if (found == std::end(kViews)) return false;
    out = EspView(found - std::begin(kViews));
    return true;
}

const char* nameOf(EspView view) {
    return size_t(view) < std::size(kViews) ? kViews[view] : "shaded";
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
