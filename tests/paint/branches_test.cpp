// Branches that are picked, cut away, and asked why they go no further.
#include <algorithm>
#include <cmath>

#include "plugin_api/espalier.hpp"
#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// The path of a branch, asked for twice as hosts do.
std::vector<EspPathSample> pathOf(const Painting& painting, uint64_t branch) {
    uint32_t count = 0;
    painting.ok(espBranchPath(painting.context, branch, nullptr, &count));
    std::vector<EspPathSample> path(count);
    painting.ok(espBranchPath(painting.context, branch, path.data(), &count));
    REQUIRE(count == path.size());
    return path;
}

EspPlantInfo plantOf(const Painting& painting, EspSeed seed) {
    EspPlantInfo info{};
    (void)painting.grown();
    painting.ok(espPlantInfo(painting.context, seed, &info));
    return info;
}

}  // namespace

TEST_CASE("a branch is picked where it grew, its path leads along it") {
    Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    const EspSeed seed = painting.plant(grammar, kFoot, kUp);
    const EspStats whole = painting.grown();
    // Straight at the foot: one of the two stems that begin there.
    EspPlantHit hit{};
    REQUIRE(pick(painting, {4, -.7f, 0}, {1, -.7f, 0}, &hit) == ESP_OK);
    CHECK(hit.seed.id == seed.id);
    CHECK(hit.depth <= 1);
    CHECK(hit.distance == doctest::Approx(3).epsilon(.02));
    CHECK(hit.position[0] == doctest::Approx(1).epsilon(.02));
    // From behind the cube hides it, and beside it is nothing.
    EspPlantHit none{};
    CHECK(pick(painting, {-4, -.7f, 0}, {1, -.7f, 0}, &none) == ESP_INVALID_ARGUMENT);
    CHECK(pick(painting, {4, .3f, -.95f}, {1, .3f, -.95f}, &none) == ESP_INVALID_ARGUMENT);

    const std::vector<EspPathSample> path = pathOf(painting, hit.branch);
    REQUIRE(path.size() > 5);
    float nearest = 9, length = 0;
    uint32_t crossings = 0;
    for (size_t i = 0; i < path.size(); ++i) {
        const glm::vec3 p(path[i].position[0], path[i].position[1], path[i].position[2]);
        CHECK(path[i].surface.id == painting.surface.id);
        CHECK(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) == doctest::Approx(1).epsilon(.001));
        nearest = std::min(nearest, glm::distance(p, glm::vec3(hit.position[0], hit.position[1], hit.position[2])));
        if (i == 0) continue;
        const glm::vec3 q(path[i - 1].position[0], path[i - 1].position[1], path[i - 1].position[2]);
        length += glm::distance(p, q);
        CHECK(glm::distance(p, q) < .06f);
        if (path[i].chart != path[i - 1].chart) ++crossings;
    }
    CHECK(nearest < .05f);
    CHECK(length > 1.3f);   // two metres, or seven tenths of that
    CHECK(crossings >= 1);  // the face is 1.8 m high above the foot
    // From a side branch to the seed's own, each leaves from its parent's way.
    EspPlantHit side{};
    for (float y = -.7f; y < 1 && side.depth < 1; y += .02f)
        for (float z = -.5f; z < .5f && side.depth < 1; z += .02f) (void)pick(painting, {4, y, z}, {1, y, z}, &side);
    REQUIRE(side.depth >= 1);
    uint64_t branch = side.branch;
    for (uint32_t depth = side.depth;; --depth) {
        EspBranchInfo info{};
        painting.ok(espBranchInfo(painting.context, branch, &info));
        CHECK(info.seed.id == seed.id);
        REQUIRE(info.depth == depth);
        CHECK((info.parent == branch) == (depth == 0));
        if (depth == 0) break;
        const EspPathSample foot = pathOf(painting, branch).front();
        CHECK(std::ranges::any_of(pathOf(painting, info.parent), [&](const EspPathSample& sample) {
            return std::equal(foot.position, foot.position + 3, sample.position);
        }));
        branch = info.parent;
    }
    EspBranchInfo info{};
    CHECK(espBranchInfo(painting.context, 12345, &info) == ESP_INVALID_ARGUMENT);
    CHECK(espBranchInfo(painting.context, branch, nullptr) == ESP_INVALID_ARGUMENT);
    uint32_t count = 0;
    CHECK(espBranchPath(painting.context, 12345, nullptr, &count) == ESP_INVALID_ARGUMENT);
    EspPlantInfo plant{};
    painting.ok(espPlantInfo(painting.context, seed, &plant));
    CHECK(plant.nodes == whole.nodes);
    for (const EspPathSample& sample : pathOf(painting, hit.branch))
        for (int i = 0; i < 3; ++i) {
            CHECK(sample.position[i] >= plant.boundsMin[i]);
            CHECK(sample.position[i] <= plant.boundsMax[i]);
        }
    CHECK(espPlantInfo(painting.context, seed, nullptr) == ESP_INVALID_ARGUMENT);
    CHECK(espPlantInfo(painting.context, {seed.id + 1}, &plant) == ESP_INVALID_ARGUMENT);
}

