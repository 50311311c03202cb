// Lines that end where they cross others, and pieces that go into like ones: against a sequential derivation in double
// precision that shares no text with the kernels, and by brute force.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "shaders/shared/exact.h"
#include "tests/pattern/keys.hpp"
#include "tests/pattern/scene.hpp"

using namespace espalier;
using patterntest::child;
using patterntest::Scene;
using patterntest::stir;

namespace {

using Vec = glm::dvec2;  // along +x and -z: counterclockwise as seen from above

constexpr double kWidth = .02;
constexpr double kLength = .5;

double across(Vec a, Vec b) {
    return a.x * b.y - a.y * b.x;
}

struct Segment {
    Vec begin, end;
    double kept = 1;
};
struct Share {
    double own, other;
};
// Where two straight lines cross, as shares of their lengths; none: they are parallel.
std::optional<Share> shareOf(const Segment& a, const Segment& b) {
    const Vec x = a.end - a.begin, y = b.end - b.begin, off = b.begin - a.begin;
    const double c = across(x, y);
    if (std::abs(c) < 1e-9) return std::nullopt;
    return Share{across(off, y) / c, across(off, x) / c};
}

// Pairs that cross away from the ends of both, as far as `near` metres.
int crossings(const std::vector<Segment>& all, double near) {
    int found = 0;
    for (size_t i = 0; i < all.size(); ++i)
        for (size_t j = i + 1; j < all.size(); ++j) {
            const std::optional<Share> s = shareOf(all[i], all[j]);
            if (!s) continue;
            const double a = near / glm::length(all[i].end - all[i].begin);
            const double b = near / glm::length(all[j].end - all[j].begin);
            found += s->own > a && s->own < 1 - a && s->other > b && s->other < 1 - b;
        }
    return found;
}

// As lines are where they have grown on the square.
std::vector<Segment> flatLines(const GrownPattern& grown) {
    std::vector<Segment> all;
    for (const PatternPiece& p : grown.pieces) {
        const vec3 end = p.position + p.x;
        all.push_back({{p.position.x, -p.position.z}, {end.x, -end.z}});
    }
    return all;
}

std::string veins(const char* line) {
    return std::string("angles degrees\nA -> V [Rz(125) V] [Rz(-118) V]\nV -> Rz(17) ") + line +
           " { T(0.5, 0, 0) LineSeg(\"box\", 0.02) V [Rz(81) V] }";
}

}  // namespace

TEST_CASE("lines end where those before them in a sequential derivation are") {
    constexpr double kHalf = 4;
    Scene scene(patterntest::square(2 * kHalf), 256);
    scene.addGrammar(veins("Line(merge)"));
    const vec3 begin = scene.placeNear({.2f, 0, -.1f});
    scene.plant(begin, {1, 0, 0}, 0, 3);
    const GrownPattern grown = scene.grow(2);

    struct Tip {
        uint64_t key;
        Vec at;
        double turn;
    };
    const uint64_t axiom = stir(3);
    std::vector<Tip> wave;
    const double turns[] = {0, 125, -118};
    for (uint32_t i = 0; i < 3; ++i)
        wave.push_back({child(axiom, "V", i), {begin.x, -begin.z}, turns[i] * std::numbers::pi / 180});
    std::vector<Segment> placed;
    bool doubtful = false;
    const auto beyond = [&](double value, double limit) {
        doubtful = doubtful || std::abs(value - limit) < 1e-4;
        return value > limit;
    };
    const auto cut = [&](Segment& own) {
        const double length = glm::length(own.end - own.begin);
        for (const Segment& other : placed) {
            const std::optional<Share> s = shareOf(own, other);
            const double there = s ? s->other * kLength : 0;
            // Both far apart: no question.
            if (!s || std::abs(s->own) > 3 || std::abs(s->other) > 3) continue;
            if (!beyond(s->own * length, .05 * kWidth) || beyond(s->own * length, length + .1 * kWidth)) continue;
            if (!beyond(there, -.05 * kWidth) || beyond(there, kLength + .05 * kWidth)) continue;
            // What was cut is there up to where it ends.
            if (other.kept < 1 && beyond(there, other.kept * kLength)) continue;
            own.kept = std::min(own.kept, s->own);
        }
    };
    int cuts = 0;
    while (!wave.empty()) {
        std::ranges::sort(wave, {}, &Tip::key);
        std::vector<Tip> next;
        for (const Tip& tip : wave) {
            const double turn = tip.turn + 17 * std::numbers::pi / 180;
            Segment own{tip.at, tip.at + kLength * Vec(std::cos(turn), std::sin(turn))};
            const double edge = kHalf - std::max(std::abs(own.end.x), std::abs(own.end.y));
            doubtful = doubtful || std::abs(edge) < 1e-3;
            if (edge < 0) continue;
            cut(own);
            placed.push_back(own);
            if (own.kept < 1) {
                ++cuts;
                continue;
            }
            next.push_back({child(tip.key, "V", 0), own.end, turn});
            next.push_back({child(tip.key, "V", 1), own.end, turn + 81 * std::numbers::pi / 180});
        }
        wave = std::move(next);
    }
    REQUIRE_FALSE(doubtful);
    CHECK(placed.size() > 100);
    CHECK(cuts > 30);
    REQUIRE(grown.pieces.size() == placed.size());
    for (const Segment& s : flatLines(grown)) {
        const auto same = [&](const Segment& o) {
            const Vec end = o.begin + (o.end - o.begin) * o.kept;
            return glm::length(s.begin - o.begin) < 2e-3 && glm::length(s.end - end) < 2e-3;
        };
        CHECK(std::ranges::count_if(placed, same) == 1);
    }
}

