// Texts of graphs: what they mean, how they are written, what is told of mistakes.
#include <filesystem>

#include "tests/nodes/graphs.hpp"

using namespace espalier;
using namespace espalier::nodetest;

namespace {

bool has(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}

// A graph that names every kind and every port once, whatever fits.
std::string everyKind() {
    std::string text =
        "graph 1\npoints0 = PointGrid\ncurves0 = Circle\nmesh0 = Cube\nmaterial0 = Material\n"
        "rules0 = Grammar\nground0 = Bake(mesh0)\nVariant0 = Variant\nPass0 = Pass(mesh0)\n";
    for (const NodeKind& kind : nodeKinds()) {
        text += "n" + kind.name + " = " + kind.name;
        std::string inputs;
        for (const NodePort& port : kind.inputs) {
            inputs += (inputs.empty() ? "(" : ", ") + port.name + ": ";
            const glm::vec3& v = port.standard.numbers;
            if (port.standard.kind == Literal::Kind::number) inputs += numberText(v.x);
            if (port.standard.kind == Literal::Kind::vector)
                inputs += "(" + numberText(v.x) + ", " + numberText(v.y) + ", " + numberText(v.z) + ")";
            if (port.standard.kind == Literal::Kind::text) inputs += "\"" + port.standard.text + "\"";
            if (port.standard.kind != Literal::Kind::none) continue;
            if (*port.opener) {
                inputs += std::string(port.opener) + "0";
                continue;
            }
            inputs += port.type == ValueType::points     ? "points0"
                      : port.type == ValueType::curves   ? "curves0"
                      : port.type == ValueType::material ? "material0"
                      : port.type == ValueType::rules    ? "rules0"
                      : port.type == ValueType::ground   ? "ground0"
                                                         : "mesh0";
        }
        text += inputs.empty() ? "\n" : inputs + ")\n";
    }
    return text;
}

}  // namespace

TEST_CASE("the shipped graphs are written in the canonical way") {
    size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator("content/graphs")) {
        const std::string name = entry.path().filename().string(), text = contentText(name);
        CAPTURE(name);
        CHECK(printGraph(parsed(text)) == text);
        CHECK(mistakesIn(text) == "");
        ++count;
    }
    CHECK(count >= 3);
}

TEST_CASE("writing and reading a graph again changes nothing") {
    const std::string odd =
        "# head\n\ngraph 1   # first\n\n"
        "b=Twist ( angle:2.50 , geometry : a ) # behind\n"
        "# of a\n"
        "a = Cube(cells: 3,\n    size: (1, 2.0, -0)\n )\n"
        "u = Unheard(a, \"x\\\"\\n\\\\\", 7, (1,2,3), way: b.out)\n"
        "show b a\nlayout { a 1 2; b 3 -4.5\n u 1e3 0 }\n# end\n";
    const NodeGraph graph = parsed(odd);
    const std::string text = printGraph(graph);
    CHECK(parsed(text) == graph);
    CHECK(printGraph(parsed(text)) == text);
    CHECK(has(text, "b = Twist(a, angle: 2.5)\n"));
    CHECK(has(text, "u = Unheard(a, \"x\\\"\\n\\\\\", 7, (1, 2, 3), way: b.out)\n"));
    CHECK(has(text, "# head\n# first\n# behind\n") == false);  // comments stay in their order
    CHECK(has(text, "# end\n"));
}

TEST_CASE("every kind of the table can be written, read and checked") {
    const std::string text = everyKind();
    CHECK(mistakesIn(text) == "");
    const std::string canonical = printGraph(parsed(text));
    CHECK(printGraph(parsed(canonical)) == canonical);
    CHECK(parsed(canonical) == parsed(text));
    for (const NodeKind& kind : nodeKinds()) {
        CAPTURE(kind.name);
        CHECK((kind.make != nullptr));
        CHECK(std::string(kind.help).size() > 5);
        for (const NodePort& port : kind.inputs) {
            CAPTURE(port.name);
            CHECK((port.standard.kind == Literal::Kind::none || mistakeInConstant(port.standard, port) == ""));
        }
    }
}

TEST_CASE("mistakes are told with their place") {
    const auto told = [](const char* body) { return mistakesIn(std::string("graph 1\n") + body); };
    CHECK(has(mistakesIn(""), "test.graph:1:1: a graph begins with 'graph 1'"));
    CHECK(has(mistakesIn("graph 2\n"), "version 2 of graphs isn't known"));
    CHECK(
        has(told("a = Cube(sice: (1,1,1))\n"), "test.graph:2:16: a: Cube has no input 'sice' (did you mean 'size'?)"));
    CHECK(has(told("a = Cube(cells: 0)\n"), "test.graph:2:17: a: 'cells' is 0, which isn't 1 to 1000"));
    CHECK(has(told("a = Cube(cells: 1.5)\n"), "'cells' takes a whole number"));
    CHECK(has(told("a = Cube(cells: nil)\n"), "there is no node 'nil'"));
    CHECK(has(told("a = Cube(cells: 1e99)\n"), "doesn't fit into 32 bits"));
    CHECK(has(told("a = Cube(size: 3)\n"), "'size' takes three numbers"));
    CHECK(has(told("a = Cube(cells: 1, cells: 2)\n"), "given twice"));
    CHECK(has(told("a = Cube\na = Cube\n"), "test.graph:3:1: a: another node has this name already"));
    CHECK(has(told("a = Loft\n"), "'path' is missing: Loft needs a wire to Curves"));
    CHECK(has(told("p = PointGrid\na = Loft(p, p)\n"), "'path' takes Curves, but 'p' gives Points"));
    CHECK(has(told("t = Time\na = Cube(cells: t.seconds)\n"), "'cells' takes Whole, but 't' gives Number"));
    CHECK(has(told("t = Time\na = Cube(cells: t.hours)\n"), "'t' (Time) has no output 'hours'"));
    CHECK(has(told("a = Scatter(b, a)\nb = Cube\n"), "wires go round in a circle: a -> a"));
    CHECK(has(told("a = Twist(c)\nb = Twist(a)\nc = Twist(b)\n"), "a -> b -> c -> a"));
    CHECK(has(told("show x\n"), "there is no node 'x'"));
    CHECK(has(told("a = Cube(\n"), "a ')' is missing"));
    CHECK(has(told("a = \"x\n"), "no closing quote"));
    CHECK(has(told("m = Scatter(a, a, up: \"x\")\na = Cube\n"), "'up' takes one of \"y\", \"normal\""));
}

TEST_CASE("a circle through very many nodes is told at once") {
    std::string text = "graph 1\n";
    for (int i = 0; i < 50000; ++i)
        text += "n" + std::to_string(i) + " = Twist(n" + std::to_string((i + 1) % 50000) + ")\n";
    CHECK(has(mistakesIn(text), "wires go round in a circle"));
}
