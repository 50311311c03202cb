// Cells that outgrow the room that there is in the order of items.
#include <doctest/doctest.h>

#include "tests/emit/edited.hpp"
#include "tests/emit/pipeline.hpp"

using namespace espalier;

namespace {

constexpr uint32_t kNodes = 16, kLeaves = 200'000;

// A short branch near the grid's left side, with very many leaves.
test::PlantData bush() {
    test::PlantData data;
    std::vector<glm::vec3> points, normals(kNodes, glm::vec3(0, 0, 1));
    for (uint32_t i = 0; i < kNodes; ++i) points.emplace_back(-3.75f, 0.2f + 0.005f * float(i), 0.2f);
    data.addBranch(points, normals, kNoIndex, [](float) { return 0.004f; });
    for (uint32_t i = 0; i < kLeaves; ++i)
        data.addLeaf(1 + i % (kNodes - 1), 1, 0.02f, i % 2 ? 1.0f : -1.0f, 0.01f, i * 2654435761u >> 8);
    test::linkChunks(data);
    return data;
}

}  // namespace

TEST_CASE("what found no room in the order of items is bound once that is known, and all of it only once") {
    const std::shared_ptr<Device> device = test::validatedDevice();
    test::PlantData data = bush();
    test::Plant plant = test::upload(*device, data);
    const Buffer touched = std::move(*makeBuffer(*device, "touched", std::vector<uint32_t>(kNodes, 1)));
    plant.view.touched = &touched;
    plant.view.number = plant.view.renewed = 1;
    test::EmitPipeline pipeline(device);
    EmitView view{};
    view.flags = kFullDetail;
    view.lodPixels = 1;
    const auto cull = [&](bool counted) {
        EmitInputs inputs = plant.inputs();
        inputs.native = true;  // kernels put only so many in order on a software device
        Result<Commands> commands = Commands::begin(*device, "cull");
        REQUIRE(commands);
        REQUIRE(pipeline.emit.cull(*commands, inputs, view, "emit", counted));
        REQUIRE(commands->finish());
        return readVector<EmitState>(*device, pipeline.emit.state(), 0, 1)->at(0);
    };
    EmitState state = cull(false);
    CHECK(state.leafCount == kLeaves);
    // Edits move it to other cells, and no count says that room runs out, until it has.
    for (uint32_t edit = 0; edit < 7 && state.crowded == 0; ++edit) {
        CHECK(state.leafCount == kLeaves);
        for (Node& node : data.nodes) node.position.x += 1;
        plant.view.number += 1;
        test::rewrite(*device, plant, touched, data, std::vector<uint32_t>(kNodes, plant.view.number));
        state = cull(false);
    }
    REQUIRE(state.crowded != 0);
    CHECK(cull(true).leafCount < kLeaves);
    CHECK(pipeline.emit.wholeBindings() == 1);
    for (const bool counted : {false, false, true, true}) {
        CHECK(cull(counted).leafCount == kLeaves);
        CHECK(pipeline.emit.wholeBindings() == 2);
    }
}
