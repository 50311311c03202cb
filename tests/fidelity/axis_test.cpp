// How bark lies on what it grows on: growth on our own shapes, the sample ruin and real models, its curves measured
// against the triangles.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/fidelity/axis.hpp"
#include "tests/support/cube_model.hpp"
#include "tests/support/data.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/content/content.hpp"

using namespace espalier;
using namespace espalier::fidelitytest;

namespace {

// Least shares that are asked for: of samples within one radius, and within a radius or a texel; of nodes within one
// radius. The paper's grammar makes steps of up to 30 radii with bark a tenth of a texel thick.
constexpr double kWithin = .999, kNodes = .9995;

// Both grammars on a model.
void judge(const std::string& name, const Model& model, uint32_t maxNodes = 40'000) {
    BakeOptions options;
    Result<Baked> baked = bake(model, options);
    if (!baked) FAIL(baked.failure().text());
    const SignedDistance mesh(model.positions, model.indices);
    for (const char* grammar : {"ivy_free.grammar", "ivy_paper.grammar"}) {
        AxisCase c;
        c.grammar = grammar;
        c.maxNodes = maxNodes;
        CAPTURE(name);
        CAPTURE(c.grammar);
        c.seeds = c.grammar == "ivy_free.grammar" ? 10 : 40;
        const AxisFigures f = measureAxis(*baked, mesh, c);
        print(name, c, f);
        CHECK(f.spans > 1000);
        CHECK(f.nodesWithin >= kNodes);
        CHECK(f.within >= kWithin);
        CHECK(f.withinTexel >= kWithin);
        CHECK(f.worstBreak <= 1.0);
    }
}

void judgeFile(const std::string& name, const std::string& file) {
    Result<Model> model = importModel(file);
    if (!model) FAIL(model.failure().text());
    judge(name, *model);
}

// The ruin, made here without its textures' detail.
std::string ruinFile(const std::string& folder) {
    content::Options options;
    options.directory = folder;
    options.textureSize = 64;
    Status made = content::generate(options);
    if (!made) FAIL(made.failure().text());
    return folder + "/ruin.glb";
}

}  // namespace

TEST_CASE("the oracle's distances are those of a sphere and a cube") {
    const Model ball = test::ball(64), box = test::cube();
    const SignedDistance sphere(ball.positions, ball.indices), cube(box.positions, box.indices);
    for (glm::dvec3 p : {glm::dvec3(1.5, .2, -.3), glm::dvec3(.1, -.7, .4), glm::dvec3(.6, .6, .6)})
        CHECK(sphere.at(p) == doctest::Approx(glm::length(p) - 1).epsilon(2e-3));
    CHECK(cube.at({0, 0, .75}) == doctest::Approx(-.25));
    CHECK(cube.at({.2, 1.5, .1}) == doctest::Approx(.5));
    CHECK(cube.at({1.3, 1.4, 0}) == doctest::Approx(.5));          // beside an edge
    CHECK(cube.at({2, 2, 2}) == doctest::Approx(std::sqrt(3.0)));  // beside a corner
    CHECK(cube.at({.9, .95, .99}) == doctest::Approx(-.01));
}

TEST_CASE("bark on our own shapes") {
    printHeading();
    judge("cube", test::cube());
    judge("sphere", test::ball(48));
}

// With its charts turned the model comes to other atlases: creases lie otherwise between texels.
TEST_CASE("bark on the sample ruin, however its atlas lies") {
    const test::ScratchFolder folder;
    Result<Model> model = importModel(ruinFile(folder.path.string()));
    if (!model) FAIL(model.failure().text());
    if (model->materialUvs.empty()) model->materialUvs = model->uvs;
    const std::vector<glm::vec2> uvs = model->uvs;
    for (float angle : {0.f, .4f, .8f}) {
        const float c = std::cos(angle), s = std::sin(angle);
        for (size_t i = 0; i < uvs.size(); ++i)
            model->uvs[i] = {uvs[i].x * c - uvs[i].y * s, uvs[i].x * s + uvs[i].y * c};
        judge("ruin " + std::to_string(int(angle * 10)), *model, 20'000);
    }
}

TEST_CASE("bark on real models") {
    if (auto file = test::dataFile("models/polyhaven_concrete_cat_statue/concrete_cat_statue_1k.gltf"))
        judgeFile("cat statue", *file);
    if (auto file = test::dataFile("models/threedscans/Column03.glb")) judgeFile("column", *file);
    if (auto file = test::dataFile("derived/bunny_unwrap.glb")) judgeFile("bunny", *file);
}
