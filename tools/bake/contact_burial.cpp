// In: a level's texels and the contacts. Out: which texels are buried. Contacts part a chart's texels into regions;
// a region is judged by some of its points, texels on a contact each by itself.
#include <algorithm>
#include <cmath>

#include "runtime/core/disjoint_sets.hpp"
#include "runtime/core/jobs.hpp"
#include "tools/bake/contact.hpp"

namespace espalier::bakery {
namespace {

constexpr size_t kSamples = 15;      // judged per region
constexpr double kSeenShare = 0.05;  // of what is hidden: less is an error of judgement
constexpr size_t kMostParts = 32;    // that a contact is judged in

}  // namespace

bool Contacts::hidden(glm::dvec3 p, uint32_t t, uint32_t exceptBody, bool crevices) const {
    glm::dvec3 a = mesh_.at(t, 0), n = glm::cross(mesh_.at(t, 1) - a, mesh_.at(t, 2) - a);
    uint32_t body = mesh_.triangles[t].body;
    // What isn't near enough to be joined hides nothing either: the sides of a groove between boards are ground.
    return bodies_.hide({p, n / glm::length(n), body, exceptBody, mesh_.solid[body] != 0}, mesh_.reachOf(t), crevices);
}

Contact part(const Contact& contact, double from, double to) {
    Contact out = contact;
    const float t0 = float(from), t1 = float(to);
    auto cut = [&](glm::vec2& a, glm::vec2& b) {
        glm::vec2 start = a, d = b - a;
        a = t0 > 0 ? start + d * t0 : a, b = t1 < 1 ? start + d * t1 : b;
    };
    cut(out.crossing.a, out.crossing.b);
    cut(out.crossing.ta, out.crossing.tb);
    return out;
}

// Where three pieces meet, a contact of two may lead from what is seen to what the third one hides, and back; another
// leads on there.
void Contacts::dropHidden() {
    std::vector<std::vector<Contact>> kept(list_.size());
    parallelFor(list_.size(), 64, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Contact& c = list_[i];
            uint32_t fromBody = mesh_.triangles[c.from].body, toBody = mesh_.triangles[c.to].body;
            size_t parts = std::clamp(size_t(glm::length(c.b - c.a) / tolerance_), size_t(1), kMostParts);
            const bool out = mesh_.lining[fromBody] != 0;  // from what is hidden anyway
            const auto asked = [&](bool far, glm::dvec3 p, bool crevices) {
                if (out && !far) return false;
                return far ? hidden(p, c.to, fromBody, crevices) : hidden(p, c.from, toBody, crevices);
            };
            const auto leads = [&](size_t k) {
                return leadsOn(c, (double(k) + 0.5) / double(parts), tolerance_, asked);
            };
            for (size_t k = 0; k < parts;) {
                if (!leads(k)) {
                    ++k;
                    continue;
                }
                size_t first = k;
                while (k < parts && (k == first || leads(k))) ++k;
                kept[i].push_back(part(c, double(first) / double(parts), double(k) / double(parts)));
            }
        }
    });
    list_.clear();
    for (const auto& parts : kept) list_.insert(list_.end(), parts.begin(), parts.end());
}

