// How many instances there are at most, and which of them stand.
#include <algorithm>
#include <glm/vector_relational.hpp>
#include <tuple>

#include "tests/nodes/graphs.hpp"

using namespace espalier;
using namespace espalier::nodetest;

namespace {

uint64_t instancesOf(const Geometry& parts) {
    uint64_t all = 0;
    for (const GeometryPart& part : parts) all += part.instances();
    return all;
}

std::string noteOf(NodeEvaluation& e, const char* node) {
    return *e.state(node)->note;
}

// Where each instance has the place `at` of its shape, in order.
std::vector<glm::vec3> placesOf(const Geometry& parts, glm::vec3 at) {
    std::vector<glm::vec3> places;
    for (const GeometryPart& part : parts)
        for (uint32_t i = 0; i < part.instances(); ++i) {
            uint32_t instance = i;
            glm::vec3 p = at;
            for (const DeformOp& op : part.program) p = deformStep(op, p, {0, 1, 0}, instance);
            places.push_back(p);
        }
    std::ranges::sort(places, {}, [](const glm::vec3& p) { return std::tuple(p.x, p.y, p.z); });
    return places;
}
bool within(const std::vector<glm::vec3>& few, const std::vector<glm::vec3>& more) {
    return std::ranges::includes(
        more, few, {}, [](const glm::vec3& p) { return std::tuple(p.x, p.y, p.z); },
        [](const glm::vec3& p) { return std::tuple(p.x, p.y, p.z); });
}

// One block, scattered seven times, and those and a ball over 300 places: 8 instances a place.
const std::string kNested =
    "graph 1\nrow = PointGrid(counts: (7, 1, 1), step: (0.1, 0, 0))\nc = Cube\nrows = Scatter(row, c, seed: 4)\n"
    "b = Sphere\nboth = Join(rows, b)\ngrid = PointGrid(counts: (20, 1, 15))\n"
    "all = Scatter(grid, both, sizeSpread: 0.5, most: 1000)\nshow all\n";

}  // namespace

TEST_CASE("of 1,250,000 instances 1,000,000 stand") {
    NodeEvaluation e = evaluationOf(
        "graph 1\ngrid = PointGrid(counts: (1250, 1, 1000))\ncube = Cube\n"
        "many = Scatter(grid, cube, turnSpread: 0)\nshow many\n");
    CHECK(e.failures().empty());
    CHECK(instancesOf(e.shown()) == 1000000);
    CHECK(noteOf(e, "many") == "1,000,000 of 1,250,000 instances");
    REQUIRE(e.notes().size() == 1);
    CHECK(toString(e.notes().front()) == "test.graph:4:1: warning: many: 1,000,000 of 1,250,000 instances");
    const std::vector<glm::vec3> places = placesOf(e.shown(), {});
    CHECK(std::ranges::adjacent_find(places) == places.end());
    CHECK(within(places, [&] {
        std::vector<glm::vec3> grid;
        for (int x = 0; x < 1250; ++x)
            for (int z = 0; z < 1000; ++z) grid.emplace_back(x - 624.5f, 0, z - 499.5f);
        return grid;
    }()));
    // What is left away is so everywhere.
    size_t left = 0, near = 0;
    for (const glm::vec3& p : places) left += p.x < 0, near += p.z < 0;
    CHECK(left == doctest::Approx(500000).epsilon(0.01));
    CHECK(near == doctest::Approx(500000).epsilon(0.01));
    REQUIRE(e.setInput("grid", "counts", Literal(glm::vec3(1000, 1, 1000))));
    REQUIRE(e.evaluate());
    CHECK(instancesOf(e.shown()) == 1000000);
    CHECK(noteOf(e, "many") == "");
    CHECK(e.shown().front().program.front().which.v == nullptr);
}

