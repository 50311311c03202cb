// What stands between the sun and a wall darkens it, however far away it is; what is cut out of its triangles doesn't.
#include <doctest/doctest.h>

#include <numeric>

#include "runtime/render/models.hpp"
#include "tests/render/drawn.hpp"
#include "tests/render/wall.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// A board of 3 by 3 m across z, its right half see-through in its picture.
SurfaceData board(float alphaCutoff) {
    SurfaceData data;
    for (int i = 0; i < 4; ++i) {
        const glm::vec2 at(i & 1, i >> 1);
        data.vertices.push_back({{3 * at.x - 1.5f, 3 * at.y, 0}, {0, 0, 1}, {1, 0, 0, 1}, at, at});
    }
    data.indices = {0, 1, 2, 1, 3, 2};
    data.boundsMin = {-1.5f, 0, 0};
    data.boundsMax = {1.5f, 3, 0};
    data.materials.resize(1);
    data.materials[0].baseColorImage = 0;
    data.materials[0].alphaCutoff = alphaCutoff;
    data.images.resize(1);
    data.images[0].width = 2;
    data.images[0].height = 1;
    data.images[0].rgba = {200, 200, 200, 255, 200, 200, 200, 0};
    data.ranges.push_back({0, 6, 0});
    return data;
}

// Of a picture of the wall, behind whose camera a board stands `away` metres towards the sun, or none.
double brightness(const SurfaceData* caster, float away) {
    Drawn drawn;
    drawn.inputs.look.shadows = true;
    drawn.inputs.look.sunDirection = {0, 0, 1};
    drawn.inputs.camera = {.eye = {0, 1.2f, 4}, .target = {0, 1.2f, 0}};
    REQUIRE(drawn.renderer().setSurface(0, wall(4, 2.6f), glm::mat4(1)));
    if (caster) {
        glm::mat4 place(1);
        place[3] = {0, 0, away, 1};
        REQUIRE(drawn.renderer().setSurface(1, *caster, place));
    }
    const std::vector<uint8_t> pixels = drawn.frame(160, 120);
    return std::accumulate(pixels.begin(), pixels.end(), 0.0) / double(pixels.size());
}

}  // namespace

TEST_CASE("a metre is one unless all models are too small or too large for it") {
    CHECK(lengthUnit(.05f, .3f) == doctest::Approx(.05f));
    CHECK(lengthUnit(.05f, 6) == 1);    // an urn beside a wall
    CHECK(lengthUnit(2, 900) == 1);     // a level
    CHECK(lengthUnit(300, 900) == 50);  // a house in centimetres
    CHECK(lengthUnit(0, 0) > 0);
}

TEST_CASE("what is cut out of a model's triangles casts no shadow") {
    const SurfaceData whole = board(0), half = board(.5f);
    const double lit = brightness(nullptr, 0), dark = brightness(&whole, 6), between = brightness(&half, 6);
    CHECK(dark < lit - 10);
    CHECK(between > dark + .3 * (lit - dark));
    CHECK(between < lit - .3 * (lit - dark));
}

TEST_CASE("what stands far away towards the sun casts its shadow where shadows are fine, too") {
    const SurfaceData whole = board(0);
    const double lit = brightness(nullptr, 0), near = brightness(&whole, 6);
    for (float away : {40.0f, 150.0f}) {
        CAPTURE(away);
        CHECK(brightness(&whole, away) < lit - .7 * (lit - near));
    }
}
