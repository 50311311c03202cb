// After edits only what they concern is bound anew, and what is drawn is what binding everything gives: by an emission
// that has never seen the growth before.
#include <doctest/doctest.h>

#include "runtime/emit/emit_memory.hpp"
#include "tests/emit/edited.hpp"
#include "tests/emit/pipeline.hpp"

using namespace espalier;

TEST_CASE("an edit binds what it concerns, and leaves what binding everything leaves") {
    const std::shared_ptr<Device> device = test::validatedDevice();
    test::Edited e = test::edited();
    test::Plant plant = test::upload(*device, e.last);
    const Buffer touched = std::move(*makeBuffer(*device, "touched", e.touchedLast));
    EmitView views[2] = {};
    views[0].flags = kFullDetail;
    views[0].lodPixels = 1;
    views[1] = parallelView(glm::mat4(1), 120, 1);  // thinned out
    for (glm::vec4& plane : views[1].planes) plane = glm::vec4(0, 0, 0, 1);
    for (const EmitView& view : views) {
        CAPTURE(&view - views);
        plant.view.touched = &touched;
        test::EmitPipeline often(device);
        const auto write = [&](const test::PlantData& data, const std::vector<uint32_t>& numbers) {
            test::rewrite(*device, plant, touched, data, numbers);
        };
        write(e.before, e.touched);
        plant.view.number = plant.view.renewed = 1;
        often.cull(plant.inputs(), view);
        CHECK(often.emit.stats().bound == plant.view.nodeCount + plant.view.leafCount);
        for (const bool again : {false, true}) {
            CAPTURE(again);
            write(again ? e.last : e.after, again ? e.touchedLast : e.touched);
            plant.view.number += 1;
            test::EmitPipeline once(device);
            const EmitState part = often.cull(plant.inputs(), view);
            const uint32_t bound = often.emit.stats().bound;
            CHECK(bound > 0);
            CHECK(bound < (plant.view.nodeCount + plant.view.leafCount) / 2);
            const EmitState whole = once.cull(plant.inputs(), view);
            CHECK(once.emit.stats().bound == plant.view.nodeCount + plant.view.leafCount);
            CHECK(whole.spanCount > 300);
            compareDrawn(*device, often, part, once, whole);
        }
        // Nodes elsewhere: all again.
        plant.view.renewed = plant.view.number += 1;
        plant.view.revision += 1;
        often.cull(plant.inputs(), view);
        CHECK(often.emit.stats().bound == plant.view.nodeCount + plant.view.leafCount);
    }
}

namespace {

// Puts a chunk without nodes between each twig and the chunk that it leaves.
void addChunksWithoutNodes(test::PlantData& data) {
    for (const BranchRecord& branch : data.branches) {
        const uint32_t twig = branch.firstChunk, joint = data.chunks[twig].previousNode;
        if (joint == kNoIndex) continue;
        const uint32_t between = uint32_t(data.chunks.size()), parent = data.nodes[joint].chunk;
        uint32_t* link = &data.chunks[parent].firstChild;
        while (*link != twig) link = &data.chunks[*link].nextSibling;
        *link = between;
        Chunk chunk{};
        chunk.branch = kNoIndex;
        chunk.previousNode = joint;
        chunk.parent = parent;
        chunk.firstChild = twig;
        chunk.nextSibling = std::exchange(data.chunks[twig].nextSibling, kNoIndex);
        data.chunks[twig].parent = between;
        data.chunks.push_back(chunk);
    }
}

}  // namespace

