// Patterns on surfaces of known geometry.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "tests/pattern/scene.hpp"

using namespace espalier;
using patterntest::Scene;

namespace {

// Whether two triangles run through each other, in double precision, by intervals along the line in which their planes
// meet.
using Tri = std::array<glm::dvec3, 3>;
bool cutsPlane(const Tri& t, const glm::dvec3& n, double d, const glm::dvec3& along, double& low, double& high) {
    double s[3];
    for (int i = 0; i < 3; ++i) s[i] = glm::dot(n, t[i]) - d;
    low = 1e300, high = -1e300;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        if ((s[i] < 0) == (s[j] < 0)) continue;
        const double at = glm::dot(along, t[i] + (t[j] - t[i]) * (s[i] / (s[i] - s[j])));
        low = std::min(low, at), high = std::max(high, at);
    }
    return low <= high;
}
bool runThrough(const Tri& a, const Tri& b, double least) {
    const glm::dvec3 n = glm::normalize(glm::cross(a[1] - a[0], a[2] - a[0]));
    const glm::dvec3 m = glm::normalize(glm::cross(b[1] - b[0], b[2] - b[0]));
    const glm::dvec3 along = glm::cross(n, m);
    if (glm::length(along) < 1e-9) return false;
    double l0, h0, l1, h1;
    if (!cutsPlane(b, n, glm::dot(n, a[0]), along, l0, h0) || !cutsPlane(a, m, glm::dot(m, b[0]), along, l1, h1))
        return false;
    return std::min(h0, h1) - std::max(l0, l1) > least;
}

struct Solid {
    std::vector<Tri> triangles;
    glm::dvec3 low{1e300}, high{-1e300};
};
Solid solidOf(const Scene& scene, const PatternPiece& p) {
    Solid solid;
    const PatternMesh& mesh = scene.meshes().meshes[p.mesh & 0xFFFF];
    for (uint32_t t = 0; t < mesh.triangleCount; ++t) {
        Tri tri;
        for (uint32_t k = 0; k < 3; ++k) {
            const vec3 v = scene.meshes().corners[mesh.firstVertex + 3 * t + k];
            tri[k] = glm::dvec3(p.position + p.x * v.x + p.y * v.y + p.z * v.z);
            solid.low = glm::min(solid.low, tri[k]), solid.high = glm::max(solid.high, tri[k]);
        }
        solid.triangles.push_back(tri);
    }
    return solid;
}
bool meet(const Solid& a, const Solid& b, double least) {
    for (int i = 0; i < 3; ++i)
        if (a.low[i] > b.high[i] || b.low[i] > a.high[i]) return false;
    for (const Tri& s : a.triangles)
        for (const Tri& t : b.triangles)
            if (runThrough(s, t, least)) return true;
    return false;
}

uint32_t meetingPairs(const Scene& scene, const GrownPattern& grown, double least) {
    std::vector<Solid> solids;
    for (const PatternPiece& p : grown.pieces) solids.push_back(solidOf(scene, p));
    uint32_t pairs = 0;
    for (size_t i = 0; i < solids.size(); ++i)
        for (size_t j = i + 1; j < solids.size(); ++j) pairs += meet(solids[i], solids[j], least);
    return pairs;
}

const char* const kLattice = R"(
angles degrees
Axiom -> P
P -> [Rz(30) T(0.6,0,0) A] [Rz(150) T(0.6,0,0) A] [Rz(-90) T(0.6,0,0) A]
A -> B [T(0.6,0,0) Rz(60) T(0.6,0,0) A] [T(0.6,0,0) Rz(-60) T(0.6,0,0) A]
B -> S(1.0, 1.0, 0.6) IC("ring")
)";

}  // namespace

TEST_CASE("scopes move, turn and scale as the paper says") {
    Scene scene(patterntest::square(8), 128);
    scene.addGrammar(R"(
angles degrees
A -> T(1, 0, 0) Rz(90) T(0, -2, 0.5) [S(2, 3, 4) I("box")] [Ry(90) S(1) I("box")])");
    scene.plant({0, 0, 0}, {1, 0, 0});
    const GrownPattern grown = scene.grow();
    REQUIRE(grown.pieces.size() == 2);
    const PatternPiece &first = grown.pieces[0], &second = grown.pieces[1];
    // Forward along +x, left is -z; after Rz(90) the scope's x axis is left, so -y is forward.
    CHECK(first.position.y == doctest::Approx(.5));
    CHECK(first.position.x - second.position.x == doctest::Approx(0));
    CHECK(glm::length(first.x) == doctest::Approx(2));
    CHECK(glm::length(first.y) == doctest::Approx(4));
    CHECK(glm::length(first.z) == doctest::Approx(3));
    CHECK(first.x.z == doctest::Approx(-2).epsilon(1e-4));
    CHECK(first.y.y == doctest::Approx(4));
    CHECK(second.x.y == doctest::Approx(-1).epsilon(1e-4));
}

