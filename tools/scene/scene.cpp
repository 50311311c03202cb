// A scene file or a bare surface -> surface, grammars, layers in a context, and what to plant and how to look.
#include "tools/scene/scene.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "tools/scene/picture.hpp"
#include "tools/scene/scene_file.hpp"

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

bool compileFile(EspContext* context, const std::string& file, EspGrammar& grammar, bool again, std::string& error) {
    std::string text;
    if (!readText(file, text, error)) return false;
    const EspGrammarDef def{file.c_str(), text.data(), text.size()};
    return fromContext(context,
                       again ? espRecompileGrammar(context, grammar, &def) : espCompileGrammar(context, &def, &grammar),
                       error);
}

bool layLayer(EspContext* context, const Scene& scene, const std::string& name, const std::string& file,
              std::string& error) {
    bool known = false;
    for (const std::string& layer : scene.layers) known = known || layer == name;
    if (!known) {
        error = file + ": no grammar of this scene reads a layer '" + name + "'";
        return false;
    }
    GreyPicture picture;
    if (!readGrey(file, picture, error)) return false;
    EspLayerDef def = espDefaultLayerDef();
    def.surface = scene.surface;
    def.name = name.c_str();
    def.space = ESP_LAYER_MATERIAL_UV;
    def.texels = picture.texels.data();
    def.width = picture.width;
    def.height = picture.height;
    return fromContext(context, espSetLayer(context, &def), error);
}

void noteLayers(EspContext* context, Scene& scene) {
    for (const LoadedGrammar& grammar : scene.grammars)
        for (uint32_t i = 0; i < espLayerCount(context, grammar.id); ++i) {
            const std::string name = espLayerName(context, grammar.id, i);
            if (std::find(scene.layers.begin(), scene.layers.end(), name) == scene.layers.end())
                scene.layers.push_back(name);
        }
}

// Numbers of 0 to 1 that are the same on every machine.
float chance(uint32_t seed, uint32_t index) {
    uint32_t x = seed * 747796405u + index * 2891336453u + 12345u;
    x = ((x >> ((x >> 28) + 4)) ^ x) * 277803737u;
    x = (x >> 22) ^ x;
    return float(x >> 8) / 16777216.f;
}

