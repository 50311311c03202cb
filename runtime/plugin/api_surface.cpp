// Loading, placing and describing surfaces; the tables of surfaces and layers that kernels read.
#include <cmath>

#include "runtime/core/undo.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/painting.hpp"
#include "runtime/plugin/seeds.hpp"
#include "runtime/plugin/surface_contacts.hpp"
#include "runtime/plugin/surface_point.hpp"

namespace espalier {
namespace {

glm::mat4 matrixOf(const EspTransform& place) {
    glm::mat4 m(1);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) m[column][row] = place.rows[row][column];
    return m;
}

// 1e-6 to 1e6, measured.
constexpr float kLeastScale = 0.99e-6f, kMostScale = 1.01e6f;
constexpr float kMostMove = 1e9f;  // metres: where squares of distances are far from what a float holds

// A move, a turn and an even scale, or nothing.
std::optional<float> evenScale(const glm::mat4& m) {
    const glm::vec3 x(m[0]), y(m[1]), z(m[2]);
    const float scale = glm::length(x);
    const float limit = 1e-3f * scale;
    const glm::vec3 moved = glm::abs(glm::vec3(m[3]));
    const bool near = moved.x <= kMostMove && moved.y <= kMostMove && moved.z <= kMostMove;
    if (!near || !(scale >= kLeastScale) || !(scale <= kMostScale)) return std::nullopt;
    if (!(std::abs(glm::length(y) - scale) < limit) || !(std::abs(glm::length(z) - scale) < limit)) return std::nullopt;
    const float skew = std::max({std::abs(glm::dot(x, y)), std::abs(glm::dot(x, z)), std::abs(glm::dot(y, z))});
    if (!(skew < limit * scale)) return std::nullopt;
    if (glm::dot(glm::cross(x, y), z) < 0) return std::nullopt;
    return scale;
}

EspSurfaceInfo describe(const SurfaceData& data, const glm::mat4& toWorld, uint32_t triangles, uint32_t levels) {
    EspSurfaceInfo info{};
    glm::vec3 low(std::numeric_limits<float>::infinity()), high(-low);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 p(corner & 1 ? data.boundsMax.x : data.boundsMin.x,
                          corner & 2 ? data.boundsMax.y : data.boundsMin.y,
                          corner & 4 ? data.boundsMax.z : data.boundsMin.z);
        const glm::vec3 world(toWorld * glm::vec4(p, 1));
        low = glm::min(low, world);
        high = glm::max(high, world);
    }
    put(info.boundsMin, low);
    put(info.boundsMax, high);
    info.triangles = triangles;
    info.charts = uint32_t(data.charts.size());
    info.levels = levels;
    info.resolution = data.levels.front().size;
    const double scale = glm::length(glm::vec3(toWorld[0]));
    for (const Chart& chart : data.charts) info.walkableArea += chart.area * scale * scale;
    info.hash = data.hash;
    for (int k = 0; k < 3; ++k) info.origin[k] = data.origin[k];
    return info;
}

// What is on the GPU and won't be asked for again.
void dropUploaded(SurfaceData& data) {
    data.images = {};
    data.materials = {};
    data.ranges = {};
    data.coarser = {};
    data.crossings = {};
    data.triangles = {};
    data.levels.resize(1);
    data.levels[0].aux = {};
    data.levels[0].crossingHead = {};
    data.levels[0].crossingRefs = {};
}

// For picking and planting: only triangles that can be walked. The bake leaves the others at walk UV (0, 0).
void prepareSearch(PlacedSurface& surface) {
    SurfaceData& data = surface.data;
    std::vector<uint32_t> walkable;
    std::vector<uint8_t> bare;
    walkable.reserve(data.indices.size());
    for (size_t i = 0; i + 2 < data.indices.size(); i += 3) {
        const auto uv = [&](size_t k) { return data.vertices[data.indices[i + k]].walkUv; };
        if (uv(0) == uv(1) && uv(1) == uv(2)) continue;
        walkable.insert(walkable.end(), data.indices.begin() + std::ptrdiff_t(i),
                        data.indices.begin() + std::ptrdiff_t(i) + 3);
        if (!data.bareTriangles.empty()) bare.push_back(data.bareTriangles[i / 3]);
    }
    data.indices = std::move(walkable);
    data.bareTriangles = std::move(bare);
    std::vector<glm::vec3> positions;
    positions.reserve(data.vertices.size());
    for (const DrawVertex& vertex : data.vertices) positions.push_back(vertex.position);
    surface.tree = MeshTree(positions, data.indices);
}

