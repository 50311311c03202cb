// Packing of loose terminals, there and back.
#include <doctest/doctest.h>
#include <initializer_list>

#include "shaders/shared/leaf_pose.h"

using namespace espalier;

TEST_CASE("leaf records keep what was packed") {
    for (float size : {0.001f, 0.0123f, 0.05f, 0.0999f, 0.1f, 1.0f, 7.7f, 60.0f})
        for (float t : {0.0f, 0.33f, 1.0f})
            for (float turn : {-3.1f, -0.4f, 0.0f, 2.9f, 9.0f})
                for (float pitch : {-1.5f, 0.0f, 0.7f, 1.57f}) {
                    const LeafPose p =
                        unpackLeaf(packLeafPlace(t, 7, size), packLeafPose(turn, pitch, 0.8f * size, size),
                                   packLeafTint(0.25f, vec3(0.04f, 0.5f, 1.0f), 0x1AB));
                    CHECK(p.size == doctest::Approx(size).epsilon(0.023));
                    CHECK(p.t == doctest::Approx(t).epsilon(1e-4));
                    CHECK(p.mesh == 7);
                    CHECK(std::abs(std::remainder(p.turn - turn, 6.2831853f)) < 1e-3f);
                    CHECK(std::abs(p.pitch - pitch) < 2e-3f);
                    CHECK(p.lift == doctest::Approx(0.8f * size).epsilon(0.03));
                    CHECK(p.tint == doctest::Approx(0.25).epsilon(0.01));
                    CHECK(glm::length(p.colour - vec3(0.04f, 0.5f, 1.0f)) < 0.03f);
                    CHECK(p.hash == 0xAB);
                }
    // Absurd values end at the limits.
    const LeafPose wild =
        unpackLeaf(packLeafPlace(9, 300, 1e30f), packLeafPose(1e30f, -50, 1e9f, 1e-9f), packLeafTint(-3, vec3(8), 0));
    CHECK(wild.size < 64);
    CHECK(wild.t == doctest::Approx(1.0f));
    CHECK(wild.pitch >= -1.5708f);
    CHECK(wild.tint == 0);
    CHECK(decodeLeafSize(encodeLeafSize(0)) < 0.00101f);
}
