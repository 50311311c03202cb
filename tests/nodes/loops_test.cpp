// Replicate and Repeat, against the same graphs with every pass written out.
#include <algorithm>
#include <set>

#include "runtime/gpu/device.hpp"
#include "runtime/nodes/wishes.hpp"
#include "tests/nodes/graphs.hpp"

using namespace espalier;
using namespace espalier::nodetest;

namespace {

// A whole number below 2^24 and a number in [0, 1), as chance has them for a place of a list.
uint32_t bitsOf(uint32_t seed, uint32_t i, uint32_t site) {
    return mixed(i + mixed(seed + mixed(site + 0x51ED2701))) >> 8;
}
double chanceOf(uint32_t seed, uint32_t i, uint32_t site) {
    return bitsOf(seed, i, site) / 16777216.0;
}

// All vertices of a mesh node with all its instances, where they stand.
std::vector<glm::vec3> standing(const std::string& text, const std::string& node,
                                std::unique_ptr<NodeMachine> machine = hostMachine(1)) {
    NodeEvaluation e =
        evaluationOf(text + "whole = Join(" + node + ")\nground = Bake(whole)\nshow ground\n", std::move(machine));
    INFO((e.failures().empty() ? std::string() : e.failures().front().message));
    REQUIRE(e.failures().empty());
    Result<const NodeValue*> value = e.inspect("ground");
    REQUIRE(value);
    return std::get<GroundRef>(**value)->places;
}

const std::string kTrees =
    "graph 1\ngrid = PointGrid(counts: (5, 1, 4), step: (3, 0, 3))\nv = Variant(seed: 9)\n"
    "height = Random(key: v.key, low: 1, high: 4, seed: 3)\ntrunk = Cylinder(height: height, sides: 5)\n"
    "lean = Math(does: \"multiply\", a: v.share, b: 0.4)\nbent = Bend(trunk, angle: lean)\n"
    "trees = Replicate(grid, bent, each: v, variants: 6, sizeSpread: 0.2, seed: 5)\n";

}  // namespace

TEST_CASE("Replicate makes each variant as if its nodes were written out") {
    NodeEvaluation e = evaluationOf(kTrees + "show trees\n");
    REQUIRE(e.failures().empty());
    const Geometry trees = geometryOf(e, "trees");
    std::set<uint32_t> points;
    size_t variants = 0;
    for (const GeometryPart& part : trees) {
        REQUIRE(part.program.size() == 2);
        // Which variant it is: the one that chance gives to all points at which it stands.
        const DeformOp& op = part.program.back();
        const auto variantOf = [](uint32_t point) { return mixed(point + mixed(5 + mixed(2 + 0x51ED2701))) % 6; };
        const uint32_t variant = variantOf(op.which.v[0]);
        for (uint32_t i = 0; i < op.points.count; ++i) {
            CHECK(variantOf(op.which.v[i]) == variant);
            CHECK(points.insert(op.which.v[i]).second);
        }
        const double height = 1 + 3 * chanceOf(3, bitsOf(9, variant, 1), 0);
        std::string one = "graph 1\ntrunk = Cylinder(height: " + numberText(float(height)) +
                          ", sides: 5)\nbent = Bend(trunk, angle: " + numberText(float(variant) / 5 * 0.4f) +
                          ")\nall = Filter(bent)\nshow all\n";
        NodeEvaluation single = evaluationOf(one);
        const std::vector<glm::vec3> wanted = *single.positions(geometryOf(single, "all").front());
        GeometryPart shape = part;
        shape.program.pop_back();
        const std::vector<glm::vec3> made = *e.places(shape);
        REQUIRE(made.size() == wanted.size());
        float apart = 0;
        for (size_t i = 0; i < made.size(); ++i) apart = std::max(apart, glm::length(made[i] - wanted[i]));
        CHECK(apart < 1e-6f);
        ++variants;
    }
    CHECK(points.size() == 20);
    CHECK(variants > 3);
    CHECK(variants <= 6);
}