TEST_CASE("a larger limit only adds, one by one") {
    NodeEvaluation e = evaluationOf(kNested);
    REQUIRE(e.setInput("all", "most", Literal(1000000.0f)));
    REQUIRE(e.evaluate());
    CHECK(noteOf(e, "all") == "");
    const glm::vec3 corner(0.5f, 0.5f, 0.5f);  // so that sizes and turns count
    const std::vector<glm::vec3> whole = placesOf(e.shown(), corner);
    REQUIRE(whole.size() == 2400);
    std::vector<glm::vec3> before;
    for (const int most : {1, 7, 8, 9, 1000, 1001, 1002, 1003, 1004, 1005, 1006, 1007, 1008, 2399}) {
        CAPTURE(most);
        REQUIRE(e.setInput("all", "most", Literal(float(most))));
        REQUIRE(e.evaluate());
        REQUIRE(e.failures().empty());
        const std::vector<glm::vec3> now = placesOf(e.shown(), corner);
        CHECK(now.size() == size_t(most));
        CHECK(within(before, now));
        CHECK(within(now, whole));
        before = now;
    }
    CHECK(noteOf(e, "all") == "2,399 of 2,400 instances");
}

TEST_CASE("variants are limited like other instances") {
    NodeEvaluation e = evaluationOf(
        "graph 1\nv = Variant\nhigh = Random(key: v.key)\nrow = PointGrid(counts: (3, 1, 1), step: (0.2, 0, 0))\n"
        "c = Cube\nt = Transform(c, scale: (0.1, 1, 0.1))\ns = Scatter(row, t)\nw = Wave(s, amount: high)\n"
        "grid = PointGrid(counts: (10, 1, 10))\nall = Replicate(grid, w, each: v, variants: 5)\nshow all\n");
    REQUIRE(e.failures().empty());
    const std::vector<glm::vec3> whole = placesOf(e.shown(), {});
    REQUIRE(whole.size() == 300);
    std::vector<glm::vec3> before;
    for (const int most : {100, 101, 102, 103, 299}) {
        REQUIRE(e.setInput("all", "most", Literal(float(most))));
        REQUIRE(e.evaluate());
        const std::vector<glm::vec3> now = placesOf(e.shown(), {});
        CHECK(now.size() == size_t(most));
        CHECK(within(before, now));
        CHECK(within(now, whole));
        before = now;
    }
    CHECK(noteOf(e, "all") == "299 of 300 instances");
}

TEST_CASE("five scatters of 1,000 in each other answer at once") {
    std::string text = "graph 1\np = PointGrid(counts: (10, 10, 10))\ns0 = Cube\n";
    for (int i = 1; i <= 5; ++i) text += "s" + std::to_string(i) + " = Scatter(p, s" + std::to_string(i - 1) + ")\n";
    text += "show s5\n";
    uint64_t bytes = 0;
    NodeEvaluation e(std::make_unique<CountingMachine>(bytes));
    REQUIRE(e.load(parsed(text)));
    CHECK(secondsOf([&] { REQUIRE(e.evaluate()); }) < 0.05);
    CHECK(e.failures().empty());
    CHECK(bytes < 200000);
    CHECK(instancesOf(e.shown()) == 1000000);
    CHECK(noteOf(e, "s2") == "");
    CHECK(noteOf(e, "s5") == "1,000,000 of 1,000,000,000 instances");
    // A box around them all takes no longer, and holds what stands.
    const Geometry parts = e.shown();
    REQUIRE(parts.size() == 1);
    Result<std::vector<NodeBox>> boxes = std::vector<NodeBox>();
    CHECK(secondsOf([&] { boxes = e.measure(parts); }) < 0.05);
    REQUIRE(boxes);
    const NodeBox box = boxes->front();
    for (uint32_t i = 0; i < 1000000; i += 997)
        for (const float side : {-0.5f, 0.5f}) {
            uint32_t instance = i;
            glm::vec3 p(side, 0.5f, side);
            for (const DeformOp& op : parts.front().program) p = deformStep(op, p, {0, 1, 0}, instance);
            CHECK(glm::all(glm::greaterThanEqual(p, box.low)));
            CHECK(glm::all(glm::lessThanEqual(p, box.high)));
        }
    CHECK(glm::length(box.high - box.low) < 150);
}