TEST_CASE("no two merged lines cross, whatever the schedule, and each that was cut ends on another") {
    Scene scene(patterntest::square(12), 256);
    scene.addGrammar(veins("Line(merge)"));
    for (int i = 0; i < 5; ++i)
        scene.plant({float(i) * 1.7f - 3, 0, std::sin(float(i)) * 3}, {std::cos(float(i)), 0, .4f}, 0, uint64_t(i) + 1);
    const GrownPattern grown = scene.grow(1);
    const std::vector<Segment> lines = flatLines(grown);
    CHECK(lines.size() > 500);
    CHECK(crossings(lines, .0025) == 0);
    int cuts = 0;
    for (const Segment& s : lines) {
        if (glm::length(s.end - s.begin) > kLength - 2e-3) continue;
        ++cuts;
        double nearest = 1;
        for (const Segment& o : lines) {
            const Vec along = o.end - o.begin;
            const double t = std::clamp(glm::dot(s.end - o.begin, along) / glm::dot(along, along), 0.0, 1.0);
            if (&o != &s) nearest = std::min(nearest, glm::length(o.begin + along * t - s.end));
        }
        CHECK(nearest < kWidth / 2);
    }
    CHECK(cuts > 100);
    for (const unsigned threads : {2u, 4u}) {
        std::swap(scene.seeds()[0], scene.seeds()[3]);
        const GrownPattern other = scene.grow(threads);
        CHECK(other.stats.hash == grown.stats.hash);
        REQUIRE(other.pieces.size() == grown.pieces.size());
        for (size_t i = 0; i < other.pieces.size(); ++i) CHECK(other.pieces[i].x == grown.pieces[i].x);
    }
    MESSAGE("segments " << lines.size() << ", cut " << cuts << ", waves " << grown.stats.waves << ", rounds "
                        << grown.stats.rounds);
}

TEST_CASE("lines without merging cross") {
    Scene scene(patterntest::square(4), 128);
    scene.addGrammar(veins("Line"));
    scene.plant({0, 0, 0}, {1, 0, 0});
    Result<GrownPattern> grown = scene.tryGrow({.maxPieces = 4'000'000, .maxDepth = 8});
    REQUIRE(grown);
    CHECK(crossings(flatLines(*grown), .0025) > 10);
}

