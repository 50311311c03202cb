// The kernels' own arithmetic against the C library in double precision.
#include "shaders/shared/exact.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "shaders/shared/random.h"

using namespace espalier;

TEST_CASE("roots, reciprocals, sines and angles keep to their stated errors") {
    double sine = 0, reciprocal = 0, root = 0, angle = 0, oct = 0;
    for (int i = -200000; i < 200000; ++i) {
        float x = float(i) * 0.005f + 0.0025f, s, c;
        sinCosExact(x, s, c);
        sine = std::max({sine, std::abs(s - std::sin(double(x))), std::abs(c - std::cos(double(x)))});
        reciprocal = std::max(reciprocal, std::abs(rcpExact(x) * double(x) - 1));
        root = std::max(root, std::abs(sqrtExact(std::abs(x)) / std::sqrt(std::abs(double(x))) - 1));
        float u = std::sin(float(i) * 0.37f) * 3, v = std::cos(float(i) * 0.11f) * 2;
        angle = std::max(angle, std::abs(atan2Exact(u, v) - std::atan2(double(u), double(v))));
        vec3 n = unit3(vec3(u, v, std::sin(float(i) * 0.77f)));
        oct = std::max(oct, double(glm::length(unpackOct(packOct(n)) - n)));
    }
    CHECK(sine < 1e-6);
    CHECK(reciprocal < 3e-7);
    CHECK(root < 3e-7);
    CHECK(angle < 2e-5);
    CHECK(oct < 1e-4);
}

TEST_CASE("random draws are uniform and keys of siblings differ") {
    double sum = 0;
    for (uint i = 0; i < 100000; ++i) {
        float r = uniformRandom(childKey(u64(i), 7, 0), 1);
        REQUIRE((r >= 0 && r < 1));
        sum += r;
    }
    CHECK(sum / 100000 == doctest::Approx(0.5).epsilon(0.01));
    CHECK(childKey(1, 2, 0) != childKey(1, 2, 1));
    CHECK(childKey(1, 2, 0) != childKey(1, 3, 0));
}
