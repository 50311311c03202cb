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
    CHECK(gpu->sizeBytes() >= expected);
    CHECK(gpu->sizeBytes() < expected + 16 * (4 * data.levels.size() + 4));  // arrays are aligned

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