EspResult load(EspContext& context, const EspSurfaceDef& def, const std::string& call, EspSurface* out) {
    const EspTransform place = def.place ? *def.place : espIdentity();
    const glm::mat4 toWorld = matrixOf(place);
    const std::optional<float> scale = evenScale(toWorld);
    if (!scale)
        return fail(&context, ESP_INVALID_ARGUMENT,
                    call + "the transform must move (by up to 1e9 m), turn and scale evenly, without mirroring");
    if (context.surfaces.size() >= SurfaceTable::kMaxPlaces)
        return fail(&context, ESP_INVALID_ARGUMENT,
                    call + "there are " + std::to_string(SurfaceTable::kMaxPlaces) + " surfaces already");
    std::vector<std::byte> file;
    if (def.bytes) {
        const auto* first = static_cast<const std::byte*>(def.bytes);
        file.assign(first, first + def.size);
    } else if (EspResult unread = readWhole(&context, def.name, file)) {
        return unread;
    }
    Result<SurfaceData> data = parseSurface(std::move(file), def.name ? def.name : "a surface from memory");
    if (!data) return failContent(&context, data.failure());

    PlacedSurface surface;
    surface.place = place;
    surface.toWorld = toWorld;
    surface.toObject = glm::inverse(toWorld);
    surface.scale = *scale;
    surface.data = std::move(*data);
    surface.info = describe(surface.data, toWorld, uint32_t(surface.data.indices.size() / 3),
                            uint32_t(surface.data.levels.size()));
    Result<GpuSurface> gpu = GpuSurface::create(*context.device, surface.data);
    if (!gpu) return failGpu(&context, gpu.failure());
    surface.gpu = std::move(*gpu);

    const uint32_t id = context.surfaces.insert(std::move(surface));
    if (!id) return fail(&context, ESP_OUT_OF_MEMORY, call + "no ids left");
    PlacedSurface& placed = *context.surfaces.find(id);
    placed.instance = instanceOf(id);
    Undo placing([&] {
        context.renderer->removeSurface(instanceOf(id));
        context.surfaces.erase(id);
    });
    Status drawn = context.renderer->setSurface(placed.instance, placed.data, toWorld, def.groundOnly != 0);
    if (!drawn) return failGpu(&context, drawn.failure());
    dropUploaded(placed.data);
    prepareSearch(placed);
    placing.done();
    placed.placed = context.nodes.surfaces.change();
    out->id = id;
    return ESP_OK;
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
        return fail(
            &context, ESP_INVALID_ARGUMENT,
            "espMoveSurface: the transform must move (by up to 1e9 m), turn and scale evenly, without mirroring");
    if (toWorld == surface.toWorld) return ESP_OK;
    // All that asks for memory comes first. What it touches from now on is known when contacts have been found anew.
    SurfaceChanges changes = withChange(context, surface.instance, changeOfMove(surface.toWorld, toWorld));
    // A frozen plant stands in its surface's own space, but for its thickness.
    thawPlantsOn(context, surface.instance, sameScale(*scale, surface.scale));
    const glm::mat4 shift = toWorld * surface.toObject;
    surface.place = place;
    surface.toWorld = toWorld;
    surface.toObject = glm::inverse(toWorld);
    surface.scale = *scale;
    surface.info = describe(surface.data, toWorld, surface.info.triangles, surface.info.levels);
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
                ref.size = surface.data.levels.front().size;
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

EspResult espDestroySurface(EspContext* context, EspSurface surface) {
    return guarded(context, [&] {
        PlacedSurface* placed = context->surfaces.find(surface.id);
        if (!placed) return fail(context, ESP_INVALID_ARGUMENT, "espDestroySurface: no such surface");
        SurfaceChanges changes = withChange(*context, placed->instance, SurfaceChange::ground);
        std::vector<uint32_t> gone;
        context->seeds.forEach([&](uint32_t id, const PlantedSeed& seed) {
            if (seed.surface == surface.id) gone.push_back(id);
        });
        for (uint32_t id : gone) removeSeed(*context, id);
        thawPlantsOn(*context, placed->instance, false);
        std::erase_if(context->layers, [&](const PaintedLayer& layer) { return layer.surface == surface.id; });
        context->renderer->removeSurface(placed->instance);
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

EspResult espSurfaceInfo(const EspContext* context, EspSurface surface, EspSurfaceInfo* out) {
    return guarded(context, [&] {
        const PlacedSurface* placed = context->surfaces.find(surface.id);
        if (!placed) return fail(context, ESP_INVALID_ARGUMENT, "espSurfaceInfo: no such surface");
        give("espSurfaceInfo", out, placed->info);
        return ESP_OK;
    });
}

}  // extern "C"
