#pragma once

// Points of the surfaces, in the world.

#include <cmath>
#include <glm/glm.hpp>
#include <optional>

#include "runtime/plugin/context.hpp"

namespace espalier {

// The number by which nodes and kernels know the surface of this id.
inline uint32_t instanceOf(uint32_t surfaceId) {
    return SurfaceTable::placeOf(surfaceId);
}

// Of two places of a surface: a turn's columns are rounded.
inline bool sameScale(float a, float b) {
    return std::abs(a - b) <= 1e-5f * b;
}

// The id of the surface and the walk's place for a point of its mesh.
struct SurfacePoint {
    uint32_t surface = 0;  // id
    uint32_t chart = 0;
    glm::vec2 uv{0};
    glm::vec3 position{0}, normal{0};  // world; the triangle's own normal
    float distance = 0;                // metres, from the ray's origin or the point that was asked for
    bool bare = false;                 // nothing grows there
};
// v: of any length but 0, though its square be more, or less, than a float holds.
glm::vec3 unitOf(glm::vec3 v);
// What the ray meets first; nothing: no surface. direction: unit.
// seen: only those that aren't hidden.
std::optional<SurfacePoint> pickSurfaces(const EspContext& context, glm::vec3 origin, glm::vec3 direction,
                                         bool seen = false);
// Bare or not; nothing: no surface has any.
std::optional<SurfacePoint> nearestOnSurfaces(const EspContext& context, glm::vec3 point);
const char* whyNoneNear(const EspContext& context);  // for messages, where there is no nearest
// About the nearest ground around a place on bare ground that is seen by who looks straight at it: not what lies behind
// a pane.
std::optional<SurfacePoint> groundBeside(const EspContext& context, const SurfacePoint& bare);

}  // namespace espalier
