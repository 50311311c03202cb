// In: two surfaces as they stand, and their contacts. Out: which texels of the one are hidden by the other; and of all
// that is hidden of a surface, what contacts close off.
//
// Where no wall of the other's bodies is near, all of a box is within or none. Elsewhere contacts part a tile's texels
// into regions, of which some texels are asked.
#include "runtime/surface/burial.hpp"

#include <algorithm>
#include <bit>
#include <iterator>

#include "runtime/core/disjoint_sets.hpp"
#include "runtime/core/jobs.hpp"

namespace espalier {
namespace {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;

constexpr double kRoom = 2;          // tolerances: a wall that is farther hides nothing
constexpr double kMostLeaks = 3;     // from hidden to seen ground: no more than these are errors of judgement
constexpr double kLeakShare = 0.01;  // of a hidden part's rim: so are these

// A tile's texels as bits, row by row.
uint64_t withNeighbours(uint64_t m) {
    constexpr uint64_t kNotFirst = 0xFEFEFEFEFEFEFEFEull, kNotLast = 0x7F7F7F7F7F7F7F7Full;
    return m | (m << 1 & kNotFirst) | (m >> 1 & kNotLast) | m << 8 | m >> 8;
}

uint32_t bitAt(uint64_t m, int n) {
    while (n-- > 0) m &= m - 1;
    return uint32_t(std::countr_zero(m));
}

// Calls fn(bit) for each set bit.
template <class Fn>
void forBits(uint64_t m, Fn&& fn) {
    for (; m != 0; m &= m - 1) fn(uint32_t(std::countr_zero(m)));
}

// Texels of a level by their places on its grid.
struct Grid {
    uint32_t size;
    uint32_t x(uint32_t texel) const { return (texel >> 6) % (size >> 3) * 8 + (texel & 7u); }
    uint32_t y(uint32_t texel) const { return (texel >> 6) / (size >> 3) * 8 + (texel >> 3 & 7u); }
    uint32_t at(uint32_t x, uint32_t y) const { return texelIndex(size, x, y); }
};

// A search of one level.
class Search {
  public:
    Search(const SurfaceData& data, size_t level, const PlacedGround& own, const PlacedGround& by,
           std::span<const Crossing> contacts, bool yields)
        : level_(data.levels[level]),
          charts_(data.charts),
          own_(*own.ground),
          tiles_(own.ground->tiles(level)),
          bodies_(by.ground->bodies()),
          toBy_(glm::inverse(by.toWorld) * own.toWorld),
          tolerance_(own.ground->texel() * glm::length(dvec3(toBy_[0]))),
          yields_(yields),
          passed_(texelsPassed(level_, contacts)) {}

    std::vector<uint32_t> hidden() const {
        struct Tile {
            uint32_t number;
            bool whole;
            uint64_t texels;
        };
        std::vector<Tile> tiles;
        tiles_.visit([&](const Box& box) { return partOf(box.mapped(toBy_).grown(kRoom * tolerance_)); },
                     [&](uint32_t number, bool whole) {
                         tiles.push_back({number, whole, 0});
                     });
        std::sort(tiles.begin(), tiles.end(), [](const Tile& a, const Tile& b) { return a.number < b.number; });
        parallelFor(tiles.size(), 16, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i)
                tiles[i].texels = tiles[i].whole ? ground(tiles[i].number) : judged(tiles[i].number);
        });
        std::vector<uint32_t> out;
        for (const Tile& tile : tiles)
            forBits(tile.texels, [&](uint32_t bit) { out.push_back(tile.number << 6 | bit); });
        return out;
    }

  private:
    TileBoxes::Part partOf(const Box& box) const {
        if (bodies_.tree().empty() || !bodies_.tree().bounds().touches(box)) return TileBoxes::Part::none;
        if (bodies_.meets(box)) return TileBoxes::Part::some;
        return bodies_.enclose((box.low + box.high) * 0.5) ? TileBoxes::Part::all : TileBoxes::Part::none;
    }

    // A tile's inner texels that no contact passes.
    uint64_t ground(uint32_t tile) const {
        uint64_t m = 0;
        for (uint32_t i = 0; i < 64; ++i)
            m |= uint64_t(texelClass(level_.texels[tile << 6 | i].bits) == kTexelInner) << i;
        for (auto p = std::lower_bound(passed_.begin(), passed_.end(), tile << 6);
             p != passed_.end() && *p >> 6 == tile; ++p)
            m &= ~(uint64_t(1) << (*p & 63u));
        return m;
    }

    uint64_t judged(uint32_t tile) const {
        uint64_t out = 0, left = ground(tile);
        while (left != 0) {
            const uint32_t chart = texelChart(level_.texels[tile << 6 | uint32_t(std::countr_zero(left))].bits);
            uint64_t ofChart = 0, region = left & -left;
            forBits(left, [&](uint32_t i) {
                ofChart |= uint64_t(texelChart(level_.texels[tile << 6 | i].bits) == chart) << i;
            });
            for (uint64_t before = 0; before != region;) before = region, region = withNeighbours(region) & ofChart;
            out |= judgedRegion(tile, region);
            left &= ~region;
        }
        return out;
    }

