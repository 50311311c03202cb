#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "runtime/surface/mesh_tree.hpp"

using namespace espalier;

namespace {

struct Soup {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
};

Soup randomSoup(uint32_t triangles, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> at(-1, 1), near(-.2f, .2f);
    Soup soup;
    for (uint32_t i = 0; i < triangles; ++i) {
        const glm::vec3 centre(at(random), at(random), at(random));
        for (int k = 0; k < 3; ++k) {
            soup.indices.push_back(uint32_t(soup.positions.size()));
            soup.positions.push_back(centre + glm::vec3(near(random), near(random), near(random)));
        }
    }
    return soup;
}

// In double precision and by another way: solves for the plane's crossing, then sums signed areas.
double rayTriangle(const Soup& soup, uint32_t t, glm::dvec3 o, glm::dvec3 d) {
    const glm::dvec3 a(soup.positions[soup.indices[3 * t]]), b(soup.positions[soup.indices[3 * t + 1]]),
        c(soup.positions[soup.indices[3 * t + 2]]);
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double along = glm::dot(n, d);
    if (along == 0) return INFINITY;
    const double s = glm::dot(n, a - o) / along;
    if (s < 0) return INFINITY;
    const glm::dvec3 p = o + s * d;
    const double u = glm::dot(n, glm::cross(b - a, p - a)), v = glm::dot(n, glm::cross(c - b, p - b)),
                 w = glm::dot(n, glm::cross(a - c, p - c));
    return u >= 0 && v >= 0 && w >= 0 ? s : INFINITY;
}

// By sampling: the triangle is cut finely, so that the result is above the truth by at most the cut.
double pointTriangle(const Soup& soup, uint32_t t, glm::dvec3 p) {
    const glm::dvec3 a(soup.positions[soup.indices[3 * t]]), b(soup.positions[soup.indices[3 * t + 1]]),
        c(soup.positions[soup.indices[3 * t + 2]]);
    double best = INFINITY;
    const int cuts = 60;
    for (int i = 0; i <= cuts; ++i)
        for (int j = 0; i + j <= cuts; ++j)
            best = std::min(best, glm::length(p - (a + (b - a) * (double(i) / cuts) + (c - a) * (double(j) / cuts))));
    return best;
}

}  // namespace

TEST_CASE("an empty tree and a degenerate triangle meet no ray") {
    const MeshTree empty;
    CHECK(!empty.pick({0, 0, 5}, {0, 0, -1}));
    CHECK(!empty.nearest({0, 0, 0}));
    const std::vector<glm::vec3> points{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const std::vector<uint32_t> indices{0, 1, 2};
    const MeshTree point(points, indices);
    CHECK(!point.pick({0, 0, 5}, {0, 0, -1}));
    REQUIRE(point.nearest({0, 3, 4}));
    CHECK(point.nearest({0, 3, 4})->distance == doctest::Approx(5));
}

TEST_CASE("rays and points find what trying every triangle finds") {
    for (uint32_t count : {1u, 4u, 5u, 63u, 300u}) {
        const Soup soup = randomSoup(count, count);
        const MeshTree tree(soup.positions, soup.indices);
        std::mt19937 random(7);
        std::uniform_real_distribution<float> at(-2, 2);
        for (int i = 0; i < 200; ++i) {
            const glm::vec3 o(at(random), at(random), at(random)), d(at(random), at(random), at(random));
            double expected = INFINITY;
            for (uint32_t t = 0; t < count; ++t) expected = std::min(expected, rayTriangle(soup, t, o, d));
            const auto hit = tree.pick(o, d);
            REQUIRE(bool(hit) == std::isfinite(expected));
            if (hit) {
                CHECK(hit->distance == doctest::Approx(expected).epsilon(1e-4));
                CHECK(glm::length(hit->position - (o + d * hit->distance)) < 1e-4);
            }
        }
        for (int i = 0; i < 10; ++i) {
            const glm::vec3 p(at(random), at(random), at(random));
            double expected = INFINITY;
            for (uint32_t t = 0; t < count; ++t) expected = std::min(expected, pointTriangle(soup, t, p));
            const auto hit = tree.nearest(p);
            REQUIRE(hit);
            CHECK(hit->distance <= expected + 1e-5);
            CHECK(hit->distance >= expected - .02);  // as fine as the oracle cuts
            CHECK(glm::length(hit->position - p) == doctest::Approx(hit->distance).epsilon(1e-4));
            CHECK(!tree.nearest(p, hit->distance * .99f));
            // Asked for any place near enough, it gives one; where none is, the nearest.
            const float generous = hit->distance * 1.5f, strict = hit->distance * .99f;
            const auto any = tree.nearest(p, INFINITY, generous), exact = tree.nearest(p, INFINITY, strict);
            REQUIRE((any && exact));
            CHECK(any->distance <= generous);
            CHECK(any->distance >= hit->distance);
            CHECK(exact->distance == hit->distance);
        }
    }
}

TEST_CASE("a ray along an axis meets an axis-aligned wall") {
    const std::vector<glm::vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<uint32_t> indices{0, 1, 2};
    const MeshTree wall(points, indices);
    const auto hit = wall.pick({.25f, .25f, 2}, {0, 0, -4});
    REQUIRE(hit);
    CHECK(hit->distance == doctest::Approx(.5));
    CHECK(hit->weights.x == doctest::Approx(.25));
    CHECK(hit->weights.y == doctest::Approx(.25));
    CHECK(!wall.pick({.25f, .25f, 2}, {0, 0, 4}));
    CHECK(!wall.pick({.25f, .25f, 2}, {0, 0, -4}, .5f));
}
