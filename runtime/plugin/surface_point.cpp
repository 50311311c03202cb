// Rays and points in the world -> a place on a surface that a walk can start from.
// The mesh tells position and walk UV; the chart is the one whose texel lies under that UV, or next to it where the
// centre of that texel is outside of the triangle.
#include "runtime/plugin/surface_point.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"

namespace espalier {
namespace {

constexpr float kFirstRing = 1e-3f, kNextRing = 1.25f;  // of the surface's size, and of the ring before
constexpr int kAround = 16;

glm::vec3 transformed(const glm::mat4& m, glm::vec3 p) {
    return glm::vec3(m * glm::vec4(p, 1));
}

// Charts may be close in the atlas, so of the texels around the one that nearest in space to `position` decides.
uint32_t chartAt(const SurfaceData& data, glm::vec2 uv, glm::vec3 position) {
    const SurfaceLevelData& level = data.levels.front();
    const int size = int(level.size);
    const int cx = std::clamp(int(uv.x * size), 0, size - 1), cy = std::clamp(int(uv.y * size), 0, size - 1);
    uint32_t best = kNoIndex;
    float bestDistance = std::numeric_limits<float>::infinity();
    for (int reach = 1; reach <= 3 && best == kNoIndex; ++reach)
        for (int y = std::max(0, cy - reach); y <= std::min(size - 1, cy + reach); ++y)
            for (int x = std::max(0, cx - reach); x <= std::min(size - 1, cx + reach); ++x) {
                const Texel& texel = level.texels[texelIndex(level.size, x, y)];
                if (texelClass(texel.bits) == kTexelEmpty) continue;
                const glm::vec3 gap = texel.position - position;
                const float d = glm::dot(gap, gap);
                if (d < bestDistance) {
                    bestDistance = d;
                    best = texelChart(texel.bits);
                }
            }
    return best;
}

std::optional<SurfacePoint> pointOf(uint32_t id, const PlacedSurface& surface, const MeshHit& hit) {
    const SurfaceData& data = surface.content->data;
    const DrawVertex& a = data.vertices[data.indices[3 * hit.triangle]];
    const DrawVertex& b = data.vertices[data.indices[3 * hit.triangle + 1]];
    const DrawVertex& c = data.vertices[data.indices[3 * hit.triangle + 2]];
    SurfacePoint point;
    point.surface = id;
    point.uv = a.walkUv + hit.weights.x * (b.walkUv - a.walkUv) + hit.weights.y * (c.walkUv - a.walkUv);
    point.chart = chartAt(data, point.uv, hit.position);
    if (point.chart == kNoIndex) return std::nullopt;
    point.position = transformed(surface.toWorld, hit.position);
    const glm::vec3 normal = glm::cross(b.position - a.position, c.position - a.position);
    const glm::vec3 world = glm::mat3(surface.toWorld) * normal;
    const float length = glm::length(world);
    point.normal = length > 0 ? world / length : glm::vec3(0, 1, 0);
    point.bare = !data.bareTriangles.empty() && data.bareTriangles[hit.triangle] != 0;
    return point;
}

}  // namespace

std::optional<SurfacePoint> pickSurfaces(const EspContext& context, glm::vec3 origin, glm::vec3 direction, bool seen) {
    std::optional<SurfacePoint> best;
    float reach = std::numeric_limits<float>::infinity();
    context.surfaces.forEach([&](uint32_t id, const PlacedSurface& surface) {
        if (seen && surface.hidden) return;
        const auto hit = surface.content->tree.pick(transformed(surface.toObject, origin),
                                                    glm::mat3(surface.toObject) * direction, reach);
        if (!hit) return;
        if (auto point = pointOf(id, surface, *hit)) {
            best = point;
            best->distance = hit->distance * glm::length(direction);
            reach = hit->distance;
        }
    });
    return best;
}

std::optional<SurfacePoint> nearestOnSurfaces(const EspContext& context, glm::vec3 point) {
    std::optional<SurfacePoint> best;
    float reach = std::numeric_limits<float>::infinity();  // metres in the world
    context.surfaces.forEach([&](uint32_t id, const PlacedSurface& surface) {
        const auto hit = surface.content->tree.nearest(transformed(surface.toObject, point), reach / surface.scale);
        if (!hit) return;
        if (auto found = pointOf(id, surface, *hit)) {
            best = found;
            best->distance = hit->distance * surface.scale;
            reach = best->distance;
        }
    });
    return best;
}

std::optional<SurfacePoint> groundBeside(const EspContext& context, const SurfacePoint& bare) {
    const glm::vec3 n = bare.normal, least = glm::abs(n.x) < .7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::vec3 u = glm::normalize(glm::cross(n, least)), v = glm::cross(n, u);
    const EspSurfaceInfo& info = context.surfaces.find(bare.surface)->info;
    float size = 0;
    for (int i = 0; i < 3; ++i) size = std::max(size, info.boundsMax[i] - info.boundsMin[i]);
    for (float radius = kFirstRing * size; radius < size; radius *= kNextRing)
        for (int i = 0; i < kAround; ++i) {
            const float angle = 6.2831853f * float(i) / kAround;
            const glm::vec3 aside = u * (radius * std::cos(angle)) + v * (radius * std::sin(angle));
            const auto found = pickSurfaces(context, bare.position + aside + n * radius, -n);
            if (found && !found->bare && found->distance < 2 * radius && glm::dot(found->normal, n) > 0) return found;
        }
    return std::nullopt;
}

glm::vec3 unitOf(glm::vec3 v) {
    return glm::normalize(v / std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}));
}

const char* whyNoneNear(const EspContext& context) {
    return context.surfaces.size() ? "no surface is within reach of that place" : "there is no surface";
}

}  // namespace espalier

using namespace espalier;

namespace {

EspHit hitAt(const SurfacePoint& point) {
    EspHit hit{};
    hit.surface.id = point.surface;
    put(hit.position, point.position);
    put(hit.normal, point.normal);
    hit.uv[0] = point.uv.x;
    hit.uv[1] = point.uv.y;
    hit.chart = point.chart;
    hit.distance = point.distance;
    return hit;
}

}  // namespace

extern "C" {

EspResult espPick(const EspContext* context, const float origin[3], const float direction[3], EspHit* out) {
    return guarded(context, [&] {
        if (!isRay(origin, direction))
            return fail(context, ESP_INVALID_ARGUMENT, "espPick: null pointer, or a ray that isn't one");
        const auto point = pickSurfaces(*context, vec(origin), unitOf(vec(direction)), true);
        // Not logged: a ray that meets nothing is an answer.
        if (!point) return ESP_INVALID_ARGUMENT;
        give("espPick", out, hitAt(*point));
        return ESP_OK;
    });
}

EspResult espNearest(const EspContext* context, const float point[3], EspHit* out) {
    return guarded(context, [&] {
        if (!point || !finite(point))
            return fail(context, ESP_INVALID_ARGUMENT, "espNearest: null pointer, or a point that isn't finite");
        const auto found = nearestOnSurfaces(*context, vec(point));
        if (!found) return fail(context, ESP_INVALID_ARGUMENT, std::string("espNearest: ") + whyNoneNear(*context));
        give("espNearest", out, hitAt(*found));
        return ESP_OK;
    });
}

}  // extern "C"