// Seeds where rays from around the model, aimed at its middle, meet its lower part.
void plantAround(const EspContext* context, const EspSurfaceInfo& info, uint32_t number, Scene& scene) {
    constexpr uint32_t kSeeds = 14;
    float centre[3], size[3];
    for (int i = 0; i < 3; ++i) {
        centre[i] = (info.boundsMin[i] + info.boundsMax[i]) / 2;
        size[i] = info.boundsMax[i] - info.boundsMin[i];
    }
    const float radius = std::sqrt(size[0] * size[0] + size[1] * size[1] + size[2] * size[2]) / 2;
    for (uint32_t i = 0; i < kSeeds; ++i) {
        const float angle = 2 * kPi * (float(i) + .7f * chance(number, 3 * i)) / kSeeds;
        const float height = info.boundsMin[1] + size[1] * (.04f + .12f * chance(number, 3 * i + 1));
        const float origin[3] = {centre[0] + 2 * radius * std::sin(angle), height,
                                 centre[2] + 2 * radius * std::cos(angle)};
        const float to[3] = {centre[0] - origin[0], 0, centre[2] - origin[2]};
        EspHit hit;
        const float aside[3] = {centre[0] + .5f * size[0] * std::sin(angle), height,
                                centre[2] + .5f * size[2] * std::cos(angle)};
        if (espPick(context, origin, to, &hit) != ESP_OK && espNearest(context, aside, &hit) != ESP_OK) continue;
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

// Lengths of the default ivy suit a wall of three metres; a statue wants smaller leaves, a palace longer stems.
void fitToModel(EspContext* context, const EspSurfaceInfo& info, const LoadedGrammar& grammar) {
    const float scale = largestSide(info) / 6;
    for (uint32_t i = 0; i < espParamCount(context, grammar.id); ++i) {
        EspParamInfo param;
        if (espParamInfo(context, grammar.id, i, &param) == ESP_OK && !std::strcmp(param.name, "scale"))
            espSetParam(context, grammar.id, "scale", &scale, 1);
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
bool loadAtLivingSize(EspContext* context, const std::string& file, EspSurface& surface, EspSurfaceInfo& info,
                      std::string& error) {
    constexpr float kSmallest = .1f, kLargest = 500, kUsual = 2;
    EspTransform place = espIdentity();
    for (int attempt = 0; attempt < 2; ++attempt) {
        if (!fromContext(context, espLoadSurface(context, file.c_str(), &place, &surface), error) ||
            !fromContext(context, espSurfaceInfo(context, surface, &info), error))
            return false;
        const float size = largestSide(info);
        if (attempt == 1 || (size >= kSmallest && size <= kLargest) || !(size > 0)) return true;
        for (int i = 0; i < 3; ++i) place.rows[i][i] = kUsual / size;
        if (!fromContext(context, espDestroySurface(context, surface), error)) return false;
    }
    return true;
}

bool openSurface(EspContext* context, const Request& request, Scene& out, std::string& error) {
    if (isUnbakedModel(request.file)) {
        error = request.file + ": isn't baked yet: espalier-bake " + request.file +
                " -o SURFACE.glb (tools/run does it for you)";
        return false;
    }
    EspSurfaceInfo info;
    if (!loadAtLivingSize(context, request.file, out.surface, info, error)) return false;
    const char* standard = request.layers.empty() ? "ivy_free.grammar" : "ivy_guided.grammar";
    LoadedGrammar grammar;
    grammar.file = request.grammar.empty() ? contentFolder() + "/grammars/" + standard : request.grammar;
    if (!compileFile(context, grammar.file, grammar.id, false, error)) return false;
    out.grammars.push_back(grammar);
    fitToModel(context, info, grammar);
    plantAround(context, info, request.seed.value_or(1), out);
    out.camera = espFrameAll(context);
    return true;
}

bool setParam(EspContext* context, const LoadedGrammar& grammar, const SceneParam& param, std::string& error) {
    return fromContext(context, espSetParam(context, grammar.id, param.name.c_str(), param.value.data(), param.count),
                       error);
}

bool openDescription(EspContext* context, const Request& request, Scene& out, std::string& error) {
    SceneFile file;
    if (!readSceneFile(request.file, file, error)) return false;
    if (!fromContext(context, espLoadSurface(context, file.surface.c_str(), nullptr, &out.surface), error))
        return false;
    uint32_t number = request.seed.value_or(0);
    for (size_t i = 0; i < file.grammars.size(); ++i) {
        const SceneGrammar& described = file.grammars[i];
        LoadedGrammar grammar;
        grammar.file = i == 0 && !request.grammar.empty() ? request.grammar : described.file;
        if (!compileFile(context, grammar.file, grammar.id, false, error)) return false;
        for (const SceneParam& param : described.params)
            if (!setParam(context, grammar, param, error)) {
                error = param.place + ": " + error;
                return false;
            }
        out.grammars.push_back(grammar);
        for (Seed seed : described.seeds) {
            seed.grammar = uint32_t(i);
            if (request.seed) seed.number = number++;
            out.seeds.push_back(seed);
        }
    }
    noteLayers(context, out);
    for (const auto& [name, picture] : file.layers) {
        // A scene may paint layers that only some grammar, given in place of its own, doesn't read.
        if (std::find(out.layers.begin(), out.layers.end(), name) == out.layers.end()) continue;
        if (!layLayer(context, out, name, picture, error)) return false;
    }
    out.camera = espFrameAll(context);
    if (file.hasCamera) {
        std::copy(file.eye.begin(), file.eye.end(), out.camera.eye);
        std::copy(file.target.begin(), file.target.end(), out.camera.target);
    }
    if (file.fov > 0) out.camera.fovY = file.fov * kPi / 180;
    file.applyLook(out.look);
    return true;
}

}  // namespace

std::string contentFolder() {
    std::error_code ignored;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    return (program.parent_path().parent_path() / "content").string();
}

bool openScene(EspContext* context, const Request& request, Scene& out, std::string& error) {
    out = Scene{};
    out.name = std::filesystem::path(request.file).filename().string();
    out.look = espDefaultLook();
    const bool described = std::filesystem::path(request.file).extension() == ".json";
    if (!(described ? openDescription : openSurface)(context, request, out, error)) return false;
    noteLayers(context, out);
    for (const auto& [name, picture] : request.layers)
        if (!layLayer(context, out, name, picture, error)) return false;
    return true;
}

bool plantAll(EspContext* context, const Scene& scene, std::string& error) {
    if (!fromContext(context, espRemoveAllSeeds(context), error)) return false;
    for (const Seed& seed : scene.seeds) {
        EspSeedDef def = espDefaultSeedDef();
        def.grammar = scene.grammars[seed.grammar].id;
        std::copy(seed.position.begin(), seed.position.end(), def.position);
        std::copy(seed.direction.begin(), seed.direction.end(), def.direction);
        def.number = seed.number;
        EspSeed planted;
        if (!fromContext(context, espPlant(context, &def, &planted), error)) return false;
    }
    return true;
}

bool recompile(EspContext* context, const LoadedGrammar& grammar, std::string& error) {
    EspGrammar id = grammar.id;
    return compileFile(context, grammar.file, id, true, error);
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
