// A fluid: the same whichever way led to a frame and whoever works it out, densities against Python's, and what physics
// says of it.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "runtime/gpu/device.hpp"
#include "shaders/shared/node_fluid.h"
#include "tests/nodes/graphs.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace espalier;
using namespace espalier::nodetest;

namespace {

// A column of 500 particles that breaks, seen through a scatter; `more` are further inputs.
std::string fluidText(const std::string& more = "") {
    return "graph 1\nt = Time\nwater = Fluid(low: (0, 0, 0), high: (1, 1, 0.25), from: (0, 0, 0), to: (0.5, 0.5, "
           "0.25), " +
           more + "time: t.frame)\nball = Cube\nballs = Scatter(water, ball, size: 0.04, up: \"normal\")\nshow balls\n";
}

void goTo(NodeEvaluation& e, int frame) {
    e.setTime({double(frame), 1.0 / 30});
    REQUIRE(e.evaluate());
    REQUIRE(e.failures().empty());
}

// A fluid's particles as they lie in memory: planes of node_fluid.h.
struct Particles {
    std::vector<glm::vec3> at, velocity;
    std::vector<float> density;
    std::vector<uint32_t> normal;
    bool operator==(const Particles&) const = default;
    uint64_t hash() const {
        uint64_t all = hashBytes(std::as_bytes(std::span(at)));
        all = hashBytes(std::as_bytes(std::span(velocity)), all);
        all = hashBytes(std::as_bytes(std::span(density)), all);
        return hashBytes(std::as_bytes(std::span(normal)), all);
    }
};

// A graph together with the machine that it runs on.
struct Fluid {
    NodeMachine* machine;
    NodeEvaluation e;
    explicit Fluid(const std::string& text, std::unique_ptr<NodeMachine> made = hostMachine(1))
        : machine(made.get()), e(evaluationOf(text, std::move(made))) {}

    Particles particles() {
        const GeometryPart part = geometryOf(e, "water").front();
        const size_t stride = part.positions.stride;
        const std::vector<std::byte> bytes = *machine->read(*part.positionBlock, stride * kFluidPlanes * sizeof(float));
        std::vector<float> planes(stride * kFluidPlanes);
        std::memcpy(planes.data(), bytes.data(), bytes.size());
        Particles all;
        for (uint32_t i = 0; i < part.elements; ++i) {
            const auto three = [&](size_t first) {
                return glm::vec3(planes[first * stride + i], planes[(first + 1) * stride + i],
                                 planes[(first + 2) * stride + i]);
            };
            all.at.push_back(three(0));
            all.velocity.push_back(three(kFluidVelocity));
            all.density.push_back(planes[kFluidDensity * stride + i]);
        }
        all.normal = *e.normals(part);
        return all;
    }
    Particles at(int frame) {
        goTo(e, frame);
        return particles();
    }
};

glm::dvec3 middleOf(const std::vector<glm::vec3>& places) {
    glm::dvec3 all(0);
    for (const glm::vec3& p : places) all += glm::dvec3(p);
    return all / double(places.size());
}

}  // namespace

TEST_CASE("frame 200 of a fluid is the same by playing, seeking, replaying and reloading") {
    Fluid sought(fluidText());
    const Particles wanted = sought.at(200);
    REQUIRE(wanted.at.size() == 500);

    Fluid played(fluidText());
    Particles before = played.at(0);
    for (int frame = 1; frame <= 200; ++frame) goTo(played.e, frame);
    CHECK(played.particles().hash() == wanted.hash());
    CHECK(played.particles() == wanted);
    CHECK(played.at(0) == before);
    CHECK(played.at(200) == wanted);  // from what it has kept
    goTo(played.e, 230);
    CHECK(played.at(199) != wanted);
    CHECK(played.at(200) == wanted);

    // Another text in which the fluid is as before, and one in which it isn't.
    std::string text = fluidText();
    REQUIRE(sought.e.load(parsed(text.replace(text.find("0.04"), 4, "0.03"))));
    CHECK(sought.at(200) == wanted);
    REQUIRE(sought.e.load(parsed(fluidText("seed: 2, "))));
    CHECK(sought.at(200) != wanted);
    REQUIRE(sought.e.load(parsed(fluidText())));
    CHECK(sought.at(200) == wanted);
    // An input that goes there and back.
    REQUIRE(sought.e.setInput("water", "viscosity", Literal(0.2f)));
    CHECK(sought.at(200) != wanted);
    REQUIRE(sought.e.setInput("water", "viscosity", Literal(0.05f)));
    CHECK(sought.at(200) == wanted);
}

