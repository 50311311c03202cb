// In: a level's texels and the contacts. Out: which texels are buried. Contacts part a chart's texels into regions;
// a region is judged by some of its points, texels on a contact each by itself. A point is judged by rays, which
// count how often they leave a solid body more than they enter it.
#include <algorithm>
#include <cmath>

#include "runtime/core/jobs.hpp"
#include "tools/bake/contact.hpp"

namespace espalier::bakery {
namespace {

constexpr size_t kSamples = 9;        // judged per region
constexpr double kFacing = 0.95;      // cosine: faces that cover one another
constexpr double kLevelShare = 0.02;  // of the tolerance: faces nearer to each other lie at one height
const glm::dvec3 kRays[3] = {{0.5377, 0.7483, 0.3883}, {-0.6157, 0.4621, -0.6382}, {0.2113, -0.8341, 0.5094}};

// 1 or -1 where the ray leaves or enters through a-b-c, else 0.
int passage(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 origin, glm::dvec3 direction) {
    glm::dvec3 e1 = b - a, e2 = c - a, h = glm::cross(direction, e2);
    double det = glm::dot(e1, h);  // negative: the ray goes the way of the normal
    if (det == 0) return 0;
    glm::dvec3 s = origin - a, q = glm::cross(s, e1);
    double u = glm::dot(s, h) / det, v = glm::dot(direction, q) / det, t = glm::dot(e2, q) / det;
    if (u < 0 || v < 0 || u + v > 1 || t < 0) return 0;
    return det < 0 ? 1 : -1;
}

}  // namespace

bool Contacts::inside(glm::dvec3 p, glm::dvec3 direction, uint32_t ownBody) const {
    struct Count {
        uint32_t body;
        int count;
    };
    thread_local std::vector<Count> counts;
    counts.clear();
    wallTree_.along(p, direction, [&](uint32_t i) {
        const Cap& w = walls_[i];
        if (w.body == ownBody) return;
        int passed = passage(w.a, w.b, w.c, p, direction);
        if (passed == 0) return;
        for (Count& c : counts)
            if (c.body == w.body) {
                c.count += passed;
                return;
            }
        counts.push_back({w.body, passed});
    });
    return std::any_of(counts.begin(), counts.end(), [](const Count& c) { return c.count > 0; });
}

// Two rays that agree decide; a ray along an edge may err.
bool Contacts::inside(glm::dvec3 p, uint32_t ownBody) const {
    bool first = inside(p, kRays[0], ownBody);
    return inside(p, kRays[1], ownBody) == first ? first : inside(p, kRays[2], ownBody);
}

bool Contacts::covered(glm::dvec3 p, uint32_t triangle) const {
    const auto& own = mesh_.triangles[triangle];
    glm::dvec3 n = normals_[triangle];
    Box around;
    around.add(p);
    bool found = false;
    tree_.near(around.grown(tolerance_), [&](uint32_t t) {
        const auto& other = mesh_.triangles[t];
        double facing = glm::dot(n, normals_[t]);
        if (found || other.body == own.body || std::abs(facing) < kFacing) return;
        if (facing < 0 && (!mesh_.solid[own.body] || mesh_.solid[other.body])) return;
        double above = glm::dot(normals_[t], mesh_.at(t, 0) - p) * (facing > 0 ? 1 : -1);
        if (std::abs(above) > tolerance_) return;
        for (uint32_t k = 0; k < 3; ++k) {
            glm::dvec3 a = mesh_.at(t, k), e = mesh_.at(t, (k + 1) % 3) - a;
            if (glm::dot(glm::cross(normals_[t], e), p - a) < 0) return;
        }
        double level = kLevelShare * tolerance_;
        found = facing < 0 || above > level || (above > -level && other.body < own.body);
    });
    return found;
}

bool Contacts::hidden(glm::dvec3 p, uint32_t triangle) const {
    uint32_t body = mesh_.triangles[triangle].body;
    glm::dvec3 n = normals_[triangle];
    return inside(p + n * (0.1 * tolerance_), body) || inside(p + n * (1.5 * tolerance_), body) || covered(p, triangle);
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
