// Enters: a surface's file. Leaves: what its upload, its walks and its picture need; then a surface of the context.
#include "runtime/plugin/surface_read.hpp"

#include <cmath>

#include "runtime/core/let_go.hpp"
#include "runtime/core/undo.hpp"
#include "runtime/gpu/color_texture.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/surface_point.hpp"

namespace espalier {
namespace {

// 1e-6 to 1e6, measured.
constexpr float kLeastScale = 0.99e-6f, kMostScale = 1.01e6f;
constexpr float kMostMove = 1e9f;  // metres: where squares of distances are far from what a float holds

// What is on the GPU and won't be asked for again.
void dropUploaded(SurfaceData& data) {
    letGo(data.images, data.materials, data.ranges, data.coarser, data.crossings, data.triangles);
    data.levels.resize(1);
    letGo(data.levels[0].aux, data.levels[0].crossingHead, data.levels[0].crossingRefs);
}

// For picking and planting: only triangles that can be walked. The bake leaves the others at walk UV (0, 0).
void prepareSearch(SurfaceContent& content) {
    SurfaceData& data = content.data;
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
    content.tree = MeshTree(positions, data.indices);
}

// Where a request asks for it.
PlacedSurface placedAs(const SurfaceRequest& request, std::shared_ptr<SurfaceContent> content) {
    PlacedSurface surface;
    surface.from = request;
    surface.stand = request.stand;
    surface.place = request.place;
    surface.toWorld = matrixOf(request.place);
    surface.toObject = glm::inverse(surface.toWorld);
    surface.scale = evenScale(surface.toWorld).value_or(1.0f);
    surface.info = describe(*content, surface.toWorld);
    surface.content = std::move(content);
    return surface;
}

SurfaceRequest checked(const EspContext& context, const std::string& call, SurfaceRequest request) {
    if (context.surfaces.size() >= SurfaceTable::kMaxPlaces)
        throw Refusal{call + "there are " + std::to_string(SurfaceTable::kMaxPlaces) + " surfaces already"};
    if (!evenScale(matrixOf(request.place)))
        throw Refusal{call + "the transform must move (by up to 1e9 m), turn and scale evenly; it may mirror"};
    request.stand = standOf(context, request.place);
    return request;
}

// The surface of a reserved id is all there is of it; puts it into the context.
void put(EspContext& context, uint32_t id, PlacedSurface placed) {
    context.surfaces.put(id, std::move(placed));
    PlacedSurface& surface = *context.surfaces.find(id);
    settle(context, surface);  // the origin may have moved while it was on its way
    surface.placed = context.nodes.surfaces.change();
}

}  // namespace

glm::dvec3 standOf(const EspContext& context, const EspTransform& place) {
    return context.origin + glm::dvec3(place.rows[0][3], place.rows[1][3], place.rows[2][3]);
}

EspTransform placeAt(const EspContext& context, EspTransform place, const glm::dvec3& stand) {
    for (int k = 0; k < 3; ++k) place.rows[k][3] = float(stand[k] - context.origin[k]);
    return place;
}

void settle(EspContext& context, PlacedSurface& surface) {
    surface.place = placeAt(context, surface.place, surface.stand);
    const glm::mat4 toWorld = matrixOf(surface.place);
    if (toWorld == surface.toWorld) return;
    surface.toWorld = toWorld;
    surface.toObject = glm::inverse(toWorld);
    surface.info = describe(*surface.content, toWorld);
    surface.placed = nextVersion();
    context.renderer->placeSurface(surface.instance, toWorld);
}

glm::mat4 matrixOf(const EspTransform& place) {
    glm::mat4 m(1);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) m[column][row] = place.rows[row][column];
    return m;
}

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
    return scale;
}

EspSurfaceInfo describe(const SurfaceContent& content, const glm::mat4& toWorld) {
    const SurfaceData& data = content.data;
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
    info.triangles = content.triangles;
    info.charts = uint32_t(data.charts.size());
    info.levels = content.levels;
    info.resolution = data.levels.front().size;
    const double scale = glm::length(glm::vec3(toWorld[0]));
    for (const Chart& chart : data.charts) info.walkableArea += chart.area * scale * scale;
    info.hash = data.hash;
    for (int k = 0; k < 3; ++k) info.origin[k] = data.origin[k];
    return info;
}

SurfaceRequest requestOf(const EspContext& context, const std::string& call, const EspSurfaceDef& def) {
    SurfaceRequest request{def.name ? def.name : "a surface from memory", def.place ? *def.place : espIdentity(),
                           def.groundOnly != 0, nullptr, glm::dvec3(0)};
    if (def.bytes) {
        const auto* first = static_cast<const std::byte*>(def.bytes);
        request.bytes = std::make_shared<const std::vector<std::byte>>(first, first + def.size);
    }
    return checked(context, call, std::move(request));
}

