// A surface's charts and links as its walks read them (Buron 2015 §4), read back from the GPU for those who look
// inside.
#include <algorithm>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"

namespace espalier {
namespace {

EspResult readAtlas(EspContext& context, uint32_t id, uint32_t level, uint32_t* out, uint32_t* size) {
    const PlacedSurface* surface = context.surfaces.find(id);
    if (!surface || level >= surface->info.levels)
        return fail(&context, ESP_INVALID_ARGUMENT, "espReadAtlas: no such surface or level");
    const uint32_t side = surface->gpu.ref().levels[level].size, room = *size;
    *size = side;
    if (!out || room == 0) return ESP_OK;
    if (room < side)
        return fail(&context, ESP_INVALID_ARGUMENT,
                    "espReadAtlas: the level has " + std::to_string(side) + " texels a side, there is room for " +
                        std::to_string(room));
    Result<std::vector<Texel>> texels = surface->gpu.readTexels(*context.device, level);
    if (!texels) return failGpu(&context, texels.failure());
    const std::vector<Chart>& charts = surface->content->data.charts;
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            const uint32_t bits = (*texels)[texelIndex(side, x, y)].bits, chart = texelChart(bits);
            const bool lost = chart < charts.size() && charts[chart].coarsestLevel < level;
            out[size_t(y) * side + x] = (bits & 0x3FFFFu) | (lost ? 1u << 18 : 0u);
        }
    return ESP_OK;
}

EspResult readLinks(EspContext& context, uint32_t id, EspLink* out, uint32_t* count) {
    const PlacedSurface* surface = context.surfaces.find(id);
    if (!surface) return fail(&context, ESP_INVALID_ARGUMENT, "espReadLinks: no such surface");
    const uint32_t room = out ? *count : 0;
    *count = surface->gpu.ref().crossingCount;
    if (room == 0 || *count == 0) return ESP_OK;
    Result<std::vector<Crossing>> crossings = surface->gpu.readCrossings(*context.device, std::min(room, *count));
    if (!crossings) return failGpu(&context, crossings.failure());
    const auto set = [](float to[2], glm::vec2 uv) { to[0] = uv.x, to[1] = uv.y; };
    for (const Crossing& crossing : *crossings) {
        EspLink& link = *out++ = EspLink{};
        set(link.a, crossing.a);
        set(link.b, crossing.b);
        set(link.toA, crossing.ta);
        set(link.toB, crossing.tb);
        link.chart = crossing.flags >> 16;
        link.toChart = crossing.target & 0xFFFFu;
        static_assert(kCrossingSeam == ESP_LINK_SEAM && kCrossingNearest == ESP_LINK_NEAREST &&
                      kCrossingContact == ESP_LINK_CONTACT && kCrossingOpen == ESP_LINK_OPEN);
        link.kind = EspLinkKind(crossing.flags & 3u);
        const uint32_t instance = crossing.target >> 16;
        link.toSurface.id = instance == 0xFFFFu ? id : context.surfaces.idAt(instance);
    }
    return ESP_OK;
}

}  // namespace
}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espReadAtlas(EspContext* context, EspSurface surface, uint32_t level, uint32_t* texels, uint32_t* size) {
    return guarded(context, [&] {
        if (!size) return fail(context, ESP_INVALID_ARGUMENT, "espReadAtlas: null pointer");
        return readAtlas(*context, surface.id, level, texels, size);
    });
}

EspResult espReadLinks(EspContext* context, EspSurface surface, EspLink* links, uint32_t* count) {
    return guarded(context, [&] {
        if (!count) return fail(context, ESP_INVALID_ARGUMENT, "espReadLinks: null pointer");
        return readLinks(*context, surface.id, links, count);
    });
}

}  // extern "C"
