#include "runtime/pattern/pattern_room.hpp"

#include <numeric>
#include <string>
#include <tuple>

namespace espalier {

PatternStatus freshPatternStatus(const PatternInputs& inputs, const PatternRoom& room) {
    PatternStatus s = {};
    s.itemRoom = room.items;
    s.setRoom = room.sets;
    s.pieceRoom = room.pieces;
    s.edgeRoom = room.edges;
    s.pairRoom = room.pairs;
    s.waiting[0] = uint32_t(inputs.seeds.size());
    s.mostDepth = inputs.limits.maxDepth;
    for (auto* groups : {s.deriveGroups, s.shapeGroups, s.pieceGroups, s.pairGroups, s.setGroups})
        groups[1] = groups[2] = 1;
    return s;
}

std::vector<PatternItem> itemsOfPatternSeeds(const PatternInputs& inputs) {
    std::vector<PatternItem> items;
    for (uint32_t i = 0; i < inputs.seeds.size(); ++i) {
        const Seed& seed = inputs.seeds[i];
        PatternItem item = {};
        item.key = seed.key;
        item.scope.walk = seed.walk;
        item.scope.turn = vec4(0, 0, 0, 1);
        item.scope.size = vec3(1);
        std::copy_n(seed.args, 4, item.args);
        item.grammar = seed.grammar;
        item.part = kNoIndex;
        item.symbol = seed.symbol;
        item.seed = i;
        items.push_back(item);
    }
    return items;
}

Status withinLimits(const PatternStatus& status, const PatternLimits& limits) {
    if (status.pieces > limits.maxPieces)
        return Failure("pattern",
                       "more than " + std::to_string(limits.maxPieces) +
                           " meshes were tried; does a rule go on for ever? A condition or larger steps end it");
    if (status.mostItems > limits.maxWaiting)
        return Failure("pattern", "more than " + std::to_string(limits.maxWaiting) +
                                      " symbols wait at once; does a rule go on for ever? A condition or fewer symbols "
                                      "behind each other end it");
    if (std::max(status.shapes, status.mostItems) > limits.maxShapes + uint64_t(limits.shapesPerSet) * status.standing)
        return Failure("pattern", std::to_string(status.shapes) + " symbols have led to only " +
                                      std::to_string(status.standing) +
                                      " meshes or locks that stand; does a rule go on for ever? A condition ends it, "
                                      "or a mesh (IC) in the same "
                                      "rule, before the symbol that goes on");
    return Done{};
}

GrownPattern standingOf(std::span<PatternPiece> pieces, std::span<const PatternSet> sets, const PatternStatus& status) {
    settleMerged(pieces, sets);
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < pieces.size(); ++i)
        if (sets[pieces[i].set].state != kSetFallen) order.push_back(i);
    // A set's pieces follow each other as they do in their production.
    std::ranges::stable_sort(order, {}, [&](uint32_t i) {
        const PatternSet& set = sets[pieces[i].set];
        return std::tuple(pieces[i].mesh & 0xFFFFu, set.key, set.number);
    });
    GrownPattern grown;
    grown.pieces.reserve(order.size());
    for (uint32_t i : order) grown.pieces.push_back(pieces[i]);
    PatternStats& s = grown.stats;
    s.hash = uint64_t(status.hash[1]) << 32 | status.hash[0];
    s.shapes = status.shapes;
    s.tried = uint32_t(pieces.size());
    s.standing = status.standing;
    s.fallen = status.fallen;
    s.ended = status.ended;
    s.deep = status.deep;
    s.waves = status.waves;
    s.rounds = status.rounds;
    s.pieces = uint32_t(grown.pieces.size());
    return grown;
}

}  // namespace espalier
