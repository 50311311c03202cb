// In: pieces and sets as they were decided. Out: segments that end where they were cut, pieces in the middle of those
// that went into them.
#include <cmath>
#include <map>
#include <numeric>

#include "runtime/pattern/pattern_room.hpp"
#include "shaders/shared/pattern_merge.h"

namespace espalier {
namespace {

// The cubic curve of a segment (pattern_piece.h), by its control points.
struct Curve {
    glm::dvec3 points[4];

    explicit Curve(const PatternPiece& p) {
        const glm::dvec3 begin = p.position, end = begin + glm::dvec3(p.x);
        const double third = glm::length(end - begin) / 3;
        points[0] = begin;
        points[1] = begin + glm::dvec3(unpackOct(floatBitsToUint(p.z.x))) * third;
        points[2] = end - glm::dvec3(unpackOct(floatBitsToUint(p.z.y))) * third;
        points[3] = end;
    }
    glm::dvec3 at(double t) const {
        glm::dvec3 p[4] = {points[0], points[1], points[2], points[3]};
        for (int n = 3; n > 0; --n)
            for (int i = 0; i < n; ++i) p[i] = glm::mix(p[i], p[i + 1], t);
        return p[0];
    }
    glm::dvec3 tangent(double t) const {
        const glm::dvec3 a = points[1] - points[0], b = points[2] - points[1], c = points[3] - points[2];
        return glm::normalize(a * ((1 - t) * (1 - t)) + b * (2 * t * (1 - t)) + c * (t * t));
    }
};

// The segment up to where it meets the middle of the one that stops it.
PatternPiece cutAt(const PatternPiece& piece, const PatternPiece& stop) {
    float at = 1, there = 0;
    if (!segmentsCross(piece, stop, at, there)) return piece;
    const vec3 up = glm::mix(unit3(piece.y), unpackOct(floatBitsToUint(piece.z.z)), at);
    PatternPiece cut = piece;
    cut.x = vec3(Curve(stop).at(there) - glm::dvec3(piece.position));
    cut.z.y = uintBitsToFloat(packOct(vec3(Curve(piece).tangent(at))));
    cut.z.z = uintBitsToFloat(packOct(unit3(up)));
    return cut;
}

}  // namespace

void settleMerged(std::span<PatternPiece> pieces, std::span<const PatternSet> sets) {
    struct Mean {
        glm::i64vec3 sum{0};
        int64_t count = 0;
    };
    constexpr double kSteps = 1 << 20;  // a metre: whole numbers have a sum whatever their order
    std::map<uint32_t, Mean> means;
    std::vector<std::pair<uint32_t, PatternPiece>> cut;
    for (uint32_t s = 0; s < sets.size(); ++s) {
        const PatternSet& set = sets[s];
        if (set.into == kNoIndex || set.reach <= 0) continue;
        const PatternPiece& other = pieces[sets[set.into].piece];
        if (set.state != kSetFallen) {
            cut.emplace_back(set.piece, cutAt(pieces[set.piece], other));
        } else {
            Mean& mean = means[sets[set.into].piece];
            mean.sum += glm::i64vec3(glm::round(glm::dvec3(pieces[set.piece].position - other.position) * kSteps));
            mean.count += 1;
        }
    }
    // All were cut at those that they met as these were before.
    for (const auto& [at, piece] : cut) pieces[at] = piece;
    for (const auto& [at, mean] : means)
        pieces[at].position += vec3(glm::dvec3(mean.sum) / (kSteps * double(mean.count + 1)));
}

}  // namespace espalier
