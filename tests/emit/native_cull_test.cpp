// Native code against the shaders that it stands in for: the same text, but roots and divisions may differ in their
// last bits, so that what lies right on a threshold may fall to either side.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "tests/emit/pipeline.hpp"

using namespace espalier;

namespace {

constexpr uint32_t kWidth = 320, kHeight = 180;

// From (0, 0.7, distance) along -z, half a unit to either side at distance 1.
EmitView viewFrom(float distance, float leafPixels) {
    const glm::vec3 eye(0.1f, 0.7f, distance);
    glm::mat4 projection(0), place(1);
    projection[0][0] = 2;
    projection[1][1] = -3.5f;
    projection[2][3] = -1;
    projection[3][2] = 0.05f;
    place[3] = glm::vec4(-eye, 1);
    EmitView view = perspectiveView(projection * place, eye, float(kWidth), 1.5f);
    view.viewProjection = projection * place;
    view.width = kWidth;
    view.height = kHeight;
    thinOut(view, leafPixels);
    return view;
}

// A wall at a metre before the left half of the picture.
Buffer wallOnTheLeft(Device& device) {
    const uint32_t columns = kWidth / kDepthTile, rows = (kHeight + kDepthTile - 1) / kDepthTile;
    std::vector<float> tiles(columns * rows, 0.0f);
    for (uint32_t i = 0; i < tiles.size(); ++i)
        if (i % columns < columns / 2) tiles[i] = 0.05f;
    return std::move(makeBuffer(device, "tiles", tiles).value());
}

struct Seen {
    EmitState state{};
    std::vector<DrawnItem> items;
    bool native = false;
};

Seen look(test::EmitPipeline& on, const test::Plant& plant, const EmitView& view, bool native) {
    EmitInputs inputs = plant.inputs();
    inputs.native = native;
    Seen seen;
    seen.state = on.cull(inputs, view);
    seen.native = on.emit.culledNative();
    seen.items = *readVector<DrawnItem>(*on.device, on.emit.drawn(), 0, seen.state.spanCount + seen.state.leafCount);
    return seen;
}

// Items of one that the other hasn't, or has in another bucket. Those of both come in the same order and agree.
size_t compare(const Seen& a, const Seen& b) {
    std::map<std::pair<uint32_t, uint32_t>, size_t> places;  // of b, by bucket and item
    const auto each = [](const Seen& s, const auto& body) {
        for (uint32_t bucket = 0; bucket < kMaxBuckets; ++bucket)
            for (uint32_t i = s.state.starts[bucket]; i < s.state.starts[bucket] + s.state.counts[bucket]; ++i)
                body(std::pair(bucket, s.items.at(i).item), i);
    };
    each(b, [&](auto key, uint32_t i) { places[key] = i; });
    size_t common = 0, unordered = 0, unlike = 0, last = 0;
    each(a, [&](auto key, uint32_t i) {
        const auto found = places.find(key);
        if (found == places.end()) return;
        const DrawnItem &x = a.items[i], &y = b.items[found->second];
        unordered += common > 0 && found->second <= last;
        unlike += std::abs(x.value - y.value) > 1e-4f * std::abs(y.value) || (x.bits & 0xFFFF) != (y.bits & 0xFFFF) ||
                  std::abs(int(x.bits >> 16) - int(y.bits >> 16)) > 3;
        last = found->second;
        ++common;
    });
    CHECK(unordered == 0);
    CHECK(unlike == 0);
    return a.items.size() + b.items.size() - 2 * common;
}

}  // namespace

TEST_CASE("native code culls as shaders do, once growth is bound and depths stand") {
    test::EmitPipeline shaders, native(shaders.device);
    const test::Plant plant = test::upload(*shaders.device, test::wallIvy(8, 2, 1.5f));
    const Buffer tiles = wallOnTheLeft(*shaders.device);
    const bool able = shaders.device->info().cpu;
    look(native, plant, viewFrom(1, 8), false);  // by shaders, as the other
    for (float distance : {2.0f, 6.0f, 25.0f})
        for (float leafPixels : {4.0f, 30.0f}) {
            CAPTURE(distance);
            CAPTURE(leafPixels);
            EmitView view = viewFrom(distance, leafPixels);
            const Seen open = look(shaders, plant, view, false), openNative = look(native, plant, view, true);
            CHECK(!open.native);
            CHECK(openNative.native == able);
            CHECK(open.items.size() > 10);
            CHECK(compare(open, openNative) <= 1 + open.items.size() / 500);
            for (uint32_t i = 0; i < 2 * kMaxBuckets; ++i)
                if (open.state.counts[i / 2] == openNative.state.counts[i / 2])
                    CHECK(std::memcmp(&open.state.draws[i], &openNative.state.draws[i], sizeof(DrawCommand)) == 0);
            CHECK(open.state.fullTriangles == openNative.state.fullTriangles);

            view.tiles.v = reinterpret_cast<float*>(tiles.address());
            CHECK(!look(native, plant, view, true).native);  // which may be still to come
            view.flags |= kTilesStand;
            view.drift = 0.05f;
            const Seen behind = look(shaders, plant, view, false), behindNative = look(native, plant, view, true);
            CHECK(behindNative.native == able);
            CHECK(behind.items.size() < open.items.size());
            CHECK(compare(behind, behindNative) <= 1 + behind.items.size() / 500);
        }
}

TEST_CASE("native code leaves alone what recordings under way still draw") {
    test::EmitPipeline pipeline;
    if (!pipeline.device->info().cpu) return;
    const test::Plant plant = test::upload(*pipeline.device, test::wallIvy(4, 2, 1));
    EmitInputs inputs = plant.inputs();
    inputs.native = true;
    pipeline.cull(inputs, viewFrom(2, 8));
    std::vector<Commands> open;
    std::vector<uint64_t> states;
    for (int i = 0; i < 8; ++i) {
        open.push_back(std::move(*Commands::begin(*pipeline.device, "open")));
        REQUIRE(pipeline.emit.cull(open.back(), inputs, viewFrom(2.0f + 0.1f * float(i), 8), "emit", true));
        if (pipeline.emit.culledNative()) states.push_back(pipeline.emit.state().address());
    }
    CHECK(states.size() > 2);
    CHECK(states.size() < 8);  // then shaders have to
    std::sort(states.begin(), states.end());
    CHECK(std::unique(states.begin(), states.end()) == states.end());
    for (Commands& commands : open) REQUIRE(commands.submit());
    REQUIRE(pipeline.device->waitIdle());
}
