// Polygons become triangles: the same as by looking at every corner for every ear, but fast.
#include "tools/bake/import_polygon.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <numeric>
#include <random>

using namespace espalier::import;

namespace {

using Points = std::vector<glm::vec3>;

std::vector<uint32_t> filled(const Points& points) {
    std::vector<uint32_t> polygon(points.size()), triangles;
    std::iota(polygon.begin(), polygon.end(), 0u);
    Triangulator().fill(points, polygon, triangles);
    return triangles;
}

double areaOfFilled(const Points& points, const std::vector<uint32_t>& triangles) {
    double sum = 0;
    for (size_t i = 0; i < triangles.size(); i += 3) {
        const glm::dvec3 a(points[triangles[i]]), b(points[triangles[i + 1]]), c(points[triangles[i + 2]]);
        sum += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    return sum;
}

double turn(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    return (double(b.x) - a.x) * (double(c.y) - a.y) - (double(b.y) - a.y) * (double(c.x) - a.x);
}

// Ears of a polygon that is counter-clockwise in x and y, found by looking at all corners.
std::vector<uint32_t> slowly(const Points& points) {
    std::vector<uint32_t> left(points.size()), out;
    std::iota(left.begin(), left.end(), 0u);
    const auto ear = [&](size_t i, uint32_t(&corner)[3]) {
        const size_t n = left.size();
        for (size_t k = 0; k < 3; ++k) corner[k] = left[(i + n - 1 + k) % n];
        const glm::vec3 &a = points[corner[0]], &b = points[corner[1]], &c = points[corner[2]];
        if (!(turn(a, b, c) > 0)) return false;
        for (uint32_t v : left) {
            const glm::vec3& p = points[v];
            if (p == a || p == b || p == c) continue;
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        return true;
    };
    uint32_t corner[3];
    for (size_t at = 0; left.size() > 3;) {
        size_t tries = 0;
        while (tries < left.size() && !ear(at % left.size(), corner)) ++at, ++tries;
        ear(at % left.size(), corner);
        out.insert(out.end(), corner, corner + 3);
        left.erase(left.begin() + std::ptrdiff_t(at % left.size()));
    }
    out.insert(out.end(), left.begin(), left.end());
    return out;
}

}  // namespace

TEST_CASE("ears are those that a search of all corners finds, whatever the outline") {
    std::mt19937 random(7);
    for (int round = 0; round < 600; ++round) {
        const uint32_t n = 3 + random() % (round % 20 == 0 ? 200 : 30);
        Points points;
        for (uint32_t i = 0; i < n; ++i) {
            const float angle = 6.2831853f * float(i) / float(n), r = 1 + float(random() % 100) / 40;
            if (round % 3 == 0)
                points.push_back({r * std::cos(angle), r * std::sin(angle), 0});
            else  // crosses itself, and has places twice
                points.push_back({float(random() % 6), float(random() % 6), 0});
        }
        double area = 0;
        for (uint32_t i = 0; i < n; ++i) area += turn(points[0], points[i], points[(i + 1) % n]);
        if (area <= 0) continue;
        CAPTURE(round);
        CHECK(filled(points) == slowly(points));
    }
}

TEST_CASE("100,000 corners are filled in about a second") {
    constexpr int kTeeth = 50'000;
    Points comb{{0, -1, 0}, {kTeeth, -1, 0}}, spiral, star, spokes;
    for (int i = kTeeth; i-- > 0;) comb.insert(comb.end(), {{float(i) + 1, 0, 0}, {float(i) + 0.5f, 3, 0}});
    comb.push_back({0, 0, 0});
    for (int i = 0; i < 2 * kTeeth; ++i) {
        const float angle = 6.2831853f * float(i) / float(2 * kTeeth);
        const float winding = float(i < kTeeth ? i : 2 * kTeeth - 1 - i) * 0.01f, r = winding + (i < kTeeth ? 4 : 1);
        spiral.push_back({r * std::cos(winding), r * std::sin(winding), 0});
        const float length = 1 + float(uint32_t(i) * 2654435761u % 1000) / 1000;
        star.push_back({length * std::cos(angle), length * std::sin(angle), 0});
        spokes.push_back(i % 2 ? glm::vec3(0) : glm::vec3(std::cos(angle), std::sin(angle), 0));
    }
    const auto begin = std::chrono::steady_clock::now();
    CHECK(areaOfFilled(comb, filled(comb)) == doctest::Approx(2.5 * kTeeth));
    for (const Points* points : {&spiral, &star, &spokes}) CHECK(filled(*points).size() == 3 * (points->size() - 2));
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    MESSAGE("four of them take ", time.count(), " s");
    CHECK(time.count() < 60);  // a search of all corners would take hours
}
