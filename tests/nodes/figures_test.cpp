// What LUNA says of its figures (Hoetzlein 2010, 4.4.1), of the shipped graphs, against formulas in double precision.
#include <cmath>

#include "runtime/gpu/device.hpp"
#include "runtime/nodes/wishes.hpp"
#include "tests/nodes/graphs.hpp"

using namespace espalier;
using namespace espalier::nodetest;

namespace {

using Place = glm::dvec3;

// Of figures 4.5: 6 x 9 x 6 points, half a metre apart, that stand on the ground.
Place gridPoint(uint32_t i) {
    return {(i % 6) * 0.5 - 1.25, (i / 6 % 9) * 0.5 + 0.25, (i / 54) * 0.5 - 1.25};
}
Place twisted(const Place& p, double perMetre) {
    const double angle = perMetre * p.y, c = std::cos(angle), s = std::sin(angle);
    return {p.x * c + p.z * s, p.y, p.z * c - p.x * s};
}

// Vertices of all instances one after the other as kernels leave them, and those of the shape.
struct Standing {
    std::vector<glm::vec3> shape, all;
};
Standing standing(const char* graph, std::unique_ptr<NodeMachine> machine = hostMachine(1)) {
    NodeEvaluation e = evaluationOf(contentText(graph) + "ground = Bake(shown)\nshow ground\n", std::move(machine));
    REQUIRE(e.failures().empty());
    Result<const NodeValue*> value = e.inspect("ground");
    REQUIRE(value);
    return {*e.positions(geometryOf(e, "cube").front()), std::get<GroundRef>(**value)->places};
}

double degreesBetween(const Place& a, const Place& b) {
    return std::acos(std::min(1.0, glm::dot(glm::normalize(a), glm::normalize(b)))) * 180 / M_PI;
}

}  // namespace

TEST_CASE("figure 4.5a: cubes over a twisted grid are congruent") {
    const Standing s = standing("twisted_points.graph");
    REQUIRE(s.all.size() == 324 * s.shape.size());
    double apart = 0, off = 0, turned = 0;
    for (uint32_t i = 0; i < 324; ++i) {
        const Place centre = twisted(gridPoint(i), double(0.35f));
        turned = std::max(turned, glm::length(centre - gridPoint(i)));
        for (uint32_t v = 0; v < s.shape.size(); ++v) {
            const Place p = s.all[i * s.shape.size() + v];
            apart = std::max(apart, glm::length(p - centre - Place(s.shape[v])));
            // Edges of one cube, which say nothing of where it stands.
            const Place edge = p - Place(s.all[i * s.shape.size()]), own = Place(s.shape[v]) - Place(s.shape[0]);
            off = std::max(off, std::abs(glm::length(edge) - glm::length(own)));
        }
    }
    CHECK(apart < 2e-6);
    CHECK(off < 1e-6);
    CHECK(turned > 1);
}

TEST_CASE("figure 4.5b: twisted cubes stand on the grid to the bit") {
    NodeEvaluation e = evaluationOf(contentText("twisted_cubes.graph"));
    const std::vector<glm::vec3> grid = *e.positions(geometryOf(e, "grid").front());
    REQUIRE(grid.size() == 324);
    for (uint32_t i = 0; i < 324; ++i) CHECK(Place(grid[i]) == gridPoint(i));
    // The middle of a shape goes to its point, with no rounding.
    const GeometryPart part = e.shown().front();
    REQUIRE(part.instances() == 324);
    for (uint32_t i = 0; i < 324; ++i) {
        uint32_t instance = i;
        glm::vec3 p(0);
        for (const DeformOp& op : part.program) p = deformStep(op, p, {0, 1, 0}, instance);
        CHECK(Place(p) == gridPoint(i));
    }
    const Standing s = standing("twisted_cubes.graph");
    double apart = 0;
    for (uint32_t i = 0; i < 324; ++i)
        for (uint32_t v = 0; v < s.shape.size(); ++v)
            apart = std::max(
                apart, glm::length(Place(s.all[i * s.shape.size() + v]) - gridPoint(i) - twisted(s.shape[v], 3.5)));
    CHECK(apart < 2e-6);
}

