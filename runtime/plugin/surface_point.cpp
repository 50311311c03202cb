// Rays and points in the world -> a place on a surface that a walk can start from.
// The mesh tells position and walk UV; the chart is the one whose texel lies under that UV, or next to it where the
// centre of that texel is outside of the triangle.
#include <cmath>

#include "runtime/plugin/context.hpp"

namespace espalier {
namespace {

constexpr float kOnEdge = 1e-3f;  // of a triangle's height

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

// A hit on its triangle's edge, a quarter of a texel further inside: what begins on the edge of bare ground might as
// well begin on that.
MeshHit offEdge(const SurfaceData& data, MeshHit hit) {
    const glm::vec2 w = hit.weights;
    if (w.x > kOnEdge && w.y > kOnEdge && w.x + w.y < 1 - kOnEdge) return hit;
    const auto at = [&](uint32_t k) -> const DrawVertex& { return data.vertices[data.indices[3 * hit.triangle + k]]; };
    const glm::vec2 inward = glm::vec2(1.f / 3) - w;
    const glm::vec2 uv = inward.x * (at(1).walkUv - at(0).walkUv) + inward.y * (at(2).walkUv - at(0).walkUv);
    const float step = .25f / (float(data.levels.front().size) * std::max(glm::length(uv), 1e-20f));
    const glm::vec2 moved = inward * std::min(step, .5f);
    hit.weights += moved;
    hit.position += moved.x * (at(1).position - at(0).position) + moved.y * (at(2).position - at(0).position);
    return hit;
}

std::optional<SurfacePoint> pointOf(uint32_t id, const PlacedSurface& surface, const MeshHit& hit) {
    const SurfaceData& data = surface.data;
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
    return point;
}

}  // namespace

std::optional<SurfacePoint> pickSurfaces(const EspContext& context, glm::vec3 origin, glm::vec3 direction) {
    std::optional<SurfacePoint> best;
    float reach = std::numeric_limits<float>::infinity();
    context.surfaces.forEach([&](uint32_t id, const PlacedSurface& surface) {
        const auto hit =
            surface.tree.pick(transformed(surface.toObject, origin), glm::mat3(surface.toObject) * direction, reach);
        if (!hit) return;
        if (auto point = pointOf(id, surface, *hit)) {
            best = point;
            best->distance = hit->distance * glm::length(direction);
            reach = hit->distance;
        }
    });
    return best;
}

std::optional<SurfacePoint> nearestOnSurfaces(const EspContext& context, glm::vec3 point, bool ground) {
    std::optional<SurfacePoint> best;
    float reach = std::numeric_limits<float>::infinity();  // metres in the world
    context.surfaces.forEach([&](uint32_t id, const PlacedSurface& surface) {
        const std::span<const uint8_t> except = ground ? surface.data.bareTriangles : std::span<const uint8_t>{};
        auto hit = surface.tree.nearest(transformed(surface.toObject, point), reach / surface.scale, 0, except);
        if (!hit) return;
        if (!except.empty()) hit = offEdge(surface.data, *hit);
        if (auto found = pointOf(id, surface, *hit)) {
            best = found;
            best->distance = hit->distance * surface.scale;
            reach = best->distance;
        }
    });
    return best;
}

}  // namespace espalier

using namespace espalier;

namespace {

bool finite(const float v[3]) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

void fill(const SurfacePoint& point, EspHit* out) {
    out->surface.id = point.surface;
    for (int i = 0; i < 3; ++i) {
        out->position[i] = point.position[i];
        out->normal[i] = point.normal[i];
    }
    out->uv[0] = point.uv.x;
    out->uv[1] = point.uv.y;
    out->chart = point.chart;
    out->distance = point.distance;
}

}  // namespace

extern "C" {

EspResult espPick(const EspContext* context, const float origin[3], const float direction[3], EspHit* out) {
    return guarded(context, [&] {
        if (!origin || !direction || !out || !finite(origin) || !finite(direction) ||
            (direction[0] == 0 && direction[1] == 0 && direction[2] == 0))
            return fail(context, ESP_INVALID_ARGUMENT, "espPick: null pointer, or a ray that isn't one");
        const auto point =
            pickSurfaces(*context, {origin[0], origin[1], origin[2]}, {direction[0], direction[1], direction[2]});
        // Not logged: a ray that meets nothing is an answer.
        if (!point) return ESP_INVALID_ARGUMENT;
        fill(*point, out);
        return ESP_OK;
    });
}

EspResult espNearest(const EspContext* context, const float point[3], EspHit* out) {
    return guarded(context, [&] {
        if (!point || !out || !finite(point))
            return fail(context, ESP_INVALID_ARGUMENT, "espNearest: null pointer, or a point that isn't finite");
        const auto found = nearestOnSurfaces(*context, {point[0], point[1], point[2]}, false);
        if (!found) return fail(context, ESP_INVALID_ARGUMENT, "espNearest: there is no surface");
        fill(*found, out);
        return ESP_OK;
    });
}

}  // extern "C"
