// Growth as native code against growth by shaders: the same plants, whatever the number of threads and whatever edits.
#include <doctest/doctest.h>

#include "shaders/shared/random.h"
#include "tests/expand/growing.hpp"
#include "tests/expand/session.hpp"
#include "tests/support/driver_between.hpp"

using namespace espalier;
using namespace espalier::growthtest;

TEST_CASE("native code grows what shaders grow") {
    TestDevice gpu;
    if (!gpu.device().info().cpu) {
        MESSAGE("only software devices run growth as native code");
        return;
    }
    Scene scene = Scene::baked(cube());
    scene.addGrammar(kGuided);
    scene.paint(0, 256, [](glm::vec2 uv) { return uv.x + uv.y < 1.2f ? 1.0f : 0.0f; });
    auto shaders = gpu.growth(), native = gpu.growth(), cramped = gpu.growth({16, 64, 16, 16, 4});
    struct Mode {
        uint32_t seeds;
        TangentMode tangents;
        WalkMode walk;
        float cap;
        uint32_t most;
    };
    const Mode modes[] = {{1, TangentMode::stem, WalkMode::intrinsic, 0, 4'000'000},
                          {65, TangentMode::stem, WalkMode::intrinsic, 0, 4'000'000},
                          {65, TangentMode::stem, WalkMode::intrinsic, 0, 3000},
                          {33, TangentMode::paper, WalkMode::paper, 0, 4'000'000},
                          {33, TangentMode::stem, WalkMode::intrinsic, 40, 4'000'000}};
    for (const Mode& mode : modes) {
        CAPTURE(&mode - modes);
        scene.clearSeeds();
        scene.plantMany(mode.seeds);
        scene.limits.tangents = mode.tangents;
        scene.limits.walk = mode.walk;
        scene.limits.leafDensityCap = mode.cap;
        scene.limits.maxNodes = mode.most;
        scene.native = false;
        mustGrow(scene, gpu, *shaders);
        CHECK(!shaders->stats().native);
        scene.native = true;
        for (Growth* growth : {native.get(), cramped.get()}) {
            mustGrow(scene, gpu, *growth);
            const GrowthStats a = shaders->stats(), b = growth->stats();
            CHECK(b.native);
            CHECK(b.nodes >= mode.seeds);
            CHECK(a.hash == b.hash);
            CHECK(a.nodes == b.nodes);
            CHECK(a.chunks == b.chunks);
            CHECK(a.branches == b.branches);
            CHECK(a.leaves == b.leaves);
            CHECK(a.stopped == b.stopped);
            CHECK(a.waves == b.waves);
        }
    }
}

// As large as numbers get, also where the lanes of native code are filled otherwise.
TEST_CASE("turns by any angle are the same in native code and in shaders") {
    TestDevice gpu;
    Scene scene = Scene::baked(cube());
    scene.addGrammar(R"(
param turn = 1e9 [0 .. 1e9]
Stem(n) -> Marching(0.04, rand(-1, 1) * turn * 1000, n < 60) {Fork(n + 1), Bark}
Fork(n) -> Branch(2) {Twig(0), Stem(n)} : 0.3
Fork(n) -> Stem(n) : 0.7
Twig(n) -> Marching(0.03, rand(-1, 1) * turn * turn, n < 8) {Twig(n + 1), Bark}
Bark -> S(0.01) Shape("bark", C1)
)");
    scene.plantMany(65);
    auto shaders = gpu.growth(), native = gpu.growth(), cramped = gpu.growth({16, 64, 16, 16, 4});
    mustGrow(scene, gpu, *shaders);
    CHECK(shaders->stats().nodes > 500);
    scene.native = gpu.device().info().cpu;
    for (Growth* growth : {native.get(), cramped.get()}) {
        mustGrow(scene, gpu, *growth);
        CHECK(growth->stats().hash == shaders->stats().hash);
    }
}

