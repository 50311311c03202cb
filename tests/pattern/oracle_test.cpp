// Grammars in the plane, derived one shape after the other in double precision: interpreters of one grammar each that
// share no text with the kernels.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <vector>

#include "tests/pattern/keys.hpp"
#include "tests/pattern/scene.hpp"

using namespace espalier;
using patterntest::child;
using patterntest::Scene;
using patterntest::stir;

namespace {

using Vec = glm::dvec2;  // along +x and -z: counterclockwise as seen from above

constexpr double kLarge = .4, kSmall = .1;

struct Frame {
    Vec at;
    double turn;
    Frame moved(double by) const { return {at + by * Vec(std::cos(turn), std::sin(turn)), turn}; }
    Frame turned(double degrees) const { return {at, turn + degrees * std::numbers::pi / 180}; }
};
struct Waiting {
    uint64_t key;
    Frame frame;
};

// How far two rings in one plane are from meeting, metres; negative: they do. Equal rings in one plane meet until they
// lie beside each other.
double gapOf(Vec a, Vec b) {
    return glm::length(a - b) - 2 * kLarge - 2 * kSmall;
}

// Of two squares, the distance along the axis that parts them best, metres; negative: they overlap.
struct Square {
    Frame frame;
    double side;
    double reachAlong(Vec axis) const {
        const Vec x(std::cos(frame.turn), std::sin(frame.turn)), y(-x.y, x.x);
        return side / 2 * (std::abs(glm::dot(axis, x)) + std::abs(glm::dot(axis, y)));
    }
};
double gapOf(const Square& a, const Square& b) {
    double gap = -1e9;
    for (const double turn :
         {a.frame.turn, a.frame.turn + std::numbers::pi / 2, b.frame.turn, b.frame.turn + std::numbers::pi / 2}) {
        const Vec axis(std::cos(turn), std::sin(turn));
        gap =
            std::max(gap, std::abs(glm::dot(axis, a.frame.at - b.frame.at)) - a.reachAlong(axis) - b.reachAlong(axis));
    }
    return gap;
}

}  // namespace

TEST_CASE("the kernels place what a sequential derivation places") {
    constexpr double kHalf = 7;
    Scene scene(patterntest::square(2 * kHalf), 256);
    scene.addGrammar(R"(
angles degrees
Axiom -> P
P -> [Rz(30) T(1.5,0,0) A] [Rz(150) T(1.5,0,0) A] [Rz(-90) T(1.5,0,0) A]
A -> B [T(0.75,0,0) Rz(60) T(0.75,0,0) A] [T(0.75,0,0) Rz(-60) T(0.75,0,0) A]
B -> IC("ring"))");
    const vec3 begin = scene.placeNear({.2f, 0, -.1f});
    scene.plant(begin, {1, 0, 0}, 0, 5);
    const GrownPattern grown = scene.grow(2);

    const Frame seed{{double(begin.x), -double(begin.z)}, 0};
    const uint64_t axiom = stir(5), p = child(axiom, "P", 0);
    std::vector<Waiting> wave;
    const double turns[] = {30, 150, -90};
    for (uint32_t i = 0; i < 3; ++i) wave.push_back({child(p, "A", i), seed.turned(turns[i]).moved(1.5)});
    std::vector<Vec> placed;
    bool doubtful = false;
    const auto inside = [&](Vec v) { return std::abs(v.x) < kHalf && std::abs(v.y) < kHalf; };
    while (!wave.empty()) {
        std::ranges::sort(wave, {}, &Waiting::key);
        std::vector<Waiting> next;
        for (const Waiting& w : wave) {
            if (!inside(w.frame.at)) continue;
            const double edge = kHalf - std::max(std::abs(w.frame.at.x), std::abs(w.frame.at.y));
            doubtful = doubtful || edge < 1e-3;
            double gap = 1;
            for (const Vec& other : placed) gap = std::min(gap, gapOf(w.frame.at, other));
            doubtful = doubtful || std::abs(gap) < 1e-3;
            if (gap < 0) continue;
            placed.push_back(w.frame.at);
            const Frame half = w.frame.moved(.75);
            next.push_back({child(w.key, "A", 0), half.turned(60).moved(.75)});
            next.push_back({child(w.key, "A", 1), half.turned(-60).moved(.75)});
        }
        wave = std::move(next);
    }
    REQUIRE_FALSE(doubtful);
    CHECK(placed.size() > 40);
    REQUIRE(grown.pieces.size() == placed.size());
    for (const PatternPiece& piece : grown.pieces) {
        const Vec at(double(piece.position.x), -double(piece.position.z));
        const auto near = [&](const Vec& v) { return glm::length(v - at) < 2e-3; };
        CHECK(std::ranges::count_if(placed, near) == 1);
    }
}