TEST_CASE("with 0 variants each point has its own, and knows where it is") {
    NodeEvaluation e = evaluationOf(
        "graph 1\ngrid = PointGrid(counts: (7, 1, 1), step: (2, 0, 0), centre: (1, 5, 0))\nv = Variant\n"
        "c = Cube(size: v.place)\nall = Replicate(grid, c, each: v, variants: 0, turnSpread: 0)\nshow all\n");
    REQUIRE(e.failures().empty());
    const Geometry all = geometryOf(e, "all");
    REQUIRE(all.size() == 7);
    for (size_t i = 0; i < all.size(); ++i) {
        CHECK(all[i].instances() == 1);
        float wide = 0;
        const std::vector<glm::vec3> places = *e.positions(all[i]);
        for (const glm::vec3& p : places) wide = std::max(wide, p.x);
        CHECK(wide == std::max(0.0f, 2 * float(i) - 5) / 2);  // negative sizes are 0
    }
}

TEST_CASE("a further point leaves the variants of the others") {
    const auto parts = [](int count) {
        std::string text = kTrees;
        text.replace(text.find("(5, 1, 4)"), 9, "(" + std::to_string(count) + ", 1, 1)");
        NodeEvaluation e = evaluationOf(text + "show trees\n");
        std::vector<uint32_t> heights(size_t(count), 0);
        for (const GeometryPart& part : geometryOf(e, "trees")) {
            const std::vector<glm::vec3> places = *e.positions(part);
            const uint32_t hash = uint32_t(hashBytes(std::as_bytes(std::span(places))));
            const DeformOp& op = part.program.back();
            for (uint32_t i = 0; i < op.points.count; ++i) heights[op.which.v[i]] = hash;
        }
        return heights;
    };
    std::vector<uint32_t> few = parts(40), more = parts(41);
    more.pop_back();
    CHECK(few == more);
    CHECK(std::set(few.begin(), few.end()).size() == 6);
}

TEST_CASE("Repeat is the chain of its passes") {
    const std::string repeated =
        "graph 1\nc = Cube(size: (1, 3, 1), cells: 4)\np = Pass(c)\nangle = Math(does: \"add\", a: p.share, b: 0.1)\n"
        "t = Twist(p, angle: angle)\nm = Transform(t, move: (0.1, 0.2, 0), scale: (0.9, 0.9, 0.9))\n"
        "r = Repeat(m, each: p, times: 5)\n";
    std::string chain = "graph 1\nm0 = Cube(size: (1, 3, 1), cells: 4)\n";
    for (int i = 0; i < 5; ++i) {
        const std::string n = std::to_string(i), next = std::to_string(i + 1);
        chain += "t" + n + " = Twist(m" + n + ", angle: " + numberText(float(i) / 4 + 0.1f) + ")\nm" + next +
                 " = Transform(t" + n + ", move: (0.1, 0.2, 0), scale: (0.9, 0.9, 0.9))\n";
    }
    const std::vector<glm::vec3> made = standing(repeated, "r"), wanted = standing(chain, "m5");
    CHECK(made == wanted);
    CHECK(made.size() == 150);
}

