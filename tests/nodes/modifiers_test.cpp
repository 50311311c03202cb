// What modifiers do to places, against formulas in double precision; and the same bits by kernels, lanes and scalar
// code.
#include <cmath>
#include <functional>

#include "runtime/gpu/device.hpp"
#include "runtime/nodes/function_text.hpp"
#include "tests/nodes/graphs.hpp"

using namespace espalier;
using namespace espalier::nodetest;

namespace {

using Place = glm::dvec3;

// Particles, and where a modifier leaves them.
struct Moved {
    std::vector<glm::vec3> from, to;
};
Moved movedBy(const std::string& modifier, std::unique_ptr<NodeMachine> machine = hostMachine(1)) {
    NodeEvaluation e =
        evaluationOf("graph 1\np = Particles(count: 333, seed: 5)\nm = " + modifier + "\nall = Filter(m)\nshow all\n",
                     std::move(machine));
    CHECK(e.failures().empty());
    return {*e.positions(geometryOf(e, "p").front()), *e.positions(geometryOf(e, "all").front())};
}

double worst(const std::string& modifier, const std::function<Place(Place)>& wanted) {
    const Moved moved = movedBy(modifier);
    REQUIRE(moved.from.size() == moved.to.size());
    double apart = 0;
    for (size_t i = 0; i < moved.from.size(); ++i)
        apart = std::max(apart, glm::length(wanted(Place(moved.from[i])) - Place(moved.to[i])));
    return apart;
}

const char* const kModifiers[] = {
    "Transform(p, move: (1, 2, 3), turn: (0.3, -1.2, 2.5), scale: (1, 2, -0.5))",
    "Spherify(p, centre: (0.1, 0, 0.2), radius: 1.5, amount: 0.7)",
    "Twist(p, angle: 1.3, axis: (1, 1, 0), centre: (0.2, 0, 0))",
    "Bend(p, angle: 0.9, axis: (0, 1, 0), towards: (0, 0, 1))",
    "Noise(p, amount: 0.3, scale: 2.1, offset: (0.5, 0, 0), seed: 9)",
    "Wave(p, amount: 0.2, direction: (0, 1, 1), travel: (1, 0, 0), length: 0.7, phase: 0.3)",
    "Function(p, x: \"x + a*sin(3*y)\", y: \"max(y, -0.2) * noise(x, y, z)\", z: \"mod(z, 0.3) - floor(4*x)/8\", a: "
    "0.25)",
};

}  // namespace

TEST_CASE("modifiers move places as their formulas say") {
    CHECK(worst("Transform(p, move: (1, 2, 3), turn: (0, 0, 1.5707964), scale: (1, 2, 1))",
                [](Place p) { return Place(1 - 2 * p.y, 2 + p.x, 3 + p.z); }) < 2e-6);
    CHECK(worst("Spherify(p, centre: (0.1, 0, 0.2), radius: 1.5, amount: 0.7)", [](Place p) {
              const Place centre(0.1f, 0, 0.2f);
              return glm::mix(p, centre + glm::normalize(p - centre) * 1.5, double(0.7f));
          }) < 2e-6);
    CHECK(worst("Twist(p, angle: 1.3)", [](Place p) {
              const double angle = double(1.3f) * p.y;
              return Place(p.x * std::cos(angle) + p.z * std::sin(angle), p.y,
                           p.z * std::cos(angle) - p.x * std::sin(angle));
          }) < 2e-6);
    CHECK(worst("Bend(p, angle: 0.9)", [](Place p) {
              const double k = double(0.9f), radius = 1 / k - p.x;
              return Place(1 / k - radius * std::cos(k * p.y), radius * std::sin(k * p.y), p.z);
          }) < 2e-6);
    CHECK(worst("Bend(p, angle: 0)", [](Place p) { return p; }) == 0);
    CHECK(worst("Wave(p, amount: 0.2, length: 0.7, phase: 0.3)", [](Place p) {
              return p + Place(0, 0.2 * std::sin(2 * M_PI * (p.x / double(0.7f) - double(0.3f))), 0);
          }) < 2e-6);
    CHECK(worst("Function(p, x: \"-(x - 2*y)/4\", y: \"sqrt(abs(z)) + cos(x*5)\", z: \"min(a, b) * c\", a: 3, b: 2, c: "
                "0.5)",
                [](Place p) { return Place(-(p.x - 2 * p.y) / 4, std::sqrt(std::abs(p.z)) + std::cos(p.x * 5), 1); }) <
          2e-6);
    // Noise stays within its amount, and moves some places a good part of it.
    const Moved noisy = movedBy("Noise(p, amount: 0.3, scale: 2)");
    float most = 0;
    for (size_t i = 0; i < noisy.from.size(); ++i) {
        const glm::vec3 d = glm::abs(noisy.to[i] - noisy.from[i]);
        most = std::max({most, d.x, d.y, d.z});
    }
    CHECK(most <= 0.3f);
    CHECK(most > 0.1f);
}

