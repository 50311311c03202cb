// A tree of joints, against a tree that is built branch by branch in double precision; and what stands on it.
#include <cmath>
#include <tuple>

#include "runtime/gpu/device.hpp"
#include "tests/nodes/graphs.hpp"

using namespace espalier;
using namespace espalier::nodetest;

namespace {

struct TreeJoint {
    glm::dvec3 at, along, side;
    double span;
};

// The numbers that chance gives, worked out once more.
double chance(uint32_t seed, uint32_t i, uint32_t site) {
    return 2 * double(mixed(i + mixed(seed + mixed(site + 0x51ED2701))) >> 8) / 16777216 - 1;
}

// Level by level, each joint from the one that carries it.
std::vector<TreeJoint> treeOf(uint32_t levels, uint32_t branches, double trunk, double shrink, double angle,
                              double spread, uint32_t seed) {
    std::vector<TreeJoint> all{{glm::dvec3(0), {0, 1, 0}, {1, 0, 0}, trunk}};
    size_t first = 0;
    for (uint32_t level = 1; level < levels; ++level) {
        const size_t end = all.size();
        for (size_t j = first; j < end; ++j)
            for (uint32_t child = 0; child < branches; ++child) {
                const TreeJoint from = all[j];
                const uint32_t i = uint32_t(all.size());
                const double around =
                    2 * M_PI * (child + 0.5 * spread * chance(seed, i, 0)) / branches + M_PI * (3 - std::sqrt(5));
                const double tilt = angle * (1 + spread * chance(seed, i, 1));
                const glm::dvec3 across =
                    from.side * std::cos(around) + glm::cross(from.along, from.side) * std::sin(around);
                all.push_back({from.at + from.along * from.span,
                               glm::normalize(from.along * std::cos(tilt) + across * std::sin(tilt)),
                               glm::normalize(across * std::cos(tilt) - from.along * std::sin(tilt)),
                               from.span * shrink * (1 + 0.5 * spread * chance(seed, i, 2))});
            }
        first = end;
    }
    return all;
}

const char* const kTree =
    "graph 1\ntree = JointTree(levels: 6, branches: 3, length: 1.5, shrink: 0.8, angle: 0.6, spread: 0.4, seed: 9)\n"
    "bar = Cube(size: (0, 2, 0))\nbars = Scatter(tree, bar, turnSpread: 0, up: \"normal\")\ntip = Cube(size: (0, 0, "
    "0))\ntips = "
    "Scatter(tree.ends, tip)\nkept = Filter(tree, low: (-100, 1, -100))\nfew = Scatter(kept, bar, turnSpread: 0, up: "
    "\"normal\")\nshow bars tips few\n";

}  // namespace

TEST_CASE("joints lie where a tree that is built branch by branch has them") {
    NodeEvaluation e = evaluationOf(kTree);
    REQUIRE(e.failures().empty());
    const std::vector<TreeJoint> wanted = treeOf(6, 3, 1.5, 0.8f, 0.6f, 0.4f, 9);
    REQUIRE(wanted.size() == 364);
    const GeometryPart tree = geometryOf(e, "tree").front();
    const std::vector<glm::vec3> places = *e.positions(tree);
    const std::vector<uint32_t> normals = *e.normals(tree);
    REQUIRE(places.size() == wanted.size());
    double apart = 0, turned = 0;
    for (size_t i = 0; i < wanted.size(); ++i) {
        apart = std::max(apart, glm::length(glm::dvec3(places[i]) - wanted[i].at));
        turned = std::max(turned, glm::length(glm::dvec3(unpackOct(normals[i])) - wanted[i].along));
    }
    CHECK(apart < 1e-5);
    CHECK(turned < 2e-4);  // of 16 bits

    // The last level's ends, in order.
    Result<const NodeValue*> given = e.inspect("tree", "ends");
    REQUIRE(given);
    const std::vector<glm::vec3> ends = *e.positions(std::get<Geometry>(*given.value()).front());
    REQUIRE(ends.size() == 243);
    for (size_t i = 0; i < ends.size(); ++i) {
        const TreeJoint& last = wanted[wanted.size() - ends.size() + i];
        CHECK(glm::length(glm::dvec3(ends[i]) - (last.at + last.along * last.span)) < 1e-5);
    }
}

