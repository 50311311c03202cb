// After edits only what they concern is bound anew, and what is drawn is what binding everything gives: by an emission
// that has never seen the growth before.
#include <doctest/doctest.h>

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
    for (int way = 0; way < 4; ++way) {
        const bool texels = way / 2 != 0;  // records by address; on software devices as texels
        const EmitView& view = views[way % 2];
        CAPTURE(way);
        plant.view.nodeBuffer = texels ? &plant.nodes : nullptr;
        plant.view.chunkBuffer = texels ? &plant.chunks : nullptr;
        plant.view.leafBuffer = texels ? &plant.leaves : nullptr;
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