TEST_CASE("with a node the spans are bound that start there behind chunks without nodes") {
    const std::shared_ptr<Device> device = test::validatedDevice();
    test::PlantData before = test::wallIvy(8, 2, 1.5f);
    test::linkChunks(before);
    addChunksWithoutNodes(before);
    test::PlantData after = before;
    std::vector<uint32_t> touched((before.nodes.size() + 3) / 4 * 4, 1);
    for (size_t twig = before.branches.size() - 3; twig < before.branches.size(); ++twig) {
        const uint32_t joint = before.chunks[before.branches[twig].firstChunk].previousNode;
        REQUIRE(joint != kNoIndex);
        after.nodes[joint].position.z += 0.01f;
        touched[joint] = 2;
    }
    test::Plant plant = test::upload(*device, before);
    const Buffer numbers = std::move(*makeBuffer(*device, "touched", touched));
    plant.view.touched = &numbers;
    EmitView view{};
    view.flags = kFullDetail;
    view.lodPixels = 1;
    for (const bool native : {false, true}) {
        CAPTURE(native);
        test::EmitPipeline often(device), once(device);
        const auto cull = [&](test::EmitPipeline& pipeline) {
            EmitInputs inputs = plant.inputs();
            inputs.native = native;
            return pipeline.cull(inputs, view);
        };
        plant.view.number = plant.view.renewed = 1;
        test::rewrite(*device, plant, numbers, before, touched);
        cull(often);
        plant.view.number = 2;
        test::rewrite(*device, plant, numbers, after, touched);
        const EmitState part = cull(often);
        CHECK(often.emit.stats().bound < (plant.view.nodeCount + plant.view.leafCount) / 2);
        compareDrawn(*device, often, part, once, cull(once));
    }
}

TEST_CASE("room is kept for twice what is bound where that costs nothing, up to what a buffer holds") {
    CHECK(instanceRoom(1000, 96, 1 << 30, false) == 1000);
    CHECK(instanceRoom(1000, 96, 1 << 30, true) == 2000);
    CHECK(instanceRoom(1000, 96, 96 * 1500 + 95, true) == 1500);
    CHECK(instanceRoom(1000, 96, 96 * 1000, true) == 1000);
    CHECK(instanceRoom(1000, 96, 96 * 500, true) == 1000);  // what is there comes first; the buffer says why not
    CHECK(instanceRoom(0, 96, 1 << 30, true) == 0);
    CHECK(instanceRoom(3'000'000'000, 96, ~0ull, true) == 6'000'000'000);
}

TEST_CASE("on software devices an edit that adds to a plant stays within the room of what is bound") {
    const std::shared_ptr<Device> device = test::validatedDevice();
    test::Edited e = test::edited();
    test::Plant plant = test::upload(*device, e.last);
    const Buffer touched = std::move(*makeBuffer(*device, "touched", e.touchedLast));
    plant.view.touched = &touched;
    test::EmitPipeline pipeline(device);
    const Emit& emit = pipeline.emit;
    const EmitView view = parallelView(glm::mat4(1), 120, 1);
    test::rewrite(*device, plant, touched, e.before, e.touched);
    plant.view.number = plant.view.renewed = 1;
    pipeline.cull(plant.inputs(), view);
    const uint64_t spare = device->info().cpu ? 2 : 1;
    constexpr uint64_t kLeast = 65536;  // bytes of any buffer
    REQUIRE(plant.view.nodeCount * sizeof(SpanInstance) > kLeast);
    REQUIRE(2 * plant.view.leafCount * sizeof(LeafInstance) > kLeast);
    CHECK(emit.spanInstances().size() == spare * plant.view.nodeCount * sizeof(SpanInstance));
    CHECK(emit.leafInstances().size() == std::max(kLeast, spare * plant.view.leafCount * sizeof(LeafInstance)));
    const uint64_t bound = emit.spanInstances().address();
    test::rewrite(*device, plant, touched, e.after, e.touched);
    REQUIRE(e.after.nodes.size() > e.before.nodes.size());
    plant.view.number += 1;
    pipeline.cull(plant.inputs(), view);
    CHECK(emit.wholeBindings() == 1);
    CHECK(emit.carries() == (spare == 2 ? 0 : 1));
    CHECK((emit.spanInstances().address() == bound) == (spare == 2));
}
