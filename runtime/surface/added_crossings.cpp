// In: a surface as it was baked, and crossings to be added. Out: what changes of its levels: lists of crossings, and
// clearances by the chessboard distance to the texels that list new ones.
#include "runtime/surface/added_crossings.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>

#include "runtime/core/jobs.hpp"
#include "runtime/surface/grid_segment.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMaxClearance = 31, kClearanceShift = 19, kClassShift = 16;
constexpr uint32_t kMostListed = 255;          // a head counts by 8 bits
constexpr size_t kMostRefs = size_t(1) << 24;  // and begins by 24

struct Hit {
    uint32_t texel, crossing;
    auto operator<=>(const Hit&) const = default;
};

std::vector<Hit> hitsOf(const SurfaceLevelData& level, std::span<const Crossing> added, uint32_t first) {
    std::vector<Hit> hits;
    const double size = level.size;
    for (uint32_t i = 0; i < added.size(); ++i) {
        const uint32_t chart = added[i].flags >> 16;
        gridSegment(glm::dvec2(added[i].a) * size, glm::dvec2(added[i].b) * size, kCrossingGrow, level.size, 0,
                    level.size, [&](int64_t y, int64_t x0, int64_t x1) {
                        for (int64_t x = x0; x <= x1; ++x) {
                            const uint32_t at = texelIndex(level.size, uint32_t(x), uint32_t(y));
                            const uint32_t bits = level.texels[at].bits;
                            if (texelClass(bits) != kTexelEmpty && texelChart(bits) == chart)
                                hits.push_back({at, first + i});
                        }
                    });
    }
    std::sort(hits.begin(), hits.end());
    return hits;
}

// Makes buried texels of a patch kTexelLink; those that it doesn't have come into it.
void bury(const SurfaceLevelData& level, const std::vector<uint32_t>& buried, LevelPatch& patch) {
    LevelPatch all;
    all.added = std::move(patch.added);
    const auto add = [&](uint32_t texel, uint32_t bits, uint32_t head) {
        all.texels.push_back(texel), all.bits.push_back(bits), all.heads.push_back(head);
    };
    const auto link = [](uint32_t bits) { return (bits & ~(3u << kClassShift)) | kTexelLink << kClassShift; };
    size_t i = 0;
    for (uint32_t texel : buried) {
        for (; i < patch.texels.size() && patch.texels[i] < texel; ++i)
            add(patch.texels[i], patch.bits[i], patch.heads[i]);
        const bool known = i < patch.texels.size() && patch.texels[i] == texel;
        add(texel, link(known ? patch.bits[i] : level.texels[texel].bits),
            known ? patch.heads[i] : level.crossingHead[texel]);
        i += known ? 1 : 0;
    }
    for (; i < patch.texels.size(); ++i) add(patch.texels[i], patch.bits[i], patch.heads[i]);
    patch = std::move(all);
}

// The chessboard distance of texels to the nearest hit, up to kFar, in the whole tiles around all that is nearer.
class Distances {
  public:
    Distances(uint32_t size, const std::vector<Hit>& hits) : tiles_(size >> 3) {
        uint32_t low[2] = {size, size}, high[2] = {0, 0};
        for (const Hit& hit : hits)
            for (int k = 0; k < 2; ++k) {
                low[k] = std::min(low[k], placeOf(hit.texel, k));
                high[k] = std::max(high[k], placeOf(hit.texel, k));
            }
        for (int k = 0; k < 2; ++k) {
            first_[k] = low[k] > kFar ? (low[k] - kFar) & ~7u : 0;
            count_[k] = std::min(size, (high[k] + kFar + 8) & ~7u) - first_[k];
        }
        values_.assign(size_t(count_[0]) * count_[1], kFar);
        std::vector<uint8_t> reached(count_[1], 0);
        for (const Hit& hit : hits) {
            const uint32_t y = placeOf(hit.texel, 1) - first_[1];
            row(y)[placeOf(hit.texel, 0) - first_[0]] = 0, reached[y] = 1;
        }
        // A way leads along the hit's row, then aslant or straight from row to row.
        for (uint32_t y = 0; y < count_[1]; ++y) {
            if (!reached[y]) continue;
            uint8_t* to = row(y);
            for (uint32_t x = 1; x < count_[0]; ++x) to[x] = std::min<uint8_t>(to[x], to[x - 1] + 1);
            for (uint32_t x = count_[0] - 1; x-- > 0;) to[x] = std::min<uint8_t>(to[x], to[x + 1] + 1);
        }
        for (uint32_t y = 1; y < count_[1]; ++y) spread(row(y - 1), row(y));
        for (uint32_t y = count_[1] - 1; y-- > 0;) spread(row(y + 1), row(y));
    }

