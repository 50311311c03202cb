// What a frame is drawn from: a host's look, and what the context has grown.
#include "runtime/plugin/frame_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/painting.hpp"
#include "runtime/plugin/shown_layers.hpp"
#include "runtime/plugin/town_growth.hpp"

namespace espalier {
namespace {

bool finiteLook(const EspLook& look) {
    for (const float* v :
         {look.sunDirection, look.sunColour, look.skyColour, look.groundColour, look.background, look.horizon})
        if (!finite(v)) return false;
    if (!finite(look.wind) || !std::isfinite(look.gusts) || !std::isfinite(look.clock)) return false;
    for (float v : {look.exposure, look.viewOpacity, look.lodPixels, look.leafPixels, look.groundLevel})
        if (!std::isfinite(v)) return false;
    return true;
}

bool isPainted(const EspContext& context, const std::string& name) {
    return std::ranges::find(context.layers, name, &PaintedLayer::name) != context.layers.end() ||
           (context.town && context.town->layers.find(name));
}

// Over surfaces; one that is painted, but that no grammar reads, gets a number to be seen by, if one is left.
std::optional<uint32_t> layerToShow(EspContext& context, const std::string& name, std::span<const uint32_t> kept) {
    const auto known = std::ranges::find(context.sceneLayers, name, &SceneLayer::name);
    if (known != context.sceneLayers.end()) return uint32_t(known - context.sceneLayers.begin());
    if (std::ranges::find(context.layers, name, &PaintedLayer::name) == context.layers.end()) return {};
    return sceneLayer(context, name, 0, kept);
}

EspResult makeLook(EspContext& context, const std::string& call, const EspLook& from, Look& look) {
    look.sunDirection = vec(from.sunDirection);
    look.sunColor = vec(from.sunColour);
    look.skyColor = vec(from.skyColour);
    look.groundColor = vec(from.groundColour);
    look.exposure = from.exposure;
    look.background = vec(from.background);
    look.horizon = vec(from.horizon);
    look.shadows = from.shadows != 0;
    look.shadowsLag = from.shadowsLag != 0;
    look.quick = from.quick != 0;
    look.wind = vec(from.wind);
    look.gusts = from.gusts;
    look.clock = from.clock;
    static_assert(uint32_t(ViewMode::charts) == ESP_VIEW_CHARTS && uint32_t(ViewMode::normals) == ESP_VIEW_NORMALS &&
                  uint32_t(ViewMode::lod) == ESP_VIEW_LOD && uint32_t(ViewMode::layer) == ESP_VIEW_LAYER &&
                  uint32_t(ViewMode::depth) == ESP_VIEW_DEPTH && uint32_t(ViewMode::overdraw) == ESP_VIEW_OVERDRAW);
    look.view = from.view == ESP_VIEW_FIELD ? ViewMode::layer : ViewMode(from.view);
    look.lodPixels = from.lodPixels;
    look.leafPixels = from.leafPixels;
    look.layerOpacity = from.viewOpacity;
    look.level = from.viewLevel;
    if (from.view == ESP_VIEW_LAYER && from.viewBrush) {
        if (const char* mistake = espalier::mistakeIn(*from.viewBrush))
            return fail(&context, ESP_INVALID_ARGUMENT, call + ": viewBrush: " + mistake);
        look.limits = limitsOf(*from.viewBrush);
    }
    if (from.view == ESP_VIEW_LAYER) {
        const std::string name = from.viewLayer ? from.viewLayer : "";
        look.layer = shownLayers(name, [&](const std::string& layer, std::span<const uint32_t> kept) {
            return layerToShow(context, layer, kept);
        });
        const auto known = [&](const std::string& layer) {
            return declaredFill(context, layer) || isPainted(context, layer);
        };
        if (look.layer == kNoIndex && !known(name) && !known(name + kChannels[0]))
            return fail(&context, ESP_INVALID_ARGUMENT, call + ": no grammar reads a layer '" + name + "'");
    }
    return ESP_OK;
}

// A field's picture is a layer of colours. Pieces would cover it.
EspResult showField(EspContext& context, const std::string& call, const std::string& name, DrawInputs& inputs) {
    const FieldInfo* info = fieldNamed(context, name);
    if (!info) return fail(&context, ESP_INVALID_ARGUMENT, call + ": no grammar declares a field '" + name + "'");
    const Result<LayerBuf> layers = fieldLayers(context, *info);
    if (!layers) return failWork(&context, layers.failure());
    inputs.layers = layers.value();
    inputs.look.layer = colourLayers(0, 1, 2);
    inputs.look.pieces = false;
    return ESP_OK;
}

}  // namespace

TakenLook::TakenLook(const std::string& call, const EspLook* given) {
    setDefaults(look);
    look = takenOr((call + ": look").c_str(), given, look);
    if (!look.viewBrush) return;
    brush = taken((call + ": viewBrush").c_str(), look.viewBrush);
    look.viewBrush = &brush;
}

EspResult checkFrame(const EspContext* context, const std::string& call, uint64_t frame, uint64_t framesDone) {
    if (frame > std::max(framesDone, context->device->hostFrame())) return ESP_OK;
    return fail(context, ESP_INVALID_ARGUMENT,
                call + ": frame " + std::to_string(frame) + " is done already: frames are numbered rising");
}

EspResult checkLook(const EspContext* context, const std::string& call, const EspLook& look) {
    if (!isAmong(look.view, ESP_VIEW_SHADED, ESP_VIEW_FIELD))
        return fail(context, ESP_INVALID_ARGUMENT, call + ": no such view");
    if (look.ground < ESP_GROUND_NONE || look.ground > ESP_GROUND_STUDIO)
        return fail(context, ESP_INVALID_ARGUMENT, call + ": no such ground");
    if (!finiteLook(look)) return fail(context, ESP_INVALID_ARGUMENT, call + ": a number of the look is not finite");
    return ESP_OK;
}

EspResult findInputs(EspContext& context, const std::string& call, const EspLook& look, bool hosted,
                     FrameInputs& inputs) {
    if (EspResult bad = makeLook(context, call, look, inputs.look)) return bad;
    Status tables = context.refreshTables();
    if (!tables) return failGpu(&context, tables.failure());
    inputs.growth = context.growth->view();
    inputs.origin = context.origin;
    if (context.town) {
        inputs.roofs = &context.town->view;
        inputs.ground = context.town->ground;
        const bool shows = look.view == ESP_VIEW_LAYER && look.viewLayer;
        context.town->view.shownLayer = shownTownLayer(context, shows ? look.viewLayer : "");
    }
    static_assert(uint32_t(GroundKind::meadow) == ESP_GROUND_MEADOW &&
                  uint32_t(GroundKind::studio) == ESP_GROUND_STUDIO);
    if (look.ground) {
        inputs.ground.kind = GroundKind(look.ground);
        inputs.ground.height = look.groundLevel;
        inputs.ground.overgrows = look.groundOvergrows != 0;
    }
    if (hosted) inputs.ground.kind = GroundKind::none;  // the ground of a host's scene is the host's
    inputs.surfaces = addressOf<SurfaceBuf>(context.surfaceTable);
    inputs.carriers = context.carriersPlaced();
    inputs.placed = inputs.carriers;
    inputs.layers = addressOf<LayerBuf>(context.layerTable);
    if (look.view == ESP_VIEW_FIELD) return showField(context, call, look.viewLayer ? look.viewLayer : "", inputs);
    return ESP_OK;
}

}  // namespace espalier
