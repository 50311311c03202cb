// Freezing: a seed's plant leaves growth's inputs but for its records, and comes back.
#include <algorithm>
#include <cstring>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/seeds.hpp"
#include "runtime/plugin/surface_contacts.hpp"
#include "runtime/plugin/surface_point.hpp"

namespace espalier {
namespace {

// Whether the surfaces that a plant has grown on are still there and as large, and if they are several, where they
// were.
bool standsYet(const EspContext& context, const PlantRecords& plant) {
    const auto instanceOfNode = [](const Node& node) { return node.place >> 16; };
    const auto elsewhere = [&](const Node& node) { return instanceOfNode(node) != instanceOfNode(plant.nodes[0]); };
    const bool across = std::ranges::any_of(plant.nodes, elsewhere);
    std::vector<bool> there(context.grownSurfaces.size());
    context.surfaces.forEach([&](uint32_t id, const PlacedSurface& surface) {
        if (surface.instance >= there.size()) return;
        const auto& [grownOn, toWorld, placed] = context.grownSurfaces[surface.instance];
        const bool stands =
            across ? toWorld == surface.toWorld : sameScale(glm::length(glm::vec3(toWorld[0])), surface.scale);
        there[surface.instance] = grownOn == id && stands;
    });
    return std::ranges::all_of(plant.nodes, [&](const Node& node) {
        return instanceOfNode(node) < there.size() && there[instanceOfNode(node)];
    });
}

std::vector<uint32_t> instancesOf(const PlantRecords& plant) {
    std::vector<uint32_t> instances;
    for (const Node& node : plant.nodes)
        if (instances.empty() || instances.back() != node.place >> 16) instances.push_back(node.place >> 16);
    std::ranges::sort(instances);
    instances.erase(std::unique(instances.begin(), instances.end()), instances.end());
    return instances;
}

// The plant as last grown.
EspResult freeze(EspContext& context, PlantedSeed& seed, uint32_t id) {
    const auto at = std::ranges::find(context.grownSeeds, id);
    if (at == context.grownSeeds.end())
        return fail(&context, ESP_INVALID_ARGUMENT, "espFreezePlant: nothing has grown from the seed yet");
    const Plants* plants = nullptr;
    if (const EspResult failed = readPlants(context, plants)) return failed;
    auto plant = std::make_shared<PlantRecords>(plantOf(plants->records(), uint32_t(at - context.grownSeeds.begin())));
    if (!standsYet(context, *plant))
        return fail(
            &context, ESP_INVALID_ARGUMENT,
            "espFreezePlant: a surface that the plant has grown on is gone, scaled or moved against another since");
    seed.frozenOn = instancesOf(*plant);
    seed.frozen = std::move(plant);
    context.nodes.seeds.change();
    return ESP_OK;
}

void thaw(EspContext& context, PlantedSeed& seed) {
    seed.frozen = nullptr;
    context.nodes.seeds.change();
}

EspResult freezeAs(EspContext& context, PlantedSeed& seed, std::span<const std::byte> bytes) {
    Result<PlantRecords> plant = unpackPlant(bytes, context.surfaceSlots());
    if (!plant) return fail(&context, ESP_INVALID_CONTENT, plant.failure().text());
    std::vector<bool> there(context.surfaceSlots(), false);
    context.surfaces.forEach([&](uint32_t, const PlacedSurface& surface) { there[surface.instance] = true; });
    for (const Node& node : plant->nodes)
        if (!there[node.place >> 16])
            return fail(&context, ESP_INVALID_CONTENT, "espFreezeAs: a surface that the plant has grown on is missing");
    std::vector<uint32_t> instances = instancesOf(*plant);
    auto frozen = std::make_shared<PlantRecords>(std::move(*plant));
    context.changes.frozen.push_back(seedKey(seed));  // unlike a plant that is frozen as it stands
    seed.frozen = std::move(frozen);
    seed.frozenOn = std::move(instances);
    context.nodes.seeds.change();
    return ESP_OK;
}

}  // namespace

void thawPlantsOn(EspContext& context, uint32_t instance, bool across) {
    context.seeds.forEach([&](uint32_t, PlantedSeed& seed) {
        const auto on = [&](const Node& node) { return node.place >> 16 == instance; };
        if (!seed.frozen || std::ranges::none_of(seed.frozen->nodes, on)) return;
        if (!across || !std::ranges::all_of(seed.frozen->nodes, on)) seed.frozen = nullptr;
    });
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espFreezePlant(EspContext* context, EspSeed id, int frozen) {
    return guarded(context, [&] {
        PlantedSeed* seed = context->seeds.find(id.id);
        if (!seed) return fail(context, ESP_INVALID_ARGUMENT, "espFreezePlant: no such seed");
        if ((frozen != 0) == bool(seed->frozen)) return ESP_OK;
        if (frozen) return freeze(*context, *seed, id.id);
        thaw(*context, *seed);
        return ESP_OK;
    });
}

EspResult espReadFrozen(EspContext* context, EspSeed id, void* bytes, size_t* size) {
    return guarded(context, [&] {
        const PlantedSeed* seed = context->seeds.find(id.id);
        if (!seed || !seed->frozen || !size)
            return fail(context, ESP_INVALID_ARGUMENT, "espReadFrozen: no such seed, or not frozen, or null");
        const std::vector<std::byte> packed = packPlant(*seed->frozen);
        const size_t room = *size;
        *size = packed.size();
        if (!bytes) return ESP_OK;
        if (room < packed.size())
            return fail(context, ESP_INVALID_ARGUMENT,
                        "espReadFrozen: the plant has " + std::to_string(packed.size()) + " bytes");
        std::memcpy(bytes, packed.data(), packed.size());
        return ESP_OK;
    });
}

EspResult espFreezeAs(EspContext* context, EspSeed id, const void* bytes, size_t size) {
    return guarded(context, [&] {
        PlantedSeed* seed = context->seeds.find(id.id);
        if (!seed || !bytes) return fail(context, ESP_INVALID_ARGUMENT, "espFreezeAs: no such seed, or null");
        return freezeAs(*context, *seed, {static_cast<const std::byte*>(bytes), size});
    });
}

}  // extern "C"