    // By its first, middle and last texel; all if these don't agree.
    uint64_t judgedRegion(uint32_t tile, uint64_t region) const {
        const int count = std::popcount(region);
        const bool first = hides(tile << 6 | bitAt(region, 0));
        if (count == 1 || (hides(tile << 6 | bitAt(region, count - 1)) == first &&
                           (count == 2 || hides(tile << 6 | bitAt(region, count / 2)) == first)))
            return first ? region : 0;
        uint64_t out = 0;
        forBits(region, [&](uint32_t i) { out |= uint64_t(hides(tile << 6 | i)) << i; });
        return out;
    }

    bool hides(uint32_t texel) const {
        const Grid grid{level_.size};
        const uint32_t x = grid.x(texel), y = grid.y(texel), chart = texelChart(level_.texels[texel].bits);
        const dvec3 here(level_.texels[texel].position);
        const auto difference = [&](uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1) {
            const Texel &a = level_.texels[grid.at(x0, y0)], &b = level_.texels[grid.at(x1, y1)];
            const bool ownA = texelClass(a.bits) != kTexelEmpty && texelChart(a.bits) == chart;
            const bool ownB = texelClass(b.bits) != kTexelEmpty && texelChart(b.bits) == chart;
            return (ownB ? dvec3(b.position) : here) - (ownA ? dvec3(a.position) : here);
        };
        const uint32_t last = level_.size - 1;
        const dvec3 across = glm::cross(difference(std::max(x, 1u) - 1, y, std::min(x + 1, last), y),
                                        difference(x, std::max(y, 1u) - 1, x, std::min(y + 1, last)));
        const dvec3 normal = dmat3(toBy_) * across * double(charts_[chart].orientation);
        const double length = glm::length(normal);
        if (!(length > 0)) return false;
        return bodies_.hide(
            {dvec3(toBy_ * glm::dvec4(here, 1)), normal / length, kNoIndex, kNoIndex, own_.solidChart(chart), yields_},
            tolerance_);
    }

    const SurfaceLevelData& level_;
    const std::vector<Chart>& charts_;
    const ContactGround& own_;
    const TileBoxes& tiles_;
    const Bodies& bodies_;
    dmat4 toBy_;
    double tolerance_;  // in the space of the bodies
    bool yields_;
    std::vector<uint32_t> passed_;
};

// The parts that hidden texels of one level form, over the chart and its seams, and what they border on.
class Parts {
  public:
    Parts(const SurfaceData& data, const SurfaceLevelData& level, const std::vector<uint32_t>& hidden,
          std::span<const Crossing> added)
        : data_(data),
          level_(level),
          hidden_(hidden),
          passed_(texelsPassed(level, added)),
          slotOfTile_(level.texels.size() / 64, kNoIndex),
          known_(slots() * 64, 0),
          rim_(known_.size(), 0),
          leaks_(known_.size(), 0),
          sets_(known_.size()) {
        for (uint32_t texel : passed_)
            if (slotOfTile_[texel >> 6] != kNoIndex) known_[placeOf(texel)] = kPassed;
        for (uint32_t texel : hidden) known_[placeOf(texel)] |= kHidden;
        for (uint32_t texel : hidden) join(texel);
        sum(rim_), sum(leaks_);
    }

    std::vector<uint32_t> closed() {
        std::vector<uint32_t> out;
        for (uint32_t texel : hidden_) {
            const uint32_t root = sets_.find(placeOf(texel));
            const double errors = std::max(kMostLeaks, kLeakShare * (leaks_[root] + rim_[root]));
            if (leaks_[root] <= errors && !passes(texel)) out.push_back(texel);
        }
        // Contacts that run within a third body, with what is on both sides of them.
        for (uint32_t texel : out) known_[placeOf(texel)] |= kClosed;
        const size_t sure = out.size();
        for (size_t i = 0; i < out.size(); ++i)
            around(out[i], [&](uint32_t other) {
                if (!isHidden(other) || (known_[placeOf(other)] & kClosed) != 0 || !passes(other)) return;
                known_[placeOf(other)] |= kClosed;
                out.push_back(other);
            });
        std::sort(out.begin() + std::ptrdiff_t(sure), out.end());
        std::inplace_merge(out.begin(), out.begin() + std::ptrdiff_t(sure), out.end());
        return out;
    }