TEST_CASE("a line has no break where its segments meet, and its ends lie on those that cut it") {
    Scene scene(patterntest::torus(2, .7f), 512);
    scene.addGrammar(
        "angles degrees\nA -> V [Rz(120) V] [Rz(-120) V]\nV -> Line(merge) { T(0.15, 0, 0) Rz(rand(-12, 12)) "
        "LineSeg(\"box\", 0.03) V [Rz(rand(60, 100)) V] }");
    scene.plant({2.7f, 0, 0}, {0, 0, 1});
    const GrownPattern grown = scene.grow(2);
    const auto tangent = [](float bits) { return unpackOct(floatBitsToUint(bits)); };
    int joints = 0, ends = 0;
    for (const PatternPiece& p : grown.pieces) {
        const vec3 end = p.position + p.x;
        float least = 4;
        double nearest = 1;
        for (const PatternPiece& q : grown.pieces) {
            if (&p == &q || glm::length(q.position - end) > .3f) continue;
            if (glm::length(q.position - end) < 1e-5f)
                least = std::min(least, std::acos(std::min(1.f, glm::dot(tangent(p.z.y), tangent(q.z.x)))));
            // The other's curve, by many chords.
            for (int i = 0; i <= 64; ++i) {
                const float t = float(i) / 64, u = 1 - t, third = glm::length(q.x) / 3;
                const vec3 a = tangent(q.z.x) * third, b = q.x - tangent(q.z.y) * third;
                const vec3 at = q.position + a * (3 * t * u * u) + b * (3 * t * t * u) + q.x * (t * t * t);
                nearest = std::min<double>(nearest, glm::length(at - end));
            }
        }
        // What was cut may end where others meet.
        if (least < 4 && glm::length(p.x) > .148f) {
            ++joints;
            CHECK(least < 1 * std::numbers::pi / 180);
        } else {
            ++ends;
            CHECK(nearest < .03 / 2);
        }
    }
    CHECK(joints > 1000);
    CHECK(ends > 500);
}

TEST_CASE("on a torus, too, no two merged lines cross") {
    const double large = 2, small = .7;
    Scene scene(patterntest::torus(float(large), float(small)), 512);
    scene.addGrammar(
        "angles degrees\nA -> V [Rz(120) V] [Rz(-120) V]\nV -> Rz(rand(-25, 25)) Line(merge) { T(0.15, 0, 0) "
        "LineSeg(\"box\", 0.03) V [Rz(rand(60, 100)) V] }");
    scene.plant({2.7f, 0, 0}, {0, 0, 1});
    scene.plant({-2, .7f, 0}, {1, 0, 1}, 0, 2);
    const GrownPattern grown = scene.grow(2);
    // Pairs that cross farther than half a width from all ends, as they are seen along the normal where the first one's
    // middle lies.
    int crossing = 0;
    for (size_t i = 0; i < grown.pieces.size(); ++i) {
        const glm::dvec3 a = grown.pieces[i].position, along = grown.pieces[i].x, middle = a + along / 2.0;
        const glm::dvec3 ring = glm::normalize(glm::dvec3(middle.x, 0, middle.z)) * large;
        const glm::dvec3 normal = glm::normalize(middle - ring), aside = glm::normalize(glm::cross(normal, along));
        const glm::dvec3 ahead = glm::cross(aside, normal);
        const auto seen = [&](glm::dvec3 p) { return Vec(glm::dot(ahead, p - a), glm::dot(aside, p - a)); };
        for (size_t j = i + 1; j < grown.pieces.size(); ++j) {
            const glm::dvec3 b = grown.pieces[j].position, end = b + glm::dvec3(grown.pieces[j].x);
            if (glm::length(b - a) > .3) continue;
            crossing += crossings({{seen(a), seen(a + along)}, {seen(b), seen(end)}}, .008);
        }
    }
    CHECK(grown.pieces.size() > 5000);
    CHECK(crossing == 0);
}