TEST_CASE("the lattice of Fig. 4 is the same however it is scheduled, and no two of its rings meet") {
    Scene scene(patterntest::square(24), 256);
    scene.addGrammar(kLattice);
    scene.plant({0, 0, 0}, {1, 0, .3f}, 0, 1);
    scene.plant({4, 0, 5}, {1, 0, -.7f}, 0, 2);
    const GrownPattern one = scene.grow(1);
    CHECK(one.stats.standing > 100);
    CHECK(one.stats.fallen > 50);
    CHECK(meetingPairs(scene, one, 1e-4) == 0);
    for (const unsigned threads : {2u, 4u}) {
        std::swap(scene.seeds()[0], scene.seeds()[1]);
        const GrownPattern other = scene.grow(threads);
        CHECK(other.stats.hash == one.stats.hash);
        CHECK(other.pieces.size() == one.pieces.size());
    }
    MESSAGE("stand " << one.stats.standing << " of " << one.stats.tried << ", waves " << one.stats.waves << ", rounds "
                     << one.stats.rounds << ", ms " << one.stats.ms);
}

TEST_CASE("what has fallen culls what stands behind it in its production, and the look-ahead sees through symbols") {
    Scene scene(patterntest::square(20), 128);
    // The second box stands in the first one's place and falls; B in front of it goes on, D behind it doesn't.
    scene.addGrammar(R"(
A -> C B C D
B -> T(0, 3, 0) IC("box")
C -> F
F -> IC("box")
D -> T(0, -3, 0) E E
E -> S(1) I("ring"))");
    scene.plant({0, 0, 0}, {1, 0, 0});
    const GrownPattern grown = scene.grow();
    CHECK(grown.stats.standing == 2);
    CHECK(grown.stats.fallen == 1);
    CHECK(std::ranges::count(grown.pieces, 1u, [](const PatternPiece& p) { return p.mesh & 0xFFFFu; }) == 0);
}

TEST_CASE("a Lock stands or falls as one") {
    Scene scene(patterntest::square(20), 128);
    scene.addGrammar(R"(
A -> IC("box") [T(3, 0, 0) L] [T(6, 0, 0) L]
L -> Lock { IC("box") | [T(-3, 0, 0) IC("box")] })");
    scene.plant({-6, 0, 0}, {1, 0, 0});
    const GrownPattern grown = scene.grow();
    // The first Lock's second box meets the first box: both of it fall. The second Lock stands.
    CHECK(grown.stats.standing == 2);
    CHECK(grown.stats.fallen == 1);
    CHECK(grown.pieces.size() == 3);
}

TEST_CASE("`else` makes something in place of a piece that has been tried in vain, `omit` goes on without it") {
    const auto countOf = [](const char* text) {
        Scene scene(patterntest::square(20), 128);
        scene.addGrammar(text);
        scene.plant({0, 0, 0}, {1, 0, 0});
        const GrownPattern grown = scene.grow();
        return std::pair(std::ranges::count(grown.pieces, 0u, [](const PatternPiece& p) { return p.mesh & 0xFFFFu; }),
                         std::ranges::count(grown.pieces, 1u, [](const PatternPiece& p) { return p.mesh & 0xFFFFu; }));
    };
    using Counts = std::pair<ptrdiff_t, ptrdiff_t>;  // of boxes, of rings
    // The second box would stand in the first one.
    CHECK(countOf("A -> IC(\"box\") B\nB -> IC(\"box\") else { T(3, 0, 0) IC(\"ring\") } T(0, 3, 0) IC(\"ring\")") ==
          Counts{1, 1});
    CHECK(countOf("A -> IC(\"box\") B\nB -> T(2, 0, 0) IC(\"box\") else { T(3, 0, 0) IC(\"ring\") } T(0, 3, 0) "
                  "IC(\"ring\") T(0, 2, 0) IC(\"ring\")") == Counts{2, 2});
    CHECK(countOf("A -> IC(\"box\") B\nB -> IC(\"box\") omit T(0, 3, 0) IC(\"ring\")") == Counts{1, 1});
    // One that has been culled isn't replaced, and neither is what stands instead of one that stands.
    CHECK(countOf("A -> IC(\"box\") IC(\"box\") IC(\"box\") else { T(3, 0, 0) IC(\"ring\") }") == Counts{1, 0});
    CHECK(countOf("A -> IC(\"box\") else { T(3, 0, 0) IC(\"ring\") else { T(0, 3, 0) IC(\"ring\") } }") ==
          Counts{1, 0});
    // Nor do symbols go on that stand behind what was culled; those in braces do where they are made.
    CHECK(countOf(
              "A -> IC(\"box\") IC(\"box\") else { B } C\nB -> T(3, 0, 0) IC(\"ring\") IC(\"ring\")\nC -> T(-3, 0, 0) "
              "IC(\"ring\") IC(\"ring\")") == Counts{1, 1});
    // A Lock that falls makes room for another.
    CHECK(
        countOf("A -> IC(\"box\") Lock { IC(\"ring\") | [T(3, 0, 0) IC(\"ring\")] } else { T(3, 0, 0) IC(\"box\") }") ==
        Counts{2, 0});
}