TEST_CASE("a fluid is the same by scalar code, lanes, threads and kernels") {
    Result<std::unique_ptr<Device>> device = Device::create();
    REQUIRE(device);
    for (const char* more : {"", "radius: 0.07, viscosity: 0.12, bounce: 0.6, gravity: (3, -9, 1), stiffness: 80, "}) {
        const auto by = [&](std::unique_ptr<NodeMachine> machine) {
            return Fluid(fluidText(more), std::move(machine)).at(20);
        };
        const Particles plain = by(hostMachine(1, true));
        for (const unsigned threads : {1u, 2u, 4u}) CHECK(by(hostMachine(threads)) == plain);
        CHECK(by(deviceMachine(**device, true)) == plain);
        CHECK(by(deviceMachine(**device, false)) == plain);
    }
}

TEST_CASE("densities of a fluid are what Python makes of its places in double precision") {
    const test::ScratchFolder folder;
    for (const int frame : {0, 12, 60}) {
        Fluid fluid(fluidText());
        const Particles particles = fluid.at(frame);
        const std::string name = folder.file("particles.txt");
        {
            std::ofstream file(name);
            file.precision(9);
            file << 0.1f << "\n0 0 0 1 1 0.25\n";
            for (size_t i = 0; i < particles.at.size(); ++i) {
                const glm::vec3 p = particles.at[i];
                file << p.x << " " << p.y << " " << p.z << " " << particles.density[i] << "\n";
            }
        }
        FILE* pipe = popen(("python3 tests/nodes/fluid_density.py '" + name + "'").c_str(), "r");
        REQUIRE(pipe);
        size_t count = 0;
        double worst = 1;
        const int read = std::fscanf(pipe, "%zu %lf", &count, &worst);
        REQUIRE(pclose(pipe) == 0);
        REQUIRE(read == 2);
        MESSAGE("frame " << frame << ": densities " << worst << " of their own apart");
        CHECK(count == 500);
        CHECK(worst <= 1e-5);  // of which the kernels need a tenth
    }
}

TEST_CASE("a fluid falls, keeps its momentum, and comes to rest as deep as it is") {
    // In the air its middle falls by the steps' own formula.
    Fluid falling(
        "graph 1\nt = Time\nwater = Fluid(low: (0, 0, 0), high: (1, 2, 1), from: (0.3, 1.5, 0.3), to: (0.7, 1.9, "
        "0.7), time: t.frame)\nshow water\n");
    const glm::dvec3 first = middleOf(falling.at(0).at);
    const glm::dvec3 after = middleOf(falling.at(10).at);
    const double steps = 80, step = 0.03125 / 8;
    CHECK(after.y == doctest::Approx(first.y - 9.81 * step * step * steps * (steps + 1) / 2).epsilon(1e-5));
    CHECK(std::abs(after.x - first.x) < 1e-5);
    // Nor does it gain any of its own: what pushes is pushed.
    REQUIRE(falling.e.setInput("water", "gravity", Literal(glm::vec3(0))));
    CHECK(glm::length(middleOf(falling.at(30).at) - first) < 1e-5);

    Fluid resting(fluidText());
    const Particles rest = resting.at(600);
    double energy = 0, volume = 0;
    for (size_t i = 0; i < rest.at.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            CHECK(std::abs(rest.at[i][k] - (k == 2 ? 0.125f : 0.5f)) <= (k == 2 ? 0.1001f : 0.4751f));
        energy += glm::dot(rest.velocity[i], rest.velocity[i]) / 2;
        volume += 0.05 * 0.05 * 0.05;
    }
    // It has fallen by an eighth of a metre; hardly any of that goes on moving.
    energy /= 500;
    CHECK(energy < 0.001 * 9.81 * 0.125);
    // Water of this volume stands so deep on this ground, and its middle half as high; it may be pressed by a
    // twentieth.
    const double depth = volume / (1.0 * 0.25);
    MESSAGE("at rest " << 2 * middleOf(rest.at).y << " m deep, poured out " << depth << " m, " << energy << " J/kg");
    CHECK(2 * middleOf(rest.at).y == doctest::Approx(depth).epsilon(0.05));
}

