// Ways that meet singularities.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/pattern/scene.hpp"

using namespace espalier;
using patterntest::Scene;

namespace {

// A field of lines that turns by half a turn about the origin, with the way around (1) or against it (-1), and leads
// straight to the origin where the way comes from.
Field turningField(const FieldMesh& mesh, int sense) {
    Field field;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3 p = mesh.positions[v];
        const bool middle = glm::length(p) < 1e-6;
        const double angle = sense * std::atan2(-p.z, p.x) / 2 + std::numbers::pi / 2;
        const double turned = 2 * mesh.angleOf(v, {std::cos(angle), 0, -std::sin(angle)});
        field.power.push_back(middle ? 0.0 : std::polar(1.0, turned));
        field.mean.push_back(0), field.deviator.push_back(1);
    }
    return field;
}

// Where a way of one metre ends that begins `before` metres in front of the singularity.
vec3 endOf(const std::string& jumps, int sense, float before) {
    Scene scene(patterntest::sheet(
                    160, 160, [](float u, float v) { return vec3(4 * (u - .5f), 0, 4 * (.5f - v)); },
                    [](float, float) { return vec3(0, 1, 0); }),
                256);
    scene.addGrammar("field flow : tensor " + jumps + "\nA -> T(1, 0, 0) S(0.01) I(\"box\")");
    scene.setField("flow", turningField(scene.mesh(), sense));
    scene.plant({-before, 0, 0}, {1, 0, 0});
    scene.seeds()[0].walk.uv = vec2(.03f + .94f * (.5f - before / 4), .03f + .94f * .5f);
    const GrownPattern grown = scene.grow();
    REQUIRE(grown.pieces.size() == 1);
    return grown.pieces[0].position;
}

}  // namespace

TEST_CASE("a way that jumps goes straight through a wedge and a trisector, one that doesn't turns aside") {
    for (const int sense : {1, -1}) {
        // Lines lead into a wedge by themselves, and away from a way to a trisector.
        const float before = sense > 0 ? .3f : .02f;
        const vec3 through = endOf("jumps", sense, before), aside = endOf("", sense, before);
        MESSAGE("jumps: " << through.x << ", " << -through.z << "; turns aside: " << aside.x << ", " << -aside.z);
        const double off = std::atan2(std::abs(through.z), through.x);
        CHECK(glm::length(through) == doctest::Approx(1 - before).epsilon(.05));
        CHECK(off < std::numbers::pi / 6);
        CHECK(std::atan2(std::abs(aside.z), aside.x) > std::numbers::pi / 4);
    }
}