  private:
    // Numbers the tiles that hold hidden texels.
    size_t slots() {
        uint32_t count = 0;
        for (uint32_t texel : hidden_)
            if (slotOfTile_[texel >> 6] == kNoIndex) slotOfTile_[texel >> 6] = count++;
        return count;
    }
    uint32_t placeOf(uint32_t texel) const { return slotOfTile_[texel >> 6] << 6 | (texel & 63u); }
    bool isHidden(uint32_t texel) const {
        return slotOfTile_[texel >> 6] != kNoIndex && (known_[placeOf(texel)] & kHidden) != 0;
    }
    bool passes(uint32_t texel) const {
        if (slotOfTile_[texel >> 6] != kNoIndex) return (known_[placeOf(texel)] & kPassed) != 0;
        return std::binary_search(passed_.begin(), passed_.end(), texel);
    }
    bool isGround(uint32_t texel, uint32_t chart) const {
        const uint32_t bits = level_.texels[texel].bits;
        return texelClass(bits) == kTexelInner && texelChart(bits) == chart;
    }
    void meet(uint32_t from, uint32_t to) {
        if (passes(to))
            ++rim_[placeOf(from)];
        else if (isHidden(to))
            sets_.join(placeOf(from), placeOf(to));
        else
            ++leaks_[placeOf(from)];
    }
    void join(uint32_t texel) {
        if (passes(texel)) return;
        around(texel, [&](uint32_t other) { meet(texel, other); });
        const uint32_t head = level_.crossingHead[texel];
        for (uint32_t i = head >> 8; i < (head >> 8) + (head & 255u); ++i)
            overSeam(texel, data_.crossings[level_.crossingRefs[i]]);
    }
    // Calls fn for each of the four texels around one that are ground of its chart.
    template <class Fn>
    void around(uint32_t texel, Fn&& fn) const {
        const Grid grid{level_.size};
        const uint32_t x = grid.x(texel), y = grid.y(texel), chart = texelChart(level_.texels[texel].bits);
        const auto look = [&](uint32_t u, uint32_t v) {
            if (u < level_.size && v < level_.size && isGround(grid.at(u, v), chart)) fn(grid.at(u, v));
        };
        look(x - 1, y), look(x, y - 1), look(x + 1, y), look(x, y + 1);
    }
    // To the ground beside the place where the seam beside a texel leads.
    void overSeam(uint32_t texel, const Crossing& c) {
        const uint32_t kind = c.flags & 3u, target = c.target & 0xFFFFu;
        if (kind != kCrossingSeam && kind != kCrossingNearest) return;
        const Grid grid{level_.size};
        const glm::vec2 middle =
            glm::vec2(float(grid.x(texel)) + 0.5f, float(grid.y(texel)) + 0.5f) / float(level_.size);
        const glm::vec2 d = c.b - c.a;
        const float t = glm::clamp(glm::dot(middle - c.a, d) / std::max(glm::dot(d, d), 1e-20f), 0.0f, 1.0f);
        const glm::ivec2 to(glm::floor((c.ta + (c.tb - c.ta) * t) * float(level_.size)));
        const int last = int(level_.size) - 1;
        uint32_t found = kNoIndex;
        for (int v = std::max(to.y - 1, 0); v <= std::min(to.y + 1, last); ++v)
            for (int u = std::max(to.x - 1, 0); u <= std::min(to.x + 1, last); ++u) {
                const uint32_t other = texelIndex(level_.size, uint32_t(u), uint32_t(v));
                // What is hidden or beside a contact first: at a contact the seam has ground of both kinds beside it.
                if (!isGround(other, target)) continue;
                if (found == kNoIndex || passes(other) || (isHidden(other) && !passes(found))) found = other;
            }
        if (found != kNoIndex) meet(texel, found);
    }
    void sum(std::vector<uint32_t>& counts) {
        for (uint32_t i = 0; i < counts.size(); ++i)
            if (const uint32_t root = sets_.find(i); root != i) counts[root] += counts[i];
    }

    const SurfaceData& data_;
    const SurfaceLevelData& level_;
    const std::vector<uint32_t>& hidden_;
    std::vector<uint32_t> passed_;
    std::vector<uint32_t> slotOfTile_;
    // By slot and texel of the tile:
    enum : uint8_t { kHidden = 1, kClosed = 2, kPassed = 4 };
    std::vector<uint8_t> known_;
    std::vector<uint32_t> rim_, leaks_;
    DisjointSets sets_;
};

}  // namespace

TexelSets hiddenTexels(const SurfaceData& data, const PlacedGround& own, const PlacedGround& by,
                       std::span<const Crossing> contacts, bool yields) {
    TexelSets out(data.levels.size());
    for (size_t l = 0; l < out.size(); ++l) out[l] = Search(data, l, own, by, contacts, yields).hidden();
    return out;
}

void addTo(TexelSets& sets, const TexelSets& more) {
    sets.resize(std::max(sets.size(), more.size()));
    for (size_t l = 0; l < more.size(); ++l) {
        std::vector<uint32_t> both;
        both.reserve(sets[l].size() + more[l].size());
        std::set_union(sets[l].begin(), sets[l].end(), more[l].begin(), more[l].end(), std::back_inserter(both));
        sets[l].swap(both);
    }
}

TexelSets buriedTexels(const SurfaceData& data, const TexelSets& hidden, std::span<const Crossing> added) {
    TexelSets out(hidden.size());
    parallelFor(hidden.size(), 1, [&](size_t l, size_t) {
        if (!hidden[l].empty()) out[l] = Parts(data, data.levels[l], hidden[l], added).closed();
    });
    return out;
}

}  // namespace espalier
