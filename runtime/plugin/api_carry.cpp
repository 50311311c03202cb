// What was painted over a surface, carried to a later bake of it.
#include <algorithm>
#include <cmath>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/layer_resample.hpp"
#include "runtime/surface/carry.hpp"

struct EspCarry {
    espalier::SurfaceMatch match;
};

using namespace espalier;

extern "C" {

EspResult espCreateCarry(const char* earlier, const char* later, EspCarry** out) {
    return guardedAlone([&] {
        if (!earlier || !later || !out) return failAlone(ESP_INVALID_ARGUMENT, "espCreateCarry: null pointer");
        *out = nullptr;
        for (const char* path : {earlier, later})
            if (std::string why = whyUnreadable(path); !why.empty()) return failAlone(ESP_IO_FAILED, why);
        Result<SurfaceData> from = readSurface(earlier);
        if (!from) return failAlone(ESP_INVALID_CONTENT, from.failure().text());
        Result<SurfaceData> to = readSurface(later);
        if (!to) return failAlone(ESP_INVALID_CONTENT, to.failure().text());
        *out = new EspCarry{SurfaceMatch(*from, *to)};
        return ESP_OK;
    });
}

uint32_t espCarrySide(const EspCarry* carry) {
    return carry ? carry->match.size() : 0;
}

EspResult espCarryLayer(const EspCarry* carry, const float* texels, uint32_t width, uint32_t height, float fresh,
                        float* out, EspCarried* carried) {
    return guardedAlone([&] {
        if (!carry || !texels || !out) return failAlone(ESP_INVALID_ARGUMENT, "espCarryLayer: null pointer");
        if (width < 1 || height < 1 || width > kMaxLayerSide || height > kMaxLayerSide)
            return failAlone(ESP_INVALID_ARGUMENT, "espCarryLayer: a layer has 1 to 8192 texels a side");
        if (!std::isfinite(fresh)) return failAlone(ESP_INVALID_ARGUMENT, "espCarryLayer: `fresh` isn't finite");
        std::vector<float> values(texels, texels + size_t(width) * height);
        std::ranges::transform(values, values.begin(), layerValue);
        const CarriedLayer layer = carry->match.carry({width, height, std::move(values)}, layerValue(fresh));
        std::ranges::copy(layer.layer.texels, out);
        if (carried) {
            EspCarried told{};
            told.fresh = layer.fresh;
            told.lost = layer.lost;
            give("espCarryLayer", carried, told);
        }
        return ESP_OK;
    });
}

void espDestroyCarry(EspCarry* carry) {
    delete carry;
}

}  // extern "C"