TEST_CASE("with `else` and `omit`, too, the kernels place what a sequential derivation places") {
    constexpr double kHalf = 8, kSmallSide = .42;
    Scene scene(patterntest::square(2 * kHalf), 256);
    scene.addGrammar(R"(
angles degrees
A -> IC("box") else { S(0.42) T(0.86,0,0) IC("box") [T(1.1,0,0) Rz(23) S(1) A] } [T(1.3,0,0) Rz(37) A] [Rz(141) T(1.6,0,0) IC("box") omit T(0.9,0,0) A])");
    const vec3 begin = scene.placeNear({.2f, 0, -.1f});
    scene.plant(begin, {1, 0, 0}, 0, 7);
    const GrownPattern grown = scene.grow(2);

    struct Shape {
        uint64_t key;
        Square scope;
    };
    std::vector<Shape> wave{{stir(7), {{{double(begin.x), -double(begin.z)}, 0}, 1}}};
    std::vector<Square> placed;
    bool doubtful = false;
    const auto inside = [&](Vec v) {
        const double edge = kHalf - std::max(std::abs(v.x), std::abs(v.y));
        doubtful = doubtful || std::abs(edge) < 1e-3;
        return edge > 0;
    };
    const auto tried = [&](const Square& s) {
        if (!inside(s.frame.at)) return false;
        double gap = 1;
        for (const Square& other : placed) gap = std::min(gap, gapOf(s, other));
        doubtful = doubtful || std::abs(gap) < 2e-4;
        if (gap >= 0) placed.push_back(s);
        return gap >= 0;
    };
    for (uint32_t waves = 0; !wave.empty() && waves < 200; ++waves) {
        std::ranges::sort(wave, {}, &Shape::key);
        std::vector<Shape> next;
        const auto goOn = [&](const Shape& from, uint32_t ordinal, const Frame& at, double side) {
            if (inside(at.at)) next.push_back({child(from.key, "A", ordinal), {at, side}});
        };
        for (const Shape& shape : wave) {
            const Frame& f = shape.scope.frame;
            if (tried(shape.scope)) {
                goOn(shape, 1, f.moved(1.3).turned(37), 1);
                const Frame aside = f.turned(141).moved(1.6);
                tried({aside, shape.scope.side});
                goOn(shape, 2, aside.moved(.9), 1);
            } else if (const Square small{f.moved(.86), kSmallSide}; tried(small)) {
                goOn(shape, 0, small.frame.moved(1.1).turned(23), 1);
            }
        }
        wave = std::move(next);
    }
    REQUIRE_FALSE(doubtful);
    CHECK(std::ranges::count(placed, kSmallSide, &Square::side) > 10);
    CHECK(std::ranges::count(placed, 1.0, &Square::side) > 10);
    REQUIRE(grown.pieces.size() == placed.size());
    for (const PatternPiece& piece : grown.pieces) {
        const Vec at(double(piece.position.x), -double(piece.position.z));
        const auto same = [&](const Square& s) {
            return glm::length(s.frame.at - at) < 2e-3 && std::abs(s.side - glm::length(piece.x)) < 1e-3;
        };
        CHECK(std::ranges::count_if(placed, same) == 1);
    }
}