TEST_CASE("figure 4.5c: what is deformed where it is drawn is what is made in memory") {
    const Standing s = standing("twisted_all.graph");
    NodeEvaluation e = evaluationOf(contentText("twisted_all.graph"));
    const GeometryPart part = e.shown().front();
    REQUIRE(s.all.size() == 324 * s.shape.size());
    double apart = 0, drawn = 0;
    for (uint32_t i = 0; i < 324; ++i)
        for (uint32_t v = 0; v < s.shape.size(); ++v) {
            const Place p = s.all[i * s.shape.size() + v];
            apart = std::max(apart, glm::length(p - twisted(gridPoint(i) + Place(s.shape[v]), double(0.35f))));
            // As the shader that draws takes the steps.
            uint32_t instance = i;
            glm::vec3 q = s.shape[v];
            for (const DeformOp& op : part.program) q = deformStep(op, q, {0, 1, 0}, instance);
            drawn = std::max(drawn, glm::length(p - Place(q)));
        }
    CHECK(apart < 2e-6);
    CHECK(drawn < 1e-6);
    Result<std::unique_ptr<Device>> device = Device::create();
    REQUIRE(device);
    CHECK(standing("twisted_all.graph", deviceMachine(**device, false)).all == s.all);
}

TEST_CASE("normals of deformed meshes turn with the surface, headings with their points") {
    const std::string text =
        "graph 1\nball = Sphere(radius: 1, sides: 48)\nt = Twist(ball, angle: 1.7)\n"
        "b = Bend(t, angle: 0.4)\nspine = Cube\nspines = Scatter(b, spine, up: \"normal\")\n"
        "tree = JointTree(levels: 5)\ntwisted = Twist(tree, angle: 0.8)\n"
        "bars = Scatter(twisted, spine, up: \"normal\")\nshow spines bars\n";
    const auto moved = [](const Place& p) {
        const Place q = twisted(p, double(1.7f));
        const double k = double(0.4f), radius = 1 / k - q.x;
        return Place(1 / k - radius * std::cos(k * q.y), radius * std::sin(k * q.y), q.z);
    };
    NodeEvaluation e = evaluationOf(text);
    REQUIRE(e.failures().empty());
    const std::vector<glm::vec3> ball = *e.positions(geometryOf(e, "ball").front());
    const DeformOp spines = geometryOf(e, "spines").front().program.back();
    double worst = 0, turned = 0;
    for (uint32_t i = 0; i < ball.size(); ++i) {
        const Place n = glm::normalize(Place(ball[i])), p = n;
        const Place across = glm::normalize(glm::cross(n, std::abs(n.y) < 0.9 ? Place(0, 1, 0) : Place(1, 0, 0)));
        const Place other = glm::cross(n, across);
        constexpr double h = 1e-6;
        const Place wanted =
            glm::cross(moved(p + across * h) - moved(p - across * h), moved(p + other * h) - moved(p - other * h));
        const Place made(unpackOct(spines.normals.v[i]));
        worst = std::max(worst, degreesBetween(wanted, made));
        turned = std::max(turned, degreesBetween(n, made));
    }
    CHECK(worst < 0.5);
    CHECK(turned > 20);
    const GeometryPart tree = geometryOf(e, "tree").front();
    const std::vector<glm::vec3> joints = *e.positions(tree);
    const std::vector<uint32_t> along = *e.normals(tree);
    const DeformOp bars = geometryOf(e, "bars").front().program.back();
    worst = turned = 0;
    for (uint32_t i = 0; i < joints.size(); ++i) {
        const Place p(joints[i]), n = glm::normalize(Place(unpackOct(along[i])));
        const Place wanted = twisted(p + n * 1e-6, double(0.8f)) - twisted(p - n * 1e-6, double(0.8f));
        const Place made(unpackOct(bars.normals.v[i]));
        worst = std::max(worst, degreesBetween(wanted, made));
        turned = std::max(turned, degreesBetween(n, made));
    }
    CHECK(worst < 0.5);
    CHECK(turned > 20);
    // The same bits on each machine: spines that are scattered stand alike.
    const auto all = [&](std::unique_ptr<NodeMachine> machine) {
        NodeEvaluation other = evaluationOf(text + "g = Bake(spines)\nshow g\n", std::move(machine));
        REQUIRE(other.failures().empty());
        return std::get<GroundRef>(**other.inspect("g"))->places;
    };
    Result<std::unique_ptr<Device>> device = Device::create();
    REQUIRE(device);
    const std::vector<glm::vec3> plain = all(hostMachine(1, true));
    CHECK(all(hostMachine(2)) == plain);
    CHECK(all(deviceMachine(**device, false)) == plain);
}
