// Native code binds what shaders do, to the same instances in the same order, and after edits notes the same tiles of a
// watched picture; where a recording that looks at what was bound is in flight, it leaves it to them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "tests/emit/edited.hpp"
#include "tests/emit/pipeline.hpp"

using namespace espalier;

namespace {

// Sees all; full detail, or thinned out.
EmitView viewOf(bool full) {
    EmitView view = parallelView(glm::mat4(1), 120, 1);
    if (full) view.flags = kFullDetail;
    for (glm::vec4& plane : view.planes) plane = glm::vec4(0, 0, 0, 1);
    view.width = view.height = 256;
    view.viewProjection = glm::mat4(0.5f);
    view.viewProjection[3][3] = 1;
    return view;
}

// What is drawn is the same, and instances of it are: to the bit, but for a span's sphere and errors, which take roots.
void compareBound(Device& device, test::EmitPipeline& native, const EmitState& state, test::EmitPipeline& shaders,
                  const EmitState& theirs) {
    CHECK(state.fullTriangles == theirs.fullTriangles);
    CHECK(std::memcmp(state.counts, theirs.counts, sizeof state.counts) == 0);
    const uint32_t count = theirs.spanCount + theirs.leafCount;
    const auto drawn = [&](test::EmitPipeline& p) { return *readVector<DrawnItem>(device, p.emit.drawn(), 0, count); };
    const auto a = drawn(native), b = drawn(shaders);
    const auto records = [&](const Buffer& buffer, auto record) {
        return *readVector<decltype(record)>(device, buffer, 0, buffer.size() / sizeof record);
    };
    const auto spans = records(native.emit.spanInstances(), SpanInstance{}),
               theirSpans = records(shaders.emit.spanInstances(), SpanInstance{});
    const auto leaves = records(native.emit.leafInstances(), LeafInstance{}),
               theirLeaves = records(shaders.emit.leafInstances(), LeafInstance{});
    size_t others = 0, otherSpheres = 0;
    for (uint32_t i = 0; i < count; ++i) {
        others += a[i].item != b[i].item;
        const uint32_t item = b[i].item;
        if (i >= theirs.spanCount) {
            others += std::memcmp(&leaves[item], &theirLeaves[item], sizeof(LeafInstance)) != 0;
            continue;
        }
        const SpanInstance &x = spans[item], &y = theirSpans[item];
        others += std::memcmp(&x, &y, offsetof(SpanInstance, metres)) != 0 || x.bits != y.bits;
        const glm::vec2 errors = glm::unpackHalf2x16(x.errors), theirErrors = glm::unpackHalf2x16(y.errors);
        otherSpheres +=
            std::abs(x.metres - y.metres) > 1e-5f || glm::distance(x.center, y.center) > 1e-5f ||
            std::abs(x.reach - y.reach) > 1e-5f ||
            glm::any(glm::greaterThan(glm::abs(errors - theirErrors), 1e-3f * glm::abs(theirErrors) + 1e-6f));
    }
    CHECK(others == 0);
    CHECK(otherSpheres == 0);
}

// Of the picture that the pipeline watches, those that have changed since, at most so many; and culls what is in them.
std::vector<uint32_t> takeTiles(test::EmitPipeline& on, const EmitInputs& inputs, const EmitView& view, uint32_t most,
                                EmitState& culled) {
    Result<Commands> commands = Commands::begin(*on.device, "take");
    REQUIRE(commands);
    REQUIRE(on.emit.bind(*commands, inputs));
    const EmitView taken = on.emit.takeChanges(*commands, inputs, most);
    REQUIRE(on.emit.cull(*commands, inputs, taken, "cull", true));
    CHECK(on.emit.culledNative() == inputs.native);
    REQUIRE(commands->finish());
    culled = *readVector<EmitState>(*on.device, on.emit.state(), 0, 1)->data();
    const auto* tiles = reinterpret_cast<const uint32_t*>(taken.tiles.v);
    return {tiles, tiles + tilesOf(view)};
}

}  // namespace

