// After surfaces have moved, come or gone only what stands on the moved ones is bound anew, and what is drawn is what
// binding everything gives.
#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "tests/emit/edited.hpp"
#include "tests/emit/pipeline.hpp"

using namespace espalier;

namespace {

// The same plants on `walls` walls side by side, each of which is an instance of its own. A branch of the second one's
// plants goes on on the third.
test::PlantData plantsOn(uint32_t walls) {
    test::PlantData all;
    for (uint32_t w = 0; w < walls; ++w) {
        const test::PlantData one = test::wallIvy(w == 1 ? 2 : 6, 1.5f, 1.5f, w + 1);
        const uint32_t nodes = uint32_t(all.nodes.size()), chunks = uint32_t(all.chunks.size());
        for (Node node : one.nodes) {
            node.chunk += chunks;
            node.place = w << 16;
            all.nodes.push_back(node);
        }
        for (Chunk chunk : one.chunks) {
            chunk.branch += uint32_t(all.branches.size());
            chunk.firstNode += nodes;
            if (chunk.previousNode != kNoIndex) chunk.previousNode += nodes;
            all.chunks.push_back(chunk);
        }
        for (BranchRecord branch : one.branches) {
            branch.firstChunk += chunks;
            all.branches.push_back(branch);
        }
        for (Leaf leaf : one.leaves) {
            leaf.node += nodes;
            all.leaves.push_back(leaf);
        }
        if (w > 0) all.surfaces.push_back(all.surfaces[0]);
        if (w == 1) {
            const Chunk& last = all.chunks[all.branches.back().firstChunk];
            for (uint32_t n = last.firstNode + 1; n < last.firstNode + chunkNodes(last.marks); ++n)
                all.nodes[n].place = 2u << 16;
        }
    }
    test::linkChunks(all);
    return all;
}

// A table of surfaces, as a context makes a new one whenever any surface changes.
struct Stands {
    std::vector<SurfaceRef> refs;
    std::vector<Version> placed;
    Buffer table;

    Stands(Device& device, const test::PlantData& plants) : refs(plants.surfaces), placed(refs.size()) {
        for (size_t i = 0; i < refs.size(); ++i) move(uint32_t(i), {2.0f * float(i), 0, 0});
        upload(device);
    }
    void move(uint32_t instance, glm::vec3 to) {
        for (int axis = 0; axis < 3; ++axis) refs[instance].toWorld[axis].w = to[axis];
        placed[instance] = nextVersion();
    }
    void upload(Device& device) { table = std::move(*makeBuffer(device, "surfaces", refs)); }
};

struct Scene {
    std::shared_ptr<Device> device = test::validatedDevice();
    test::PlantData data = plantsOn(3);
    test::Plant plant = test::upload(*device, data);
    Stands stands{*device, data};
    test::EmitPipeline often{device};
    bool native = false;
    EmitView view = parallelView(glm::mat4(1), 120, 1);

    explicit Scene(bool asNative) : native(asNative) {
        for (glm::vec4& plane : view.planes) plane = glm::vec4(0, 0, 0, 1);
        plant.view.number = plant.view.renewed = 1;
    }
    EmitInputs inputs() const {
        EmitInputs given = plant.inputs();
        given.native = native;
        given.surfaces = addressOf<SurfaceBuf>(stands.table);
        given.placed = stands.placed;
        given.low = {-1, 0, -1};
        given.high = {5.9f, 1.9f, 0.9f};
        return given;
    }
    EmitState cull(test::EmitPipeline& pipeline) { return pipeline.cull(inputs(), view); }
    uint32_t items() const { return plant.view.nodeCount + plant.view.leafCount; }
    // What is drawn now is what an emission draws that has never seen any of it. Returns how much was bound for it.
    uint32_t compare() {
        test::EmitPipeline once(device);
        const EmitState part = cull(often);
        const uint32_t bound = often.emit.stats().bound;
        compareDrawn(*device, often, part, once, cull(once));
        return bound;
    }
};

}  // namespace

TEST_CASE("a surface that moves binds what stands on it") {
    for (const bool native : {false, true}) {
        CAPTURE(native);
        Scene scene(native);
        REQUIRE(scene.plant.view.touched == nullptr);  // of plants that no edit has changed
        scene.cull(scene.often);
        CHECK(scene.often.emit.stats().bound == scene.items());
        for (int step = 1; step < 40; ++step) {
            CAPTURE(step);
            scene.stands.move(1, {2.0f + 0.05f * float(step), 0.01f * float(step % 7), 0});
            scene.stands.upload(*scene.device);
            const uint32_t bound = scene.compare();
            CHECK(bound > 0);
            CHECK(bound < scene.items() / 2);
        }
        CHECK(scene.often.emit.wholeBindings() == 1);
    }
}

