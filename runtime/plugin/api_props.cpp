// Furnishing: props and what lies on the ground.
#include <algorithm>
#include <cmath>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/furnishing.hpp"
#include "runtime/plugin/given.hpp"

namespace espalier {
namespace {

EspResult findPlaces(const EspContext& context, const TerminalData& models, const EspPropPlace* places, uint32_t count,
                     std::vector<PropPlace>& out) {
    for (uint32_t i = 0; i < count; ++i) {
        const EspPropPlace& place = places[i];
        const std::string name = place.model ? place.model : "";
        const auto found = std::find_if(models.variants.begin(), models.variants.end(),
                                        [&](const TerminalVariant& v) { return v.name == name; });
        if (found == models.variants.end())
            return fail(&context, ESP_INVALID_CONTENT, "espSetProps: there is no model '" + name + "'");
        const auto usable = [](float v) { return std::abs(v) <= 1e7f; };
        if (!std::ranges::all_of(place.position, usable) || !usable(place.turn) || !usable(place.scale) ||
            !(place.scale > 0))
            return fail(&context, ESP_INVALID_ARGUMENT,
                        "espSetProps: place " + std::to_string(i) + " of '" + name + "' is out of range");
        out.push_back({uint32_t(found - models.variants.begin()), vec(place.position), place.turn, place.scale});
    }
    return ESP_OK;
}

EspResult readModels(EspContext& context, const std::string& path, TerminalData& models) {
    std::vector<std::byte> file;
    if (EspResult unread = readWhole(&context, path, file)) return unread;
    // The first kind is none: it would be bark.
    Result<TerminalData> read = parseTerminals(file, path, {"none"});
    if (!read) return fail(&context, ESP_INVALID_CONTENT, read.failure().text());
    models = std::move(*read);
    // As the GPU sorts them.
    std::stable_sort(models.variants.begin(), models.variants.end(),
                     [](const TerminalVariant& a, const TerminalVariant& b) { return a.kind < b.kind; });
    return ESP_OK;
}

EspResult draw(EspContext& context, const Furnishing& props, TerminalData models) {
    Status set = context.renderer->setProps(std::move(models), props.places);
    if (set) return ESP_OK;
    if (set.failure().ofDevice()) return failGpu(&context, set.failure());
    return fail(&context, ESP_INVALID_CONTENT, props.models + ": " + set.failure().text());
}

EspResult setProps(EspContext& context, const char* path, const EspPropPlace* places, uint32_t count) {
    Furnishing props;
    if (path && count > 0) {
        TerminalData models;
        props.models = path;
        if (EspResult bad = readModels(context, path, models)) return bad;
        if (EspResult bad = findPlaces(context, models, places, count, props.places)) return bad;
        if (EspResult bad = draw(context, props, std::move(models))) return bad;
    } else if (Status cleared = context.renderer->removeProps(); !cleared) {
        return failGpu(&context, cleared.failure());
    }
    context.props = std::move(props);
    return ESP_OK;
}

EspResult setSite(EspContext& context, const EspSiteDef& def) {
    constexpr uint32_t kMostSide = 8192;
    SiteMap map;
    if (def.rgba) {
        if (def.width < 1 || def.height < 1 || def.width > kMostSide || def.height > kMostSide)
            return fail(&context, ESP_INVALID_ARGUMENT, "espSetSite: a map has 1 to 8192 texels a side");
        map.low = {def.low[0], def.low[1]};
        map.high = {def.high[0], def.high[1]};
        const glm::vec2 size = map.high - map.low;
        if (!(size.x > 1e-3f && size.y > 1e-3f && size.x < 1e6f && size.y < 1e6f))
            return fail(&context, ESP_INVALID_ARGUMENT, "espSetSite: 'high' must lie beyond 'low'");
        map.width = def.width;
        map.height = def.height;
        map.rgba.assign(def.rgba, def.rgba + size_t(def.width) * def.height * 4);
    }
    Status set = context.renderer->setSite(map);
    if (!set) return failGpu(&context, set.failure());
    context.site = std::move(map);
    return ESP_OK;
}

}  // namespace

EspResult furnishAgain(EspContext& context) {
    if (Status set = context.renderer->setSite(context.site); !set) return failGpu(&context, set.failure());
    if (context.props.places.empty()) return ESP_OK;
    TerminalData models;
    if (EspResult bad = readModels(context, context.props.models, models)) return bad;
    const auto missing = [&](const PropPlace& place) { return place.variant >= models.variants.size(); };
    if (std::ranges::any_of(context.props.places, missing))
        return fail(&context, ESP_INVALID_CONTENT, context.props.models + ": has fewer models than before");
    return draw(context, context.props, std::move(models));
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espSetProps(EspContext* context, const char* models, const EspPropPlace* places, uint32_t count) {
    return guarded(context, [&] {
        if (count > 0 && models && !places) return fail(context, ESP_INVALID_ARGUMENT, "espSetProps: null pointer");
        return setProps(*context, models, places, count);
    });
}

EspResult espSetSite(EspContext* context, const EspSiteDef* def) {
    return guarded(context, [&] { return setSite(*context, takenOr("espSetSite", def, EspSiteDef{})); });
}

}  // extern "C"
