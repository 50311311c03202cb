// Emission as devices do it that aren't software.
#include <doctest/doctest.h>

#include <numeric>

#include "tests/emit/edited.hpp"
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

// An edited plant on a device, and its emission there.
struct Edits {
    test::EmitPipeline pipeline;
    const test::Edited& plants;
    test::Plant plant;
    Buffer touched, nodesStay, leavesStay;  // the latter two: moves of all to where they are

    Edits(const std::shared_ptr<Device>& device, const test::Edited& given)
        : pipeline(device), plants(given), plant(test::upload(*device, given.last)) {
        touched = std::move(*makeBuffer(*device, "touched", given.touchedLast));
        nodesStay = counted(given.after.nodes.size());
        leavesStay = counted(given.after.leaves.size());
        plant.view.touched = &touched;
    }
    Buffer counted(size_t count) {
        std::vector<uint32_t> numbers(count);
        std::iota(numbers.begin(), numbers.end(), 0u);
        return std::move(*makeBuffer(*pipeline.device, "stay", numbers));
    }
    void begin() {
        plant.view.number = plant.view.renewed = 1;
        test::rewrite(*pipeline.device, plant, touched, plants.before, plants.touched);
    }
    void edit() {
        plant.view.number = 2;
        test::rewrite(*pipeline.device, plant, touched, plants.after, plants.touched);
    }
    // Growth 3 closes gaps, 4 edits.
    void editClosed() {
        const uint32_t nodes = uint32_t(plants.after.nodes.size()), leaves = uint32_t(plants.after.leaves.size());
        plant.view.moved = {&nodesStay, &leavesStay, nodes, leaves, nodes, leaves};
        plant.view.renewed = 3;
        plant.view.number = 4;
        std::vector<uint32_t> numbers = plants.touchedLast;
        for (uint32_t& number : numbers) number += number == 3;
        test::rewrite(*pipeline.device, plant, touched, plants.last, numbers);
    }
    // side: half the grid's, metres.
    EmitState cull(float side) {
        EmitView view = parallelView(glm::mat4(1), 120, 1);
        for (glm::vec4& plane : view.planes) plane = glm::vec4(0, 0, 0, 1);
        EmitInputs inputs = plant.inputs();
        inputs.low = glm::vec3(-side);
        inputs.high = glm::vec3(side);
        return pipeline.cull(inputs, view);
    }
};

}  // namespace

TEST_CASE("what is drawn doesn't depend on the kind of device, nor on how coarse cells are") {
    const std::shared_ptr<Device> real = test::validatedDevice(), other = discrete(*real);
    REQUIRE_FALSE(other->info().cpu);
    // As many as a kernel sorts on a software device, which ends its loops after 65,535 trips in all.
    const test::PlantData data = test::wallIvy(6, 4, 3);
    const EmitView view = parallelView(glm::mat4(1), 120, 1);
    REQUIRE(data.nodes.size() > 30 * kLongRun);  // where cells are coarse most share a few bins
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

TEST_CASE("an edit binds and carries over the same on any kind of device, however coarse cells are") {
    const std::shared_ptr<Device> real = test::validatedDevice(), other = discrete(*real);
    const test::Edited plants = test::edited();
    for (float side : {4.0f, 4000.0f}) {
        CAPTURE(side);
        Edits a(real, plants), b(other, plants);
        const auto compare = [&](void (Edits::*step)()) {
            (a.*step)();
            (b.*step)();
            const EmitState ours = a.cull(side), theirs = b.cull(side);
            CHECK(ours.spanCount > 300);
            compareDrawn(*real, b.pipeline, theirs, a.pipeline, ours);
        };
        compare(&Edits::begin);
        compare(&Edits::edit);
        CHECK(b.pipeline.emit.carries() == 1);  // a GPU keeps no room for more
        compare(&Edits::editClosed);
        CHECK(b.pipeline.emit.carries() == 2);
        for (const Edits* e : {&a, &b}) CHECK(e->pipeline.emit.wholeBindings() == 1);
    }
    CHECK(real->validationMessages() == 0);
}
