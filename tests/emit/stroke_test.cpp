// A long stroke of the brush over growth: gaps are closed and buffers enlarged in it, and yet no frame binds more than
// what its dab concerned; what is drawn is what binding everything gives.
#include <doctest/doctest.h>

#include <cstdio>

#include "tests/emit/pipeline.hpp"
#include "tests/expand/session.hpp"

using namespace espalier;

TEST_CASE("however long a stroke, everything is bound once") {
    for (const bool native : {false, true}) {
        CAPTURE(native);
        growthtest::Session s(growthtest::flatSquare(), GrowthRoom{64, 256, 64, 256, 64});
        s.scene.native = native;
        s.scene.plantMany(60, 0, 1);
        const std::shared_ptr<Device> device(&s.gpu.device(), [](Device*) {});
        EmitView view = parallelView(glm::mat4(1), 400, 1);
        for (glm::vec4& plane : view.planes) plane = glm::vec4(0, 0, 0, 1);
        const Buffer surfaces = std::move(*makeBuffer(*device, "surfaces", test::PlantData().surfaces));
        const auto inputs = [&] {
            EmitInputs given{s.growth->view()};
            given.native = native;
            given.surfaces.v = reinterpret_cast<SurfaceRef*>(surfaces.address());
            return given;
        };
        test::EmitPipeline often(device);
        // What the brush takes away it gives back elsewhere; at last there is more than at first.
        s.dab(0, {0.5f, 0.5f}, 0.3f, 0);
        s.grow();
        often.cull(inputs(), view);
        uint32_t renewed = 0, compared = 0;
        double share[2] = {};  // of what there is that was bound: summed over frames without and with gaps closed
        constexpr int kDabs = 40;
        for (int i = 0; i < kDabs; ++i) {
            CAPTURE(i);
            const uint32_t before = s.growth->view().renewed;
            s.dab(0, {0.3f + 0.4f * float(i % 7) / 7, 0.3f + 0.4f * float(i % 11) / 11}, 0.05f, i % 3 ? 1.0f : 0.0f);
            s.grow();
            const EmitState part = often.cull(inputs(), view);
            const GrowthView& grown = s.growth->view();
            const bool moved = grown.renewed != before;
            renewed += moved;
            share[moved] += double(often.emit.stats().bound) / double(grown.nodeCount + grown.leafCount);
            if (!moved && i % 20 != 19) continue;
            test::EmitPipeline once(device);
            const EmitState whole = once.cull(inputs(), view);
            CHECK(whole.spanCount > 300);
            compareDrawn(*device, often, part, once, whole);
            compared += 1;
        }
        const double usual = share[0] / (kDabs - renewed), closing = share[1] / std::max(renewed, 1u);
        std::printf(
            "gaps closed %u times, bound growth carried over %u times; %.0f %% bound in such frames, %.0f %% in "
            "others\n",
            renewed, uint32_t(often.emit.carries()), 100 * closing, 100 * usual);
        CHECK(renewed >= 2);
        CHECK(compared >= 4);
        CHECK(often.emit.carries() >= renewed);
        CHECK(often.emit.wholeBindings() == 1);
        CHECK(closing < 1.5 * usual);
        s.check();
    }
}