TEST_CASE("loops lie in each other") {
    // Rows of rows: a branch carries two smaller ones, three times.
    const std::string text =
        "graph 1\nc = Cube\np = Pass(c)\nsmall = Transform(p, move: (0, 1, 0), scale: (0.5, 0.5, 0.5))\n"
        "left = Transform(small, turn: (0, 0, 0.6))\nright = Transform(small, turn: (0, 0, -0.6))\n"
        "both = Join(c, left, right)\nfern = Repeat(both, each: p, times: 3)\n";
    NodeEvaluation e = evaluationOf(text + "show fern\n");
    REQUIRE(e.failures().empty());
    CHECK(geometryOf(e, "fern").size() == 1 + 2 * (1 + 2 * 3));
    // Each variant of the outer loop has its own number of inner passes.
    const std::string nested =
        "graph 1\ngrid = PointGrid(counts: (4, 1, 1))\nv = Variant\nc = Cube\np = Pass(c)\n"
        "up = Transform(p, move: (0, 1, 0))\nboth = Join(c, up)\nmore = Math(does: \"add\", a: v.index, b: 1)\n"
        "times = Round(more)\nstack = Repeat(both, each: p, times: times)\n"
        "towers = Replicate(grid, stack, each: v, variants: 0)\n";
    NodeEvaluation towers = evaluationOf(nested + "show towers\n");
    INFO((towers.failures().empty() ? std::string() : towers.failures().front().message));
    REQUIRE(towers.failures().empty());
    CHECK(geometryOf(towers, "towers").size() == 2 + 3 + 4 + 5);
    float high = 0;
    for (const glm::vec3& p : standing(nested, "towers")) high = std::max(high, p.y);
    CHECK(high == 4.5f);
}

TEST_CASE("what is repeated has the same bits by kernels, lanes and scalar code") {
    Result<std::unique_ptr<Device>> device = Device::create();
    REQUIRE(device);
    const std::vector<glm::vec3> plain = standing(kTrees, "trees", hostMachine(1, true));
    CHECK(plain.size() == 20 * 36);  // 12 vertices around and 12 at each end
    CHECK(standing(kTrees, "trees", hostMachine(2)) == plain);
    CHECK(standing(kTrees, "trees", deviceMachine(**device, false)) == plain);
}

TEST_CASE("passes are made again only when their nodes are") {
    NodeEvaluation e = evaluationOf(
        "graph 1\ngrid = PointGrid(counts: (5, 1, 4))\nv = Variant\nring = Circle(samples: 9, radius: v.random)\n"
        "path = Curve\ntube = Loft(path, ring)\nmany = Replicate(grid, tube, each: v, variants: 4)\nshow many\n");
    REQUIRE(e.failures().empty());
    const uint32_t all = e.stats().kernels;
    CHECK(all > 4 * 3);
    REQUIRE(e.setInput("many", "size", Literal(2.0f)));
    REQUIRE(e.evaluate());
    CHECK(e.stats().kernels == 0);
    CHECK(geometryOf(e, "many").front().program.back().a[0] == 2);
    REQUIRE(e.setInput("ring", "turn", Literal(1.0f)));
    REQUIRE(e.evaluate());
    CHECK(e.stats().kernels >= 4 * 3);
    CHECK(e.stats().kernels < all);
    // Another text in which the loop is the same goes on with what its passes keep.
    const std::string text = printGraph(e.graph());
    const std::vector<glm::vec3> before = *e.positions(geometryOf(e, "many").front());
    std::string wider = text;
    wider.replace(wider.find("turn: 1"), 7, "turn: 2");
    REQUIRE(e.load(parsed(wider)));
    REQUIRE(e.evaluate());
    CHECK(*e.positions(geometryOf(e, "many").front()) != before);
    REQUIRE(e.load(parsed(text)));
    REQUIRE(e.evaluate());
    CHECK(*e.positions(geometryOf(e, "many").front()) == before);
}

