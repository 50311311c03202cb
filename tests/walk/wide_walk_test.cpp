// Walks side by side in the processor's vectors against the same walks one by one.
#include <bit>
#include <cstring>
#include <string>

#include <doctest/doctest.h>

#include "runtime/host/wide_walk.hpp"
#include "tests/walk/judge.hpp"

using namespace espalier;
using namespace espalier::walktest;

namespace {

constexpr int kRounds = 30, kStretches = 40;

template <class T>
bool sameBits(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

void checkSame(const WalkState& a, const WalkState& b) {
    CHECK(sameBits(a.position, b.position));
    CHECK(sameBits(a.normal, b.normal));
    CHECK(sameBits(a.du, b.du));
    CHECK(sameBits(a.dv, b.dv));
    CHECK(sameBits(a.slip, b.slip));
    CHECK(sameBits(a.walk.uv, b.walk.uv));
    CHECK(sameBits(a.walk.direction, b.walk.direction));
    CHECK(sameBits(a.walk.arc, b.walk.arc));
    CHECK(sameBits(a.spread, b.spread));
    CHECK(sameBits(a.clear, b.clear));
    CHECK(sameBits(a.limit, b.limit));
    CHECK(a.flags == b.flags);
    CHECK(a.walk.place == b.walk.place);
    CHECK(sameBits(a.orientation, b.orientation));
    CHECK(a.level == b.level);
    CHECK(sameBits(a.leftUv, b.leftUv));
    CHECK(a.leftPlace == b.leftPlace);
}

struct Lanes {
    WalkState walk[kWalkLanes];
    float remaining[kWalkLanes] = {};
};

// A stretch of the walks in `marching`, some of which turn first. Returns those that landed inside their charts.
uint32_t stretch(WideWalks& wide, SurfaceBuf surfaces, Lanes& lanes, uint32_t marching, std::mt19937_64& random) {
    std::uniform_real_distribution<float> unit(-1, 1);
    float angle[kWalkLanes] = {};
    for (uint32_t i = 0; i < kWalkLanes; ++i) {
        if ((marching >> i & 1) == 0) continue;
        putWalk(wide, i, surfaces, 0, lanes.walk[i], lanes.remaining[i]);
        if (unit(random) > 0) continue;
        angle[i] = unit(random);
        wide.turns[i] = 1;
        wide.angle[i] = angle[i];
    }
    const uint32_t landed = advanceWide(wide, surfaces, marching);
    CHECK((landed & ~marching) == 0);
    for (uint32_t i = 0; i < kWalkLanes; ++i) {
        if ((marching >> i & 1) == 0) continue;
        WalkState beside = lanes.walk[i], &w = lanes.walk[i];
        float besideRemaining = lanes.remaining[i];
        if (wide.turns[i] != 0) rotateHeading(w, angle[i]);
        vec3 normal, besideNormal;
        const uint event = walkAdvance(surfaces, 0, w, lanes.remaining[i], normal);
        if ((landed >> i & 1) != 0) {
            takeWalk(wide, i, beside);
            CHECK(wide.event[i] == event);
            CHECK(sameBits(wide.remaining[i], lanes.remaining[i]));
            CHECK(wide.packedNormal[i] == packOct(normal));
            CHECK(wide.packedHeading[i] == packOct(w.walk.direction));
        } else {
            CHECK(takeMeeting(wide, i, beside, besideRemaining, besideNormal) == event);
            CHECK(sameBits(besideRemaining, lanes.remaining[i]));
            CHECK(sameBits(besideNormal, normal));
        }
        checkSame(beside, w);
        if (!walkGoesOn(event)) lanes.remaining[i] = 0;
    }
    return landed;
}

void checkSideBySide(const Shape& shape, VectorKind vectors) {
    const SurfaceData data = toSurface(shape, 512, 1);
    SurfaceRef ref = surfaceRef(data);
    const SurfaceBuf surfaces{&ref};
    std::mt19937_64 random(17);
    std::uniform_real_distribution<float> length(0, 0.03f * float(shape.radius));
    uint32_t walked = 0, landings = 0;
    for (int round = 0; round < kRounds; ++round) {
        WideWalks wide = {};
        wide.vectors = vectors;
        Lanes lanes;
        for (WalkState& w : lanes.walk) {
            const Start s = randomStart(shape, random);
            REQUIRE(startWalk(surfaces, 0, chartAt(data, vec2(s.uv), s.position), vec2(s.uv), vec3(s.direction), w));
        }
        for (int k = 0; k < kStretches; ++k) {
            const uint32_t all = (1u << kWalkLanes) - 1, marching = round % 2 == 0 ? all : uint32_t(random() & all);
            for (uint32_t i = 0; i < kWalkLanes; ++i)
                if (lanes.remaining[i] == 0) lanes.remaining[i] = length(random);
            landings += uint32_t(std::popcount(stretch(wide, surfaces, lanes, marching, random)));
            walked += uint32_t(std::popcount(marching));
        }
    }
    CHECK(landings > walked * 3 / 4);
    MESSAGE(shape.name << ": " << landings << " of " << walked << " stretches land");
}

}  // namespace

TEST_CASE("walks side by side come to the bit where one by one they come, and most land") {
    for (const VectorKind vectors : {VectorKind::avx2, VectorKind::avx512}) {
        const bool wide = vectors == VectorKind::avx512;
        if (vectors > platform::widestVectors()) {
            MESSAGE("this processor, or a build by this compiler, has no " << std::string(wide ? "AVX-512" : "AVX2"));
            continue;
        }
        CAPTURE(wide);
        for (const Shape& shape : {sphere(96), torus(96), cubeOfSixCharts(), cubeWithStrip()}) {
            CAPTURE(shape.name);
            checkSideBySide(shape, vectors);
        }
    }
}
