// A surface or a town on its own -> what a scene file would say of it: grammar, seeds, size, ground, camera.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string_view>

#include "plugin_api/espalier.hpp"
#include "tools/scene/scene_parts.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

const char* kSurfaceExtension = "\"ESPALIER_";  // how docs/surface_format.md names it

// Numbers of 0 to 1 that are the same on every machine.
float chance(uint32_t seed, uint32_t index) {
    uint32_t x = seed * 747796405u + index * 2891336453u + 12345u;
    x = ((x >> ((x >> 28) + 4)) ^ x) * 277803737u;
    x = (x >> 22) ^ x;
    return float(x >> 8) / 16777216.f;
}

// So many plants around a foot of this size: few hide a slim model.
uint32_t seedsAround(const float size[3]) {
    constexpr float kMost = 16, kLeast = 3;
    return uint32_t(std::clamp(std::ceil(kMost * .5f * (size[0] + size[2]) / std::max(size[1], 1e-6f)), kLeast, kMost));
}

// Seeds where rays from all around meet the model's foot: they stand in the ground. They are aimed at places spread
// evenly over its ground plan, so that of pieces that lie apart each gets its share; what leads through a gap is aimed
// at the middle.
void plantAround(const EspContext* context, const EspSurfaceInfo& info, uint32_t number, Scene& scene) {
    constexpr float kHighest = .02f;                         // of the model's height
    constexpr float kPlanX = .7548777f, kPlanZ = .5698403f;  // of the evenest sequence of points in a square
    float centre[3], size[3];
    for (int i = 0; i < 3; ++i) {
        centre[i] = (info.boundsMin[i] + info.boundsMax[i]) / 2;
        size[i] = info.boundsMax[i] - info.boundsMin[i];
    }
    const float far = std::sqrt(size[0] * size[0] + size[1] * size[1] + size[2] * size[2]);
    const uint32_t seeds = seedsAround(size);
    for (uint32_t i = 0; i < seeds; ++i) {
        const float angle = 2 * std::numbers::pi_v<float> * (float(i) + .7f * chance(number, 3 * i)) / float(seeds);
        const float height = info.boundsMin[1] + size[1] * kHighest * (.1f + .9f * chance(number, 3 * i + 1));
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

// A pattern spreads by itself: one seed where the eye that sees all of the model meets it.
void plantInSight(const EspContext* context, uint32_t number, Scene& scene) {
    const EspCamera& camera = scene.camera;
    const float towards[3] = {camera.target[0] - camera.eye[0], camera.target[1] - camera.eye[1],
                              camera.target[2] - camera.eye[2]};
    EspHit hit;
    if (espPick(context, camera.eye, towards, &hit) != ESP_OK && espNearest(context, camera.target, &hit) != ESP_OK)
        return;
    Seed seed;
    std::memcpy(seed.position.data(), hit.position, sizeof hit.position);
    seed.direction = {0, -1, 0};
    seed.number = number;
    scene.seeds.push_back(seed);
}

bool makesPatterns(const EspContext* context, EspGrammar grammar) {
    EspGrammarKind kind;
    return espGrammarKind(context, grammar, &kind) == ESP_OK && kind == ESP_GRAMMAR_PATTERNS;
}

float largestSide(const EspSurfaceInfo& info) {
    float size = 0;
    for (int i = 0; i < 3; ++i) size = std::max(size, info.boundsMax[i] - info.boundsMin[i]);
    return size;
}

constexpr float kAbove = .001f;  // of its size, that a model stands above the ground: a pixel or so

// glTF's unit is the metre, but many scans come in another: a statue of a centimetre, or of a kilometre, is shown as
// one of two metres, so that ivy on it is ivy.
bool loadAtLivingSize(EspContext* context, LoadedSurface& surface, EspSurfaceInfo& info, std::string& error) {
    for (int attempt = 0; attempt < 2; ++attempt) {
        const EspTransform place = surface.placing.transform();
        if (!fromContext(context, espLoadSurface(context, surface.file.c_str(), &place, &surface.id), error) ||
            !fromContext(context, espSurfaceInfo(context, surface.id, &info), error))
            return false;
        const float scale = livingScale(largestSide(info));
        if (attempt == 1 || scale == 1) return true;
        surface.placing.scale = scale;
        if (!fromContext(context, espDestroySurface(context, surface.id), error)) return false;
    }
    return true;
}

}  // namespace

// What stands alone gets something to stand on, below all of it, floors too: a studio's floor, under a light that shows
// forms and colours. The eye is not to be below it.
void layGround(float level, Scene& scene) {
    EspLook& look = scene.ownLook;
    look.ground = ESP_GROUND_STUDIO;
    look.groundLevel = level;
    look.groundOvergrows = 0;
    const auto set = [](float(&to)[3], float r, float g, float b) { to[0] = r, to[1] = g, to[2] = b; };
    set(look.sunDirection, .62f, .66f, .55f);
    set(look.sunColour, 2.6f, 2.36f, 2.0f);
    set(look.skyColour, .80f, .87f, .98f);
    set(look.groundColour, .46f, .43f, .38f);
    set(look.background, .24f, .29f, .35f);
    set(look.horizon, .45f, .47f, .49f);
    EspCamera& camera = scene.camera;
    const float away = std::hypot(camera.eye[0] - camera.target[0], camera.eye[2] - camera.target[2]);
    camera.eye[1] = std::max(camera.eye[1], level + .02f * away);
}

float livingScale(float side) {
    constexpr float kSmallest = .1f, kLargest = 500, kUsual = 2;
    return (side >= kSmallest && side <= kLargest) || !(side > 0) ? 1 : kUsual / side;
}

// Leaves of a model of something large are smaller, never larger than life; and stems are to get well up whatever
// it is.
std::vector<ParamValue> fittingParams(const EspContext* context, EspGrammar grammar, float side, float height) {
    const bool pattern = makesPatterns(context, grammar);  // whose lengths suit a model of two metres
    const float scale = pattern ? side / 2 : std::min(1.f, side / 6), reach = .7f * height / scale;
    std::vector<ParamValue> values;
    for (uint32_t i = 0; i < espParamCount(context, grammar); ++i) {
        EspParamInfo param;
        if (espParamInfo(context, grammar, i, &param) != ESP_OK) continue;
        if (!std::strcmp(param.name, "scale")) values.push_back({"scale", {scale}});
        if (!std::strcmp(param.name, "reach") && reach > param.value[0])
            values.push_back({"reach", {std::min(reach, param.high)}});
    }
    return values;
}

bool isSurface(const std::string& path, std::string& error) {
    std::string text;
    if (!readText(path, text, error)) return false;
    const bool glb = text.starts_with("glTF");
    if (glb && text.find(kSurfaceExtension) != std::string::npos) return true;
    // A model as modelling programs write it is what a user may well try first.
    const std::string ending = std::filesystem::path(path).extension().string();
    const bool model = glb || (ending == ".gltf" && text.find("\"asset\"") != std::string::npos) || ending == ".obj" ||
                       ending == ".ply" || ending == ".stl" || ending == ".fbx";
    error =
        path + (model ? ": isn't baked yet: espalier-bake " + path + " -o SURFACE.glb (tools/run does it for you)"
                      : ": neither a scene (.json), a town (.geojson), a graph (.graph) nor a baked surface (.glb)");
    return false;
}

bool openSurface(EspContext* context, const Request& request, Scene& out, std::string& error) {
    if (!isSurface(request.file, error)) return false;
    EspSurfaceInfo info;
    LoadedSurface& surface = out.surfaces.emplace_back();
    surface.file = request.file;
    if (!loadAtLivingSize(context, surface, info, error)) return false;
    const char* standard = request.layers.empty() ? "ivy_free.grammar" : "ivy_guided.grammar";
    LoadedGrammar grammar;
    grammar.file = request.grammar.empty() ? contentFolder() + "/grammars/" + standard : request.grammar;
    if (!compileFile(context, grammar, error)) return false;
    out.grammars.push_back(grammar);
    for (const ParamValue& value :
         fittingParams(context, grammar.id, largestSide(info), info.boundsMax[1] - info.boundsMin[1]))
        (void)espSetParam(context, grammar.id, value.name.c_str(), value.value.data(), value.count);
    out.camera = esp::frameAll(context);
    if (makesPatterns(context, grammar.id))
        plantInSight(context, request.seed.value_or(1), out);
    else
        plantAround(context, info, request.seed.value_or(1), out);
    layGround(info.boundsMin[1] - kAbove * largestSide(info), out);
    return true;
}

// A town on its own, by the grammar of all kinds of roofs unless another is asked for.
bool openTown(EspContext* context, const Request& request, Scene& out, std::string& error) {
    LoadedGrammar grammar;
    grammar.file = request.grammar.empty() ? contentFolder() + "/grammars/town.grammar" : request.grammar;
    if (!compileFile(context, grammar, error)) return false;
    out.grammars.push_back(grammar);
    out.town = SceneTown{request.file, -1, {}, true, {}};
    if (!loadTown(context, out, error)) return false;
    out.camera = esp::frameAll(context);
    return true;
}

}  // namespace espalier::scene
