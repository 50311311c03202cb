#pragma once

// Room for one derivation of patterns, and how it grows until all fits.

#include <algorithm>

#include "runtime/pattern/pattern_data.hpp"

namespace espalier {

struct PatternRoom {
    uint32_t items = 4096, sets = 16384, pieces = 16384, edges = 65536, pairs = 65536;

    // Of cells, a power of two.
    uint32_t cells() const {
        uint32_t n = 1024;
        while (n < 2 * pieces) n *= 2;
        return n;
    }
    // Whether what a status tells has found room. Else there is more now, where limits allow it.
    bool holds(const PatternStatus& s) const {
        return s.sets <= sets && s.pieces <= pieces && s.edges <= edges && s.mostPairs <= pairs && s.mostItems <= items;
    }
    void grow(const PatternStatus& s) {
        const auto more = [](uint32_t& room, uint32_t asked) {
            if (asked > room)
                room = uint32_t(std::min<uint64_t>(std::max(2ull * room, asked + asked / 2ull), 1u << 30));
        };
        more(items, s.mostItems);
        more(sets, s.sets);
        more(pieces, s.pieces);
        more(edges, s.edges);
        more(pairs, s.mostPairs);
    }
};

// Counters to begin with: seeds wait in priority 0.
PatternStatus freshPatternStatus(const PatternInputs& inputs, const PatternRoom& room);
// Seeds as symbols that wait.
std::vector<PatternItem> itemsOfPatternSeeds(const PatternInputs& inputs);
// Empty, or which limit what a status tells goes beyond.
Status withinLimits(const PatternStatus& status, const PatternLimits& limits);
// Segments that were cut end there, and pieces that others merged into move to the middle of all of them.
void settleMerged(std::span<PatternPiece> pieces, std::span<const PatternSet> sets);
// Of all pieces, those of sets that stand: sorted by mesh, then by key. Fills in stats but for the time.
GrownPattern standingOf(std::span<PatternPiece> pieces, std::span<const PatternSet> sets, const PatternStatus& status);

}  // namespace espalier
