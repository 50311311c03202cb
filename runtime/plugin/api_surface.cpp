// Loading, placing and describing surfaces; the tables of surfaces and layers that kernels read.
#include "runtime/gpu/color_texture.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/painting.hpp"
#include "runtime/plugin/seeds.hpp"
#include "runtime/plugin/surface_contacts.hpp"
#include "runtime/plugin/surface_point.hpp"
#include "runtime/plugin/surface_read.hpp"

namespace espalier {
namespace {

EspResult load(EspContext& context, const EspSurfaceDef& def, const std::string& call, EspSurface* out) {
    const SurfaceRequest request = requestOf(context, call, def);
    std::vector<std::byte> file;
    if (EspResult unread = readFileOf(context, request, file)) return unread;
    Result<SurfaceRead> read = readSurface(std::move(file), request, holdsRoots(*context.device));
    if (!read) return failContent(&context, read.failure());
    if (Status uploaded = read->upload.run(*context.device); !uploaded) return failGpu(&context, uploaded.failure());
    return standSurface(context, call, std::move(*read), out);
}

EspSurfaceDef named(const char* path, const EspTransform* place, int groundOnly) {
    EspSurfaceDef def{};
    def.name = path;
    def.place = place;
    def.groundOnly = groundOnly;
    return def;
}

// Its seeds stay where they are on it.
EspResult move(EspContext& context, uint32_t id, PlacedSurface& surface, const EspTransform& place) {
    const glm::mat4 toWorld = matrixOf(place);
    const std::optional<float> scale = evenScale(toWorld);
    if (!scale)
        return fail(&context, ESP_INVALID_ARGUMENT,
                    "espMoveSurface: the transform must move (by up to 1e9 m), turn and scale evenly; it may mirror");
    if (toWorld == surface.toWorld) return ESP_OK;
    // All that asks for memory comes first. What it touches from now on is known when contacts have been found anew.
    SurfaceChanges changes = withChange(context, surface.instance, changeOfMove(surface.toWorld, toWorld));
    // A frozen plant stands in its surface's own space, but for its thickness.
    thawPlantsOn(context, surface.instance, sameScale(*scale, surface.scale));
    const glm::mat4 shift = toWorld * surface.toObject;
    surface.place = place;
    surface.stand = standOf(context, place);
    surface.toWorld = toWorld;
    surface.toObject = glm::inverse(toWorld);
    surface.scale = *scale;
    surface.info = describe(*surface.content, toWorld);
    context.renderer->placeSurface(surface.instance, toWorld);
    const auto moved = [&](glm::vec3 p) { return glm::vec3(shift * glm::vec4(p, 1)); };
    const auto turned = [&](glm::vec3 v) { return glm::mat3(shift) * v; };
    context.seeds.forEach([&](uint32_t, PlantedSeed& seed) {
        if (seed.surface != id) return;
        seed.position = moved(seed.position);
        seed.normal = glm::normalize(turned(seed.normal));
        seed.direction = glm::normalize(turned(seed.direction));
        seed.givenPosition = moved(seed.givenPosition);
        seed.givenDirection = turned(seed.givenDirection);
    });
    context.plants.reset();  // which were read where they stood
    context.surfaceChanges = std::move(changes);
    surface.placed = context.nodes.surfaces.change();
    return ESP_OK;
}

}  // namespace

}  // namespace espalier

using namespace espalier;

uint32_t EspContext::surfaceSlots() const {
    uint32_t slots = 0;
    surfaces.forEach([&](uint32_t, const PlacedSurface& surface) { slots = std::max(slots, surface.instance + 1); });
    return slots;
}

std::vector<glm::mat4> EspContext::stands() const {
    std::vector<glm::mat4> places(std::max({size_t(surfaceSlots()), grownSurfaces.size(), size_t(1)}), glm::mat4(1));
    for (size_t i = 0; i < grownSurfaces.size(); ++i) places[i] = grownSurfaces[i].toWorld;
    surfaces.forEach([&](uint32_t, const PlacedSurface& surface) { places[surface.instance] = surface.toWorld; });
    return places;
}

std::vector<Version> EspContext::carriersPlaced() const {
    std::vector<Version> placed(carriers.size());
    const auto put = [&](size_t instance, Version version) {
        if (instance < carriers.size() && carriers[instance]) placed[instance] = version;
    };
    for (size_t i = 0; i < grownSurfaces.size(); ++i) put(i, grownSurfaces[i].placed);
    surfaces.forEach([&](uint32_t, const PlacedSurface& surface) { put(surface.instance, surface.placed); });
    return placed;
}

