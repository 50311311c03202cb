// What is too thin for the resolution is named, and what stands apart isn't joined by it.
#include <doctest/doctest.h>

#include "tests/bake/baking.hpp"
#include "tests/bake/gltf_maker.hpp"
#include "tests/bake/kits.hpp"

using namespace espalier;
using namespace espalier::test;
using glm::dvec3;

namespace {

// A hall with a washing line of four sides, `wide` metres each, across it.
Model hallWithLine(double wide) {
    Kit kit;
    kit.box({0, 0, 0}, {5, 0.5, 5});
    const int line = kit.box({0, 2, 0}, {4, wide / 2, wide / 2});
    Model model = kit.model();
    model.uvs.clear();
    model.materials.resize(2);
    model.materialNames = {"stone", "rope"};
    for (int panel = 0; panel < kit.count(); ++panel)
        model.triangleMaterial.insert(model.triangleMaterial.end(), 2, panel >= line ? 1u : 0u);
    return model;
}

}  // namespace

TEST_CASE("threads are named with their material, their place and the resolution that they want") {
    const BakeReport report = bakeOrFail(hallWithLine(0.01), 256).report;
    REQUIRE(report.threads.size() == 1);
    const Thread& thread = report.threads[0];
    CHECK(thread.material == "rope");
    CHECK(thread.pieces == 1);
    CHECK(thread.texels < 4);
    CHECK(thread.area == doctest::Approx(8 * 0.04).epsilon(0.01));
    CHECK(glm::length(thread.at - glm::vec3(0, 2, 0)) < 1e-3f);
    CHECK(says(warningsOf(report.warnings), "1 thin piece of material 'rope'"));
    CHECK(says(report.json(), "\"threads\""));
    // Twice as wide wants half as much; wide enough wants nothing.
    const std::vector<Thread> twice = bakeOrFail(hallWithLine(0.02), 256).report.threads;
    REQUIRE(twice.size() == 1);
    CHECK(twice[0].texels > 1.5 * thread.texels);
    CHECK((thread.wants == 0 || twice[0].wants < thread.wants));
    CHECK(bakeOrFail(hallWithLine(1), 256).report.threads.empty());
    // What was asked for is enough.
    REQUIRE(twice[0].wants > 256);
    if (twice[0].wants <= 2048) CHECK(bakeOrFail(hallWithLine(0.02), twice[0].wants).report.threads.empty());
}

TEST_CASE("props that are seen apart aren't joined, and the report says from where on that is") {
    // Two crates of a metre on nothing, and a pole whose borders lie as far from those of another.
    const auto pieces = [](double gap, uint32_t resolution) {
        Kit kit;
        kit.box({-0.5 - gap / 2, 0, 0}, dvec3(0.5));
        kit.box({0.5 + gap / 2, 0, 0}, dvec3(0.5));
        kit.panel({-8, -3, 0}, {8 - gap / 2, 0, 0}, {0, 0.5, 0});
        kit.panel({gap / 2, -3, 0}, {8 - gap / 2, 0, 0}, {0, 0.5, 0});
        Model model = kit.model();
        model.uvs.clear();
        const BakeReport report = bakeOrFail(model, resolution).report;
        return std::pair(report.pieces.size(), report.touching);
    };
    for (uint32_t resolution : {128u, 512u, 2048u}) {
        CAPTURE(resolution);
        for (double gap : {0.001, 0.004, 0.0098, 0.0102, 0.02}) {
            CAPTURE(gap);
            const auto [count, touching] = pieces(gap, resolution);
            CHECK(touching <= 0.0100001);
            CHECK(count == (gap < touching ? 2 : 4));
        }
    }
    CHECK(pieces(0.5, 128).second == doctest::Approx(0.01));  // a texel would be a tenth of a metre
    CHECK(pieces(0.5, 2048).second < 0.0095);                 // here it is less
    // In other units a centimetre is something else.
    Kit kit;
    kit.box({0, 0, 0}, dvec3(600));
    const BakeReport report = bakeOrFail(kit.model(), 64).report;
    CHECK(report.touching == doctest::Approx(2));
    CHECK(says(report.json(), "\"touching_metres\""));
}
