// Seeds: places with a direction that plants grow from, what a seed has of its own, and the branches of its plant that
// are cut away.
#include <algorithm>
#include <cmath>

#include "runtime/core/undo.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/seeds.hpp"
#include "runtime/plugin/surface_point.hpp"
#include "shaders/shared/random.h"

namespace espalier {
namespace {

constexpr uint32_t kMaxSeeds = 1u << 20;

// The unit tangent nearest to `wanted` on a plane; any where there is none.
glm::vec3 laidInto(glm::vec3 wanted, glm::vec3 normal) {
    const auto tangent = [&](glm::vec3 v) { return v - normal * glm::dot(v, normal); };
    const float length = glm::length(wanted);
    glm::vec3 best = length > 0 ? tangent(wanted / length) : glm::vec3(0);
    if (!(glm::length(best) > 1e-3f)) best = tangent({0, 1, 0});
    if (!(glm::length(best) > 1e-3f)) best = tangent({1, 0, 0});
    if (!(glm::length(best) > 1e-3f)) best = tangent({0, 0, 1});
    return glm::normalize(best);
}

// Puts a seed on the surface nearest to a point, from bare ground to the ground beside it. False: there is no surface.
bool place(const EspContext& context, glm::vec3 position, glm::vec3 direction, PlantedSeed& seed) {
    auto point = nearestOnSurfaces(context, position);
    if (!point) return false;
    if (point->bare)
        if (auto beside = groundBeside(context, *point)) point = beside;
    const PlacedSurface& surface = *context.surfaces.find(point->surface);
    seed.surface = point->surface;
    seed.walk.place = (surface.instance << 16) | point->chart;
    seed.walk.uv = point->uv;
    seed.onBare = point->bare;
    seed.givenPosition = position;
    seed.givenDirection = direction;
    seed.position = point->position;
    seed.normal = point->normal;
    seed.direction = laidInto(direction, point->normal);
    seed.walk.direction = glm::normalize(glm::mat3(surface.toObject) * seed.direction);
    return true;
}

EspResult plant(EspContext& context, const EspSeedDef& def, EspSeed* out) {
    const LoadedGrammar* grammar = context.grammars.find(def.grammar.id);
    if (!grammar) return fail(&context, ESP_INVALID_ARGUMENT, "espPlant: no such grammar");
    if (grammar->map.roofs())
        return fail(&context, ESP_INVALID_ARGUMENT, grammar->name + ": makes roofs and can't be planted");
    if (!finite(def.position) || !finite(def.direction))
        return fail(&context, ESP_INVALID_ARGUMENT, "espPlant: position or direction not finite");
    if (context.seeds.size() >= kMaxSeeds)
        return fail(&context, ESP_INVALID_ARGUMENT, "espPlant: there are 1048576 seeds already");
    if (def.symbol && *def.symbol) {
        const auto symbol = grammar->map.findSymbol(def.symbol);
        if (!symbol || !grammar->map.symbols()[*symbol].grows)
            return fail(&context, ESP_INVALID_ARGUMENT,
                        grammar->name + ": no rule grows from '" + std::string(def.symbol) + "'");
    }
    if (def.twin > TwinTable::kMaxTwin)
        return fail(&context, ESP_INVALID_ARGUMENT, "espPlant: a twin is at most 1048576");
    PlantedSeed seed;
    seed.grammar = def.grammar.id;
    seed.symbol = def.symbol ? def.symbol : "";
    if (!place(context, vec(def.position), vec(def.direction), seed))
        return fail(&context, ESP_INVALID_ARGUMENT, std::string("espPlant: ") + whyNoneNear(context));
    if (!context.twins.take(def.number, def.twin, seed.twin))
        return fail(&context, ESP_INVALID_ARGUMENT,
                    "espPlant: twin " + std::to_string(def.twin) + " of number " + std::to_string(def.number) +
                        " is planted already");
    seed.number = def.number;
    Undo taking([&, twin = seed.twin] { context.twins.release(def.number, twin); });
    const uint32_t id = context.seeds.insert(std::move(seed));
    if (!id) return fail(&context, ESP_OUT_OF_MEMORY, "espPlant: no ids left");
    taking.done();
    context.nodes.seeds.change();
    out->id = id;
    return ESP_OK;
}

uint64_t keyOf(uint32_t number, uint32_t twin) {
    return combineKeys(mix64(number), twin - 1);
}

PlantedSeed* find(const EspContext* context, EspSeed seed) {
    return const_cast<EspContext*>(context)->seeds.find(seed.id);
}

EspResult setNumber(EspContext& context, PlantedSeed& seed, uint32_t number, uint32_t twin) {
    if (number == seed.number && (twin == 0 || twin == seed.twin)) return ESP_OK;
    if (twin > TwinTable::kMaxTwin)
        return fail(&context, ESP_INVALID_ARGUMENT, "espSetSeedNumber: a twin is at most 1048576");
    uint32_t taken = 0;
    if (!context.twins.take(number, twin, taken))
        return fail(&context, ESP_INVALID_ARGUMENT,
                    "espSetSeedNumber: twin " + std::to_string(twin) + " of number " + std::to_string(number) +
                        " is planted already");
    Undo taking([&] { context.twins.release(number, taken); });
    context.changes.frozen.push_back(keyOf(number, taken));  // what has grown under this number isn't its plant
    taking.done();
    context.twins.release(seed.number, seed.twin);
    seed.number = number;
    seed.twin = taken;
    context.nodes.seeds.change();
    return ESP_OK;
}

EspResult setParam(EspContext& context, PlantedSeed& seed, const char* name, const float* value, uint32_t count) {
    const auto known = std::ranges::find(seed.params, name, &SeedParam::name);
    if (count == 0) {
        if (known == seed.params.end()) return ESP_OK;
        seed.params.erase(known);
        context.nodes.seeds.change();
        return ESP_OK;
    }
    const RuleMap& map = context.grammars.find(seed.grammar)->map;
    const auto index = map.findParam(name);
    if (!index)
        return fail(&context, ESP_INVALID_ARGUMENT,
                    std::string("espSetSeedParam: the seed's grammar has no parameter '") + name + "'");
    if (const uint32_t takes = numbersOf(map.params()[*index]); count != takes)
        return fail(&context, ESP_INVALID_ARGUMENT,
                    std::string("espSetSeedParam: '") + name + "' takes " + std::to_string(takes) +
                        (takes == 1 ? " number" : " numbers"));
    SeedParam param{name, {}, count};
    for (uint32_t i = 0; i < count; ++i) {
        if (!std::isfinite(value[i]))
            return fail(&context, ESP_INVALID_ARGUMENT, std::string("espSetSeedParam: ") + name + ": not a number");
        param.value[i] = value[i];
    }
    if (known != seed.params.end()) {
        if (*known == param) return ESP_OK;
        *known = param;
    } else {
        // In order of names, so that the same settings make the same list.
        seed.params.insert(std::ranges::lower_bound(seed.params, param.name, {}, &SeedParam::name), param);
    }
    context.nodes.seeds.change();
    return ESP_OK;
}

}  // namespace

void setDefaults(EspSeedDef& def) {
    def.number = 1;
}

uint64_t seedKey(const PlantedSeed& seed) {
    return keyOf(seed.number, seed.twin);
}

bool TwinTable::take(uint32_t number, uint32_t wanted, uint32_t& twin) {
    if (wanted > kMaxTwin) return false;
    Uses& uses = numbers_[number];
    if (wanted == 0) {
        while (uses.firstFree < uses.taken.size() && uses.taken[uses.firstFree]) ++uses.firstFree;
        wanted = uses.firstFree + 1;
        if (wanted > kMaxTwin) return false;
    }
    if (wanted > uses.taken.size()) uses.taken.resize(wanted);
    if (uses.taken[wanted - 1]) return false;
    uses.taken[wanted - 1] = true;
    twin = wanted;
    return true;
}

void TwinTable::release(uint32_t number, uint32_t twin) {
    Uses& uses = numbers_[number];
    uses.taken[twin - 1] = false;
    uses.firstFree = std::min(uses.firstFree, twin - 1);
    while (!uses.taken.empty() && !uses.taken.back()) uses.taken.pop_back();
    if (uses.taken.empty()) numbers_.erase(number);
}

bool isAway(const EspContext& context, const PlantedSeed& seed) {
    const auto away = [&](uint32_t instance) { return context.surfaces.idAt(instance) == 0; };
    return !context.surfaces.find(seed.surface) || (seed.frozen && std::ranges::any_of(seed.frozenOn, away));
}

void removeSeed(EspContext& context, uint32_t id) {
    const PlantedSeed* seed = context.seeds.find(id);
    context.twins.release(seed->number, seed->twin);
    context.seeds.erase(id);
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espDefaultSeedDef(EspSeedDef* out) {
    return giveDefaults("espDefaultSeedDef", out);
}

EspResult espPlant(EspContext* context, const EspSeedDef* def, EspSeed* out) {
    return guarded(context, [&] {
        if (!out) return fail(context, ESP_INVALID_ARGUMENT, "espPlant: null pointer");
        return plant(*context, taken("espPlant", def), out);
    });
}

EspResult espRemoveSeed(EspContext* context, EspSeed seed) {
    return guarded(context, [&] {
        if (!find(context, seed)) return fail(context, ESP_INVALID_ARGUMENT, "espRemoveSeed: no such seed");
        removeSeed(*context, seed.id);
        context->nodes.seeds.change();
        return ESP_OK;
    });
}

EspResult espRemoveAllSeeds(EspContext* context) {
    return guarded(context, [&] {
        std::vector<uint32_t> all;
        context->seeds.forEach([&](uint32_t id, const PlantedSeed& seed) {
            if (!seed.ofGraph) all.push_back(id);
        });
        if (all.empty()) return ESP_OK;
        for (uint32_t id : all) removeSeed(*context, id);
        context->nodes.seeds.change();
        return ESP_OK;
    });
}

uint32_t espSeedCount(const EspContext* context) {
    return context ? context->seeds.size() : 0;
}

EspResult espSeedAt(const EspContext* context, uint32_t index, EspSeed* out) {
    return guarded(context, [&] {
        if (!out || index >= context->seeds.size())
            return fail(context, ESP_INVALID_ARGUMENT, "espSeedAt: null pointer, or beyond the last seed");
        out->id = context->seeds.nth(index);
        return ESP_OK;
    });
}

EspResult espSeedInfo(const EspContext* context, EspSeed id, EspSeedInfo* out) {
    return guarded(context, [&] {
        const PlantedSeed* seed = find(context, id);
        if (!seed) return fail(context, ESP_INVALID_ARGUMENT, "espSeedInfo: no such seed");
        EspSeedInfo info{};
        info.surface.id = seed->surface;
        put(info.position, seed->position);
        put(info.normal, seed->normal);
        put(info.direction, seed->direction);
        info.frozen = seed->frozen ? 1 : 0;
        info.ofGraph = seed->ofGraph ? 1 : 0;
        info.hidden = seed->hidden ? 1 : 0;
        give("espSeedInfo", out, info);
        return ESP_OK;
    });
}

EspResult espHideSeed(EspContext* context, EspSeed id, int hidden) {
    return guarded(context, [&] {
        PlantedSeed* seed = find(context, id);
        if (!seed) return fail(context, ESP_INVALID_ARGUMENT, "espHideSeed: no such seed");
        if (seed->hidden == (hidden != 0)) return ESP_OK;
        seed->hidden = hidden != 0;
        context->nodes.seeds.change();
        return ESP_OK;
    });
}

EspResult espSeedDef(const EspContext* context, EspSeed id, EspSeedDef* out) {
    return guarded(context, [&] {
        const PlantedSeed* seed = find(context, id);
        if (!seed) return fail(context, ESP_INVALID_ARGUMENT, "espSeedDef: no such seed");
        EspSeedDef def{};
        def.grammar.id = seed->grammar;
        def.symbol = seed->symbol.c_str();
        put(def.position, seed->givenPosition);
        put(def.direction, seed->givenDirection);
        def.number = seed->number;
        def.twin = seed->twin;
        give("espSeedDef", out, def);
        return ESP_OK;
    });
}

EspResult espMoveSeed(EspContext* context, EspSeed id, const float position[3], const float direction[3]) {
    return guarded(context, [&] {
        PlantedSeed* seed = find(context, id);
        if (!seed || !position || !direction || !finite(position) || !finite(direction))
            return fail(context, ESP_INVALID_ARGUMENT, "espMoveSeed: no such seed, or a place that isn't one");
        if (!place(*context, vec(position), vec(direction), *seed))
            return fail(context, ESP_INVALID_ARGUMENT, std::string("espMoveSeed: ") + whyNoneNear(*context));
        context->nodes.seeds.change();
        return ESP_OK;
    });
}

EspResult espSetSeedNumber(EspContext* context, EspSeed id, uint32_t number, uint32_t twin) {
    return guarded(context, [&] {
        PlantedSeed* seed = find(context, id);
        if (!seed) return fail(context, ESP_INVALID_ARGUMENT, "espSetSeedNumber: no such seed");
        return setNumber(*context, *seed, number, twin);
    });
}

EspResult espSetSeedParam(EspContext* context, EspSeed id, const char* name, const float* value, uint32_t count) {
    return guarded(context, [&] {
        PlantedSeed* seed = find(context, id);
        if (!seed || !name || (!value && count) || count > 3)
            return fail(context, ESP_INVALID_ARGUMENT,
                        "espSetSeedParam: no such seed, or null, or more than 3 numbers");
        return setParam(*context, *seed, name, value, count);
    });
}

EspResult espSeedParam(const EspContext* context, EspSeed id, const char* name, float value[3], uint32_t* count) {
    return guarded(context, [&] {
        const PlantedSeed* seed = find(context, id);
        if (!seed || !name || !value || !count)
            return fail(context, ESP_INVALID_ARGUMENT, "espSeedParam: no such seed, or null");
        *count = 0;
        const auto known = std::ranges::find(seed->params, name, &SeedParam::name);
        if (known == seed->params.end()) return ESP_OK;
        *count = known->count;
        std::copy_n(known->value.begin(), known->count, value);
        return ESP_OK;
    });
}

}  // extern "C"
