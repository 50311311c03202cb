// Spans between samples: ends, tangents, frames, against the paper's formulas in double precision.
#include "shaders/shared/bezier.h"

#include <cmath>
#include <random>

#include <doctest/doctest.h>

using namespace espalier;

namespace {

vec3 randomUnit(std::mt19937& random) {
    std::normal_distribution<float> n;
    return glm::normalize(vec3{n(random), n(random), n(random)});  // braces: in one order with every compiler
}

}  // namespace

TEST_CASE("smooth spans pass their samples along the tangents; neighbours join without a break") {
    std::mt19937 random(1);
    for (int i = 0; i < 2000; ++i) {
        vec3 p[4], n[4];
        p[0] = randomUnit(random);
        n[0] = randomUnit(random);
        for (int k = 1; k < 4; ++k) {
            p[k] = p[k - 1] + randomUnit(random) * 0.3f;
            n[k] = randomUnit(random);
        }
        vec3 t1 = stemTangent(p[0], p[1], p[2], n[1], vec3(1, 0, 0));
        vec3 t2 = stemTangent(p[1], p[2], p[3], n[2], vec3(1, 0, 0));
        if (std::abs(dot3(t1, n[1])) > 1e-3f) continue;  // segments cancelled out: the heading was taken
        CHECK(length3(t1) == doctest::Approx(1).epsilon(1e-5));
        // The paper's tangent, in double precision.
        auto unit = [](vec3 a, vec3 b) { return glm::normalize(glm::dvec3(b) - glm::dvec3(a)); };
        glm::dvec3 sum = unit(p[0], p[1]) + unit(p[1], p[2]), nd(n[1]);
        glm::dvec3 expected = glm::normalize(sum - nd * glm::dot(nd, sum));
        CHECK(glm::dot(expected, glm::dvec3(t1)) > 0.9999);
        Span s = smoothSpan(p[1], t1, p[2], t2);
        CHECK(length3(spanPoint(s, 0) - p[1]) < 1e-6f);
        CHECK(length3(spanPoint(s, 1) - p[2]) < 1e-6f);
        if (dot3(t1, p[2] - p[1]) > 0.06f) {
            glm::dvec3 b1 = glm::dvec3(p[1]) + expected * (glm::dot(expected, glm::dvec3(p[2] - p[1])) / 3);
            CHECK(glm::length(b1 - glm::dvec3(s.b1)) < 1e-3);
        }
        // The joint: the span before arrives along the same tangent.
        vec3 t0 = stemTangent(p[0], p[0], p[1], n[0], vec3(1, 0, 0));
        Span before = smoothSpan(p[0], t0, p[1], t1);
        vec3 in = unit3(spanVelocity(before, 1)), out = unit3(spanVelocity(s, 0));
        CHECK(dot3(in, out) > 0.9999f);
    }
}

TEST_CASE("spans so short that coordinates hardly tell their ends apart keep their tangents") {
    std::mt19937 random(3);
    for (float length : {0.0f, 1e-7f, 1e-6f, 1e-5f, 1e-4f, 1e-3f})
        for (int i = 0; i < 500; ++i) {
            const vec3 p0 = randomUnit(random) * 4.0f, t0 = randomUnit(random), t3 = randomUnit(random);
            const Span s = smoothSpan(p0, t0, p0 + randomUnit(random) * length, t3);
            CHECK(dot3(unit3(spanVelocity(s, 0)), t0) > 0.99998f);  // a third of a degree
            CHECK(dot3(unit3(spanVelocity(s, 1)), t3) > 0.99998f);
        }
}

TEST_CASE("frames are orthonormal, agree at joints and follow the surface") {
    std::mt19937 random(2);
    for (int i = 0; i < 2000; ++i) {
        vec3 p0 = randomUnit(random), p1 = p0 + randomUnit(random) * 0.2f;
        vec3 n0 = i % 7 ? randomUnit(random) : unit3(p1 - p0), n1 = i % 5 ? randomUnit(random) : vec3(0) - n0;
        Span s = smoothSpan(p0, unit3(p1 - p0 + randomUnit(random) * 0.05f), p1, unit3(p1 - p0));
        for (float u : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
            Frame f = spanFrame(s, u, n0, n1);
            CHECK(length3(f.along) == doctest::Approx(1).epsilon(1e-4));
            CHECK(length3(f.out1) == doctest::Approx(1).epsilon(1e-4));
            // Of normals whose blend lies almost along the curve few digits are left.
            const float left = length3(cross3(f.along, n0 * (1 - u) + n1 * u));
            CHECK(std::abs(dot3(f.along, f.out1)) < (left > 0.01f ? 2e-5f : 3e-4f));
            CHECK(length3(cross3(f.along, f.out1) - f.side) < 1e-5f);
        }
    }
    // Around a cylinder: the frame's out stays the cylinder's normal to within what the chord leaves.
    auto at = [](float a) { return vec3(std::cos(a), std::sin(a), 0.2f * a); };
    auto normal = [](float a) { return vec3(std::cos(a), std::sin(a), 0); };
    auto tangent = [](float a) { return unit3(vec3(-std::sin(a), std::cos(a), 0.2f)); };
    for (float a = 0; a < 6; a += 0.2f) {
        Span s = smoothSpan(at(a), tangent(a), at(a + 0.2f), tangent(a + 0.2f));
        for (float u : {0.1f, 0.5f, 0.9f}) {
            float middle = a + 0.2f * u;
            CHECK(dot3(spanFrame(s, u, normal(a), normal(a + 0.2f)).out1, normal(middle)) > 0.9999f);
            CHECK(length3(spanPoint(s, u) - at(middle)) < 5e-4f);
        }
        CHECK(spanLength(s) == doctest::Approx(0.2 * std::sqrt(1.04)).epsilon(0.01));
    }
}

TEST_CASE("coinciding samples and opposite tangents give no NaN") {
    vec3 p(1, 2, 3), t(0, 0, 1);
    Span s = smoothSpan(p, t, p, vec3(0) - t);
    Frame f = spanFrame(s, 0.5f, t, vec3(0) - t);
    CHECK(std::isfinite(f.out1.x + f.along.y + f.side.z));
    vec3 tangent = stemTangent(p, p, p, t, vec3(1, 0, 0));
    CHECK(tangent == vec3(1, 0, 0));
    vec3 back = stemTangent(p, p + vec3(1, 0, 0), p, t, vec3(0, 1, 0));  // there and back
    CHECK(back == vec3(0, 1, 0));
}
