// What materials look like beyond a plain colour: textures by UVs of their own, light, metal, glass.
#include <doctest/doctest.h>

#include "tests/render/drawn.hpp"
#include "tests/render/wall.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// Squares of 2 by 2 m across z, of one material each, whose pictures are these texels in a row.
struct Square {
    float z = 0;
    Material material{};
    std::vector<uint8_t> texels{};  // rgba; empty: no picture
};

SurfaceData squares(const std::vector<Square>& all) {
    SurfaceData data;
    data.boundsMin = {-1, -1, 1e9f};
    data.boundsMax = {1, 1, -1e9f};
    for (const Square& square : all) {
        const uint32_t first = uint32_t(data.vertices.size()), begin = uint32_t(data.indices.size());
        for (int i = 0; i < 4; ++i) {
            const glm::vec2 at(i & 1, i >> 1);
            // The second set lies where the picture's last texel is.
            data.vertices.push_back({{2 * at.x - 1, 2 * at.y - 1, square.z},
                                     {0, 0, 1},
                                     {1, 0, 0, 1},
                                     at,
                                     at,
                                     glm::vec2(0.9f, 0.5f) + 0.01f * at});
        }
        for (uint32_t i : {0u, 1u, 2u, 1u, 3u, 2u}) data.indices.push_back(first + i);
        data.ranges.push_back({begin, 6, uint32_t(data.materials.size())});
        data.materials.push_back(square.material);
        if (!square.texels.empty()) {
            data.images.emplace_back();
            data.images.back().width = uint32_t(square.texels.size() / 4);
            data.images.back().height = 1;
            data.images.back().rgba = square.texels;
        }
        data.boundsMin.z = std::min(data.boundsMin.z, square.z);
        data.boundsMax.z = std::max(data.boundsMax.z, square.z);
    }
    return data;
}

struct Seen {
    Look look{};
    float from = 4;   // z of the eye
    float aside = 0;  // and its x
};

// The picture's middle pixel, 0 to 255.
glm::ivec3 middle(const SurfaceData& surface, const Seen& seen = {}) {
    Drawn drawn;
    drawn.inputs.look = seen.look;
    drawn.inputs.look.shadows = false;
    drawn.inputs.look.sunDirection = {0.6f, 0.5f, seen.from > 0 ? 0.6f : -0.6f};
    drawn.inputs.camera = {.eye = {seen.aside, 0.1f, seen.from}, .target = {0, 0.1f, 0}};
    REQUIRE(drawn.renderer().setSurface(0, surface, glm::mat4(1)));
    const std::vector<uint8_t> pixels = drawn.frame(64, 64);
    const size_t at = (32 * 64 + 32) * 4;
    return {pixels[at], pixels[at + 1], pixels[at + 2]};
}

Material pane(glm::vec4 color) {
    Material m;
    m.baseColor = color;
    m.blended = m.doubleSided = true;
    return m;
}

const std::vector<uint8_t> kRedGreenBlue = {230, 10, 10, 255, 10, 230, 10, 255, 10, 10, 230, 255};

}  // namespace

TEST_CASE("textures are looked up by their own UV set and transform") {
    Material m;
    m.baseColorImage = 0;
    const auto seen = [&](const TextureMap& map) {
        m.baseColorMap = map;
        return middle(squares({{0, m, kRedGreenBlue}}));
    };
    const glm::ivec3 plain = seen({});  // the middle texel
    CHECK(plain.g > plain.r + 60);
    CHECK(plain.g > plain.b + 60);
    const glm::ivec3 other = seen({.set = 1});
    CHECK(other.b > other.g + 60);
    const glm::ivec3 moved = seen({.offset = {0.4f, 0}, .scale = {0.01f, 1}});
    CHECK(moved.g > moved.r + 60);
    const glm::ivec3 back = seen({.offset = {0.1f, 0}, .scale = {0.01f, 1}});
    CHECK(back.r > back.g + 60);
    const glm::ivec3 both = seen({.set = 1, .offset = {0.75f, 0}, .scale = {0.1f, 1}});
    CHECK(both.b > both.g + 60);
}

TEST_CASE("beyond its borders a picture repeats, ends or is mirrored as its material says") {
    Material m;
    m.baseColorImage = 0;
    // The middle of the square shows u = 1.17 and then -0.17: the picture's first, last or first texel again.
    const auto seen = [&](Wrap wrap, float u) {
        m.wrapU = wrap;
        m.baseColorMap = {.offset = {u - .005f, 0}, .scale = {0.01f, 1}};
        return middle(squares({{0, m, kRedGreenBlue}}));
    };
    const auto most = [](glm::ivec3 c) { return c.r > c.g + 60 ? 'r' : c.b > c.g + 60 ? 'b' : 'g'; };
    CHECK(most(seen(Wrap::repeat, 1.17f)) == 'r');
    CHECK(most(seen(Wrap::clamp, 1.17f)) == 'b');
    CHECK(most(seen(Wrap::mirror, 1.17f)) == 'b');
    CHECK(most(seen(Wrap::repeat, -.17f)) == 'b');
    CHECK(most(seen(Wrap::clamp, -.17f)) == 'r');
    CHECK(most(seen(Wrap::mirror, -.17f)) == 'r');
    CHECK(most(seen(Wrap::mirror, 2.5f)) == 'g');
}

