// In: a surface as it was baked, and crossings to be added. Out: what changes of its levels: lists of crossings, and
// clearances by a chessboard distance that spreads from the texels that list new ones, ring by ring.
#include "runtime/surface/added_crossings.hpp"

#include <algorithm>
#include <atomic>

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

// A texel of a level with its coordinates.
struct Spot {
    uint32_t index, x, y;
};
Spot spotOf(uint32_t size, uint32_t index) {
    const uint32_t tile = index >> 6, tiles = size >> 3;
    return {index, (tile % tiles) * 8 + (index & 7u), (tile / tiles) * 8 + (index >> 3 & 7u)};
}

// All texels nearer than 33 to one of the hits, with their distance, in ascending order.
struct Near {
    uint32_t texel, distance;
    bool operator<(const Near& other) const { return texel < other.texel; }
};
std::vector<Near> surroundings(uint32_t size, const std::vector<Hit>& hits) {
    std::vector<uint8_t> seen(size_t(size) * size, 0);
    std::vector<Near> out;
    std::vector<Spot> ring, next;
    auto visit = [&](uint32_t index, uint32_t distance, std::vector<Spot>& into) {
        if (seen[index]) return;
        seen[index] = 1;
        out.push_back({index, distance});
        into.push_back(spotOf(size, index));
    };
    for (const Hit& hit : hits) visit(hit.texel, 0, ring);
    for (uint32_t distance = 1; distance <= kMaxClearance + 1 && !ring.empty(); ++distance) {
        next.clear();
        for (const Spot& s : ring)
            for (uint32_t y = s.y > 0 ? s.y - 1 : 0; y <= std::min(s.y + 1, size - 1); ++y)
                for (uint32_t x = s.x > 0 ? s.x - 1 : 0; x <= std::min(s.x + 1, size - 1); ++x)
                    visit(texelIndex(size, x, y), distance, next);
        ring.swap(next);
    }
    std::sort(out.begin(), out.end());
    return out;
}

// False: the level lists more than it can.
bool patchLevel(const SurfaceLevelData& level, std::span<const Crossing> added, uint32_t first, LevelPatch& patch) {
    const std::vector<Hit> hits = hitsOf(level, added, first);
    size_t i = 0;
    for (const Near& near : surroundings(level.size, hits)) {
        uint32_t bits = level.texels[near.texel].bits, head = level.crossingHead[near.texel];
        const uint32_t clearance = near.distance > 1 ? near.distance - 1 : 0;
        if (near.distance > 0 && clearance >= texelClearance(bits)) continue;
        bits &= ~(kMaxClearance << kClearanceShift);
        bits |= clearance << kClearanceShift;
        if (near.distance == 0) {
            const size_t start = level.crossingRefs.size() + patch.added.size();
            const auto old = level.crossingRefs.begin() + (head >> 8);
            patch.added.insert(patch.added.end(), old, old + (head & 255u));
            uint32_t count = head & 255u;
            for (; i < hits.size() && hits[i].texel == near.texel; ++i)
                if (count < kMostListed) patch.added.push_back(hits[i].crossing), ++count;
            if (start + count >= kMostRefs) return false;
            head = uint32_t(start) << 8 | count;
        }
        patch.texels.push_back(near.texel);
        patch.bits.push_back(bits);
        patch.heads.push_back(head);
    }
    return true;
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
