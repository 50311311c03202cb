// What is made when: invalidation, failures, last good outputs.
#include "tests/nodes/graphs.hpp"

using namespace espalier;
using namespace espalier::nodetest;

TEST_CASE("a still graph evaluates nothing, and time only what reads it") {
    NodeEvaluation e = evaluationOf(contentText("woven_sphere_low.graph"));
    CHECK(e.stats().evaluated == 6);
    const Version before = e.revision();
    CHECK_FALSE(e.due());
    REQUIRE(e.evaluate());
    CHECK(e.revision() == before);
    e.setTime({0, 1.0 / 30});
    CHECK_FALSE(e.due());
    e.setTime({7, 1.0 / 30});
    REQUIRE(e.evaluate());
    CHECK(e.stats().evaluated == 5);  // all but the ring
    CHECK(e.stats().kernels == 5);    // neither which points a curve takes nor which corners triangles have
}

TEST_CASE("of ten thousand nodes one is made again when a leaf's input changes") {
    std::string text = "graph 1\n";
    for (int i = 0; i < 9999; ++i) text += "n" + std::to_string(i) + " = Cube(cells: 1)\n";
    text += "all = Join(n0";
    for (int i = 1; i < 4000; ++i) text += ", n" + std::to_string(i);
    text += ")\nshow all n9000\n";
    NodeEvaluation e = evaluationOf(text);
    CHECK(e.stats().evaluated == 4002);
    REQUIRE(e.setInput("n9000", "cells", Literal(2.0f)));
    REQUIRE(e.evaluate());
    CHECK(e.stats().evaluated == 1);
    REQUIRE(e.setInput("n9000", "cells", Literal(2.0f)));
    CHECK_FALSE(e.due());
    REQUIRE(e.setInput("n7", "cells", Literal(2.0f)));
    REQUIRE(e.evaluate());
    CHECK(e.stats().evaluated == 2);
    REQUIRE(e.setInput("n5000", "cells", Literal(2.0f)));  // which nobody sees
    CHECK_FALSE(e.due());
}

TEST_CASE("another text makes only what it changes") {
    const std::string text = contentText("woven_sphere_low.graph");
    NodeEvaluation e = evaluationOf(text);
    const uint64_t hash = hashOf(e);
    REQUIRE(e.load(parsed(text)));
    REQUIRE(e.evaluate());
    CHECK(e.stats().evaluated == 6);  // of the first time: nothing is due
    CHECK(hashOf(e) == hash);
    std::string wider = text;
    wider.replace(wider.find("0.025"), 5, "0.03");
    REQUIRE(e.load(parsed(wider)));
    REQUIRE(e.evaluate());
    CHECK(e.stats().evaluated == 2);  // ring and tubes
    CHECK(hashOf(e) != hash);
    REQUIRE(e.setInput("ring", "radius", Literal(0.025f)));
    REQUIRE(e.evaluate());
    CHECK(hashOf(e) == hash);
    CHECK(printGraph(e.graph()) == text);
}

TEST_CASE("a text with mistakes leaves the last good graph") {
    NodeEvaluation e = evaluationOf("graph 1\na = Cube\nshow a\n");
    const uint64_t hash = hashOf(e);
    Result<NodeGraph> bad = parseGraph("graph 1\na = Cube(cells: b)\nshow a\n", "bad.graph");
    REQUIRE(bad);
    CHECK_FALSE(e.load(std::move(*bad)));
    REQUIRE(e.evaluate());
    CHECK(hashOf(e) == hash);
}

TEST_CASE("a node that fails keeps its last good output, its siblings go on") {
    NodeEvaluation e = evaluationOf(
        "graph 1\npoints = Particles(count: 20)\ncurves = SubsetCurves(points, keys: 8)\nring = Circle(radius: 0.1)\n"
        "tubes = Loft(curves, ring)\nother = Scatter(points, cube)\ncube = Cube\nshow tubes other\n");
    CHECK(e.failures().empty());
    const auto partsOf = [&](const char* node) { return geometryOf(e, node).front().elements; };
    const uint32_t tubes = partsOf("tubes");
    REQUIRE(e.setInput("points", "count", Literal(5.0f)));
    REQUIRE(e.evaluate());
    REQUIRE(e.failures().size() == 1);
    CHECK(toString(e.failures().front()) ==
          "test.graph:3:1: curves: a curve through 8 points needs as many, but there are 5");
    CHECK(partsOf("tubes") == tubes);
    CHECK(geometryOf(e, "other").front().instances() == 5);
    REQUIRE(e.evaluate());
    REQUIRE(e.setInput("points", "count", Literal(30.0f)));
    REQUIRE(e.evaluate());
    CHECK(e.failures().empty());
    CHECK(geometryOf(e, "other").front().instances() == 30);
}

