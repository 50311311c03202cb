// Devices that run kernels wrongly are found before anything grows on them, and named.
#include <doctest/doctest.h>

#include <cstdio>
#include <fstream>

#include "runtime/expand/cpu_growth.hpp"
#include "runtime/plugin/checked_devices.hpp"
#include "runtime/plugin/self_check.hpp"
#include "runtime/plugin/self_check_picture.hpp"
#include "runtime/plugin/self_check_scene.hpp"
#include "tests/support/driver_between.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace espalier;

namespace {

std::unique_ptr<Device> madeDevice(const DeviceOptions& options = {}) {
    Result<std::unique_ptr<Device>> device = Device::create(options);
    REQUIRE_MESSAGE(device, (device ? "" : device.failure().text()));
    return std::move(*device);
}
std::unique_ptr<Device> adopted(const test::DriverBetween& driver) {
    Result<std::unique_ptr<Device>> device = Device::adopt(driver.host());
    REQUIRE_MESSAGE(device, (device ? "" : device.failure().text()));
    return std::move(*device);
}

// Faults of a driver.
VKAPI_ATTR void VKAPI_CALL dispatchNothing(VkCommandBuffer, VkBuffer, VkDeviceSize) {}
VKAPI_ATTR void VKAPI_CALL drawNothing(VkCommandBuffer, VkBuffer, VkDeviceSize, uint32_t, uint32_t) {}
VKAPI_ATTR void VKAPI_CALL drawNoIndexed(VkCommandBuffer, uint32_t, uint32_t, uint32_t, int32_t, uint32_t) {}

std::string faultOf(Device& device) {
    const Status ran = runSelfCheck(device);
    REQUIRE_FALSE(ran);
    CHECK(ran.failure().cause == Failure::Cause::fault);
    const std::string text = ran.failure().text();
    CAPTURE(text);
    CHECK(text.find(device.info().name) != std::string::npos);
    CHECK(text.find(device.info().driver) != std::string::npos);
    return text;
}

}  // namespace

TEST_CASE("the scene of the self-check is a sound surface, whose plants go over its seam") {
    const SurfaceData step = selfcheck::step();
    const test::ScratchFolder folder;
    REQUIRE(writeSurface(step, folder.file("step.glb")));
    const Result<SurfaceData> read = readSurface(folder.file("step.glb"));
    REQUIRE_MESSAGE(read, (read ? "" : read.failure().text()));
    CHECK(read.value().hash == step.hash);

    Result<RuleMap> rules = selfcheck::plantRules();
    REQUIRE_MESSAGE(rules, (rules ? "" : rules.failure().text()));
    CHECK(rules->warnings().empty());
    const RuleMapRef ref = rules->ref();
    SurfaceRef surface = surfaceRef(step);
    std::vector<LayerRef> layers(kMaxLayers, LayerRef{{nullptr}, 0, 1});
    const std::vector<Seed> seeds = selfcheck::seedsOnFloor(12);
    GrowthInputs inputs;
    inputs.surfaces = {&surface};
    inputs.surfaceCount = 1;
    inputs.layers = {layers.data()};
    inputs.grammars = {&ref, 1};
    inputs.seeds = seeds;
    const Result<CpuGrowth> grown = growOnCpu(inputs);
    REQUIRE(grown);
    uint32_t onFloor = 0, onWall = 0;
    for (const Node& node : grown.value().nodes) {
        const bool wall = (node.place & 0xFFFFu) == 1;
        ++(wall ? onWall : onFloor);
        CHECK(std::abs(wall ? node.position.z : node.position.y) < 1e-4f);
    }
    CHECK(onFloor > 50);
    CHECK(onWall > 50);
    CHECK(grown.value().branches.size() > 2 * seeds.size());
    CHECK(grown.value().leaves.size() > 100);
}

TEST_CASE("the self-check's picture is the one that was written down") {
    std::unique_ptr<Device> device = madeDevice();
    const Result<CheckPicture> picture = drawCheckPicture(*device);
    REQUIRE_MESSAGE(picture, (picture ? "" : picture.failure().text()));
    if (picture.value() == selfcheck::kPicture) return;
    std::printf("inline constexpr CheckPicture kPicture{{\n");
    for (const auto& block : picture.value()) std::printf("{%d, %d, %d},\n", block[0], block[1], block[2]);
    std::printf("}};\n");
    FAIL_CHECK("the table above belongs into runtime/plugin/self_check_picture.hpp, if the picture is right");
}

TEST_CASE("a driver that drops work is told by its name, wherever it drops it") {
    const std::unique_ptr<Device> real = madeDevice();
    SUBCASE("kernels whose groups are counted by others") {
        test::DriverBetween driver(*real);
        driver.replace("vkCmdDispatchIndirect", &dispatchNothing);
        CHECK(faultOf(*adopted(driver)).find("growth lost shapes") != std::string::npos);
    }
    SUBCASE("draws") {
        test::DriverBetween driver(*real);
        driver.replace("vkCmdDrawIndexedIndirect", &drawNothing);
        driver.replace("vkCmdDrawIndexed", &drawNoIndexed);
        CHECK(faultOf(*adopted(driver)).find("picture") != std::string::npos);
    }
}

TEST_CASE("a device that has passed is remembered in the folder; a check that crashed is told") {
    const test::ScratchFolder folder;
    std::string said;
    DeviceOptions options;
    options.log = [&](Severity, std::string_view text) { said += text; };
    std::unique_ptr<Device> device = madeDevice(options);
    forgetCheckedDevices();
    REQUIRE(checkDevice(*device, folder.path));
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path)) files.push_back(entry.path());
    REQUIRE(files.size() == 1);
    CHECK(files[0].extension() == ".passed");
    CHECK(said.empty());
    // A process that is no more has left its mark, and the check runs again, since what has passed isn't known.
    std::filesystem::remove(files[0]);
    forgetCheckedDevices();
    std::ofstream(files[0].replace_extension(".checking")) << 0x7FFFFFF0;
    REQUIRE(checkDevice(*device, folder.path));
    CHECK(said.find(device->info().name) != std::string::npos);
    CHECK(said.find("didn't come to its end") != std::string::npos);
    CHECK(!std::filesystem::exists(files[0]));
    CHECK(std::filesystem::exists(files[0].replace_extension(".passed")));
}