EspResult readFileOf(const EspContext& context, const SurfaceRequest& request, std::vector<std::byte>& file) {
    if (!request.bytes) return readWhole(&context, request.name, file);
    file = *request.bytes;
    return ESP_OK;
}

Result<SurfaceRead> readSurface(std::vector<std::byte> file, const SurfaceRequest& request, bool roots) {
    Result<SurfaceData> data = parseSurface(std::move(file), request.name);
    if (!data) return data.failure();
    SurfaceRead read;
    read.groundOnly = request.groundOnly;
    auto content = std::make_shared<SurfaceContent>();
    content->data = std::move(*data);
    content->triangles = uint32_t(content->data.indices.size() / 3);
    content->levels = uint32_t(content->data.levels.size());
    read.ground = GpuSurface::plan(content->data, read.upload);
    read.drawn = Models::plan(content->data, matrixOf(request.place), request.groundOnly, roots, read.upload);
    dropUploaded(content->data);
    prepareSearch(*content);
    read.surface = placedAs(request, std::move(content));
    return read;
}

void standAs(EspContext& context, uint32_t id, SurfaceRead read) {
    read.surface.gpu = GpuSurface(read.ground, read.upload);
    read.surface.instance = instanceOf(id);
    context.renderer->setSurface(read.surface.instance, std::move(read.drawn), read.upload);
    put(context, id, std::move(read.surface));
}

void standLike(EspContext& context, uint32_t id, const PlacedSurface& like, SurfaceRequest request) {
    PlacedSurface surface = placedAs(request, like.content);
    surface.gpu = like.gpu.another();
    surface.instance = instanceOf(id);
    context.renderer->setSurfaceLike(surface.instance, like.instance, surface.toWorld);
    put(context, id, std::move(surface));
}

EspResult standLike(EspContext& context, const std::string& call, uint32_t like, const EspTransform& place,
                    EspSurface* out) {
    const PlacedSurface* placed = context.surfaces.find(like);
    if (!placed) return fail(&context, ESP_INVALID_ARGUMENT, call + "no such surface");
    SurfaceRequest request = placed->from;
    request.place = place;
    request = checked(context, call, std::move(request));
    const uint32_t id = context.surfaces.reserve();
    if (!id) return fail(&context, ESP_OUT_OF_MEMORY, call + "no numbers for surfaces are left");
    Undo reserving([&] { context.surfaces.release(id); });
    standLike(context, id, *context.surfaces.find(like), std::move(request));
    reserving.done();
    out->id = id;
    return ESP_OK;
}

EspResult standAgain(EspContext& context, uint32_t id) {
    PlacedSurface& surface = *context.surfaces.find(id);
    if (surface.gpu) return ESP_OK;  // as another place of what has been read already
    SurfaceRequest request = surface.from;
    request.place = surface.place;
    std::vector<std::byte> file;
    if (EspResult unread = readFileOf(context, request, file)) return unread;
    Result<SurfaceRead> read = readSurface(std::move(file), request, holdsRoots(*context.device));
    if (!read) return failContent(&context, read.failure());
    if (read->surface.content->data.hash != surface.content->data.hash)
        return fail(&context, ESP_INVALID_CONTENT, request.name + ": isn't the file any more that was loaded");
    if (Status uploaded = read->upload.run(*context.device); !uploaded) return failGpu(&context, uploaded.failure());
    const GpuSurface gpu(read->ground, read->upload);
    context.renderer->setSurface(surface.instance, std::move(read->drawn), read->upload);
    const std::shared_ptr<SurfaceContent> before = surface.content, now = read->surface.content;
    // What may run out of memory comes first, so that all places change or none.
    context.surfaces.forEach([&](uint32_t, const PlacedSurface& place) {
        if (place.content != before) return;
        if (&place != &surface) context.renderer->setSurfaceLike(place.instance, surface.instance, place.toWorld);
        context.renderer->hideSurface(place.instance, place.hidden);
    });
    context.surfaces.forEach([&](uint32_t, PlacedSurface& place) {
        if (place.content != before) return;
        place.content = now;
        place.gpu = gpu.another();
        place.contacts = {};
        place.buried = {};
        place.placed = context.nodes.surfaces.change();
    });
    return ESP_OK;
}

EspResult standSurface(EspContext& context, const std::string& call, SurfaceRead read, EspSurface* out) {
    const uint32_t id = context.surfaces.reserve();
    if (!id) return fail(&context, ESP_OUT_OF_MEMORY, call + "no numbers for surfaces are left");
    Undo reserving([&] { context.surfaces.release(id); });
    standAs(context, id, std::move(read));
    reserving.done();
    out->id = id;
    return ESP_OK;
}

}  // namespace espalier
