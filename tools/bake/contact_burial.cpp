// In: a level's texels and the contacts. Out: which texels are buried. Contacts part a chart's texels into regions;
// a region is judged by some of its points, texels on a contact each by itself.
#include <algorithm>
#include <cmath>

#include "runtime/core/jobs.hpp"
#include "tools/bake/contact.hpp"

namespace espalier::bakery {
namespace {

constexpr size_t kSamples = 9;  // judged per region

}  // namespace

bool Contacts::hidden(glm::dvec3 p, uint32_t t) const {
    glm::dvec3 a = mesh_.at(t, 0), n = glm::cross(mesh_.at(t, 1) - a, mesh_.at(t, 2) - a);
    uint32_t body = mesh_.triangles[t].body;
    return bodies_.hide({p, n / glm::length(n), body, mesh_.solid[body] != 0}, tolerance_);
}

uint64_t Contacts::bury(const std::vector<Crossing>& crossings, const std::vector<Plane>& planes,
                        SurfaceLevelData& level) const {
    if (shells_ < 2) return 0;
    uint32_t size = level.size;
    enum : uint8_t { kOther, kFree, kOnContact, kSeen };
    std::vector<uint8_t> state(size_t(size) * size, kOther);  // row by row
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x) {
            uint32_t at = texelIndex(size, x, y), head = level.crossingHead[at];
            if (texelClass(level.texels[at].bits) != kTexelInner) continue;
            bool contact = false;
            for (uint32_t i = 0; i < (head & 255u) && !contact; ++i)
                contact = (crossings[level.crossingRefs[(head >> 8) + i]].flags & 3u) == kCrossingContact;
            state[size_t(y) * size + x] = contact ? kOnContact : kFree;
        }
    auto chartAt = [&](uint32_t i) { return texelChart(level.texels[texelIndex(size, i % size, i / size)].bits); };

    // Regions of one chart between contacts; each texel on a contact is a region of its own.
    std::vector<uint32_t> members, first{0};
    for (uint32_t seed = 0; seed < state.size(); ++seed) {
        if (state[seed] == kOther || state[seed] == kSeen) continue;
        size_t begin = members.size();
        bool grows = state[seed] == kFree;
        state[seed] = kSeen;
        members.push_back(seed);
        for (size_t i = begin; grows && i < members.size(); ++i) {
            uint32_t m = members[i], chart = chartAt(m);
            uint32_t around[4] = {m - 1, m + 1, m - size, m + size};
            bool exists[4] = {m % size > 0, m % size + 1 < size, m >= size, m + size < state.size()};
            for (int k = 0; k < 4; ++k)
                if (exists[k] && state[around[k]] == kFree && chartAt(around[k]) == chart) {
                    state[around[k]] = kSeen;
                    members.push_back(around[k]);
                }
        }
        first.push_back(uint32_t(members.size()));
    }
    auto judge = [&](uint32_t i) {
        uint32_t x = i % size, y = i / size, at = texelIndex(size, x, y), t = level.aux[at].triangle;
        const Plane& plane = planes[t];
        glm::vec2 d(glm::dvec2((x + 0.5) / size, (y + 0.5) / size) - plane.uv0);
        return hidden(glm::dvec3(plane.p0 + plane.e1 * glm::dot(plane.g1, d) + plane.e2 * glm::dot(plane.g2, d)), t);
    };
    std::vector<uint8_t> buried(members.size(), 0);
    parallelFor(first.size() - 1, 64, [&](size_t begin, size_t end) {
        for (size_t r = begin; r < end; ++r) {
            size_t from = first[r], count = first[r + 1] - from, samples = std::min(count, kSamples), yes = 0;
            for (size_t s = 0; s < samples; ++s) yes += judge(members[from + (2 * s + 1) * count / (2 * samples)]);
            bool mixed = yes > 0 && yes < samples;  // contacts leave gaps where pieces end
            for (size_t i = from; i < from + count; ++i) buried[i] = mixed ? judge(members[i]) : yes > 0;
        }
    });
    uint64_t sum = 0;
    for (size_t i = 0; i < members.size(); ++i) {
        if (!buried[i]) continue;
        uint32_t& bits = level.texels[texelIndex(size, members[i] % size, members[i] / size)].bits;
        bits = (bits & ~0x30000u) | kTexelLink << 16;
        ++sum;
    }
    return sum;
}

}  // namespace espalier::bakery