    // Calls fn(texel, distance) for all that are nearer than kFar, in ascending order.
    template <class Fn>
    void forNear(Fn&& fn) const {
        constexpr uint64_t kNone = kFar * 0x0101010101010101ull;
        for (uint32_t y0 = 0; y0 < count_[1]; y0 += 8)
            for (uint32_t x0 = 0; x0 < count_[0]; x0 += 8) {
                const uint32_t tile = ((first_[1] + y0) >> 3) * tiles_ + ((first_[0] + x0) >> 3);
                for (uint32_t v = 0; v < 8; ++v) {
                    const uint8_t* from = &values_[size_t(y0 + v) * count_[0] + x0];
                    uint64_t eight;
                    std::memcpy(&eight, from, 8);
                    for (uint32_t u = 0; eight != kNone && u < 8; ++u)
                        if (from[u] < kFar) fn(tile << 6 | v << 3 | u, from[u]);
                }
            }
    }

  private:
    static constexpr uint8_t kFar = kMaxClearance + 2;

    uint32_t placeOf(uint32_t texel, int axis) const {
        const uint32_t tile = texel >> 6;
        return axis == 0 ? tile % tiles_ * 8 + (texel & 7u) : tile / tiles_ * 8 + (texel >> 3 & 7u);
    }
    uint8_t* row(uint32_t y) { return &values_[size_t(y) * count_[0]]; }
    void spread(const uint8_t* from, uint8_t* to) const {
        const uint32_t last = count_[0] - 1;
        to[0] = std::min<uint8_t>(to[0], std::min(from[0], from[1]) + 1);
        for (uint32_t x = 1; x < last; ++x)
            to[x] = std::min<uint8_t>(to[x], std::min(std::min(from[x - 1], from[x]), from[x + 1]) + 1);
        to[last] = std::min<uint8_t>(to[last], std::min(from[last - 1], from[last]) + 1);
    }

    uint32_t tiles_;                // of the level, a side
    uint32_t first_[2], count_[2];  // of the texels, in x and y
    std::vector<uint8_t> values_;   // row by row
};

// False: the level lists more than it can.
bool patchLevel(const SurfaceLevelData& level, std::span<const Crossing> added, uint32_t first, LevelPatch& patch) {
    const std::vector<Hit> hits = hitsOf(level, added, first);
    if (hits.empty()) return true;
    size_t i = 0;
    bool fits = true;
    Distances(level.size, hits).forNear([&](uint32_t texel, uint32_t distance) {
        uint32_t bits = level.texels[texel].bits, head = level.crossingHead[texel];
        const uint32_t clearance = distance > 1 ? distance - 1 : 0;
        if (distance > 0 && clearance >= texelClearance(bits)) return;
        bits &= ~(kMaxClearance << kClearanceShift);
        bits |= clearance << kClearanceShift;
        if (distance == 0) {
            const size_t start = level.crossingRefs.size() + patch.added.size();
            const auto old = level.crossingRefs.begin() + (head >> 8);
            patch.added.insert(patch.added.end(), old, old + (head & 255u));
            uint32_t count = head & 255u;
            for (; i < hits.size() && hits[i].texel == texel; ++i)
                if (count < kMostListed) patch.added.push_back(hits[i].crossing), ++count;
            fits = fits && start + count < kMostRefs;
            head = uint32_t(start) << 8 | count;
        }
        patch.texels.push_back(texel);
        patch.bits.push_back(bits);
        patch.heads.push_back(head);
    });
    return fits;
}

}  // namespace

std::vector<uint32_t> texelsPassed(const SurfaceLevelData& level, std::span<const Crossing> crossings) {
    std::vector<uint32_t> out;
    for (const Hit& hit : hitsOf(level, crossings, 0))
        if (out.empty() || out.back() != hit.texel) out.push_back(hit.texel);
    return out;
}

Result<std::vector<LevelPatch>> patchLevels(const SurfaceData& data, std::span<const Crossing> added,
                                            const TexelSets& buried) {
    std::vector<LevelPatch> patches(data.levels.size());
    if (added.empty() && buried.empty()) return patches;
    std::atomic<bool> fits = true;
    parallelFor(patches.size(), 1, [&](size_t l, size_t) {
        if (!patchLevel(data.levels[l], added, uint32_t(data.crossings.size()), patches[l])) fits = false;
        if (l < buried.size() && !buried[l].empty()) bury(data.levels[l], buried[l], patches[l]);
    });
    if (!fits) return Failure(data.source, "more contacts with other surfaces than a level can list");
    return patches;
}

void applyPatch(const LevelPatch& patch, SurfaceLevelData& level) {
    for (size_t i = 0; i < patch.texels.size(); ++i) {
        level.texels[patch.texels[i]].bits = patch.bits[i];
        level.crossingHead[patch.texels[i]] = patch.heads[i];
    }
    level.crossingRefs.insert(level.crossingRefs.end(), patch.added.begin(), patch.added.end());
}

}  // namespace espalier