Status EspContext::refreshTables() {
    if (nodes.contacts.due()) {
        if (Status found = refreshContacts(*this); !found) return found;
        nodes.contacts.made();
    }
    if (nodes.tables.due()) {
        const std::vector<glm::mat4> places = stands();
        std::vector<SurfaceRef> refs(places.size());
        for (size_t i = 0; i < places.size(); ++i) placeSurface(refs[i], places[i]);
        std::vector<LayerRef> layerRefs(places.size() * kMaxLayers);
        for (LayerRef& ref : layerRefs) ref = LayerRef{{nullptr}, 0, 1};
        for (size_t i = 0; i < layerRefs.size(); ++i)
            if (i % kMaxLayers < sceneLayers.size()) layerRefs[i].fill = sceneLayers[i % kMaxLayers].fill;
        surfaces.forEach([&](uint32_t id, const PlacedSurface& surface) {
            refs[surface.instance] = surface.gpu.ref(surface.toWorld);
            for (uint32_t i = 0; i < sceneLayers.size(); ++i) {
                LayerRef& ref = layerRefs[surface.instance * kMaxLayers + i];
                ref.size = surface.content->data.levels.front().size;
                if (const PaintedLayer* painted = paintedLayer(*this, id, sceneLayers[i].name))
                    ref.texels = addressOf<FloatBuf>(painted->texels);
            }
        });
        Result<Buffer> newSurfaces = makeBuffer(*device, "surface table", refs);
        if (!newSurfaces) return newSurfaces.failure();
        Result<Buffer> newLayers = makeBuffer(*device, "layer table", layerRefs);
        if (!newLayers) return newLayers.failure();
        surfaceTable = std::move(*newSurfaces);
        layerTable = std::move(*newLayers);
        nodes.tables.made();
    }
    Status status = Done{};
    grammars.forEach([&](uint32_t, LoadedGrammar& grammar) {
        if (grammar.uploaded == grammar.version || !status) return;
        Result<Buffer> words = makeBuffer(*device, "rule map", std::as_bytes(grammar.map.words()));
        if (!words) {
            status = words.failure();
            return;
        }
        grammar.words = std::move(*words);
        grammar.uploaded = grammar.version;
    });
    return status;
}

extern "C" {

EspTransform espIdentity(void) {
    EspTransform t{};
    for (int i = 0; i < 3; ++i) t.rows[i][i] = 1;
    return t;
}

EspResult espLoadSurface(EspContext* context, const char* path, const EspTransform* place, EspSurface* out) {
    return guarded(context, [&] {
        if (!path || !out) return fail(context, ESP_INVALID_ARGUMENT, "espLoadSurface: null pointer");
        return load(*context, named(path, place, 0), "espLoadSurface: ", out);
    });
}

EspResult espLoadGround(EspContext* context, const char* path, const EspTransform* place, EspSurface* out) {
    return guarded(context, [&] {
        if (!path || !out) return fail(context, ESP_INVALID_ARGUMENT, "espLoadGround: null pointer");
        return load(*context, named(path, place, 1), "espLoadGround: ", out);
    });
}

EspResult espAddSurface(EspContext* context, const EspSurfaceDef* given, EspSurface* out) {
    return guarded(context, [&] {
        const EspSurfaceDef def = taken("espAddSurface", given);
        if ((!def.name && !def.bytes) || !out)
            return fail(context, ESP_INVALID_ARGUMENT, "espAddSurface: null pointer");
        return load(*context, def, "espAddSurface: ", out);
    });
}

EspResult espPlaceAgain(EspContext* context, EspSurface like, const EspTransform* place, EspSurface* out) {
    return guarded(context, [&] {
        if (!place || !out) return fail(context, ESP_INVALID_ARGUMENT, "espPlaceAgain: null pointer");
        return standLike(*context, "espPlaceAgain: ", like.id, *place, out);
    });
}

EspResult espDestroySurface(EspContext* context, EspSurface surface) {
    return guarded(context, [&] {
        if (!context->knowsSurface(surface.id))
            return fail(context, ESP_INVALID_ARGUMENT, "espDestroySurface: no such surface");
        const uint32_t instance = instanceOf(surface.id);
        SurfaceChanges changes = withChange(*context, instance, SurfaceChange::ground);
        std::vector<uint32_t> gone;
        context->seeds.forEach([&](uint32_t id, const PlantedSeed& seed) {
            if (seed.surface == surface.id) gone.push_back(id);
        });
        for (uint32_t id : gone) removeSeed(*context, id);
        thawPlantsOn(*context, instance, false);
        std::erase_if(context->layers, [&](const PaintedLayer& layer) { return layer.surface == surface.id; });
        if (context->streaming) context->streaming->forget(surface.id);
        context->renderer->removeSurface(instance);
        context->surfaces.erase(surface.id);
        context->surfaceChanges = std::move(changes);
        context->nodes.surfaces.change();
        return ESP_OK;
    });
}

EspResult espMoveSurface(EspContext* context, EspSurface surface, const EspTransform* place) {
    return guarded(context, [&] {
        PlacedSurface* placed = context->surfaces.find(surface.id);
        if (!placed || !place) return fail(context, ESP_INVALID_ARGUMENT, "espMoveSurface: no such surface, or null");
        return move(*context, surface.id, *placed, *place);
    });
}

EspResult espHideSurface(EspContext* context, EspSurface surface, int hidden) {
    return guarded(context, [&] {
        PlacedSurface* placed = context->surfaces.find(surface.id);
        if (!placed) return fail(context, ESP_INVALID_ARGUMENT, "espHideSurface: no such surface");
        placed->hidden = hidden != 0;
        context->renderer->hideSurface(placed->instance, placed->hidden);
        return ESP_OK;
    });
}

EspResult espSurfaceInfo(const EspContext* context, EspSurface surface, EspSurfaceInfo* out) {
    return guarded(context, [&] {
        const PlacedSurface* placed = context->surfaces.find(surface.id);
        if (!placed) return fail(context, ESP_INVALID_ARGUMENT, "espSurfaceInfo: no such surface");
        give("espSurfaceInfo", out, placed->info);
        return ESP_OK;
    });
}

}  // extern "C"
