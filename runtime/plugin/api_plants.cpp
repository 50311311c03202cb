// Plants that have grown: picking a branch, showing its way over the charts, cutting it away for good.
#include <algorithm>
#include <limits>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/seeds.hpp"
#include "runtime/plugin/surface_contacts.hpp"
#include "runtime/plugin/surface_point.hpp"

namespace espalier {

EspResult readPlants(EspContext& context, const Plants*& out) {
    const uint64_t revision = context.growth->view().revision;
    if (!context.plants || context.plantsRevision != revision) {
        Result<GrowthRecords> records = context.growth->read();
        if (!records) return failGpu(&context, records.failure());
        context.plants.emplace(std::move(*records), context.stands());
        context.plantsRevision = revision;
    }
    out = &*context.plants;
    return ESP_OK;
}

namespace {

static_assert(int(BranchEnd::byRules) == ESP_END_BY_RULES && int(BranchEnd::refused) == ESP_END_REFUSED &&
              int(BranchEnd::noGround) == ESP_END_NO_GROUND && int(BranchEnd::byLimit) == ESP_END_BY_LIMIT);

EspSeed seedOf(const EspContext& context, const Plants& plants, uint32_t branch) {
    const uint32_t seed = plants.seedOf(branch);
    return {seed < context.grownSeeds.size() ? context.grownSeeds[seed] : 0};
}

EspResult pickPlant(EspContext& context, glm::vec3 origin, glm::vec3 direction, EspPlantHit* out) {
    const Plants* plants = nullptr;
    if (const EspResult failed = readPlants(context, plants)) return failed;
    direction = unitOf(direction);
    // What a surface hides isn't picked; a stem lies on its surface, so a little behind it is not behind.
    const auto wall = pickSurfaces(context, origin, direction, true);
    const float slack = .05f;
    const auto hit =
        plants->pick(origin, direction, wall ? wall->distance + slack : std::numeric_limits<float>::infinity());
    // Not logged: a ray that meets nothing is an answer.
    if (!hit) return ESP_INVALID_ARGUMENT;
    EspPlantHit found{};
    found.seed = seedOf(context, *plants, hit->branch);
    found.branch = plants->keyOf(hit->branch);
    found.depth = plants->depthOf(hit->branch);
    found.distance = hit->distance;
    put(found.position, hit->position);
    give("espPickPlant", out, found);
    return ESP_OK;
}

EspResult branchInfo(EspContext& context, uint64_t branch, EspBranchInfo* out) {
    const Plants* plants = nullptr;
    if (const EspResult failed = readPlants(context, plants)) return failed;
    const auto index = plants->findBranch(branch);
    if (!index) return fail(&context, ESP_INVALID_ARGUMENT, "espBranchInfo: no such branch has grown");
    const uint32_t parent = plants->parentOf(*index).value_or(*index);
    EspBranchInfo info{};
    info.seed = seedOf(context, *plants, *index);
    info.parent = plants->keyOf(parent);
    info.depth = plants->depthOf(*index);
    info.end = EspBranchEnd(plants->endOf(*index));
    give("espBranchInfo", out, info);
    return ESP_OK;
}

EspResult branchPath(EspContext& context, uint64_t branch, EspPathSample* samples, uint32_t* count) {
    const Plants* plants = nullptr;
    if (const EspResult failed = readPlants(context, plants)) return failed;
    const auto index = plants->findBranch(branch);
    if (!index) return fail(&context, ESP_INVALID_ARGUMENT, "espBranchPath: no such branch has grown");
    const std::vector<uint32_t> nodes = plants->nodesOf(*index);
    const uint32_t room = samples ? *count : 0;
    *count = uint32_t(nodes.size());
    for (uint32_t i = 0; i < std::min(room, *count); ++i) {
        const Node& node = plants->node(nodes[i]);
        EspPathSample sample{};
        put(sample.position, plants->positionOf(nodes[i]));
        const glm::vec2 uv = unpackUv(node.uv);
        sample.uv[0] = uv.x;
        sample.uv[1] = uv.y;
        sample.chart = node.place & 0xFFFFu;
        sample.surface.id = context.surfaces.idAt(node.place >> 16);
        sample.inserted = (node.flags & kNodeInserted) != 0;
        samples[i] = sample;
    }
    return ESP_OK;
}

EspResult plantInfo(EspContext& context, uint32_t id, const PlantedSeed& seed, EspPlantInfo* out) {
    const Plants* plants = nullptr;
    if (const EspResult failed = readPlants(context, plants)) return failed;
    PlantExtent extent;
    const auto grown = std::ranges::find(context.grownSeeds, id);
    if (grown != context.grownSeeds.end())
        extent = plants->extentOf(uint32_t(grown - context.grownSeeds.begin()));
    else if (seed.onBare || isAway(context, seed) || buriedByOthers(context, seed))
        extent.end = BranchEnd::noGround;
    if (extent.nodes == 0) extent.low = extent.high = seed.position;
    EspPlantInfo info{};
    info.nodes = extent.nodes;
    info.end = EspBranchEnd(extent.end);
    put(info.boundsMin, extent.low);
    put(info.boundsMax, extent.high);
    give("espPlantInfo", out, info);
    return ESP_OK;
}

}  // namespace
}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espPickPlant(EspContext* context, const float origin[3], const float direction[3], EspPlantHit* out) {
    return guarded(context, [&] {
        if (!isRay(origin, direction))
            return fail(context, ESP_INVALID_ARGUMENT, "espPickPlant: null pointer, or a ray that isn't one");
        return pickPlant(*context, vec(origin), vec(direction), out);
    });
}

EspResult espBranchPath(EspContext* context, uint64_t branch, EspPathSample* samples, uint32_t* count) {
    return guarded(context, [&] {
        if (!count) return fail(context, ESP_INVALID_ARGUMENT, "espBranchPath: null pointer");
        return branchPath(*context, branch, samples, count);
    });
}

EspResult espBranchInfo(EspContext* context, uint64_t branch, EspBranchInfo* out) {
    return guarded(context, [&] { return branchInfo(*context, branch, out); });
}

EspResult espPlantInfo(EspContext* context, EspSeed seed, EspPlantInfo* out) {
    return guarded(context, [&] {
        const PlantedSeed* planted = context->seeds.find(seed.id);
        if (!planted) return fail(context, ESP_INVALID_ARGUMENT, "espPlantInfo: no such seed");
        return plantInfo(*context, seed.id, *planted, out);
    });
}

EspResult espPruneBranch(EspContext* context, uint64_t branch, int pruned) {
    return guarded(context, [&] {
        std::vector<uint64_t>& keys = context->pruned;
        const auto at = std::ranges::lower_bound(keys, branch);
        const bool known = at != keys.end() && *at == branch;
        if (known == (pruned != 0)) return ESP_OK;
        if (known) {
            keys.erase(at);
        } else {
            keys.insert(at, branch);
        }
        context->nodes.seeds.change();
        return ESP_OK;
    });
}

uint32_t espPrunedCount(const EspContext* context) {
    return context ? uint32_t(context->pruned.size()) : 0;
}

EspResult espPrunedAt(const EspContext* context, uint32_t index, uint64_t* branch) {
    return guarded(context, [&] {
        if (!branch || index >= context->pruned.size())
            return fail(context, ESP_INVALID_ARGUMENT, "espPrunedAt: null pointer, or beyond the last key");
        *branch = context->pruned[index];
        return ESP_OK;
    });
}

}  // extern "C"
