// Enters: how far the world's origin moves. Leaves: all that stands, at places seen from there, as it has grown.
#include <cmath>
#include <map>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"

namespace espalier {
namespace {

constexpr double kFarthestOrigin = 1e9;  // metres, as surfaces

// Fields in object space stay what they were; what was asked for in the world goes along.
void shiftFields(EspContext& context, const glm::dvec3& by) {
    for (auto& [key, asked] : context.patterns.asked)
        for (size_t i = 0; i < asked.elements.size(); ++i) {
            glm::vec3 position = vec(asked.elements[i].position);
            shift(position, asked.remainders[i], by);
            put(asked.elements[i].position, position);
        }
}
void keepFields(EspContext& context, uint32_t id, const glm::mat4& before, const glm::mat4& now) {
    const auto ground = context.patterns.ground.find(id);
    if (ground == context.patterns.ground.end()) return;
    for (auto& [name, made] : ground->second.made)
        if (made.toObject == before) made.toObject = now;
}

// What has grown, and what was found between surfaces, was made where these stood: unless they have moved since, that
// is where they stand now. before: by their ids.
void keepStands(EspContext& context, const std::map<uint32_t, glm::mat4>& before, const glm::dvec3& by) {
    const auto keep = [&](uint32_t id, glm::mat4& toWorld) {
        const auto stood = before.find(id);
        const bool stays = stood != before.end() && stood->second == toWorld;
        toWorld[3] = stays ? context.surfaces.find(id)->toWorld[3] : toWorld[3] - glm::vec4(glm::vec3(by), 0);
        return stays;
    };
    for (EspContext::GrownSurface& grown : context.grownSurfaces)
        grown.placed = keep(grown.id, grown.toWorld) ? context.surfaces.find(grown.id)->placed : nextVersion();
    for (SurfacePair& pair : context.pairs) {
        (void)keep(pair.a.id, pair.a.toWorld);
        (void)keep(pair.b.id, pair.b.toWorld);
        for (SurfacePair::Stand& other : pair.others) (void)keep(other.id, other.toWorld);
    }
}

EspResult shiftOrigin(EspContext& context, const glm::dvec3& by) {
    const auto refuse = [&](const char* what) {
        return fail(&context, ESP_INVALID_ARGUMENT,
                    std::string("espShiftOrigin: ") + what + " can't move yet; take it away before");
    };
    if (context.town) return refuse("a town");
    if (context.graphs.graphs.size() > 0) return refuse("a procedural graph");
    if (!context.props.places.empty() || !context.site.rgba.empty()) return refuse("furnishing");
    const bool patterned = !context.nodes.patterns.due();
    for (auto& [key, asked] : context.patterns.asked) asked.remainders.resize(asked.elements.size());
    if (EspResult bad = shiftPatterns(context, by)) return bad;
    context.origin += by;
    std::map<uint32_t, glm::mat4> before;
    context.surfaces.forEach([&](uint32_t id, PlacedSurface& surface) {
        before[id] = surface.toWorld;
        const glm::mat4 toObject = surface.toObject;
        settle(context, surface);
        keepFields(context, id, toObject, surface.toObject);
    });
    context.seeds.forEach([&](uint32_t, PlantedSeed& seed) {
        shift(seed.position, seed.remainder, by);
        shift(seed.givenPosition, seed.givenRemainder, by);
    });
    context.strokes.forEach([&](uint32_t, PaintStroke& stroke) {
        for (DabRecord& dab : stroke.dabs) dab.position = glm::vec3(glm::dvec3(dab.position) - by);
    });
    shiftFields(context, by);
    keepStands(context, before, by);
    if (context.streaming) context.streaming->shift(by);
    context.plants.reset();
    context.parts = {};
    context.dropTriangles();
    context.renderer->unprepare();
    context.nodes.origin.change();
    if (patterned) keepPatterns(context);
    return ESP_OK;
}

}  // namespace
}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espShiftOrigin(EspContext* context, const double by[3]) {
    return guarded(context, [&] {
        if (!by) return fail(context, ESP_INVALID_ARGUMENT, "espShiftOrigin: null pointer");
        const glm::dvec3 moved(by[0], by[1], by[2]);
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(context->origin[k] + moved[k]) <= kFarthestOrigin))
                return fail(context, ESP_INVALID_ARGUMENT,
                            "espShiftOrigin: the origin goes at most 1e9 m from where it was at first");
        return shiftOrigin(*context, moved);
    });
}

}  // extern "C"