TEST_CASE("all surfaces may move at once, again and again, and cells find room for all of it") {
    for (const bool native : {false, true}) {
        CAPTURE(native);
        Scene scene(native);
        scene.cull(scene.often);
        for (int step = 1; step < 20; ++step) {
            CAPTURE(step);
            for (uint32_t i = 0; i < 3; ++i)
                scene.stands.move(i, {2.0f * float((i + uint32_t(step)) % 3), 0.03f * float(step), 0});
            scene.stands.upload(*scene.device);
            CHECK(scene.compare() > 0);
        }
        // Native code knows in time that this costs less.
        CHECK(scene.often.emit.wholeBindings() == (native ? 20 : 1));
    }
}

TEST_CASE("another table, and surfaces that come and go, bind nothing") {
    for (const bool native : {false, true}) {
        CAPTURE(native);
        Scene scene(native);
        scene.cull(scene.often);
        const uint64_t carried = scene.often.emit.carries();
        const auto unchanged = [&] {
            scene.stands.upload(*scene.device);
            scene.compare();
            CHECK(scene.often.emit.wholeBindings() == 1);
            CHECK(scene.often.emit.carries() == carried);
        };
        const Buffer before = std::move(scene.stands.table);
        unchanged();
        REQUIRE(scene.stands.table.address() != before.address());
        scene.stands.refs.push_back(scene.stands.refs[0]);  // one comes
        scene.stands.placed.push_back(nextVersion());
        unchanged();
        scene.stands.placed.back() = 0;  // and goes
        unchanged();
        scene.stands.placed.back() = nextVersion();  // another one comes in its place
        unchanged();
        scene.stands.refs.pop_back();
        scene.stands.placed.pop_back();
        unchanged();
    }
}

TEST_CASE("a surface that comes in the place of another one takes what stands there with it") {
    Scene scene(false);
    scene.cull(scene.often);
    scene.stands.move(0, {0.5f, 0.25f, 0.1f});
    scene.stands.upload(*scene.device);
    CHECK(scene.compare() > 0);
    CHECK(scene.often.emit.wholeBindings() == 1);
}

TEST_CASE("an edit and a move at once bind what either concerns") {
    for (const bool native : {false, true}) {
        CAPTURE(native);
        Scene scene(native);
        std::vector<uint32_t> numbers((scene.data.nodes.size() + 3) / 4 * 4, 1);
        const Buffer touched = std::move(*makeBuffer(*scene.device, "touched", numbers));
        scene.plant.view.touched = &touched;
        test::rewrite(*scene.device, scene.plant, touched, scene.data, numbers);
        scene.cull(scene.often);
        for (uint32_t n = 0; n < 5; ++n) {
            scene.data.nodes[n].radius *= 1.5f;
            numbers[n] = 2;
        }
        test::rewrite(*scene.device, scene.plant, touched, scene.data, numbers);
        scene.plant.view.number = 2;
        scene.stands.move(1, {2.2f, 0.1f, 0});
        scene.stands.upload(*scene.device);
        const uint32_t bound = scene.compare();
        CHECK(bound > 0);
        CHECK(bound < scene.items() / 2);
        // Growth that writes all anew meanwhile.
        scene.plant.view.renewed = scene.plant.view.number = 3;
        scene.plant.view.revision += 1;
        scene.stands.move(1, {2.3f, 0.1f, 0});
        scene.stands.upload(*scene.device);
        CHECK(scene.compare() == scene.items());
    }
}

TEST_CASE("bounds that change a little leave the grid, and others bind all by another one") {
    Scene scene(false);
    scene.cull(scene.often);
    EmitInputs given = scene.inputs();
    given.high += glm::vec3(0.001f);
    scene.often.cull(given, scene.view);
    CHECK(scene.often.emit.wholeBindings() == 1);
    given.high.x += 20;
    scene.often.cull(given, scene.view);
    CHECK(scene.often.emit.wholeBindings() == 2);
}

TEST_CASE("more surfaces than there are bits for are bound anew as a whole") {
    Scene scene(false);
    scene.stands.refs.resize(32 * kMovedWords + 2, scene.stands.refs[0]);
    scene.stands.placed.resize(scene.stands.refs.size(), nextVersion());
    scene.stands.upload(*scene.device);
    scene.cull(scene.often);
    scene.stands.placed.back() = nextVersion();
    CHECK(scene.compare() == scene.items());
    CHECK(scene.often.emit.wholeBindings() == 2);
}