TEST_CASE("native code binds what shaders bind") {
    const std::shared_ptr<Device> device = test::validatedDevice();
    if (!device->info().cpu) return;
    test::Edited e = test::edited();
    test::Plant plant = test::upload(*device, e.last);
    const Buffer touched = std::move(*makeBuffer(*device, "touched", e.touchedLast));
    plant.view.touched = &touched;
    for (const bool full : {false, true}) {
        CAPTURE(full);
        const EmitView view = viewOf(full);
        test::EmitPipeline shaders(device), native(device);
        plant.view.number = plant.view.renewed = plant.view.number + 1;
        std::vector<uint32_t> numbers(e.touched.size(), plant.view.number);
        const auto compare = [&] {
            EmitInputs inputs = plant.inputs();
            inputs.native = false;
            const EmitState a = shaders.cull(inputs, view);
            inputs.native = true;
            const EmitState b = native.cull(inputs, view);
            CHECK(native.emit.culledNative());  // so it stood when the view was recorded
            CHECK(a.spanCount > 300);
            CHECK(a.leafCount > 100);
            compareBound(*device, native, b, shaders, a);
        };
        test::rewrite(*device, plant, touched, e.before, numbers);
        compare();
        for (test::EmitPipeline* on : {&shaders, &native}) {
            Result<Commands> commands = Commands::begin(*device, "watch");
            REQUIRE(commands);
            REQUIRE(on->emit.watch(*commands, view));
            REQUIRE(commands->finish());
        }
        for (uint32_t i = 0; i < numbers.size(); ++i) numbers[i] += e.touched[i] - 1;
        test::rewrite(*device, plant, touched, e.after, numbers);
        plant.view.number += 1;
        // Some, the next ones, all that are left, none.
        for (const auto& [most, least, last] : {std::tuple{6u, 6, 6}, {5u, 5, 5}, {4096u, 1, 4000}, {9u, 0, 0}}) {
            EmitInputs inputs = plant.inputs();
            EmitState theirs, ours;
            inputs.native = false;
            const std::vector<uint32_t> changed = takeTiles(shaders, inputs, view, most, theirs);
            inputs.native = true;
            CHECK(takeTiles(native, inputs, view, most, ours) == changed);
            const auto count = std::count(changed.begin(), changed.end(), kChangedTile);
            CHECK(count >= least);
            CHECK(count <= last);
            CHECK(count < std::ptrdiff_t(changed.size()));
            CHECK(ours.spanCount == theirs.spanCount);
            CHECK(ours.leafCount == theirs.leafCount);
        }
        compare();
        CHECK(native.emit.stats().bound == shaders.emit.stats().bound);
    }
}

TEST_CASE("native code binds nothing that a recording under way looks at") {
    test::EmitPipeline pipeline;
    if (!pipeline.device->info().cpu) return;
    test::Plant plant = test::upload(*pipeline.device, test::wallIvy(4, 2, 1));
    EmitInputs inputs = plant.inputs();
    inputs.native = true;
    Commands first = std::move(*Commands::begin(*pipeline.device, "first"));
    REQUIRE(pipeline.emit.cull(first, inputs, viewOf(false), "emit", true));
    CHECK(pipeline.emit.culledNative());
    inputs.growth.renewed = inputs.growth.number += 1;
    inputs.growth.revision += 1;
    Commands second = std::move(*Commands::begin(*pipeline.device, "second"));
    REQUIRE(pipeline.emit.cull(second, inputs, viewOf(false), "emit", true));
    CHECK(!pipeline.emit.culledNative());
    REQUIRE(first.submit());
    REQUIRE(second.submit());
    REQUIRE(pipeline.device->waitIdle());
    CHECK(pipeline.emit.stats().spans > 10);
}
