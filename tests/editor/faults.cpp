// Functions in place of the plugin's own, for all that this program holds: they fail where a test wants it.
#include "tests/editor/faults.hpp"

#include <dlfcn.h>

#include "plugin_api/espalier.h"

int callsUntilFailure = 0;

namespace {

bool fails() {
    return callsUntilFailure > 0 && --callsUntilFailure == 0;
}

template <class Function>
Function* plugins(const char* name, Function*) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

EspResult espReadLayer(EspContext* context, EspSurface surface, const char* layer, float* texels, uint32_t* size) {
    static auto* real = plugins("espReadLayer", &espReadLayer);
    return fails() ? ESP_OUT_OF_MEMORY : real(context, surface, layer, texels, size);
}

EspResult espBeginStroke(EspContext* context, const EspBrush* brush, EspStroke* out) {
    static auto* real = plugins("espBeginStroke", &espBeginStroke);
    return fails() ? ESP_OUT_OF_MEMORY : real(context, brush, out);
}

EspResult espEndStroke(EspContext* context, EspStroke stroke) {
    static auto* real = plugins("espEndStroke", &espEndStroke);
    const EspResult ended = real(context, stroke);  // one that fails has ended, too
    return fails() ? ESP_OUT_OF_MEMORY : ended;
}

EspResult espFillLayer(EspContext* context, const char* layer, float value, EspStroke* out) {
    static auto* real = plugins("espFillLayer", &espFillLayer);
    return fails() ? ESP_OUT_OF_MEMORY : real(context, layer, value, out);
}

EspResult espImportLayer(EspContext* context, const EspLayerDef* def, EspStroke* out) {
    static auto* real = plugins("espImportLayer", &espImportLayer);
    return fails() ? ESP_OUT_OF_MEMORY : real(context, def, out);
}

}  // extern "C"
