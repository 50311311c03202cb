// Placed surfaces -> crossings between those that touch, and the ground that they bury of each other. A pair is looked
// at again only when one of the two, or a third that reaches between them, has moved.
#include "runtime/plugin/surface_contacts.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <numeric>
#include <unordered_map>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/surface_point.hpp"

namespace espalier {
namespace {

using Stand = SurfacePair::Stand;

Box boxOf(const PlacedSurface& surface) {
    Box box;
    const auto& [low, high] = std::tie(surface.info.boundsMin, surface.info.boundsMax);
    box.add(vec(low));
    box.add(vec(high));
    return box;
}

// What a search between surfaces needs of one, made when it is first needed.
Status prepare(EspContext& context, PlacedSurface& surface) {
    if (surface.content->ground) return Done{};
    if (Status read = surface.gpu.readBack(*context.device, surface.content->data); !read) return read;
    surface.content->ground = std::make_unique<ContactGround>(surface.content->data);
    return Done{};
}

bool same(const std::vector<Crossing>& a, const std::vector<Crossing>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Crossing)) == 0);
}

// [surface]: those whose boxes meet its box, ascending. Surfaces are gone through from left to right, so that only
// those are compared that lie side by side.
std::vector<std::vector<size_t>> neighboursOf(const std::vector<Box>& boxes) {
    std::vector<size_t> order(boxes.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::ranges::sort(order, {}, [&](size_t i) { return boxes[i].low.x; });
    std::vector<std::vector<size_t>> neighbours(boxes.size());
    for (size_t a = 0; a < order.size(); ++a)
        for (size_t b = a + 1; b < order.size() && boxes[order[b]].low.x <= boxes[order[a]].high.x; ++b) {
            const size_t i = order[a], j = order[b];
            if (!boxes[i].touches(boxes[j])) continue;
            neighbours[i].push_back(j);
            neighbours[j].push_back(i);
        }
    for (std::vector<size_t>& some : neighbours) std::ranges::sort(some);
    return neighbours;
}

// The pairs whose boxes meet, each with the further surfaces that reach to where they do.
std::vector<SurfacePair> pairsOf(const std::vector<Stand>& stands, const std::vector<Box>& boxes) {
    const std::vector<std::vector<size_t>> neighbours = neighboursOf(boxes);
    std::vector<SurfacePair> pairs;
    for (size_t i = 0; i < stands.size(); ++i)
        for (size_t j : neighbours[i]) {
            if (j < i) continue;
            const Box shared{glm::max(boxes[i].low, boxes[j].low), glm::min(boxes[i].high, boxes[j].high)};
            SurfacePair pair{stands[i], stands[j], {}, {}, {}, {}};
            // Who touches what they share is a neighbour of both, of whom one may be a ground with thousands.
            const bool fewer = neighbours[i].size() < neighbours[j].size();
            for (size_t k : fewer ? neighbours[i] : neighbours[j])
                if (k != i && k != j && boxes[k].touches(shared)) pair.others.push_back(stands[k]);
            pairs.push_back(std::move(pair));
        }
    return pairs;
}

// Pairs are sorted by these.
std::pair<uint32_t, uint32_t> instancesOf(const SurfacePair& pair) {
    return {instanceOf(pair.a.id), instanceOf(pair.b.id)};
}

// The pair as it stands among others; null: it doesn't, or otherwise.
const SurfacePair* sameIn(const std::vector<SurfacePair>& sorted, const SurfacePair& pair) {
    const auto at = std::ranges::lower_bound(sorted, instancesOf(pair), {}, instancesOf);
    const bool same = at != sorted.end() && at->a == pair.a && at->b == pair.b && at->others == pair.others;
    return same ? &*at : nullptr;
}

Status find(EspContext& context, SurfacePair& pair) {
    const auto placed = [&](const Stand& stand) {
        return PlacedGround{context.surfaces.find(stand.id)->content->ground.get(), glm::dmat4(stand.toWorld)};
    };
    std::vector<PlacedGround> others;
    for (const Stand& stand : {pair.a, pair.b})
        if (Status s = prepare(context, *context.surfaces.find(stand.id)); !s) return s;
    for (const Stand& stand : pair.others) {
        if (Status s = prepare(context, *context.surfaces.find(stand.id)); !s) return s;
        others.push_back(placed(stand));
    }
    const PlacedGround a = placed(pair.a), b = placed(pair.b);
    pair.found = contactsOf(a, b, others);
    pair.hiddenOfA = hiddenTexels(context.surfaces.find(pair.a.id)->content->data, a, b, pair.found.fromA, true);
    pair.hiddenOfB = hiddenTexels(context.surfaces.find(pair.b.id)->content->data, b, a, pair.found.fromB, false);
    return Done{};
}

}  // namespace

