// Freezing: a seed's plant leaves growth's inputs but for its records, and comes back.
#include <algorithm>
#include <cstring>

#include "runtime/plugin/context.hpp"

namespace espalier {
namespace {

// The plant of a seed as last grown; null: it hasn't grown, or can't be read.
std::shared_ptr<const PlantRecords> grownPlant(EspContext& context, uint32_t seed) {
    const auto at = std::ranges::find(context.grownSeeds, seed);
    if (at == context.grownSeeds.end()) return nullptr;
    const Plants* plants = readPlants(context);
    if (!plants) return nullptr;
    return std::make_shared<PlantRecords>(plantOf(plants->records(), uint32_t(at - context.grownSeeds.begin())));
}

EspResult freeze(EspContext& context, PlantedSeed& seed, uint32_t id, bool frozen) {
    if (frozen == bool(seed.frozen)) return ESP_OK;
    std::shared_ptr<const PlantRecords> plant = frozen ? grownPlant(context, id) : nullptr;
    if (frozen && !plant && context.device->lost()) return ESP_DEVICE_LOST;
    if (frozen && !plant)
        return fail(&context, ESP_INVALID_ARGUMENT, "espFreezePlant: nothing has grown from the seed yet");
    seed.frozen = std::move(plant);
    ++context.revision;
    return ESP_OK;
}

EspResult freezeAs(EspContext& context, PlantedSeed& seed, std::span<const std::byte> bytes) {
    Result<PlantRecords> plant = unpackPlant(bytes, context.surfaceSlots());
    if (!plant) return fail(&context, ESP_INVALID_CONTENT, plant.failure().text());
    std::vector<bool> there(context.surfaceSlots(), false);
    context.surfaces.forEach([&](uint32_t, const PlacedSurface& surface) { there[surface.instance] = true; });
    for (const Node& node : plant->nodes)
        if (!there[node.place >> 16])
            return fail(&context, ESP_INVALID_CONTENT, "espFreezeAs: a surface that the plant has grown on is missing");
    seed.frozen = std::make_shared<PlantRecords>(std::move(*plant));
    context.changes.frozen.push_back(seedKey(seed));  // unlike a plant that is frozen as it stands
    ++context.revision;
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
        return freeze(*context, *seed, id.id, frozen != 0);
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
