// What emission leaves behind where memory runs short, and what it needn't do twice.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/emit/pipeline.hpp"
#include "tests/support/driver_between.hpp"

using namespace espalier;

namespace {

// Of the driver in between: calls until one fails.
uint32_t viewsLeft = ~0u, submissionsLeft = ~0u;
PFN_vkCreateBufferView realView;
VKAPI_ATTR VkResult VKAPI_CALL createView(VkDevice device, const VkBufferViewCreateInfo* info,
                                          const VkAllocationCallbacks* memory, VkBufferView* view) {
    return viewsLeft-- == 0 ? VK_ERROR_OUT_OF_DEVICE_MEMORY : realView(device, info, memory, view);
}
PFN_vkQueueSubmit2 realSubmit;
VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count, const VkSubmitInfo2* infos, VkFence fence) {
    return submissionsLeft-- == 0 ? VK_ERROR_OUT_OF_DEVICE_MEMORY : realSubmit(queue, count, infos, fence);
}

// A host's memory, which may refuse what has a certain name.
class RefusingMemory : public MemorySource {
  public:
    explicit RefusingMemory(MemorySource& source) : source_(source) {}
    Result<MemoryBlock> allocate(const MemoryRequest& request) override {
        if (refused == request.name) return Failure(request.name, "none left");
        return source_.allocate(request);
    }
    void free(const MemoryBlock& block) noexcept override { source_.free(block); }
    uint64_t bytesUsed() const override { return source_.bytesUsed(); }
    uint64_t bytesReserved() const override { return source_.bytesReserved(); }
    std::string refused;

  private:
    MemorySource& source_;
};

// A device that runs short on order.
struct Short {
    std::shared_ptr<Device> real = test::validatedDevice();
    RefusingMemory memory{real->memory()};
    std::shared_ptr<Device> device;

    Short() {
        viewsLeft = submissionsLeft = ~0u;
        realView = real->vk().vkCreateBufferView;
        realSubmit = real->vk().vkQueueSubmit2;
        test::DriverBetween driver(*real);
        driver.replace("vkCreateBufferView", createView);
        driver.replace("vkQueueSubmit2", submit);
        HostDevice host = driver.host();
        host.memory = &memory;
        Result<std::unique_ptr<Device>> adopted = Device::adopt(host);
        REQUIRE(adopted);
        device = std::move(*adopted);
    }
    ~Short() {
        device.reset();
        CHECK(real->validationMessages() == 0);
    }
};

Commands begun(Device& device) {
    Result<Commands> commands = Commands::begin(device, "test");
    REQUIRE(commands);
    return std::move(*commands);
}

}  // namespace

TEST_CASE("a view of texels that can't be made costs the picture that needed it, and no other") {
    Short host;
    const test::PlantData few = test::helix(100), many = test::wallIvy(40, 4, 3);
    const test::Plant small = test::upload(*host.device, few), large = test::upload(*host.device, many);
    uint32_t failures = 0;
    for (bool native : {false, true})
        for (uint32_t at = 0;; ++at) {
            REQUIRE(at < 1000);
            CAPTURE(at);
            CAPTURE(native);
            test::EmitPipeline pipeline(host.device);
            pipeline.cull(small.inputs(), test::fullDetail());
            EmitInputs inputs = large.inputs();
            inputs.native = native;
            bool drawn = false;
            {
                Commands dropped = begun(*host.device);
                viewsLeft = at;
                drawn = bool(pipeline.emit.cull(dropped, inputs, test::fullDetail(), "emit", true));
                viewsLeft = ~0u;
            }
            pipeline.emit.forget();
            const EmitState state = pipeline.cull(inputs, test::fullDetail());
            CHECK(state.leafCount == many.leaves.size());
            if (drawn) break;
            failures += 1;
        }
    CHECK(failures > 4);
}

TEST_CASE("a picture is watched when there is memory for it again") {
    Short host;
    const test::PlantData data = test::helix(100);
    const test::Plant plant = test::upload(*host.device, data);
    test::EmitPipeline pipeline(host.device);
    EmitView view = parallelView(glm::mat4(1), 100, 1);
    view.width = view.height = 256;
    Commands commands = begun(*host.device);
    host.memory.refused = "taken tiles";
    REQUIRE_FALSE(pipeline.emit.watch(commands, view));
    host.memory.refused.clear();
    REQUIRE(pipeline.emit.watch(commands, view));
    const EmitInputs inputs = plant.inputs();
    const EmitView first = pipeline.emit.takeChanges(commands, inputs, 4);
    CHECK(first.tiles.v != nullptr);
    const EmitView second = pipeline.emit.takeChanges(commands, inputs, 4);
    CHECK(second.scene != first.scene);
    REQUIRE(commands.finish());
}

TEST_CASE("growth that was bound in a recording that never ran is bound anew") {
    Short host;
    const test::PlantData data = test::wallIvy(5, 2, 1.5f);
    const test::Plant plant = test::upload(*host.device, data);
    test::EmitPipeline pipeline(host.device);
    submissionsLeft = 0;
    REQUIRE_FALSE(pipeline.emit.materialise(plant.inputs()));
    const EmitState state = pipeline.cull(plant.inputs(), test::fullDetail());
    CHECK(state.leafCount == data.leaves.size());
    CHECK(state.spanCount > 100);
    CHECK(pipeline.emit.materialise(plant.inputs()));
}

TEST_CASE("an unmoved view isn't culled again where only its tiles lie elsewhere") {
    test::EmitPipeline pipeline;
    Device& device = *pipeline.device;
    const test::PlantData data = test::wallIvy(5, 2, 1.5f);
    const test::Plant plant = test::upload(device, data);
    EmitView view = parallelView(glm::mat4(1), 100, 1);
    view.viewProjection = glm::mat4(1);
    view.width = view.height = 64;
    std::vector<Buffer> tiles;
    for (int i = 0; i < 2; ++i)
        tiles.push_back(std::move(*makeBuffer(device, "tiles", std::vector<float>(tilesOf(view), 0.0f))));
    const auto culledBy = [&](const Buffer* at, uint64_t scene) {
        view.tiles.v = at ? reinterpret_cast<float*>(at->address()) : nullptr;
        view.scene = scene;
        pipeline.cull(plant.inputs(), view);
        device.collect();
        const auto found = std::ranges::find(device.timings(), "emit", &PassTime::name);
        REQUIRE(found != device.timings().end());
        return found->submission;
    };
    const uint64_t first = culledBy(&tiles[0], 1);
    CHECK(culledBy(&tiles[1], 1) == first);
    const uint64_t second = culledBy(&tiles[0], 2);
    CHECK(second > first);
    CHECK(culledBy(nullptr, 2) > second);
}
