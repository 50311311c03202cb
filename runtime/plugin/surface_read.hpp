#pragma once

// Surfaces on their way from a file into a context, in steps: what needs no device can be done on any thread.

#include <optional>
#include <string>
#include <vector>

#include "runtime/gpu/upload.hpp"
#include "runtime/plugin/contents.hpp"
#include "runtime/render/models.hpp"

struct EspContext;

namespace espalier {

// Taken from a host; what can't be used is refused.
SurfaceRequest requestOf(const EspContext& context, const std::string& call, const EspSurfaceDef& def);

// The bytes of the request's file, or its own.
EspResult readFileOf(const EspContext& context, const SurfaceRequest& request, std::vector<std::byte>& file);

// Read, and ready to be uploaded.
struct SurfaceRead {
    PlacedSurface surface;
    bool groundOnly = false;
    Upload upload;
    GpuSurface::Plan ground;
    Models::Plan drawn;
};
// Any thread. roots: holdsRoots() of the device that it is for.
Result<SurfaceRead> readSurface(std::vector<std::byte> file, const SurfaceRequest& request, bool roots);

// Puts a surface into the context whose upload has been submitted. call: begins messages.
EspResult standSurface(EspContext& context, const std::string& call, SurfaceRead read, EspSurface* out);

// Likewise under an id that is reserved.
void standAs(EspContext& context, uint32_t id, SurfaceRead read);

// Places a standing surface once more: the new one shares all that was read and uploaded. Fails where the place
// can't be used, with messages that begin with `call`.
EspResult standLike(EspContext& context, const std::string& call, uint32_t like, const EspTransform& place,
                    EspSurface* out);
// Likewise under an id that is reserved.
void standLike(EspContext& context, uint32_t id, const PlacedSurface& like, SurfaceRequest request);

// Reads and uploads a surface of the context once more, after all that was on the device has gone; its other places
// share that again.
EspResult standAgain(EspContext& context, uint32_t id);

// Where a host's place puts what stands there, seen from the world's first origin.
glm::dvec3 standOf(const EspContext& context, const EspTransform& place);
// The place of what stands there, as the world's origin is now.
EspTransform placeAt(const EspContext& context, EspTransform place, const glm::dvec3& stand);
// Puts a surface of the context where it stands, after the origin was another: nothing is found anew, and what has
// grown on it goes along.
void settle(EspContext& context, PlacedSurface& surface);

glm::mat4 matrixOf(const EspTransform& place);
// The scale of a move, a turn and an even scale, mirrored perhaps, or nothing.
std::optional<float> evenScale(const glm::mat4& toWorld);
EspSurfaceInfo describe(const SurfaceContent& content, const glm::mat4& toWorld);

}  // namespace espalier
