// Which plants grow anew after surfaces came, went or moved.
#include "runtime/plugin/surface_changes.hpp"

#include <algorithm>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/seeds.hpp"
#include "runtime/plugin/surface_contacts.hpp"
#include "runtime/plugin/surface_point.hpp"

namespace espalier {

SurfaceChanges withChange(const EspContext& context, uint32_t instance, SurfaceChange change) {
    SurfaceChanges changes = context.surfaceChanges;
    changes.resize(std::max<size_t>(changes.size(), context.surfaceSlots()));
    std::vector<bool> reached(context.surfaceSlots());
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
    std::vector<uint64_t>& noted = context.changes.seeds;
    context.seeds.forEach([&](uint32_t, const PlantedSeed& seed) {
        if (other[instanceOf(seed.surface)]) noted.push_back(seedKey(seed));
    });
    // They are noted again at each attempt until one succeeds.
    std::ranges::sort(noted);
    noted.erase(std::ranges::unique(noted).begin(), noted.end());
}

}  // namespace espalier
