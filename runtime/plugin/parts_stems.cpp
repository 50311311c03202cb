// In: rings along branches. Out: tubes of as few rings and sides as the error allows, with both sets of UVs.
#include "runtime/plugin/parts_stems.hpp"

#include <algorithm>
#include <cmath>

namespace espalier {
namespace {

constexpr float kTurn = 6.2831853f;
constexpr size_t kMostSkipped = 48;    // rings, so that a tube keeps its curve where it twists
constexpr float kLeastTogether = .5f;  // cosine of the twist from one kept ring to the next

uint32_t sidesFor(float radius, float error) {
    if (!(error > 0)) return kBarkSides;
    if (error >= radius / 2) return 3;
    const float sides = std::ceil(kTurn / 2 / std::acos(1 - error / radius));
    return std::clamp(uint32_t(sides), 3u, kBarkSides);
}

// Whether the rings between two differ from a straight tube between them by no more than `error`.
bool straight(const StemRun& run, size_t from, size_t to, float error) {
    const BarkRing &a = run[from].ring, &b = run[to].ring;
    if (glm::dot(a.side, b.side) < kLeastTogether || glm::dot(a.up, b.up) < kLeastTogether) return false;
    const glm::vec3 chord = b.center - a.center;
    const float length2 = std::max(glm::dot(chord, chord), 1e-20f);
    for (size_t i = from + 1; i < to; ++i) {
        const BarkRing& r = run[i].ring;
        const float t = std::clamp(glm::dot(r.center - a.center, chord) / length2, 0.0f, 1.0f);
        const glm::vec3 off = r.center - (a.center + chord * t);
        if (glm::dot(off, off) > error * error) return false;
        if (std::abs(r.radius - glm::mix(a.radius, b.radius, t)) > error) return false;
    }
    return true;
}

std::vector<size_t> keptRings(const StemRun& run, float error) {
    std::vector<size_t> kept{0};
    while (kept.back() + 1 < run.size()) {
        size_t next = kept.back() + 1;
        const size_t end = std::min(run.size(), kept.back() + kMostSkipped);
        while (error > 0 && next + 1 < end && straight(run, kept.back(), next + 1, error)) ++next;
        kept.push_back(next);
    }
    return kept;
}

class TubeWriter {
  public:
    TubeWriter(const std::vector<StemRun>& runs, float error, bool thinOut) : error_(error) {
        for (const StemRun& run : runs) {
            const float radius = thickest(run);
            if (run.size() < 2 || (thinOut && radius < error)) continue;
            tubes_.push_back({&run, radius});
            strips_.push_back({std::max(run.back().metres - run.front().metres, 1e-6f), kTurn * radius});
        }
    }

    PartLevel write() {
        const Packing packing = packed(strips_);
        for (size_t i = 0; i < tubes_.size(); ++i)
            tube(*tubes_[i].run, tubes_[i].radius, packing.places[i] / packing.size, strips_[i] / packing.size);
        level_.error = error_;
        return std::move(level_);
    }

  private:
    // low, size: the strip's place in the second set of UVs.
    void tube(const StemRun& run, float radius, glm::vec2 low, glm::vec2 size) {
        const uint32_t sides = sidesFor(radius, error_ / 2), across = sides + 1;
        // Pictures of bark repeat at powers of two of the girth, so that texels are about as long as wide.
        const float perMetre = std::exp2(-std::floor(std::log2(std::max(radius, 1e-6f)))) / kTurn;
        const float first = run.front().metres, length = std::max(run.back().metres - first, 1e-6f);
        uint32_t before = 0;
        for (size_t kept : keptRings(run, error_)) {
            const StemRing& r = run[kept];
            const uint32_t at = uint32_t(level_.vertices.size());
            for (uint32_t side = 0; side < across; ++side) {
                const float around = float(side) / float(sides);
                EspPartVertex v = onRing(r, around);
                v.uv[0] = around;
                v.uv[1] = r.metres * perMetre;
                v.uv2[0] = low.x + size.x * std::clamp((r.metres - first) / length, 0.0f, 1.0f);
                v.uv2[1] = low.y + size.y * around;
                level_.vertices.push_back(v);
            }
            if (kept > 0) join(before, at, sides);
            before = at;
        }
    }
    static EspPartVertex onRing(const StemRing& r, float around) {
        EspPartVertex v{};
        const glm::vec3 n = r.ring.side * std::cos(kTurn * around) + r.ring.up * std::sin(kTurn * around);
        const glm::vec3 p = r.ring.center + n * r.ring.radius;
        for (int i = 0; i < 3; ++i) v.position[i] = p[i], v.normal[i] = n[i], v.colour[i] = 1;
        v.wind = r.wind;
        v.age = r.age;
        return v;
    }
    void join(uint32_t from, uint32_t to, uint32_t sides) {
        for (uint32_t side = 0; side < sides; ++side)
            for (uint32_t v : {from + side, from + side + 1, to + side, from + side + 1, to + side + 1, to + side})
                level_.indices.push_back(v);
    }

    struct Tube {
        const StemRun* run;
        float radius;
    };
    float error_;
    std::vector<Tube> tubes_;
    std::vector<glm::vec2> strips_;
    PartLevel level_;
};

}  // namespace

float thickest(const StemRun& run) {
    float radius = 0;
    for (const StemRing& r : run) radius = std::max(radius, r.ring.radius);
    return radius;
}

PartLevel stemLevel(const std::vector<StemRun>& runs, float error, bool thinOut) {
    return TubeWriter(runs, error, thinOut).write();
}

}  // namespace espalier
