// Emission as devices do it that aren't software.
#include <doctest/doctest.h>

#include "tests/emit/pipeline.hpp"
#include "tests/support/driver_between.hpp"

using namespace espalier;

namespace {

PFN_vkGetPhysicalDeviceProperties2 realProperties;
VKAPI_ATTR void VKAPI_CALL asDiscrete(VkPhysicalDevice device, VkPhysicalDeviceProperties2* all) {
    realProperties(device, all);
    all->properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
}

// The same device under another name.
std::shared_ptr<Device> discrete(Device& real) {
    realProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(
        real.getInstanceProcAddr()(real.instance(), "vkGetPhysicalDeviceProperties2"));
    test::DriverBetween driver(real);
    driver.replace("vkGetPhysicalDeviceProperties2", asDiscrete);
    Result<std::unique_ptr<Device>> adopted = Device::adopt(driver.host());
    REQUIRE(adopted);
    return std::move(*adopted);
}

}  // namespace

TEST_CASE("what is drawn doesn't depend on the kind of device, nor on how coarse cells are") {
    const std::shared_ptr<Device> real = test::validatedDevice(), other = discrete(*real);
    REQUIRE_FALSE(other->info().cpu);
    // As many as a kernel sorts on a software device, which ends its loops after 65,535 trips in all.
    const test::PlantData data = test::wallIvy(10, 4, 3);
    const EmitView view = parallelView(glm::mat4(1), 120, 1);
    EmitState states[2];
    std::vector<DrawnItem> drawn[2];
    for (float side : {4.0f, 4000.0f})  // with the second all grows in a few cells
        for (int i : {0, 1}) {
            CAPTURE(side);
            test::EmitPipeline pipeline(i == 0 ? real : other);
            const test::Plant plant = test::upload(*pipeline.device, data);
            EmitInputs inputs = plant.inputs();
            inputs.low = glm::vec3(-side);
            inputs.high = glm::vec3(side);
            states[i] = pipeline.cull(inputs, view);
            drawn[i] = *readVector<DrawnItem>(*pipeline.device, pipeline.emit.drawn(), 0,
                                              states[i].spanCount + states[i].leafCount);
            if (i == 0) continue;
            CHECK(states[0].leafCount > 300);
            CHECK(std::memcmp(&states[0].counts, &states[1].counts, sizeof states[0].counts) == 0);
            CHECK(std::memcmp(&states[0].draws, &states[1].draws, sizeof states[0].draws) == 0);
            REQUIRE(drawn[0].size() == drawn[1].size());
            CHECK(std::memcmp(drawn[0].data(), drawn[1].data(), drawn[0].size() * sizeof(DrawnItem)) == 0);
        }
    CHECK(real->validationMessages() == 0);
}