TEST_CASE("modifiers make the same bits by kernels, lanes and scalar code") {
    Result<std::unique_ptr<Device>> device = Device::create();
    REQUIRE(device);
    for (const char* modifier : kModifiers) {
        CAPTURE(std::string(modifier));
        const Moved plain = movedBy(modifier, hostMachine(1, true));
        CHECK(plain.to != plain.from);
        CHECK(movedBy(modifier, hostMachine(2)).to == plain.to);
        CHECK(movedBy(modifier, deviceMachine(**device, false)).to == plain.to);
    }
}

TEST_CASE("modifiers of meshes see normals") {
    NodeEvaluation e = evaluationOf(
        "graph 1\nball = Sphere(radius: 1)\nout = Displace(ball, amount: 0.2, scale: 3)\nall = Filter(out)\nshow "
        "all\n");
    float least = 2, most = 0;
    const std::vector<glm::vec3> places = *e.positions(geometryOf(e, "all").front());
    for (const glm::vec3& p : places) {
        least = std::min(least, glm::length(p));
        most = std::max(most, glm::length(p));
    }
    CHECK(least > 0.8f);
    CHECK(least < 0.98f);
    CHECK(most > 1.02f);
    CHECK(most < 1.2f);
}

TEST_CASE("functions with mistakes tell where") {
    const auto told = [](const char* x) {
        Result<std::vector<uint32_t>> code = compileFunction({x, "y", "z"});
        return code ? std::string() : code.failure().diagnostics.front().message;
    };
    CHECK(told("x") == "");
    CHECK(told("") == "'x': column 1: expected a number, a name or '(', but the text ends");
    CHECK(told("x +") == "'x': column 4: expected a number, a name or '(', but the text ends");
    CHECK(told("x y") == "'x': column 3: expected an operator, found 'y'");
    CHECK(told("(x") == "'x': column 3: a ')' is missing");
    CHECK(told("sin x") == "'x': column 5: expected '(' behind sin");
    CHECK(told("min(x)") == "'x': column 6: min takes 2 numbers");
    CHECK(told("tan(x)").find("column 1: there is no 'tan'") != std::string::npos);
    CHECK(told("1e999") == "'x': column 1: this is no number");
    CHECK(told((std::string(100, '(') + "x").c_str()).find("too many parentheses") != std::string::npos);
    std::string deep = "x";
    for (int i = 0; i < 12; ++i) deep = "y+(" + deep + ")";
    CHECK(told(deep.c_str()).find("keeps too many numbers at once") != std::string::npos);
    std::string longer = "x";
    for (int i = 0; i < 400; ++i) longer += "+x";
    CHECK(told(longer.c_str()).find("is too long") != std::string::npos);
    Result<std::vector<uint32_t>> bad = compileFunction({"x", "y", "q"});
    REQUIRE_FALSE(bad);
    CHECK(bad.failure().diagnostics.front().message.starts_with("'z': column 1"));
}