TEST_CASE("a piece goes into a like one within its distance and turn, which moves to the middle of all") {
    const auto grownOf = [](const char* text) {
        Scene scene(patterntest::square(20), 128);
        scene.addGrammar(text);
        scene.plant({0, 0, 0}, {1, 0, 0});
        return scene.grow();
    };
    // B stands behind the first piece, C behind the second, which goes into it.
    const GrownPattern merged = grownOf(
        "angles degrees\nA -> IM(\"box\", 0.5, 20) B [T(0.4, 0, 0) Rz(15) Second]\nSecond -> IM(\"box\", 0.5, 20) C\n"
        "B -> T(0, 3, 0) I(\"ring\")\nC -> T(0, -3, 0) I(\"ring\")");
    REQUIRE(merged.pieces.size() == 2);
    CHECK(merged.pieces[0].position.x - merged.pieces[1].position.x == doctest::Approx(.2).epsilon(1e-3));
    // Too far, turned too far, of another mesh, not tried to be merged.
    for (const char* second : {"T(0.6, 0, 0) IM(\"box\", 0.5, 20)", "T(0.4, 0, 0) Rz(25) IM(\"box\", 0.5, 20)",
                               "T(0.4, 0, 0) IM(\"ring\", 0.5, 20)", "T(0.4, 0, 0) IC(\"box\")"})
        CHECK(grownOf((std::string("angles degrees\nA -> IM(\"box\", 0.5, 20) B\nB -> ") + second +
                       " omit T(1, 0, 0) C\nC -> I(\"ring\")")
                          .c_str())
                  .pieces.size() == 3);
    // Into the nearest of two.
    const GrownPattern nearest = grownOf(
        "angles degrees\nA -> IM(\"box\", 0.1, 20) [T(1, 0, 0) IM(\"box\", 0.1, 20)] [T(0.7, 0, 0) B]\nB -> "
        "IM(\"box\", 0.9, 20)");
    REQUIRE(nearest.pieces.size() == 2);
    CHECK(std::abs(nearest.pieces[0].position.x - nearest.pieces[1].position.x) == doctest::Approx(.85).epsilon(1e-3));
}

TEST_CASE("pieces that merge stand where those before them in a sequential derivation leave room") {
    constexpr double kHalf = 5, kReach = .8;
    Scene scene(patterntest::square(2 * kHalf), 256);
    scene.addGrammar(
        "angles degrees\nA -> S(0.2) IM(\"box\", 0.8, 180) [T(1, 0, 0) Rz(23) A] [Rz(107) T(1.1, 0, 0) A]");
    const vec3 begin = scene.placeNear({.2f, 0, -.1f});
    scene.plant(begin, {1, 0, 0}, 0, 9);
    const GrownPattern grown = scene.grow(2);

    struct Shape {
        uint64_t key;
        Vec at;
        double turn;
    };
    struct Group {
        Vec anchor, sum;
        int count;
    };
    std::vector<Shape> wave{{stir(9), {begin.x, -begin.z}, 0}};
    std::vector<Group> groups;
    bool doubtful = false;
    int merged = 0;
    while (!wave.empty()) {
        std::ranges::sort(wave, {}, &Shape::key);
        std::vector<Shape> next;
        // Who goes into whom is found among all of the wave that stand before it.
        for (const Shape& s : wave) {
            Group* nearest = nullptr;
            for (Group& g : groups) {
                const double distance = glm::length(g.anchor - s.at);
                doubtful = doubtful || std::abs(distance - kReach) < 1e-3;
                if (distance > kReach) continue;
                if (!nearest || distance < glm::length(nearest->anchor - s.at)) nearest = &g;
            }
            if (nearest) {
                nearest->sum += s.at;
                nearest->count += 1;
                ++merged;
                continue;
            }
            groups.push_back({s.at, s.at, 1});
            const auto goOn = [&](uint32_t ordinal, double turn, double by, double turnAfter) {
                const Vec at = s.at + by * Vec(std::cos(turn), std::sin(turn));
                const double edge = kHalf - std::max(std::abs(at.x), std::abs(at.y));
                doubtful = doubtful || std::abs(edge) < 1e-3;
                if (edge > 0) next.push_back({child(s.key, "A", ordinal), at, turnAfter});
            };
            constexpr double kDegree = std::numbers::pi / 180;
            goOn(0, s.turn, 1, s.turn + 23 * kDegree);
            goOn(1, s.turn + 107 * kDegree, 1.1, s.turn + 107 * kDegree);
        }
        wave = std::move(next);
    }
    REQUIRE_FALSE(doubtful);
    CHECK(groups.size() > 30);
    CHECK(merged > 30);
    REQUIRE(grown.pieces.size() == groups.size());
    for (const PatternPiece& p : grown.pieces) {
        const Vec at(p.position.x, -p.position.z);
        CHECK(std::ranges::count_if(
                  groups, [&](const Group& g) { return glm::length(g.sum / double(g.count) - at) < 2e-3; }) == 1);
    }
}
