// A surface on the GPU: the buffers hold what was baked, and the record points at them.
#include "runtime/surface/gpu_surface.hpp"

#include <doctest/doctest.h>

#include <cstring>

#include "runtime/gpu/device.hpp"
#include "tests/bake/small_models.hpp"

using namespace espalier;
using namespace espalier::test;

TEST_CASE("an uploaded surface states its arrays' sizes, addresses and its place in the world") {
    auto device = Device::create({});
    if (!device) {
        MESSAGE("skipped: " << device.failure().text());
        return;
    }
    BakeOptions options;
    options.resolution = 64;
    auto baked = bake(cubeCross(2), options);
    REQUIRE(baked);
    const SurfaceData& data = baked->surface;
    auto gpu = GpuSurface::create(**device, data);
    if (!gpu) FAIL(gpu.failure().text());
    CHECK(gpu->hash() == data.hash);
    uint64_t expected = data.crossings.size() * 48 + data.charts.size() * 40 + data.triangles.size() * 64;
    for (const SurfaceLevelData& level : data.levels)
        expected += level.texels.size() * 28 + level.crossingRefs.size() * 4;
    CHECK(gpu->bakedBytes() >= expected);
    CHECK(gpu->bakedBytes() < expected + 16 * (4 * data.levels.size() + 4));  // arrays are aligned

    glm::mat4 place(0);
    place[0] = {0, 2, 0, 0};  // a quarter turn about z, twice as large
    place[1] = {-2, 0, 0, 0};
    place[2] = {0, 0, 2, 0};
    place[3] = {5, 6, 7, 1};
    SurfaceRef ref = gpu->ref(place);
    CHECK(ref.levelCount == data.levels.size());
    CHECK(ref.crossingCount == data.crossings.size());
    CHECK(ref.triangleCount == data.triangles.size());
    CHECK(ref.scale == doctest::Approx(2));
    CHECK(ref.radius == doctest::Approx(std::sqrt(3.0)));
    CHECK(ref.toWorld[0] == glm::vec4(0, -2, 0, 5));
    CHECK(ref.toWorld[1] == glm::vec4(2, 0, 0, 6));
    for (uint32_t l = 0; l < ref.levelCount; ++l) {
        CHECK(ref.levels[l].size == data.levels[l].size);
        CHECK(ref.levels[l].texels.v != nullptr);
        CHECK(ref.levels[l].crossingHead.v != nullptr);
        CHECK(ref.levels[l].texels.v != surfaceRef(data).levels[l].texels.v);  // the device's address, not ours
    }
}

TEST_CASE("what touches one place of a surface leaves its others as they were baked") {
    auto device = Device::create({});
    if (!device) {
        MESSAGE("skipped: " << device.failure().text());
        return;
    }
    BakeOptions options;
    options.resolution = 256;
    auto baked = bake(cubeCross(2), options);
    REQUIRE(baked);
    const SurfaceData& data = baked->surface;
    auto gpu = GpuSurface::create(**device, data);
    if (!gpu) FAIL(gpu.failure().text());
    GpuSurface other = gpu->another();
    CHECK(other.shares(*gpu));
    // A contact across the middle of a chart, and a few texels that something buries.
    Crossing contact = data.crossings.front();
    const Chart& chart = data.charts.front();
    const glm::vec2 middle = (chart.uvMin + chart.uvMax) * .5f, half = (chart.uvMax - chart.uvMin) * .1f;
    contact.a = middle - half, contact.b = middle + half;
    contact.flags = kCrossingContact | kCrossingInsideLeft;
    TexelSets buried(data.levels.size());
    for (uint32_t i = 0; i < data.levels[0].texels.size() && buried[0].size() < 40; i += 7)
        if (texelClass(data.levels[0].texels[i].bits) == kTexelInner) buried[0].push_back(i);
    const std::vector<Crossing> added(3, contact);
    REQUIRE(gpu->addCrossings(**device, data, added, buried));
    Result<std::vector<LevelPatch>> patches = patchLevels(data, added, buried);
    REQUIRE(patches);
    size_t changed = 0;
    for (size_t l = 0; l < data.levels.size(); ++l) {
        SurfaceLevelData expected = data.levels[l];
        applyPatch((*patches)[l], expected);
        changed += (*patches)[l].texels.size();
        const auto differ = [&](const std::vector<Texel>& a, const std::vector<Texel>& b) {
            return a.size() != b.size() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Texel)) != 0;
        };
        CHECK_FALSE(differ(*gpu->readTexels(**device, l), expected.texels));
        CHECK_FALSE(differ(*other.readTexels(**device, l), data.levels[l].texels));
    }
    CHECK(changed > 100);
    CHECK(gpu->ref().crossingCount == data.crossings.size() + added.size());
    CHECK(other.ref().crossingCount == data.crossings.size());
    const std::vector<Crossing> read = *gpu->readCrossings(**device, data.crossings.size() + added.size());
    CHECK(read.back().a == contact.a);
    CHECK(other.ownBytes() == 0);
    CHECK(gpu->ownBytes() > 0);
    CHECK(gpu->ownBytes() < gpu->bakedBytes() / 2);
    // Nothing touches it any more.
    REQUIRE(gpu->addCrossings(**device, data, {}, {}));
    CHECK(gpu->ownBytes() == 0);
    CHECK(gpu->ref().levels[0].touched == 0);
}
