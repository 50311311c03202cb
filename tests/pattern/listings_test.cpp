// What the listings of Li 2011, §4.4, place, counted by hand; and how often rules are chosen.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "tests/pattern/scene.hpp"

using namespace espalier;
using patterntest::Scene;

namespace {

// Ten shapes in a row, two metres apart. Rings lie where the first, fourth, seventh and tenth would place their piece.
constexpr const char* kRow =
    "Axiom -> [T(-9, 0, 0) Ring(0)] [T(-9, 0, 0) Row(0)]\n"
    "Ring(k) : k < 4 -> [T(0, 2, 0) IC(\"ring\")] [T(6, 0, 0) Ring(k + 1)] priority 7\n"
    "Row(n) : n < 10 -> [A] [T(2, 0, 0) Row(n + 1)]\n";

// Boxes that stand so far to the left of the row, in metres.
int boxesAt(const GrownPattern& grown, float left) {
    return int(std::ranges::count_if(grown.pieces, [&](const PatternPiece& p) {
        return (p.mesh & 0xFFFFu) == 0 && std::abs(-p.position.z - left) < .1f;
    }));
}
// On the seed's own place as the origin.
GrownPattern rowOf(const std::string& rules) {
    Scene scene(patterntest::square(24), 128);
    scene.addGrammar(kRow + rules);
    const vec3 middle = scene.placeNear({0, 0, 0});
    scene.plant(middle, {1, 0, 0});
    GrownPattern grown = scene.grow(2);
    for (PatternPiece& p : grown.pieces) p.position -= middle;
    return grown;
}

// Pearson's sum over classes of given shares.
double chiSquare(std::span<const int> counts, std::span<const double> shares) {
    double all = 0, sum = 0;
    for (int n : counts) all += n;
    for (size_t i = 0; i < counts.size(); ++i) sum += std::pow(counts[i] - shares[i] * all, 2) / (shares[i] * all);
    return sum;
}

// 2^17 of symbol B, each by a path of its own.
constexpr const char* kMany = "Axiom -> A(17)\nA(n) : n > 0 -> A(n - 1) A(n - 1)\nA(n) : otherwise -> B\n";

GrownPattern manyOf(const std::string& rules) {
    Scene scene(patterntest::square(2), 64);
    scene.addGrammar(kMany + rules);
    scene.plant({0, 0, 0}, {1, 0, 0});
    Result<GrownPattern> grown = scene.tryGrow({.maxShapes = 1u << 20}, 2);
    if (!grown) FAIL(grown.failure().text());
    return std::move(*grown);
}

}  // namespace

TEST_CASE("the listing of Lock: a component that collides takes its set with it") {
    const GrownPattern grown = rowOf(R"(
A -> Pattern
Pattern -> Lock{ Component1 | Component2 | Component3 }
Component1 -> IC("box")
Component2 -> T(0, 2, 0) IC("box")
Component3 -> T(0, 4, 0) IC("box"))");
    CHECK(grown.stats.standing == 4 + 6);
    CHECK(grown.stats.fallen == 4);
    for (float left : {0.f, 2.f, 4.f}) CHECK(boxesAt(grown, left) == 6);
}

TEST_CASE("the listing of culling: what stands in front is derived, what stands behind isn't") {
    const GrownPattern grown = rowOf(R"(
A -> B [T(0, 2, 0) IC("box")] D E
B -> T(0, -2, 0) I("box") NULL
D -> T(0, 4, 0) I("box") NULL
E -> T(0, 6, 0) I("box") NULL)");
    CHECK(boxesAt(grown, -2) == 10);
    for (float left : {2.f, 4.f, 6.f}) CHECK(boxesAt(grown, left) == 6);
    CHECK(grown.pieces.size() == 4 + 10 + 3 * 6);
}

TEST_CASE("the listing of look-ahead: a piece that only appears two rules later culls all the same") {
    const GrownPattern grown = rowOf(R"(
A -> B C D E
B -> T(0, -2, 0) I("box")
C -> F
F -> T(0, 2, 0) IC("box")
D -> T(0, 4, 0) I("box")
E -> T(0, 6, 0) I("box"))");
    CHECK(boxesAt(grown, -2) == 10);
    for (float left : {2.f, 4.f, 6.f}) CHECK(boxesAt(grown, left) == 6);
}

TEST_CASE("rules are chosen as often as their probabilities say") {
    const GrownPattern grown = manyOf("B -> I(\"box\") : 0.5\nB -> I(\"ring\") : 0.3\nB -> S(0.5) I(\"ring\") : 0.2");
    REQUIRE(grown.pieces.size() == 1 << 17);
    std::array<int, 3> counts{};
    for (const PatternPiece& p : grown.pieces)
        counts[(p.mesh & 0xFFFFu) == 0 ? 0 : glm::length(p.x) > .75f ? 1 : 2] += 1;
    const std::array<double, 3> shares{.5, .3, .2};
    MESSAGE("chi square " << chiSquare(counts, shares));
    CHECK(chiSquare(counts, shares) < 13.82);  // which one in a thousand exceeds, of two degrees of freedom
}

TEST_CASE("random numbers are even, and neighbours' don't hang together") {
    const GrownPattern grown = manyOf("B -> S(1 + rand(), 1, 1 + rand()) I(\"box\")");
    REQUIRE(grown.pieces.size() == 1 << 17);
    std::array<int, 64> counts{};
    std::array<double, 64> shares;
    shares.fill(1. / 64);
    const auto eighth = [](vec3 axis) { return std::clamp(int((glm::length(axis) - 1) * 8), 0, 7); };
    for (const PatternPiece& p : grown.pieces) counts[8 * eighth(p.x) + eighth(p.y)] += 1;
    MESSAGE("chi square " << chiSquare(counts, shares));
    CHECK(chiSquare(counts, shares) < 103.4);  // one in a thousand, of 63 degrees of freedom
}
