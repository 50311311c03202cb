// Worlds that are larger than memory.
#include <cmath>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"

namespace espalier {
namespace {

void makeStreaming(EspContext& context) {
    (void)loadsOf(context);
    if (context.streaming) return;
    EspStreamingDef def{};
    setDefaults(def);
    context.streaming = std::make_unique<Streaming>(context);
    context.streaming->set(def);
}

EspResult addStreamed(EspContext& context, const EspStreamedDef& def, EspSurface* out) {
    const EspSurfaceDef surface = taken("espAddStreamed", def.surface);
    if (!surface.name || surface.bytes)
        return fail(&context, ESP_INVALID_ARGUMENT, "espAddStreamed: the surface needs a name, and no bytes");
    const glm::vec3 low = vec(def.boundsMin), high = vec(def.boundsMax);
    if (!finite(def.boundsMin) || !finite(def.boundsMax) || glm::any(glm::greaterThan(low, high)) || low == high)
        return fail(&context, ESP_INVALID_ARGUMENT, "espAddStreamed: boundsMin and boundsMax aren't a box");
    makeStreaming(context);
    return context.streaming->add(requestOf(context, "espAddStreamed: ", surface), low, high, out);
}

}  // namespace

void setDefaults(EspStreamingDef& def) {
    def.loadsAtOnce = 3;
    def.leastSize = 0.02f;
    def.deviceBytes = 1ull << 30;
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espAddStreamed(EspContext* context, const EspStreamedDef* given, EspSurface* out) {
    return guarded(context, [&] {
        if (!out) return fail(context, ESP_INVALID_ARGUMENT, "espAddStreamed: null pointer");
        return addStreamed(*context, taken("espAddStreamed", given), out);
    });
}

EspResult espDefaultStreamingDef(EspStreamingDef* out) {
    return giveDefaults("espDefaultStreamingDef", out);
}

EspResult espSetStreaming(EspContext* context, const EspStreamingDef* given) {
    return guarded(context, [&] {
        const EspStreamingDef def = taken("espSetStreaming", given);
        if (!finite(def.eye) || !std::isfinite(def.leastSize) || def.leastSize < 0 || def.loadsAtOnce < 1)
            return fail(context, ESP_INVALID_ARGUMENT, "espSetStreaming: a value is out of its range");
        makeStreaming(*context);
        context->streaming->set(def);
        return ESP_OK;
    });
}

EspResult espStreamedInfo(const EspContext* context, EspSurface surface, EspStreamedInfo* out) {
    return guarded(context, [&] {
        if (!context->streaming || !context->streaming->knows(surface.id))
            return fail(context, ESP_INVALID_ARGUMENT, "espStreamedInfo: no such streamed surface");
        give("espStreamedInfo", out, context->streaming->infoOf(surface.id));
        return ESP_OK;
    });
}

EspResult espStreamingInfo(const EspContext* context, EspStreamingInfo* out) {
    return guarded(context, [&] {
        give("espStreamingInfo", out, context->streaming ? context->streaming->info() : EspStreamingInfo{});
        return ESP_OK;
    });
}

}  // extern "C"
