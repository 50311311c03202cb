// Spans that are drawn as one: each span of the growth is drawn exactly once, alone or with others, and no stretch
// leaves out more than the view allows. And detail that follows the frames' time.
#include <doctest/doctest.h>

#include "tests/emit/pipeline.hpp"
#include "tools/scene/moving.hpp"

using namespace espalier;

namespace {

struct Drawn {
    EmitState state;
    std::vector<DrawnItem> spans;
};

struct Gpu : test::EmitPipeline {
    Drawn cull(const EmitInputs& inputs, const EmitView& view) {
        Drawn drawn{EmitPipeline::cull(inputs, view), {}};
        drawn.spans = *readVector<DrawnItem>(*device, emit.drawn(), 0, drawn.state.spanCount);
        return drawn;
    }
};

// From everywhere, at `pixels` a metre.
EmitView openView(float pixels, float lodPixels) {
    EmitView view = parallelView(glm::mat4(1), pixels, lodPixels);
    for (glm::vec4& plane : view.planes) plane = glm::vec4(0, 0, 0, 1);
    return view;
}

uint32_t joinedBefore(const DrawnItem& item) {
    return (item.bits >> 3) & 7;
}

}  // namespace

TEST_CASE("far spans are drawn as one with those before them, each once and none far off") {
    Gpu gpu;
    const test::PlantData data = test::wallIvy(8, 2, 1.5f);
    test::Plant plant = test::upload(*gpu.device, data);
    uint32_t bark = 0;
    for (const Node& node : data.nodes) bark += (node.flags & kNodeBark) != 0;
    for (float pixels : {20.0f, 80.0f, 320.0f, 4000.0f}) {
        CAPTURE(pixels);
        EmitView view = openView(pixels, 3);
        view.leastPixels = 1e-6f;  // nothing goes by its thickness
        CHECK(gpu.cull(plant.inputs(), view).state.spanCount == bark);
        view.flags = kStretches;
        const Drawn drawn = gpu.cull(plant.inputs(), view);
        std::vector<int> times(data.nodes.size(), 0);
        float worst = 0;
        for (const DrawnItem& item : drawn.spans) {
            const uint32_t first = item.item - joinedBefore(item);
            for (uint32_t n = first; n <= item.item; ++n) {
                ++times[n];
                CHECK(data.nodes[n].chunk == data.nodes[item.item].chunk);
            }
            const Chunk& chunk = data.chunks[data.nodes[first].chunk];
            const glm::vec3 a = data.nodes[first == chunk.firstNode ? chunk.previousNode : first - 1].position;
            const glm::vec3 along = glm::normalize(data.nodes[item.item].position - a);
            for (uint32_t n = first; joinedBefore(item) > 0 && n < item.item; ++n) {
                const glm::vec3 arm = data.nodes[n].position - a;
                worst = std::max(worst, glm::length(arm - along * glm::dot(arm, along)));
            }
        }
        for (size_t n = 0; n < data.nodes.size(); ++n)
            CHECK(times[n] == ((data.nodes[n].flags & kNodeBark) != 0 ? 1 : 0));
        CHECK(worst * pixels <= 3);
        if (pixels == 20) CHECK(drawn.state.spanCount < bark / 4);
        if (pixels == 4000) CHECK(drawn.state.spanCount == bark);
    }
}

TEST_CASE("leaves are thinned out while something moves, and all come back when it rests") {
    Gpu gpu;
    test::Plant plant = test::upload(*gpu.device, test::wallIvy(20, 4, 2));
    const EmitView full = openView(60, 1);
    const Drawn still = gpu.cull(plant.inputs(), full);
    CHECK((full.flags & kStretches) == 0);
    scene::MovingDetail detail;
    // Frames that are too slow as long as many leaves are drawn.
    const uint32_t many = 10 * scene::MovingDetail::kLeaves;
    for (int frame = 0; frame < 100; ++frame) detail.follow(2 * scene::MovingDetail::kFrameMs, many);
    EmitView moving = full;
    moving.lodPixels *= scene::MovingDetail::kLod;
    thinOut(moving, 8 * detail.leaf());
    const Drawn thin = gpu.cull(plant.inputs(), moving);
    CHECK(thin.state.leafCount * 2 < still.state.leafCount);
    CHECK(thin.state.spanCount * 2 < still.state.spanCount);
    // Few leaves are never thinned out further, and fast frames bring all back.
    const float coarse = detail.leaf();
    detail.follow(2 * scene::MovingDetail::kFrameMs, scene::MovingDetail::kLeaves - 1);
    CHECK(detail.leaf() < coarse);
    for (int frame = 0; frame < 100; ++frame) detail.follow(0.5 * scene::MovingDetail::kFrameMs, many);
    CHECK(detail.leaf() == 1);
    const Drawn again = gpu.cull(plant.inputs(), full);
    CHECK(again.state.leafCount == still.state.leafCount);
    CHECK(again.state.spanCount == still.state.spanCount);
}