TEST_CASE("a higher priority is derived first") {
    Scene scene(patterntest::square(20), 128);
    scene.addGrammar(R"(
A -> [T(2, 0, 0) Late] [T(0.5, 0, 0) Soon]
Late -> T(-1.5, 0, 0) IC("box") priority 0
Soon -> T(0.3, 0, 0) IC("ring") priority 3)");
    scene.plant({0, 0, 0}, {1, 0, 0});
    const GrownPattern grown = scene.grow();
    REQUIRE(grown.pieces.size() == 1);
    CHECK((grown.pieces[0].mesh & 0xFFFFu) == 1);
}

TEST_CASE("T keeps its angle to the field") {
    const float large = 2, small = .7f;
    Scene scene(patterntest::torus(large, small), 512);
    // Around the axis everywhere: the field's direction is that of the lesser curvature outside.
    scene.addGrammar("field flow : tensor\nA -> T(9, 0, 0) S(0.01) I(\"box\")");
    Field field;
    const FieldMesh& mesh = scene.mesh();
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3 p = mesh.positions[v];
        field.power.push_back(std::polar(1.0, 2 * mesh.angleOf(v, {-p.z, 0, p.x})));
        field.mean.push_back(0), field.deviator.push_back(1);
    }
    scene.setField("flow", field);
    // A way that keeps its angle of 0 to the field is a circle about the axis: it stays on its ring.
    const vec3 begin = scene.placeNear({large + small * std::cos(1.1f), small * std::sin(1.1f), 0});
    const float ring = std::hypot(begin.x, begin.z);
    scene.plant(begin, {-begin.z, 0, begin.x});
    const GrownPattern grown = scene.grow();
    REQUIRE(grown.pieces.size() == 1);
    const vec3 end = grown.pieces[0].position;
    const float turned = std::remainder(std::atan2(-end.z, end.x) - std::atan2(-begin.z, begin.x) + 9 / ring,
                                        2 * std::numbers::pi_v<float>);
    MESSAGE("off the ring by " << std::hypot(end.x, end.z) - ring << " m, along it by " << turned * ring << " m of 9");
    CHECK(std::abs(std::hypot(end.x, end.z) - ring) < .009f);
    CHECK(std::abs(end.y - begin.y) < .009f);
    CHECK(std::abs(turned * ring) < .009f);
}

TEST_CASE("a rule without an end is stopped by a limit that is named") {
    Scene scene(patterntest::torus(2, .7f, 48, 24), 128);
    scene.addGrammar("A -> [T(0.1, 0, 0) A] [S(0.01) I(\"box\")] [T(0, 0.1, 0) A]");
    scene.plant({2.7f, 0, 0}, {0, 0, 1});
    const Result<GrownPattern> grown = scene.tryGrow({.maxPieces = 20000, .maxDepth = 4096});
    REQUIRE_FALSE(grown);
    CHECK(grown.failure().text().find("more than 20000 meshes") != std::string::npos);

    Scene barren(patterntest::torus(2, .7f, 48, 24), 128);
    barren.addGrammar("A -> [T(0.1, 0, 0) A] [T(0, 0.1, 0) A] B\nB -> T(0, 0, 1) : 0.5\nB -> S(0.1) IC(\"box\") : 0.5");
    barren.plant({2.7f, 0, 0}, {0, 0, 1});
    const Result<GrownPattern> none = barren.tryGrow({.maxShapes = 3000, .shapesPerSet = 10});
    REQUIRE_FALSE(none);
    CHECK(none.failure().text().find("does a rule go on for ever?") != std::string::npos);

    // What stands as it is, without meeting others, pays for as many symbols as it likes.
    Scene free(patterntest::torus(2, .7f, 48, 24), 128);
    free.addGrammar("A -> [T(0.1, 0, 0) A] [T(0, 0.1, 0) A] I(\"box\")");
    free.plant({2.7f, 0, 0}, {0, 0, 1});
    const Result<GrownPattern> most = free.tryGrow({.maxWaiting = 50000});
    REQUIRE_FALSE(most);
    CHECK(most.failure().text().find("more than 50000 symbols wait at once") != std::string::npos);
}