TEST_CASE("a pruned branch stays cut whatever changes, and grows back as it was") {
    Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    painting.plant(grammar, kFoot, kUp);
    const EspStats whole = painting.grown();
    EspPlantHit hit{};
    REQUIRE(pick(painting, {4, -.7f, 0}, {1, -.7f, 0}, &hit) == ESP_OK);
    painting.ok(espPruneBranch(painting.context, hit.branch, 1));
    painting.ok(espPruneBranch(painting.context, hit.branch, 1));
    CHECK(espPrunedCount(painting.context) == 1);
    uint64_t key = 0;
    painting.ok(espPrunedAt(painting.context, 0, &key));
    CHECK(key == hit.branch);
    CHECK(espPrunedAt(painting.context, 1, &key) == ESP_INVALID_ARGUMENT);
    const EspStats cut = painting.grown();
    CHECK(cut.nodes < whole.nodes);
    uint32_t count = 0;
    CHECK(espBranchPath(painting.context, hit.branch, nullptr, &count) == ESP_INVALID_ARGUMENT);
    EspGrammarDef def = esp::grammarDef("again", kMaskedIvy);
    painting.ok(espRecompileGrammar(painting.context, grammar, &def));
    CHECK(painting.grown().hash == cut.hash);
    EspGrowDef grow = esp::defaults<EspGrowDef>();
    grow.maxDepth = 100;  // all anew
    painting.ok(espSetGrow(painting.context, &grow));
    CHECK(painting.grown().hash == cut.hash);
    painting.ok(espPruneBranch(painting.context, hit.branch, 0));
    CHECK(espPrunedCount(painting.context) == 0);
    CHECK(painting.grown().hash == whole.hash);
}

TEST_CASE("a branch tells why it goes no further: its rules, its condition, the end of the ground, a limit") {
    Painting painting(openQuad(4));
    const EspGrammar grammar = painting.grammar(
        "context mask = 1\nparam stride = 0.05 [0.01 .. 2]\nparam most = 5 [1 .. 1000]\n"
        "Stem : step >= most -> NULL\n"
        "Stem -> Marching(stride, 0, mask(texCoord) > 0.5) {Stem, Wood}\n"
        "Wood -> S(0.01) Shape(\"bark\", C1)\n");
    const EspSeed seed = painting.plant(grammar, {.5f, .05f, 0}, kUp);
    const auto plant = [&] { return plantOf(painting, seed); };
    const auto limit = [&](uint32_t nodes, uint32_t depth) {
        EspGrowDef grow = esp::defaults<EspGrowDef>();
        grow.maxNodes = nodes;
        grow.maxDepth = depth;
        painting.ok(espSetGrow(painting.context, &grow));
    };
    const auto set = [&](const char* name, float value) {
        painting.ok(espSetParam(painting.context, grammar, name, &value, 1));
    };
    CHECK(plant().end == ESP_END_BY_RULES);
    // No step of this length leads anywhere within the square but the first.
    set("stride", .9f);
    CHECK(plant().end == ESP_END_NO_GROUND);
    CHECK(plant().nodes == 2);
    EspPlantHit hit{};
    painting.ok(pick(painting, {.5f, .5f, 2}, {.5f, .5f, 0}, &hit));
    EspBranchInfo info{};
    painting.ok(espBranchInfo(painting.context, hit.branch, &info));
    CHECK(info.end == ESP_END_NO_GROUND);
    painting.ok(espFreezePlant(painting.context, seed, 1));
    EspStroke emptied{};
    painting.ok(espFillLayer(painting.context, "mask", 0, &emptied));
    CHECK(plant().end == ESP_END_NO_GROUND);  // as it was frozen
    painting.ok(espFreezePlant(painting.context, seed, 0));
    CHECK(plant().end == ESP_END_REFUSED);
    CHECK(plant().nodes == 1);
    painting.ok(espFillLayer(painting.context, "mask", 1, &emptied));
    // A limit that leaves nothing of it, and one that ends it in the middle, after more nodes than a chunk has.
    limit(1, 1000);
    CHECK(plant().end == ESP_END_BY_LIMIT);
    CHECK(plant().nodes == 0);
    set("stride", .01f);
    set("most", 80);
    limit(1000, 2);
    CHECK(plant().end == ESP_END_BY_LIMIT);
    CHECK(plant().nodes > 32);
    CHECK(plant().nodes < 80);
    limit(1000, 1000);
    CHECK(plant().end == ESP_END_BY_RULES);
    CHECK(plant().nodes == 81);
    painting.ok(espPruneBranch(painting.context, hit.branch, 1));
    CHECK(plant().end == ESP_END_BY_RULES);
    CHECK(plant().nodes == 0);
}

TEST_CASE("where no ground is ahead a branch says so, though a condition has turned it aside before") {
    Painting painting(openQuad(4));
    // Aside at once, since what is straight ahead isn't painted; then a step that is longer than the way to any border.
    const EspGrammar grammar = painting.grammar(
        "context mask = 1\n"
        "Stem : step < 1 -> Marching(0.1, 0, mask(texCoord) > 0.5) {Stem, Wood}\n"
        "Stem : step < 2 -> Marching(0.9, 0, true) {Stem, Wood}\n"
        "Wood -> S(0.01) Shape(\"bark\", C1)\n");
    const EspSeed seed = painting.plant(grammar, {.5f, .5f, 0}, kUp);
    EspBrush erase = brushOn("mask", .04f, 1, 1);
    erase.value = 0;
    EspDab dab{};
    dab.position[0] = .5f, dab.position[1] = .6f, dab.normal[2] = 1, dab.pressure = 1;
    (void)painting.stroke(erase, {dab});
    const EspPlantInfo plant = plantOf(painting, seed);
    CHECK(plant.nodes == 2);
    CHECK(std::abs(plant.boundsMax[0] - plant.boundsMin[0]) > .02f);  // it went aside
    CHECK(plant.end == ESP_END_NO_GROUND);
}