TEST_CASE("a kind that isn't known fails by itself") {
    NodeEvaluation e = evaluationOf("graph 1\na = Unheard(1)\nb = Twist(a)\nc = Cube\nshow b c\n");
    REQUIRE(e.failures().size() == 1);
    CHECK(e.failures().front().message == "there is no kind of node 'Unheard'");
    CHECK(e.warnings().size() == 1);
    CHECK(e.shown().size() == 1);
}

TEST_CASE("inputs are refused as a text's would be") {
    NodeEvaluation e = evaluationOf("graph 1\nt = Time\na = Cube(cells: t.frame)\nshow a\n");
    CHECK_FALSE(e.setInput("b", "cells", Literal(1.0f)));
    CHECK_FALSE(e.setInput("a", "cell", Literal(1.0f)));
    CHECK_FALSE(e.setInput("a", "cells", Literal(1.0f)));  // wired
    CHECK_FALSE(e.setInput("a", "size", Literal(1.0f)));
    CHECK_FALSE(e.setInput("a", "size", Literal(glm::vec3(-1))));
    CHECK(e.setInput("a", "size", Literal(glm::vec3(2))));
    // A wired number that is out of range is drawn to its nearest end: 0 cells are 1.
    CHECK(geometryOf(e, "a").front().indexCount == 36);
}

TEST_CASE("boxes hold what stands") {
    NodeEvaluation e = evaluationOf(
        "graph 1\ngrid = PointGrid(counts: (3, 1, 3), step: (2, 2, 2))\nball = Sphere(radius: 0.5)\n"
        "balls = Scatter(grid, ball)\nmoved = Transform(balls, move: (10, 0, 0), scale: (2, 1, 1))\nshow moved ball\n");
    const Geometry parts = e.shown();
    Result<std::vector<NodeBox>> boxes = e.measure(parts);
    REQUIRE(boxes);
    REQUIRE(boxes->size() == 2);
    const NodeBox &moved = boxes.value()[0], &ball = boxes.value()[1];
    for (int k = 0; k < 3; ++k) CHECK(ball.high[k] == doctest::Approx(0.5).epsilon(1e-5));
    // A ball's box turns with it, so it may be wider by the root of two.
    CHECK(moved.low.x <= 10 - 2 * 2.5f + 1e-4f);
    CHECK(moved.low.x >= 10 - 2 * 2.72f);
    CHECK(moved.high.y == doctest::Approx(0.5).epsilon(1e-5));
}

TEST_CASE("a filter keeps what lies in its box, and with a larger share what it kept") {
    NodeEvaluation e = evaluationOf(
        "graph 1\ngrid = PointGrid(counts: (10, 1, 10), step: (1, 1, 1))\nmoved = Transform(grid, move: (0, 3, 0))\n"
        "half = Filter(moved, low: (0, 2, -100), share: 1)\nfew = Filter(moved, share: 0.3)\n"
        "more = Filter(moved, share: 0.6)\ncube = Cube\nshown = Scatter(half, cube)\nshow shown\n");
    CHECK(e.shown().front().instances() == 50);
    const auto placesOf = [&](const char* node) { return *e.positions(geometryOf(e, node).front()); };
    for (const glm::vec3& p : placesOf("half")) {
        CHECK(p.x > 0);
        CHECK(p.y == 3);
    }
    const std::vector<glm::vec3> few = placesOf("few"), more = placesOf("more");
    CHECK(few.size() > 15);
    CHECK(few.size() < 45);
    for (const glm::vec3& p : few) CHECK(std::ranges::find(more, p) != more.end());
    REQUIRE(e.setInput("half", "low", Literal(glm::vec3(50, 0, 0))));
    REQUIRE(e.evaluate());
    REQUIRE(e.failures().size() == 1);
    CHECK(e.failures().front().message == "keeps none of 100 points");
    CHECK(e.shown().front().instances() == 50);
}

TEST_CASE("a file that can't be read is told by its node") {
    NodeEvaluation e = evaluationOf("graph 1\na = MeshFile(file: \"x.glb\")\nshow a\n");
    REQUIRE(e.failures().size() == 1);
    CHECK(e.failures().front().message == "this graph can't read files");
    std::string asked;
    NodeEvaluation beside(hostMachine(1), [&](const std::string& graphFile, const std::string& name) {
        asked = graphFile + " " + name;
        return Result<NodeFile>(NodeFile{name, std::vector<std::byte>(100)});
    });
    NodeGraph graph = parsed("graph 1\na = MeshFile(file: \"../b/x.glb\")\nshow a\n");
    graph.file = "c/d/test.graph";
    REQUIRE(beside.load(std::move(graph)));
    REQUIRE(beside.evaluate());
    CHECK(asked == "c/d/test.graph ../b/x.glb");
    REQUIRE(beside.failures().size() == 1);
    CHECK(beside.failures().front().message.find("../b/x.glb") != std::string::npos);
}
