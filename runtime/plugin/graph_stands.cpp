// In: wishes of a graph's shown nodes. Out: surfaces, grammars and seeds of the context that fulfil them.
#include "runtime/plugin/graph_stands.hpp"

#include <algorithm>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/given.hpp"
#include "shaders/shared/random.h"

namespace espalier {
namespace {

// The same graph plants the same, whatever stands beside it.
uint32_t seedNumber(const std::string& node, uint32_t seed, uint32_t point) {
    uint64_t key = seed;
    for (const char c : node) key = combineKeys(key, uint8_t(c));
    return uint32_t(mix64(combineKeys(key, point)));
}

// The surface that is nearest to a point; id 0: none is near enough.
EspSurface groundAt(const EspContext& context, glm::vec3 point, float reach) {
    if (context.surfaces.size() == 0) return {};
    float at[3];
    put(at, point);
    EspHit hit = {};
    hit.structSize = sizeof hit;
    return espNearest(&context, at, &hit) == ESP_OK && hit.distance <= reach ? hit.surface : EspSurface{};
}

// It may have gone with its ground or its grammar.
void removeSeed(EspContext& context, EspSeed& seed) {
    if (context.seeds.find(seed.id)) espRemoveSeed(&context, seed);
    seed = {};
}

struct Asked {
    GroundRef ground;
    PlantsRef plants;
};
Asked askedBy(const NodeValue& value) {
    if (const auto* ground = std::get_if<GroundRef>(&value)) return {*ground, nullptr};
    if (const auto* plants = std::get_if<PlantsRef>(&value)) return {(*plants)->ground, *plants};
    return {};
}

}  // namespace

bool GraphStands::stands(const EspContext& context, const GroundRef& ground) const {
    const auto known = grounds_.find(ground->key);
    return known != grounds_.end() && context.surfaces.find(known->second.surface.id);
}

bool GraphStands::due(const EspContext& context) const {
    return due_ || town_.due(context) || (!stands_.empty() && surfaces_ != context.nodes.surfaces.version());
}

void GraphStands::update(EspContext& context, const NodeEvaluation& graph) {
    waiting_.clear();
    troubles_.clear();
    town_.update(context, graph, troubles_);
    std::vector<GroundRef> wanted;
    std::map<std::string, Stand, std::less<>> before = std::exchange(stands_, {});
    for (const NodeEvaluation::Shown& shown : graph.shownValues()) {
        const Asked asked = shown.value ? askedBy(*shown.value) : Asked{};
        if (!asked.ground && !asked.plants) continue;
        const std::string& node = graph.graph().nodes[shown.node].name;
        Stand stand;
        if (const auto old = before.find(node); old != before.end()) {
            stand = std::move(old->second);
            before.erase(old);
        }
        if (asked.ground) {
            wanted.push_back(asked.ground);
            Ground& ground = grounds_[asked.ground->key];
            ground.wish = asked.ground;
            if (!context.surfaces.find(ground.surface.id)) ground.surface = {};  // a host may have destroyed it
            if (!ground.failure.empty()) troubles_.push_back({node, ground.failure});
        }
        if (!asked.ground || stands(context, asked.ground)) {
            stand.ground = asked.ground;
            const std::string why = asked.plants ? plant(context, node, asked.plants, stand) : std::string();
            if (!why.empty()) troubles_.push_back({node, why});
        } else if (!stand.ground) {
            waiting_.insert(waiting_.end(), asked.ground->shown.begin(), asked.ground->shown.end());
        }
        stands_.emplace(node, std::move(stand));
    }
    for (auto& [node, stand] : before) uproot(context, stand);
    surfaces_ = context.nodes.surfaces.version();  // plants of ground that goes now may find other ground
    due_ = false;
    dropUnused(context, wanted);
}

// "", or why they don't stand as wished.
std::string GraphStands::plant(EspContext& context, const std::string& node, const PlantsRef& wish, Stand& stand) {
    if (const std::string why = stand.grammar.bring(context, wish->rules); !why.empty()) return why;
    place(context, node, *wish, stand);
    stand.plants = wish;
    const size_t without = size_t(std::ranges::count(stand.seeds, 0u, &EspSeed::id));
    if (without == 0) return {};
    return "no ground is within " + numberText(wish->reach) + " m of " + std::to_string(without) + " of " +
           std::to_string(stand.seeds.size()) + " points";
}

// Point i keeps its seed, so that a plant whose point moves keeps its random numbers.
void GraphStands::place(EspContext& context, const std::string& node, const PlantsWish& wish, Stand& stand) {
    const bool replant = !stand.plants || stand.plants->seed != wish.seed;
    for (size_t i = replant ? 0 : wish.points.size(); i < stand.seeds.size(); ++i) removeSeed(context, stand.seeds[i]);
    stand.seeds.resize(wish.points.size());
    EspSeedDef def = {};
    def.structSize = sizeof def;
    espDefaultSeedDef(&def);
    def.grammar = stand.grammar.id();
    put(def.direction, wish.direction);
    for (uint32_t i = 0; i < wish.points.size(); ++i) {
        EspSeed& seed = stand.seeds[i];
        const EspSurface ground = groundAt(context, wish.points[i], wish.reach);
        const PlantedSeed* known = context.seeds.find(seed.id);
        put(def.position, wish.points[i]);
        if (!ground.id) {
            removeSeed(context, seed);
        } else if (!known) {
            def.number = seedNumber(node, wish.seed, i);
            seed = {};
            if (espPlant(&context, &def, &seed) == ESP_OK) context.seeds.find(seed.id)->ofGraph = true;
        } else if (known->givenPosition != wish.points[i] || known->givenDirection != wish.direction ||
                   known->surface != ground.id) {
            espMoveSeed(&context, seed, def.position, def.direction);
        }
    }
}

void GraphStands::uproot(EspContext& context, Stand& stand) {
    for (EspSeed& seed : stand.seeds) removeSeed(context, seed);
    stand.grammar.drop(context);
    stand.plants = nullptr;
    stand.seeds.clear();
}

// Ground that nobody asks for, and that nothing stands on any more.
void GraphStands::dropUnused(EspContext& context, const std::vector<GroundRef>& wanted) {
    const auto used = [&](uint64_t key) {
        return std::ranges::any_of(wanted, [&](const GroundRef& g) { return g->key == key; }) ||
               std::ranges::any_of(stands_,
                                   [&](const auto& s) { return s.second.ground && s.second.ground->key == key; });
    };
    for (auto ground = grounds_.begin(); ground != grounds_.end();) {
        if (used(ground->first)) {
            ++ground;
            continue;
        }
        if (context.surfaces.find(ground->second.surface.id)) espDestroySurface(&context, ground->second.surface);
        ground = grounds_.erase(ground);
    }
}

void GraphStands::removeAll(EspContext& context) {
    for (auto& [node, stand] : stands_) uproot(context, stand);
    stands_.clear();
    dropUnused(context, {});
    town_.removeAll(context);
    waiting_.clear();
}

void GraphStands::letGoOfMeshes() {
    const auto bare = [](const GroundRef& ground) -> GroundRef {
        if (!ground) return nullptr;
        auto copy = std::make_shared<GroundWish>(*ground);
        copy->shown.clear();
        return copy;
    };
    for (auto& [key, ground] : grounds_) ground.wish = bare(ground.wish);
    for (auto& [node, stand] : stands_) {
        stand.ground = bare(stand.ground);
        if (!stand.plants) continue;
        auto plants = std::make_shared<PlantsWish>(*stand.plants);
        plants->ground = stand.ground;
        stand.plants = plants;
    }
    waiting_.clear();
    due_ = true;
}

const GroundWish* GraphStands::wanted() const {
    for (const auto& [key, ground] : grounds_)
        if (!ground.surface.id && ground.failure.empty()) return ground.wish.get();
    return nullptr;
}

EspResult GraphStands::give(EspContext& context, uint64_t key, const std::string& file, const std::string& why) {
    const auto found = grounds_.find(key);
    if (found == grounds_.end()) return ESP_OK;  // nobody asks for it any more
    Ground& ground = found->second;
    due_ = true;
    if (file.empty()) {
        ground.failure = why;
        return ESP_OK;
    }
    EspSurface surface{};
    const EspResult loaded = espLoadSurface(&context, file.c_str(), nullptr, &surface);
    if (loaded == ESP_OK)
        ground.surface = surface;
    else
        ground.failure = context.error;
    return loaded;
}

}  // namespace espalier
