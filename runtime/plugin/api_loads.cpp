// Loading surfaces beside the frames.
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/surface_loads.hpp"

namespace espalier {

SurfaceLoads& loadsOf(EspContext& context) {
    if (!context.loads) context.loads = std::make_unique<SurfaceLoads>(context);
    return *context.loads;
}

void setDefaults(EspLoadingDef& def) {
    const SurfaceLoads::Limits limits;
    def.bytesPerUpdate = limits.bytesPerUpdate;
    def.bytesAhead = limits.bytesAhead;
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espBeginLoad(EspContext* context, const EspSurfaceDef* given, EspLoad* out) {
    return guarded(context, [&] {
        const EspSurfaceDef def = taken("espBeginLoad", given);
        if ((!def.name && !def.bytes) || !out) return fail(context, ESP_INVALID_ARGUMENT, "espBeginLoad: null pointer");
        SurfaceRequest request = requestOf(*context, "espBeginLoad: ", def);
        std::optional<std::vector<std::byte>> file;
        if (def.bytes || context->files.fromHost()) {
            file.emplace();
            if (EspResult unread = readFileOf(*context, request, *file)) return unread;
        }
        out->id = loadsOf(*context).begin(std::move(request), std::move(file));
        return ESP_OK;
    });
}

EspResult espLoadInfo(const EspContext* context, EspLoad load, EspLoadInfo* out) {
    return guarded(context, [&] {
        const SurfaceLoads::State* state = context->loads ? context->loads->find(load.id) : nullptr;
        if (!state) return fail(context, ESP_INVALID_ARGUMENT, "espLoadInfo: no such load");
        EspLoadInfo info{};
        info.state = state->state;
        info.surface = state->surface;
        info.result = state->result;
        info.message = state->message.c_str();
        info.bytes = state->bytes;
        give("espLoadInfo", out, info);
        return ESP_OK;
    });
}

EspResult espEndLoad(EspContext* context, EspLoad load) {
    return guarded(context, [&] {
        if (!context->loads || !context->loads->end(load.id))
            return fail(context, ESP_INVALID_ARGUMENT, "espEndLoad: no such load");
        return ESP_OK;
    });
}

EspResult espDefaultLoadingDef(EspLoadingDef* out) {
    return giveDefaults("espDefaultLoadingDef", out);
}

EspResult espSetLoading(EspContext* context, const EspLoadingDef* given) {
    return guarded(context, [&] {
        const EspLoadingDef def = taken("espSetLoading", given);
        loadsOf(*context).limit({def.bytesPerUpdate, def.bytesAhead});
        return ESP_OK;
    });
}

}  // extern "C"
