// Colours of vertices: kept in the surface's file, in all its meshes, and by simpler meshes as far as they are seen.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "runtime/core/file.hpp"
#include "tests/bake/baking.hpp"
#include "tests/bake/small_models.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// A cube whose upper half is red and whose lower is blue, sharply.
Model twoColours(int n) {
    Model model = cube(n);
    model.colours.resize(model.positions.size());
    for (size_t v = 0; v < model.positions.size(); ++v)
        model.colours[v] = model.positions[v].y > 0 ? glm::vec4(0.8f, 0.1f, 0, 1) : glm::vec4(0, 0.1f, 0.8f, 0.5f);
    return model;
}

glm::vec4 colourOf(const DrawVertex& v) {
    return unpackColour(v.colour);
}

bool close(glm::vec4 a, glm::vec4 b) {
    const glm::vec4 off = glm::abs(a - b);
    return std::max({off.x, off.y, off.z, off.w}) < 1 / 4000.0f;
}

}  // namespace

TEST_CASE("vertex colours are kept in the file as COLOR_0, by all of its meshes") {
    ScratchFolder folder;
    const Baked baked = bakeOrFail(twoColours(16), 64);
    CHECK(baked.surface.materials[0].coloured);
    REQUIRE(!baked.surface.coarser.empty());
    REQUIRE(writeSurface(baked.surface, folder.file("a.glb")));
    auto surface = readSurface(folder.file("a.glb"));
    if (!surface) FAIL(surface.failure().text());
    CHECK(surface->materials[0].coloured);
    const auto check = [](const std::vector<DrawVertex>& vertices) {
        size_t red = 0, blue = 0;
        for (const DrawVertex& v : vertices) {
            const bool isRed = close(colourOf(v), {0.8f, 0.1f, 0, 1}),
                       isBlue = close(colourOf(v), {0, 0.1f, 0.8f, 0.5f});
            CHECK(isRed != isBlue);
            if (std::abs(v.position.y) > 0.2f) CHECK(isRed == (v.position.y > 0));
            red += isRed, blue += isBlue;
        }
        CHECK(red > 3);
        CHECK(blue > 3);
    };
    check(surface->vertices);
    for (const CoarserMesh& mesh : surface->coarser) check(mesh.vertices);
}

TEST_CASE("a model without colours has none in its file") {
    ScratchFolder folder;
    Model model = cube(4);
    const Baked plain = bakeOrFail(model, 64);
    REQUIRE(writeSurface(plain.surface, folder.file("plain.glb")));
    model.colours.assign(model.positions.size(), glm::vec4(1));
    REQUIRE(writeSurface(bakeOrFail(model, 64).surface, folder.file("white.glb")));
    auto a = readFile(folder.file("plain.glb")), b = readFile(folder.file("white.glb"));
    REQUIRE(a);
    REQUIRE(b);
    CHECK(*a == *b);
    CHECK(readTextFile(folder.file("plain.glb"))->find("COLOR_0") == std::string::npos);
    CHECK(!plain.surface.materials[0].coloured);
}

TEST_CASE("a simpler mesh counts the colours that it loses as error") {
    // A flat chequerboard: without colours two triangles would do.
    const auto board = [](bool coloured) {
        Model model;
        model.name = "board";
        const auto place = [](float s, float t) { return glm::vec3(s, 0, -t); };
        const auto uv = [](float s, float t) { return glm::vec2(s, t); };
        addPatch(model, 64, place, uv);
        for (size_t v = 0; coloured && v < model.positions.size(); ++v)
            model.colours.push_back(v % 2 ? glm::vec4(1) : glm::vec4(0, 0, 0, 1));
        return bakeOrFail(model, 64).surface;
    };
    const SurfaceData plain = board(false), coloured = board(true);
    REQUIRE(!plain.coarser.empty());
    CHECK(plain.coarser[0].error < 1e-4f);
    for (const CoarserMesh& mesh : coloured.coarser) CHECK(mesh.error > 0.01f);
}