TEST_CASE("what stands on a joint is as long as it, behind a filter too") {
    NodeEvaluation e = evaluationOf(kTree);
    const std::vector<TreeJoint> wanted = treeOf(6, 3, 1.5, 0.8f, 0.6f, 0.4f, 9);
    // A bar of height 2 about its middle reaches from one length before a joint's beginning to one behind it.
    const auto reaches = [&](const char* node, const std::vector<TreeJoint>& joints) {
        const GeometryPart bars = geometryOf(e, node).front();
        REQUIRE(bars.instances() == joints.size());
        const DeformOp op = bars.program.back();
        for (uint32_t i = 0; i < joints.size(); ++i) {
            const glm::dvec3 top(instanceStep(op, glm::vec3(0, 1, 0), i));
            CHECK(glm::length(top - (joints[i].at + joints[i].along * joints[i].span)) < 3e-4 * joints[i].span);
        }
    };
    reaches("bars", wanted);
    std::vector<TreeJoint> high;
    for (const TreeJoint& joint : wanted)
        if (joint.at.y >= 1) high.push_back(joint);
    REQUIRE(high.size() == 363);
    reaches("few", high);
}

TEST_CASE("more levels leave the joints that there are, and too many are refused") {
    NodeEvaluation e = evaluationOf(kTree);
    const std::vector<glm::vec3> before = *e.positions(geometryOf(e, "tree").front());
    REQUIRE(e.setInput("tree", "levels", Literal(8.0f)));
    REQUIRE(e.evaluate());
    const std::vector<glm::vec3> after = *e.positions(geometryOf(e, "tree").front());
    REQUIRE(after.size() == 3280);
    CHECK(std::equal(before.begin(), before.end(), after.begin()));
    REQUIRE(e.setInput("tree", "levels", Literal(16.0f)));
    REQUIRE(e.evaluate());
    REQUIRE(e.failures().size() == 1);
    CHECK(e.failures().front().message ==
          "21523360 joints are more than 4,000,000; make 'levels' or 'branches' smaller");
    CHECK(geometryOf(e, "bars").front().instances() == 3280);
    REQUIRE(e.setInput("tree", "branches", Literal(16.0f)));
    REQUIRE(e.evaluate());
    CHECK(e.failures().front().message.find("joints are more than 4,000,000") != std::string::npos);
    REQUIRE(e.setInput("tree", "branches", Literal(1.0f)));
    REQUIRE(e.evaluate());
    CHECK(geometryOf(e, "tree").front().elements == 16);
    CHECK(e.failures().empty());
}

TEST_CASE("joints have the same bits by scalar code, threads and kernels") {
    Result<std::unique_ptr<Device>> device = Device::create();
    REQUIRE(device);
    const auto by = [](std::unique_ptr<NodeMachine> machine) {
        NodeMachine* const made = machine.get();
        NodeEvaluation e = evaluationOf(kTree, std::move(machine));
        const GeometryPart tree = geometryOf(e, "tree").front();
        Result<std::vector<uint32_t>> sizes = readWords(*made, tree, tree.sizes);
        REQUIRE(sizes);
        const Geometry ends = std::get<Geometry>(**e.inspect("tree", "ends"));
        return std::tuple(*e.positions(tree), *e.normals(tree), *sizes, *e.positions(ends.front()),
                          *e.normals(ends.front()));
    };
    const auto plain = by(hostMachine(1, true));
    CHECK((by(hostMachine(1)) == plain));
    CHECK((by(hostMachine(4)) == plain));
    CHECK((by(deviceMachine(**device, true)) == plain));
    CHECK((by(deviceMachine(**device, false)) == plain));
}
