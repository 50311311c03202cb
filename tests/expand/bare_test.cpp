// Growth on a real house whose windows are bare, judged by the model's own triangles: no node lies on a pane.
#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "tests/expand/scene.hpp"
#include "tests/support/data.hpp"
#include "tools/bake/import_model.hpp"

using namespace espalier;
using namespace espalier::growthtest;

namespace {

const char* kTangle = R"(
param reach = 60 [0 .. 1000] "steps" "Steps"
Stem(n) -> Marching(0.04, rand(-0.4, 0.4), n < reach) {Fork(n + 1), Bark}
Fork(n) -> Branch(2) {Stem(n + 12), Stem(n)} : 0.1
Fork(n) -> Stem(n) : 0.9
Bark -> S(0.01) Shape("bark", C1)
)";

// After Ericson, Real-Time Collision Detection, 5.1.5.
double distanceTo(const Model& model, size_t t, glm::dvec3 p) {
    const auto at = [&](size_t k) { return glm::dvec3(model.positions[model.indices[3 * t + k]]); };
    const auto toEdge = [&](glm::dvec3 a, glm::dvec3 b) {
        const glm::dvec3 d = b - a;
        const double s = glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-300);
        return glm::length(p - (a + d * std::clamp(s, 0.0, 1.0)));
    };
    const glm::dvec3 a = at(0), b = at(1), c = at(2), n = glm::cross(b - a, c - a);
    const auto left = [&](glm::dvec3 from, glm::dvec3 to) { return glm::dot(glm::cross(to - from, p - from), n) >= 0; };
    if (glm::length(n) > 0 && left(a, b) && left(b, c) && left(c, a))
        return std::abs(glm::dot(p - a, n)) / glm::length(n);
    return std::min({toEdge(a, b), toEdge(b, c), toEdge(c, a)});
}

// How many nodes lie on triangles of a material, and farther than `within` from all others.
int nodesOn(const Model& model, uint32_t material, const std::vector<Node>& nodes, double within) {
    int count = 0;
    for (const Node& node : nodes) {
        double on = std::numeric_limits<double>::max(), beside = on;
        for (size_t t = 0; t < model.triangleMaterial.size(); ++t) {
            double& least = model.triangleMaterial[t] == material ? on : beside;
            least = std::min(least, distanceTo(model, t, glm::dvec3(node.position)));
        }
        count += on < beside && beside > within;
    }
    return count;
}

}  // namespace

TEST_CASE("no node lies on a window that is bare, some do where it isn't") {
    const auto path = test::dataFile("models/quaternius/House_1.glb");
    if (!path) return;
    int on[2] = {};
    size_t nodes[2] = {};
    for (bool bare : {false, true}) {
        ImportOptions options;
        if (bare) options.bare = {"windows"};
        Result<Model> model = importModel(*path, options);
        REQUIRE(model);
        const auto name = std::ranges::find(model->materialNames, "Windows");
        REQUIRE(name != model->materialNames.end());
        Scene scene = Scene::baked(*model, 1024);
        scene.addGrammar(kTangle);
        // Around all windows: the panes' corners and places a little aside.
        const uint32_t windows = uint32_t(name - model->materialNames.begin());
        for (size_t t = 0; t < model->triangleMaterial.size(); t += 3)
            if (model->triangleMaterial[t] == windows)
                scene.plant(model->positions[model->indices[3 * t]], {float(t % 5) - 2, 1, float(t % 3) - 1}, 0, t);
        Result<CpuGrowth> grown = scene.growOnCpu();
        if (!grown) FAIL(grown.failure().text());
        nodes[bare] = grown->nodes.size();
        on[bare] = nodesOn(*model, windows, grown->nodes, 0.002);
    }
    MESSAGE("of " << nodes[0] << " nodes " << on[0] << " on windows; of " << nodes[1] << " where these are bare "
                  << on[1]);
    CHECK(nodes[1] > 1000);
    CHECK(on[0] > 10);
    CHECK(on[1] == 0);
}
