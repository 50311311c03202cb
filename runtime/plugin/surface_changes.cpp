// Which plants grow anew after surfaces came, went or moved.
#include "runtime/plugin/surface_changes.hpp"

#include <algorithm>
#include <map>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/seeds.hpp"
#include "runtime/plugin/surface_contacts.hpp"
#include "runtime/plugin/surface_point.hpp"

namespace espalier {
namespace {

// What of the world a surface's plants may ask for, so that they grow otherwise after its change; kInput... bits.
uint32_t inputsChangedBy(SurfaceChange change) {
    switch (change) {
        case SurfaceChange::none:
            return 0;
        case SurfaceChange::shifted:
            return kInputPosition | kInputHeight;
        case SurfaceChange::turned:
            return kInputsOfWorld;
        case SurfaceChange::ground:
            break;
    }
    return ~0u;
}

}  // namespace

SurfaceChange changeOfMove(const glm::mat4& before, const glm::mat4& after) {
    if (scaleOf(before) != scaleOf(after) || isMirrored(before) != isMirrored(after)) return SurfaceChange::ground;
    return glm::mat3(before) == glm::mat3(after) ? SurfaceChange::shifted : SurfaceChange::turned;
}

SurfaceChanges withChange(const EspContext& context, uint32_t instance, SurfaceChange change) {
    SurfaceChanges changes = context.surfaceChanges;
    const size_t slots = std::max<size_t>(context.surfaceSlots(), instance + 1);
    changes.resize(std::max(changes.size(), slots));
    std::vector<bool> reached(slots);
    reached[instance] = true;
    addReached(context, reached);
    const bool alone = std::ranges::count(reached, true) == 1;
    for (size_t i = 0; i < reached.size(); ++i)
        if (reached[i]) changes[i] = std::max(changes[i], alone ? change : SurfaceChange::ground);
    return changes;
}

void noteSurfaceChanges(EspContext& context) {
    SurfaceChanges& changes = context.surfaceChanges;
    changes.resize(context.surfaceSlots());
    if (std::ranges::count(changes, SurfaceChange::none) == std::ptrdiff_t(changes.size())) return;
    std::vector<bool> other(changes.size());
    for (size_t i = 0; i < changes.size(); ++i) other[i] = changes[i] == SurfaceChange::ground;
    addReached(context, other);
    std::map<uint32_t, uint32_t> asked;  // by grammars, by their ids; variants have the same rules
    context.grammars.forEach([&](uint32_t id, const LoadedGrammar& grammar) { asked[id] = grammar.map.inputs(); });
    std::vector<uint64_t>& noted = context.changes.seeds;
    context.seeds.forEach([&](uint32_t, const PlantedSeed& seed) {
        const uint32_t instance = instanceOf(seed.surface);
        if (instance >= changes.size()) return;  // away
        if (other[instance] || (inputsChangedBy(changes[instance]) & asked.at(seed.grammar)) != 0)
            noted.push_back(seedKey(seed));
    });
    // They are noted again at each attempt until one succeeds.
    std::ranges::sort(noted);
    noted.erase(std::unique(noted.begin(), noted.end()), noted.end());
}

}  // namespace espalier