TEST_CASE("loops with mistakes are told") {
    const auto told = [](const std::string& body) { return mistakesIn("graph 1\ng = PointGrid\nc = Cube\n" + body); };
    const auto has = [](const std::string& text, const char* part) {
        INFO(text);
        CHECK(text.find(part) != std::string::npos);
    };
    has(told("r = Replicate(g, c)\n"), "test.graph:4:1: r: 'each' is missing: Replicate needs a wire to Variant");
    has(told("r = Replicate(g, c, each: c)\n"), "'each' takes a wire to Variant, but 'c' is Cube");
    has(told("p = Pass(c)\nr = Replicate(g, c, each: p)\n"), "'each' takes a wire to Variant, but 'p' is Pass");
    has(told("r = Repeat(c, each: 0)\n"), "'each' takes a wire to Pass");
    has(told("v = Variant\nr = Replicate(g, c, each: v, variants: 5000)\n"),
        "'variants' is 5000, which isn't 0 to 4096");
    // A loop is no reason for wires to go round: what a pass begins with can't be what Repeat gives.
    has(told("p = Pass(r)\nr = Repeat(p, each: p)\n"), "wires go round in a circle: p -> r -> p");
    std::string many;
    for (int i = 0; i < 257; ++i) {
        const std::string n = std::to_string(i);
        many += "p" + n + " = Pass(c)\nr" + n + " = Repeat(p" + n + ", each: p" + n + ")\n";
    }
    has(told(many), "a graph has at most 256 nodes that repeat");
}

TEST_CASE("a pass that fails says which, and the last good one stays") {
    NodeEvaluation e = evaluationOf(
        "graph 1\ngrid = PointGrid(counts: (4, 1, 1))\nv = Variant\nd = Math(does: \"subtract\", a: 9, b: v.index)\n"
        "q = Math(does: \"divide\", a: 1, b: d)\nc = Cylinder(radius: q)\n"
        "all = Replicate(grid, c, each: v, variants: 0)\nshow all\n");
    REQUIRE(e.failures().empty());
    CHECK(geometryOf(e, "all").size() == 4);
    REQUIRE(e.setInput("d", "a", Literal(2.0f)));
    REQUIRE(e.evaluate());
    REQUIRE(e.failures().size() == 1);
    CHECK(toString(e.failures().front()) == "test.graph:7:1: all: in pass 2 of 4, 'q' divides by 0");
    CHECK(geometryOf(e, "all").size() == 4);
    REQUIRE(e.setInput("d", "a", Literal(7.0f)));
    REQUIRE(e.evaluate());
    CHECK(e.failures().empty());
}

TEST_CASE("loops are counted before anything is made") {
    // Each level repeats the one below a thousand times.
    const std::string text =
        "graph 1\nc = Cube\np0 = Pass(c)\np1 = Pass(p0)\np2 = Pass(p1)\nt = Switch(choices: p2)\n"
        "r2 = Repeat(t, each: p2, times: 1000)\nr1 = Repeat(r2, each: p1, times: 1000)\n"
        "r0 = Repeat(r1, each: p0, times: 1000)\nshow r0\n";
    uint64_t bytes = 0;
    NodeEvaluation e(std::make_unique<CountingMachine>(bytes));
    REQUIRE(e.load(parsed(text)));
    CHECK(secondsOf([&] { REQUIRE(e.evaluate()); }) < 0.5);
    REQUIRE(e.failures().size() == 1);
    CHECK(e.failures().front().message ==
          "in pass 0 of 1000, 'r2' 1000000 passes of 2 nodes are more than 1,000,000 in all");
    CHECK(bytes < 100000);
    // A part that doubles in each pass ends where parts do.
    NodeEvaluation doubled = evaluationOf(
        "graph 1\nc = Cube\np = Pass(c)\nt = Twist(p)\nj = Join(p, t)\nr = Repeat(j, each: p, times: 1000)\nshow r\n");
    REQUIRE(doubled.failures().size() == 1);
    CHECK(doubled.failures().front().message == "in pass 12 of 1000, 'j' joins more than 4,096 parts");
    NodeEvaluation deep =
        evaluationOf("graph 1\nc = Cube\np = Pass(c)\nt = Twist(p)\nr = Repeat(t, each: p, times: 65)\nshow r\n");
    REQUIRE(deep.failures().size() == 1);
    CHECK(deep.failures().front().message == "in pass 64 of 65, 't' more than 64 steps act on one geometry");
}
