#pragma once

// A scene that is edited, and the check that growing only what edits concern gives what growing everything anew gives:
// by the structure's hash of the CPU reference, which knows nothing of edits, and by all counts.

#include <doctest/doctest.h>

#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include "tests/expand/scene.hpp"

namespace espalier::growthtest {

// Stems that a mask leads, twigs of twigs; bark thins towards tips and so depends on where a branch ends; leaves read
// another layer than the rules do.
inline const char* const kGuided = R"(
context mask = 1
context cover = 1
param reach = 40 [0 .. 1000] "steps" "Steps"
param stride = 0.04 [0.01 .. 1] "m" "Step"
param leafSize = 0.04 [0.01 .. 1] "m" "Leaves"
param twigs = 0.3 [0 .. 1] "" "Twigs"
Stem(n) -> Marching(stride, rand(-0.3, 0.3), mask(texCoord) > 0.5 and n < reach) {Fork(n + 1), Cover}
Fork(n) -> Branch(2) {Twig(0, rand(0, 12)), Stem(n)} : 0.3
Fork(n) -> Stem(n) : 0.7
Twig(n, k) -> Marching(stride * 0.7, rand(-0.6, 0.6), mask(texCoord) > 0.5 and n < k) {Bud(n + 1, k), Cover}
Bud(n, k) : rand() < twigs -> Branch(2) {Tip(0), Twig(n, k)}
Bud(n, k) -> Twig(n, k)
Tip(n) -> Marching(0.02, rand(-1, 1), n < 3) {Tip(n + 1), Cover}
Cover -> Bark Leaves
Bark -> S(0.002 + 0.01 * clamp(toTip / 0.5, 0, 1)) Shape("bark", C1)
Leaves -> Repeat(floor(rand(0, 3) * cover(texCoord))) { T(rand(), 0.01) R(rand(-1, 1), 0.4) S(leafSize * rand(0.6, 1)) Shape("leaf") }
)";

inline const char* const kPlain = R"(
param reach = 25 [0 .. 1000] "steps" "Steps"
Stem(n) -> Marching(0.05, rand(-0.2, 0.2), n < reach) {Fork(n + 1), Bark}
Fork(n) -> Branch(2) {Twig(0), Stem(n)} : 0.2
Fork(n) -> Stem(n) : 0.8
Twig(n) -> Marching(0.03, rand(-0.5, 0.5), n < 6) {Twig(n + 1), Bark}
Bark -> S(0.01) Shape("bark", C1)
)";

// A scene that is edited, its growth, and notes of the edits since.
class Session {
  public:
    explicit Session(const Model& model, const GrowthRoom& room = {})
        : scene(Scene::baked(model)), growth(gpu.growth(room)) {
        changes.everything = false;
        scene.addGrammar(kGuided);
        scene.addGrammar(kPlain);
        for (auto& layer : layers) layer.assign(kSize * kSize, 1.0f);
    }
    ~Session() { growth.reset(); }

    // A round dab that is `value` inside; the texels that it touches are noted.
    void dab(uint32_t layer, glm::vec2 at, float radius, float value) {
        glm::ivec2 low = glm::max(glm::ivec2((at - radius) * float(kSize)), 0);
        glm::ivec2 high = glm::min(glm::ivec2((at + radius) * float(kSize)) + 1, int(kSize));
        for (int y = low.y; y < high.y; ++y)
            for (int x = low.x; x < high.x; ++x)
                if (glm::length((glm::vec2(x, y) + 0.5f) / float(kSize) - at) < radius)
                    layers[layer][size_t(y) * kSize + size_t(x)] = value;
        upload(layer);
        changes.markTexels(0, layer, kSize, uint32_t(low.x), uint32_t(low.y), uint32_t(high.x), uint32_t(high.y));
    }
    void set(uint32_t grammar, const char* name, float value) {
        RuleMap& map = scene.grammar(grammar);
        changes.markUses(grammar, map.setParam(*map.findParam(name), {&value, 1}));
    }
    // Another text of a grammar, its parameters as they stand.
    RuleChanges write(uint32_t grammar, const std::string& rules) {
        Result<RuleMap> map = compileGrammar(rules);
        REQUIRE_MESSAGE(map, (map ? "" : map.failure().text()));
        RuleMap& old = scene.grammar(grammar);
        for (const ParamInfo& param : old.params())
            if (const auto index = map->findParam(param.name)) map->setParam(*index, std::span(param.value, 1));
        const RuleChanges what = map->changesFrom(old);
        old = std::move(*map);
        changes.markUses(grammar, what.uses);
        if (what.all) changes.grammars.push_back(grammar);
        if (what.extrudes) changes.extrudes.push_back(grammar);
        return what;
    }
    // Writes `to` in place of `from` in the first grammar's text, which has it once.
    RuleChanges rewrite(const std::string& from, const std::string& to) {
        const size_t at = text.find(from);
        REQUIRE(at != std::string::npos);
        REQUIRE(text.find(from, at + 1) == std::string::npos);
        text.replace(at, from.size(), to);
        return write(0, text);
    }
    void upload(uint32_t layer) {
        scene.paint(layer, kSize, [&](glm::vec2 uv) {
            return layers[layer][size_t(uv.y * float(kSize)) * kSize + size_t(uv.x * float(kSize))];
        });
    }
    void grow() {
        scene.changes = &changes;
        Status grown = scene.grow(gpu.device(), *growth);
        if (!grown) FAIL(grown.failure().text());
        changes = {.everything = false, .cells = {}, .uses = {}, .grammars = {}};
    }
    void check() {
        grow();
        Result<CpuGrowth> whole = scene.growOnCpu();
        REQUIRE(whole);
        const GrowthStats s = growth->stats();
        const GrowthStats& w = whole->stats;
        CHECK(s.hash == w.hash);
        CHECK(s.nodes == w.nodes);
        CHECK(s.chunks == w.chunks);
        CHECK(s.branches == w.branches);
        CHECK(s.leaves == w.leaves);
        CHECK(s.steps == w.steps);
        CHECK(s.inserted == w.inserted);
        CHECK(s.deadEnds == w.deadEnds);
        CHECK(s.stopped == w.stopped);
        Result<GrowthRecords> records = growth->read();
        REQUIRE(records);
        CHECK(records->nodes.size() == w.nodes);
        CHECK(records->leaves.size() == w.leaves);
        const GrowthDifference difference = compareGrowth(*whole, *records);
        CHECK(difference.alike == difference.branches);
        for (const std::string& note : difference.notes) std::printf("  %s\n", note.c_str());
    }

    static constexpr uint32_t kSize = 256;
    TestDevice gpu;
    Scene scene;
    std::unique_ptr<Growth> growth;
    GrowthChanges changes;
    std::string text = kGuided;  // of the first grammar
    std::array<std::vector<float>, 2> layers;
};

}  // namespace espalier::growthtest