TEST_CASE("a particle's normal is where it is heading") {
    Fluid fluid(fluidText());
    const Particles particles = fluid.at(14);
    int moving = 0;
    for (size_t i = 0; i < particles.at.size(); ++i) {
        const glm::vec3 v = particles.velocity[i];
        if (glm::length(v) < 0.01f) continue;
        ++moving;
        CHECK(glm::dot(unpackOct(particles.normal[i]), glm::normalize(v)) > 0.9999f);
    }
    CHECK(moving > 250);
    for (const uint32_t normal : fluid.at(0).normal) CHECK(unpackOct(normal).y > 0.9999f);
}

TEST_CASE("a fluid that can't be says why, and what it made last stands") {
    const auto refusal = [](const std::string& inputs) {
        NodeEvaluation e = evaluationOf("graph 1\nzero = Number\nwater = Fluid(" + inputs + ")\nshow water\n");
        REQUIRE(e.failures().size() == 1);
        return e.failures().front().message;
    };
    CHECK(mistakesIn("graph 1\na = Fluid(radius: 0)\nshow a\n") ==
          "test.graph:2:19: a: 'radius' is 0, which isn't 0.001 to 1000");
    CHECK(refusal("radius: zero").starts_with("the box is too large for a fluid of that radius: it holds 1998 radii"));
    CHECK(refusal("radius: 0.01") == "3840000 particles are more than 200,000; take a larger radius, or less fluid");
    CHECK(refusal("low: (-1e6, 0, -1e6), high: (1e6, 1e6, 1e6), from: (-1e6, 0, -1e6), to: (1e6, 1e6, 1e6)") ==
          "places so far from the origin aren't fine enough for that radius");
    CHECK(refusal("low: (-90, 0, -90), high: (90, 90, 90), radius: 0.3")
              .starts_with("the box is too large for a fluid of that radius: it holds 599 radii"));
    CHECK(refusal("from: (2, 0, 0), to: (3, 1, 1)") == "'from' and 'to' lie outside of the box, so there is no fluid");
    CHECK(refusal("substeps: 3") ==
          "would shake itself apart: with this radius, stiffness and viscosity it needs 5 substeps");
    CHECK(refusal("stiffness: 1e6, radius: 0.04, step: 1") ==
          "is too stiff or viscous for its radius: it needs 50001 substeps");
    CHECK(refusal("stiffness: 3") ==
          "would be crushed by its weight: with this gravity and box it needs a stiffness of 5");
    // How wide a basin is makes nothing heavier.
    const NodeEvaluation wide = evaluationOf(
        "graph 1\nwater = Fluid(low: (-10, 0, -10), high: (10, 2, 10), from: (-1, 0, -1), to: (1, 1, 1), radius: 0.2)\n"
        "show water\n");
    CHECK(wide.failures().empty());
    CHECK(refusal("time: 1e6").starts_with("frame 1000000 lies beyond frame 1529, to which 3840 particles"));

    Fluid fluid(fluidText());
    const Particles wanted = fluid.at(5);
    const Status noNumber = fluid.e.setInput("water", "radius", Literal(std::nanf("")));
    REQUIRE_FALSE(noNumber);
    CHECK(noNumber.failure().text() == "test.graph: water: 'radius' is nan, which isn't 0.001 to 1000");
    fluid.e.setTime({1e5, 1.0 / 30});
    REQUIRE(fluid.e.evaluate());
    REQUIRE(fluid.e.failures().size() == 1);
    CHECK(fluid.e.shown().front().instances() == 500);
    CHECK(fluid.at(5) == wanted);
}
