// Nodes that ask for other stages: what they ask for, and meshes with all their instances.
#include "runtime/gpu/device.hpp"
#include "runtime/nodes/wishes.hpp"
#include "tests/nodes/graphs.hpp"

using namespace espalier;
using namespace espalier::nodetest;

namespace {

template <class T>
std::shared_ptr<const T> wishOf(NodeEvaluation& evaluation, const char* node) {
    Result<const NodeValue*> value = evaluation.inspect(node);
    REQUIRE(value);
    REQUIRE(value.value());
    return std::get<std::shared_ptr<const T>>(*value.value());
}

constexpr const char* kBlocks =
    "graph 1\n"
    "grid = PointGrid(counts: (3, 1, 5), step: (2, 1, 3))\n"
    "cube = Cube(cells: 2)\n"
    "blocks = Scatter(grid, cube, turnSpread: 0)\n"
    "lifted = Transform(blocks, move: (0, 7, 0))\n"
    "circle = Circle(samples: 5, radius: 0.1)\n"
    "paths = SubsetCurves(grid, curves: 3, keys: 4, samples: 7)\n"
    "tubes = Loft(paths, circle)\n"
    "twice = Scatter(lifted2, tubes, turnSpread: 0)\n"
    "lifted2 = PointGrid(counts: (2, 1, 1), step: (100, 1, 1), centre: (50, 0, 0))\n"
    "all = Join(lifted, twice)\n"
    "ground = Bake(all, resolution: 256)\n"
    "show ground\n";

TEST_CASE("ground takes a mesh with all its instances") {
    NodeEvaluation e = evaluationOf(kBlocks);
    REQUIRE(e.failures().empty());
    const auto ground = wishOf<GroundWish>(e, "ground");
    CHECK(ground->resolution == 256);
    const std::vector<glm::vec3> cube = *e.positions(geometryOf(e, "cube").front());
    const std::vector<uint32_t> corners = *e.corners(geometryOf(e, "cube").front());
    const std::vector<glm::vec3> tubes = *e.positions(geometryOf(e, "tubes").front());
    const std::vector<uint32_t> tubeCorners = *e.corners(geometryOf(e, "tubes").front());
    REQUIRE(ground->places.size() == 15 * cube.size() + 2 * tubes.size());
    REQUIRE(ground->corners.size() == 15 * corners.size() + 2 * tubeCorners.size());
    size_t apart = 0;
    for (size_t copy = 0; copy < 15; ++copy) {
        const glm::vec3 at(2 * float(copy % 3) - 2, 7, 3 * float(copy / 3) - 6);
        for (size_t i = 0; i < cube.size(); ++i)
            apart += glm::length(ground->places[copy * cube.size() + i] - (cube[i] + at)) > 1e-5f;
        for (size_t i = 0; i < corners.size(); ++i)
            apart += ground->corners[copy * corners.size() + i] != corners[i] + copy * cube.size();
    }
    for (size_t copy = 0; copy < 2; ++copy)
        for (size_t i = 0; i < tubes.size(); ++i) {
            const glm::vec3 there = ground->places[15 * cube.size() + copy * tubes.size() + i];
            apart += glm::length(there - (tubes[i] + glm::vec3(100 * float(copy), 0, 0))) > 1e-4f;
        }
    CHECK(apart == 0);
}

TEST_CASE("scalar code, lanes and kernels ask for the same ground, and another mesh for another") {
    NodeEvaluation lanes = evaluationOf(kBlocks), plain = evaluationOf(kBlocks, hostMachine(1, true));
    const uint64_t key = wishOf<GroundWish>(lanes, "ground")->key;
    CHECK(wishOf<GroundWish>(plain, "ground")->key == key);
    Result<std::unique_ptr<Device>> device = Device::create({});
    REQUIRE(device);
    NodeEvaluation kernels = evaluationOf(kBlocks, deviceMachine(**device, false));
    CHECK(wishOf<GroundWish>(kernels, "ground")->key == key);
    REQUIRE(lanes.setInput("cube", "size", Literal(glm::vec3(1, 1.25f, 1))));
    CHECK(wishOf<GroundWish>(lanes, "ground")->key != key);
    REQUIRE(lanes.setInput("cube", "size", Literal(glm::vec3(1))));
    CHECK(wishOf<GroundWish>(lanes, "ground")->key == key);
}

TEST_CASE("plants are asked for at points, by a grammar and its parameters") {
    NodeEvaluation e(hostMachine(1), [](const std::string&, const std::string& name) -> Result<NodeFile> {
        const std::string text = "text of " + name;
        const auto bytes = std::as_bytes(std::span(text));
        return NodeFile{"found/" + name, {bytes.begin(), bytes.end()}};
    });
    REQUIRE(
        e.load(*parseGraph("graph 1\n"
                           "time = Time\n"
                           "rules = Grammar(file: \"../g/ivy.grammar\")\n"
                           "dense = Parameter(rules, name: \"leaf\", value: time.seconds)\n"
                           "again = Parameter(dense, name: \"leaf\", value: 3)\n"
                           "red = ColourParameter(again, name: \"hue\", colour: (1, 0, 0.5))\n"
                           "feet = PointGrid(counts: (4, 1, 1))\n"
                           "ivy = Grow(feet, red, seed: 9)\n"
                           "show ivy\n",
                           "a/b/x.graph")));
    REQUIRE(e.evaluate());
    REQUIRE(e.failures().empty());
    const auto plants = wishOf<PlantsWish>(e, "ivy");
    CHECK(plants->points.size() == 4);
    CHECK(plants->seed == 9);
    CHECK(!plants->ground);
    CHECK(plants->rules->file == "found/../g/ivy.grammar");
    CHECK(plants->rules->text == "text of ../g/ivy.grammar");
    CHECK(plants->rules->params == std::vector<WishedParam>{{"leaf", {3, 0, 0}, 1}, {"hue", {1, 0, 0.5f}, 3}});
}

TEST_CASE("what can't be asked for is told by its node") {
    const auto failureOf = [](const std::string& text) {
        NodeEvaluation e = evaluationOf("graph 1\n" + text);
        return e.failures().empty() ? std::string() : e.failures().front().message;
    };
    CHECK(failureOf("c = Circle\nb = Bake(c)\nshow b\n") == "'mesh' holds no triangles");
    CHECK(failureOf("g = Grammar\np = PointGrid\ni = Grow(p, g)\nshow i\n") == "'file' names no file");
    CHECK(failureOf("g = Grammar(file: \"x\")\nshow g\n") == "this graph can't read files");
    CHECK(mistakesIn("graph 1\nc = Cube\ni = Grow(c, c)\nshow i\n") ==
          "test.graph:3:13: i: 'grammar' takes Grammar, but 'c' gives Mesh");
}

}  // namespace