TEST_CASE("what shines is bright in the dark, in its texture's colours") {
    Seen night;
    night.look.sunColor = night.look.skyColor = night.look.groundColor = glm::vec3(0);
    Material m;
    m.baseColor = {0, 0, 0, 1};
    CHECK(middle(squares({{0, m}}), night).r < 8);
    m.emissive = {0.5f, 0.5f, 0.5f};
    const glm::ivec3 grey = middle(squares({{0, m}}), night);
    CHECK(grey.r > 80);
    CHECK(std::abs(grey.r - grey.b) < 12);
    m.emissiveImage = 0;
    m.emissiveMap = {.set = 1};
    const glm::ivec3 blue = middle(squares({{0, m, kRedGreenBlue}}), night);
    CHECK(blue.b > blue.r + 60);
    m.emissive *= 8;
    CHECK(middle(squares({{0, m, kRedGreenBlue}}), night).b > blue.b);
}

TEST_CASE("a smooth metal mirrors the sky by its colour, a rough one scatters it, and a texture says where which is") {
    // The eye looks at the wall from above, which mirrors the horizon's land, or from below, which mirrors the sky.
    const auto mirrored = [](const Material& m, float y, const std::vector<uint8_t>& texels = {}) {
        Drawn drawn;
        drawn.inputs.look.shadows = false;
        drawn.inputs.look.sunDirection = {0, 0.2f, -1};  // behind the wall
        drawn.inputs.look.background = {0.05f, 0.1f, 0.9f};
        drawn.inputs.look.groundColor = {0.4f, 0.2f, 0.02f};
        drawn.inputs.camera = {.eye = {0, y, 3}, .target = {0, 0, 0}};
        REQUIRE(drawn.renderer().setSurface(0, squares({{0, m, texels}}), glm::mat4(1)));
        const std::vector<uint8_t> pixels = drawn.frame(64, 64);
        const size_t at = (32 * 64 + 32) * 4;
        return glm::ivec3(pixels[at], pixels[at + 1], pixels[at + 2]);
    };
    Material m;
    m.baseColor = {0.9f, 0.9f, 0.88f, 1};
    m.metallic = 1;
    m.roughness = 0;
    const glm::ivec3 sky = mirrored(m, -3), land = mirrored(m, 3);
    CHECK(sky.b > sky.r + 60);
    CHECK(land.r > land.b + 30);
    m.baseColor = {1, 0.1f, 0.1f, 1};  // takes the sky's blue away
    const glm::ivec3 red = mirrored(m, -3);
    CHECK(red.b < sky.b - 60);
    // Rough, what it shows depends little on where one looks from.
    m.baseColor = {0.9f, 0.9f, 0.88f, 1};
    m.roughness = 1;
    const glm::ivec3 high = mirrored(m, 3), low = mirrored(m, -3);
    CHECK(glm::length(glm::vec3(high - low)) < 0.5f * glm::length(glm::vec3(land - sky)));
    // Where the texture's blue is 0 there is no metal.
    m.roughness = 0.05f;
    m.roughnessImage = 0;
    const glm::ivec3 none = mirrored(m, -3, {0, 255, 0, 255}), all = mirrored(m, -3, {0, 255, 255, 255});
    CHECK(all.b > none.b + 20);
}

TEST_CASE("through glass one sees what lies behind, the nearer pane in front, from either side") {
    Material white;
    white.baseColor = {0.2f, 0.2f, 0.2f, 1};
    const glm::ivec3 bare = middle(squares({{-1, white}}));
    const glm::ivec3 faint = middle(squares({{-1, white}, {0, pane({0.5f, 0.5f, 0.5f, 0.02f})}}));
    CHECK(std::abs(faint.r - bare.r) < 24);
    const glm::vec4 red(0.9f, 0.02f, 0.02f, 0.6f), green(0.02f, 0.9f, 0.02f, 0.6f);
    for (bool redInFront : {true, false})
        for (bool redFirst : {true, false}) {
            const Square a{redInFront ? 0.5f : 0.0f, pane(red)}, b{redInFront ? 0.0f : 0.5f, pane(green)};
            const SurfaceData both = squares(redFirst ? std::vector{a, b} : std::vector{b, a});
            const glm::ivec3 front = middle(both), back = middle(both, {.from = -4});
            CHECK((front.r > front.g) == redInFront);
            CHECK((back.r > back.g) == !redInFront);
            CHECK(middle(both) == front);  // the same in every run
        }
    // Panes of one material are sorted, too: all of the nearest one's picture is seen.
    Material clear;
    clear.blended = true;
    clear.transmission = 1;
    clear.roughness = 0;
    const glm::ivec3 through = middle(squares({{-1, white}, {0, clear}}));
    CHECK(std::abs(through.r - bare.r) < 40);
    clear.baseColor = {0.1f, 0.8f, 0.2f, 1};
    const glm::ivec3 tinted = middle(squares({{-1, white}, {0, clear}}));
    CHECK(tinted.g > tinted.r + 40);
    // Where a blended picture has nothing no sky is mirrored, however aslant one looks.
    Material decal = pane({1, 1, 1, 1});
    decal.baseColorImage = 0;
    decal.roughness = 0;
    const Seen aslant{.from = 0.5f, .aside = 4};
    const SurfaceData wall = squares({{-0.02f, white}});
    const auto over = [&](uint8_t alpha) { return squares({{-0.02f, white}, {0, decal, {230, 10, 10, alpha}}}); };
    CHECK(glm::length(glm::vec3(middle(over(0), aslant) - middle(wall, aslant))) < 3);
    CHECK(glm::length(glm::vec3(middle(over(40), aslant) - middle(wall, aslant))) > 10);
    // Other views show what there is, glass or not.
    Seen normals;
    normals.look.view = ViewMode::normals;
    CHECK(middle(squares({{0, clear}}), normals).b > 200);
}
