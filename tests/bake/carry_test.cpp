// Layers carried from a surface to another whose charts lie elsewhere: what is painted is a function of the place, so
// that every texel's value is known.
#include "runtime/surface/carry.hpp"

#include <doctest/doctest.h>

#include "tests/bake/kits.hpp"
#include "tests/bake/small_models.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

SurfaceData surfaceOf(const Model& model, uint32_t resolution = 256) {
    BakeOptions options;
    options.resolution = resolution;
    options.levels = 1;
    auto baked = bake(model, options);
    if (!baked) throw std::runtime_error(baked.failure().text());
    return std::move(baked->surface);
}

template <class Fn>
UvPicture paint(const SurfaceData& surface, Fn&& value) {
    const SurfaceLevelData& level = surface.levels[0];
    UvPicture out{level.size, level.size, std::vector<float>(size_t(level.size) * level.size, 0.0f)};
    for (uint32_t y = 0; y < level.size; ++y)
        for (uint32_t x = 0; x < level.size; ++x) {
            const Texel& t = level.texels[texelIndex(level.size, x, y)];
            if (texelClass(t.bits) != kTexelEmpty) out.texels[size_t(y) * level.size + x] = value(t.position);
        }
    return out;
}

// Calls fn(position, normal, value) for each texel of ground.
template <class Fn>
void forGround(const SurfaceData& surface, const UvPicture& layer, Fn&& fn) {
    const SurfaceLevelData& level = surface.levels[0];
    for (uint32_t y = 0; y < level.size; ++y)
        for (uint32_t x = 0; x < level.size; ++x) {
            const uint32_t at = texelIndex(level.size, x, y);
            if (texelClass(level.texels[at].bits) != kTexelInner) continue;
            const TrianglePlane& t = surface.triangles[level.aux[at].triangle];
            const glm::vec3 normal = glm::normalize(glm::cross(t.du, t.dv)) * surface.charts[t.chart].orientation;
            fn(level.texels[at].position, normal, layer.texels[size_t(y) * level.size + x]);
        }
}

float hue(glm::vec3 p) {
    return 0.5f + 0.2f * p.x - 0.15f * p.y + 0.1f * p.z;
}

}  // namespace

TEST_CASE("a layer keeps its places on an atlas of other charts and another resolution") {
    const SurfaceData from = surfaceOf(cube(3));
    Model bare = cube(5);
    bare.uvs.clear();
    const SurfaceData to = surfaceOf(bare, 128);
    const CarriedLayer carried = SurfaceMatch(from, to).carry(paint(from, hue));
    CHECK(carried.fresh == 0);
    CHECK(carried.lost == 0);
    REQUIRE(carried.layer.width == 128);
    float worst = 0;
    forGround(to, carried.layer,
              [&](glm::vec3 p, glm::vec3, float v) { worst = std::max(worst, std::abs(v - hue(p))); });
    CHECK(worst < 0.01f);
}

TEST_CASE("what a change adds is fresh, what it takes away is lost, and a thin wall's sides stay apart") {
    Kit wall, more;
    for (Kit* kit : {&wall, &more}) kit->box({0, 1, 0}, {2, 1, 0.02});
    more.box({0, 4, 0}, glm::dvec3(0.5));  // 6 m²
    const SurfaceData less = surfaceOf(wall.model()), all = surfaceOf(more.model());
    // The front alone is painted.
    auto front = [](glm::vec3 p) { return p.z > 0 ? 1.0f : 0.0f; };
    const CarriedLayer grown = SurfaceMatch(less, all).carry(paint(less, front));
    CHECK(grown.fresh == doctest::Approx(6).epsilon(0.03));
    CHECK(grown.lost == 0);
    int wrong = 0, seen = 0;
    forGround(all, grown.layer, [&](glm::vec3 p, glm::vec3 n, float v) {
        if (p.y > 3) {
            wrong += v != 0;
        } else if (std::abs(n.z) > 0.9f) {
            ++seen;
            wrong += v != (n.z > 0 ? 1.0f : 0.0f);
        }
    });
    CHECK(seen > 1000);
    CHECK(wrong <= seen / 100);  // beside a chart's border a bilinear read mixes
    const CarriedLayer shrunk = SurfaceMatch(all, less).carry(paint(all, [](glm::vec3) { return 0.5f; }));
    CHECK(shrunk.fresh == 0);
    CHECK(shrunk.lost == doctest::Approx(6).epsilon(0.03));
}

TEST_CASE("a mask that is carried again and again keeps its borders") {
    Model bare = cube(5);
    bare.uvs.clear();
    const SurfaceData one = surfaceOf(cube(3)), other = surfaceOf(bare, 128);
    const SurfaceMatch there(one, other), back(other, one);
    UvPicture mask = paint(one, [](glm::vec3) { return 1.0f; });
    for (int i = 0; i < 2; ++i) mask = back.carry(there.carry(mask).layer).layer;
    float least = 1;
    forGround(one, mask, [&](glm::vec3, glm::vec3, float v) { least = std::min(least, v); });
    CHECK(least > 0.999f);
}

TEST_CASE("surfaces that a bake gave unlike origins lie in one place all the same") {
    const SurfaceData from = surfaceOf(cube(3));
    Model moved = cube(5);
    moved.origin = {-30, 0, 7};
    for (glm::vec3& p : moved.positions) p -= glm::vec3(moved.origin);
    const SurfaceData to = surfaceOf(moved, 128);
    const CarriedLayer carried = SurfaceMatch(from, to).carry(paint(from, hue));
    CHECK(carried.fresh == 0);
    CHECK(carried.lost == 0);
    float worst = 0;
    forGround(to, carried.layer, [&](glm::vec3 p, glm::vec3, float v) {
        worst = std::max(worst, std::abs(v - hue(p + glm::vec3(moved.origin))));
    });
    CHECK(worst < 0.01f);
    const glm::vec3 on(1, 0, 0);
    CHECK(!carryPlaces(from, to, std::span(&on, 1)).front().lost);
}