namespace {

// The texel that holds uv.
uint32_t texelOf(const SurfaceLevelData& level, glm::vec2 uv) {
    glm::vec2 p = glm::clamp(uv * float(level.size), glm::vec2(0), glm::vec2(float(level.size) - 1));
    return uint32_t(p.y) * level.size + uint32_t(p.x);
}

// Does a contact of the chart lie between p and q? By the lists of the texels around them.
bool parted(const std::vector<Crossing>& crossings, const SurfaceLevelData& level, uint32_t chart, glm::dvec2 p,
            glm::dvec2 q) {
    const uint32_t i = texelOf(level, glm::min(p, q)), j = texelOf(level, glm::max(p, q));
    for (uint32_t y = i / level.size; y <= j / level.size; ++y)
        for (uint32_t x = i % level.size; x <= j % level.size; ++x) {
            const uint32_t head = level.crossingHead[texelIndex(level.size, x, y)];
            for (uint32_t k = 0; k < (head & 255u); ++k) {
                const Crossing& c = crossings[level.crossingRefs[(head >> 8) + k]];
                if ((c.flags & 3u) != kCrossingContact || c.flags >> 16 != chart) continue;
                const glm::dvec2 a(c.a), d = glm::dvec2(c.b) - a, e = q - p;
                const bool beside = (cross(d, p - a) > 0) == (cross(d, q - a) > 0);
                if (!beside && (cross(e, a - p) > 0) != (cross(e, a + d - p) > 0)) return true;
            }
        }
    return false;
}

// Regions that borders join are one, unless a contact runs along the border or close to it. Returns for each region the
// one that stands for all that it is joined with. members, first: the regions' texels.
std::vector<uint32_t> joinRegions(const std::vector<Crossing>& crossings, const SurfaceLevelData& level,
                                  const std::vector<uint32_t>& members, const std::vector<uint32_t>& first) {
    std::vector<uint32_t> regionOf(level.texels.size(), kNone), joined(first.size() - 1);
    DisjointSets regions(joined.size());
    for (uint32_t r = 0; r < joined.size(); ++r)
        for (uint32_t i = first[r]; i < first[r + 1]; ++i) regionOf[members[i]] = r;
    float texel = 1.0f / float(level.size);
    // Where texels are too large to tell sides apart there is nothing to join: regions of one texel judge themselves.
    auto regionAt = [&](glm::vec2 at, glm::vec2 edge, bool left, uint32_t chart) {
        glm::vec2 inward = glm::vec2(-edge.y, edge.x) * ((left ? 1.0f : -1.0f) / std::max(glm::length(edge), 1e-20f));
        for (float reach : {0.6f, 1.2f}) {
            const glm::vec2 inside = at + inward * (reach * texel);
            if (parted(crossings, level, chart, glm::dvec2(at), glm::dvec2(inside))) return kNone;
            uint32_t t = texelOf(level, inside);
            uint32_t index = texelIndex(level.size, t % level.size, t / level.size);
            uint32_t head = level.crossingHead[index];
            bool contact = false;
            for (uint32_t i = 0; i < (head & 255u) && !contact; ++i)
                contact = (crossings[level.crossingRefs[(head >> 8) + i]].flags & 3u) == kCrossingContact;
            if (!contact && regionOf[t] != kNone && texelChart(level.texels[index].bits) == chart) return regionOf[t];
        }
        return kNone;
    };
    for (const Crossing& c : crossings) {
        uint32_t kind = c.flags & 3u, chart = c.flags >> 16, other = c.target & 0xFFFFu;
        if (kind != kCrossingSeam && kind != kCrossingNearest) continue;
        // Contacts may part a long border often.
        int steps = int(glm::length(c.b - c.a) * float(level.size)) + 1;
        for (int k = 0; k < steps; ++k) {
            float t = (float(k) + 0.5f) / float(steps);
            glm::vec2 here = c.a + (c.b - c.a) * t, there = c.ta + (c.tb - c.ta) * t;
            bool left = (c.flags & kCrossingInsideLeft) != 0;
            uint32_t r = regionAt(here, c.b - c.a, left, chart);
            // The far side's handedness isn't known here; whichever side holds the chart will do.
            uint32_t q = regionAt(there, c.tb - c.ta, !left, other);
            if (q == kNone) q = regionAt(there, c.tb - c.ta, left, other);
            if (r != kNone && q != kNone) regions.join(r, q);
        }
    }
    for (uint32_t r = 0; r < joined.size(); ++r) joined[r] = regions.find(r);
    return joined;
}

}  // namespace

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
        return hidden(glm::dvec3(plane.p0 + plane.e1 * glm::dot(plane.g1, d) + plane.e2 * glm::dot(plane.g2, d)), t,
                      kNone);
    };
    std::vector<uint8_t> buried(members.size(), 0);
    size_t regions = first.size() - 1;
    std::vector<uint32_t> whole = joinRegions(crossings, level, members, first);
    std::vector<double> seen(regions, 0), hides(regions, 0);  // texels, at the region that stands for the whole
    std::vector<double> share(regions, 0);
    parallelFor(regions, 64, [&](size_t begin, size_t end) {
        for (size_t r = begin; r < end; ++r) {
            size_t from = first[r], count = first[r + 1] - from, samples = std::min(count, kSamples), yes = 0;
            for (size_t s = 0; s < samples; ++s) yes += judge(members[from + (2 * s + 1) * count / (2 * samples)]);
            share[r] = double(yes) / double(samples);
        }
    });
    for (size_t r = 0; r < regions; ++r) {
        double count = first[r + 1] - first[r];
        hides[whole[r]] += share[r] * count;
        seen[whole[r]] += (1 - share[r]) * count;
    }
    // What is seen in parts is no ground in none: no contact closes off the rest, a walk may come there by a hole.
    for (size_t r = 0; r < regions; ++r) {
        bool gone = seen[whole[r]] <= kSeenShare * hides[whole[r]] && hides[whole[r]] > 0;
        std::fill(buried.begin() + first[r], buried.begin() + first[r + 1], gone);
    }
    uint64_t sum = 0;
    for (size_t i = 0; i < members.size(); ++i) {
        if (!buried[i]) continue;
        uint32_t& bits = level.texels[texelIndex(size, members[i] % size, members[i] / size)].bits;
        bits = (bits & ~0xFB0000u) | kTexelLink << 16;  // and no clearance
        ++sum;
    }
    return sum;
}

}  // namespace espalier::bakery