void addReached(const EspContext& context, std::vector<bool>& instances) {
    instances.resize(context.surfaceSlots());
    for (bool more = true; more;) {
        more = false;
        context.surfaces.forEach([&](uint32_t, const PlacedSurface& surface) {
            for (const Crossing& c : surface.contacts) {
                const uint32_t other = c.target >> 16;
                if (other >= instances.size()) continue;  // gone since contacts were found
                if (instances[surface.instance] != instances[other])
                    more = instances[surface.instance] = instances[other] = true;
            }
        });
    }
}

bool buriedByOthers(const EspContext& context, const PlantedSeed& seed) {
    const auto hides = [&](const Stand& other, bool yields) {
        const PlacedSurface *by = context.surfaces.find(other.id), *own = context.surfaces.find(seed.surface);
        if (!by || !own) return false;  // gone since contacts were found
        return hiddenBy({by->content->ground.get(), glm::dmat4(other.toWorld)},
                        {seed.position, seed.normal, kNoIndex, kNoIndex, false, yields},
                        own->content->ground->texel() * own->scale);
    };
    return std::ranges::any_of(context.pairs, [&](const SurfacePair& pair) {
        return (pair.a.id == seed.surface && hides(pair.b, true)) ||
               (pair.b.id == seed.surface && hides(pair.a, false));
    });
}

Status refreshContacts(EspContext& context) {
    const auto start = std::chrono::steady_clock::now();
    context.surfaceChanges.resize(context.surfaceSlots());
    std::vector<Stand> stands;
    std::vector<Box> boxes;
    context.surfaces.forEach([&](uint32_t id, const PlacedSurface& surface) {
        stands.push_back({id, surface.toWorld});
        const Box box = boxOf(surface);
        boxes.push_back(box.grown(1e-3 * glm::length(box.high - box.low)));
    });
    // Nothing changes for surfaces of which no pair came, went or is found anew.
    const auto note = [&](const SurfacePair& pair) { context.touched.insert({pair.a.id, pair.b.id}); };
    std::vector<SurfacePair> pairs = pairsOf(stands, boxes);
    for (const SurfacePair& pair : context.pairs)
        if (!sameIn(pairs, pair)) note(pair);
    for (SurfacePair& pair : pairs) {
        if (const SurfacePair* known = sameIn(context.pairs, pair)) {
            pair.found = known->found, pair.hiddenOfA = known->hiddenOfA, pair.hiddenOfB = known->hiddenOfB;
            continue;
        }
        note(pair);
        if (Status s = find(context, pair); !s) return s;
    }
    context.pairs = std::move(pairs);

    std::unordered_map<uint32_t, std::vector<const SurfacePair*>> pairsWith;  // by ids
    for (const SurfacePair& pair : context.pairs)
        for (const uint32_t id : {pair.a.id, pair.b.id})
            if (context.touched.contains(id)) pairsWith[id].push_back(&pair);
    context.contactCount = 0;
    Status status = Done{};
    context.surfaces.forEach([&](uint32_t id, PlacedSurface& surface) {
        if (!context.touched.contains(id)) {
            context.contactCount += uint32_t(surface.contacts.size());
            return;
        }
        std::vector<Crossing> wanted;
        TexelSets hidden;
        const auto add = [&](const std::vector<Crossing>& crossings, uint32_t target) {
            for (Crossing c : crossings) {
                c.target = instanceOf(target) << 16 | (c.target & 0xFFFFu);
                wanted.push_back(c);
            }
        };
        for (const SurfacePair* pair : pairsWith[id]) {
            if (pair->a.id == id) add(pair->found.fromA, pair->b.id), addTo(hidden, pair->hiddenOfA);
            if (pair->b.id == id) add(pair->found.fromB, pair->a.id), addTo(hidden, pair->hiddenOfB);
        }
        context.contactCount += uint32_t(wanted.size());
        TexelSets buried = buriedTexels(surface.content->data, hidden, wanted);
        // Beside each other, without a touch: as baked.
        if (std::ranges::all_of(buried, &std::vector<uint32_t>::empty)) buried.clear();
        if (!status || (same(wanted, surface.contacts) && buried == surface.buried)) return;
        status = surface.gpu.addCrossings(*context.device, surface.content->data, wanted, buried);
        if (!status) return;
        context.surfaceChanges[surface.instance] = SurfaceChange::ground;
        surface.contacts = std::move(wanted), surface.buried = std::move(buried);
    });
    if (status) context.touched.clear();
    context.contactMs = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return status;
}

}  // namespace espalier