TEST_CASE("native code grows where shaders have grown") {
    TestDevice gpu;
    Scene scene = Scene::baked(cube());
    scene.addGrammar(kGuided);
    scene.plantMany(5);
    auto growth = gpu.growth();
    mustGrow(scene, gpu, *growth);
    const uint64_t hash = growth->stats().hash;
    scene.native = true;
    mustGrow(scene, gpu, *growth);
    CHECK(growth->stats().hash == hash);
}

TEST_CASE("edits of what native code has grown") {
    Session s(ball());
    s.scene.native = true;
    s.scene.plantMany(40, 0);
    s.scene.plantMany(20, 1, 2);  // with keys of their own, by which growths are compared
    s.upload(0);
    s.upload(1);
    s.check();
    const uint32_t before = s.growth->stats().regrowths;
    uint64_t key = 7;
    for (int i = 0; i < 6; ++i) {
        CAPTURE(i);
        key = mix64(key);
        const glm::vec2 at(uniformRandom(key, 1), uniformRandom(key, 2));
        s.dab(uint32_t(i & 1), at, 0.02f + 0.1f * uniformRandom(key, 3), i % 3 == 0 ? 0.0f : uniformRandom(key, 4));
        s.check();
    }
    s.set(0, "leafSize", 0.05f);
    s.check();
    s.set(1, "reach", 18);
    s.check();
    s.scene.seeds().pop_back();
    s.check();
    CHECK(s.growth->stats().regrowths > before);
}

namespace {

constexpr VkDeviceSize kMostBytes = 48ull << 20;

PFN_vkGetPhysicalDeviceProperties2 realProperties;
VKAPI_ATTR void VKAPI_CALL withSmallBuffers(VkPhysicalDevice device, VkPhysicalDeviceProperties2* all) {
    realProperties(device, all);
    for (auto* next = static_cast<VkBaseOutStructure*>(all->pNext); next; next = next->pNext)
        if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES)
            reinterpret_cast<VkPhysicalDeviceVulkan13Properties*>(next)->maxBufferSize = kMostBytes;
}

PFN_vkAllocateMemory realAllocate;
VKAPI_ATTR VkResult VKAPI_CALL allocateLittle(VkDevice device, const VkMemoryAllocateInfo* info,
                                              const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory) {
    constexpr VkDeviceSize kBlock = 64ull << 20;  // that small requests share
    if (info->allocationSize > kMostBytes && info->allocationSize != kBlock) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return realAllocate(device, info, callbacks, memory);
}

}  // namespace

TEST_CASE("what grows has its room where there is none to spare") {
    TestDevice gpu;
    if (!gpu.device().info().cpu) return;
    // Half as much again is more than a buffer holds, or than there is memory for.
    const uint32_t nodes = uint32_t((40ull << 20) / sizeof(Node));
    for (bool small : {true, false}) {
        CAPTURE(small);
        test::DriverBetween driver(gpu.device());
        realProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(
            gpu.device().getInstanceProcAddr()(gpu.device().instance(), "vkGetPhysicalDeviceProperties2"));
        realAllocate = gpu.device().vk().vkAllocateMemory;
        if (small)
            driver.replace("vkGetPhysicalDeviceProperties2", withSmallBuffers);
        else
            driver.replace("vkAllocateMemory", allocateLittle);
        Result<std::unique_ptr<Device>> adopted = Device::adopt(driver.host());
        REQUIRE(adopted);
        auto growth = Growth::create(**adopted, {64, nodes, 64, 64, 64});
        REQUIRE(growth);
        Scene scene = Scene::baked(cube());
        scene.addGrammar(kPlain);
        scene.native = true;
        scene.plantMany(4);
        const Status grown = scene.grow(**adopted, **growth);
        if (!grown) FAIL(grown.failure().text());
        CHECK((*growth)->stats().native);
        Result<CpuGrowth> reference = scene.growOnCpu();
        REQUIRE(reference);
        CHECK((*growth)->stats().hash == reference->stats.hash);
        const uint64_t bytes = (*growth)->view().nodeBuffer->size();
        CHECK(bytes >= nodes * sizeof(Node));
        CHECK(bytes <= kMostBytes);
    }
}
