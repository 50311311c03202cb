// Colours of vertices: kept in the surface's file, in all its meshes, and by simpler meshes as far as they are seen.
#include <doctest/doctest.h>

#include <cmath>
#include <span>

#include "runtime/core/glb.hpp"
#include "tests/bake/model_folder.hpp"
#include "tests/bake/small_models.hpp"

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
    ModelFolder folder;
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
    // The file is a glTF like any other, with its colours in Draco's data.
    auto again = importModel(folder.file("a.glb"));
    REQUIRE(again);
    REQUIRE(again->colours.size() == again->positions.size());
    for (size_t v = 0; v < again->colours.size(); ++v)
        CHECK(close(again->colours[v],
                    again->colours[v].r > 0.5f ? glm::vec4(0.8f, 0.1f, 0, 1) : glm::vec4(0, 0.1f, 0.8f, 0.5f)));
    for (const CoarserMesh& mesh : surface->coarser) check(mesh.vertices);
}

TEST_CASE("a model without colours has none in its file") {
    ModelFolder folder;
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

TEST_CASE("glTF: COLOR_0 of any kind is read as shares of one, linear") {
    ModelFolder folder;
    struct Case {
        int componentType;
        bool normalized;
        const char* type;
        std::string bytes;  // of one vertex
        glm::vec4 colour;
    };
    const auto floats = [](std::vector<float> values) {
        return std::string(reinterpret_cast<const char*>(values.data()), values.size() * 4);
    };
    for (const Case& c : {Case{5126, false, "VEC3", floats({0.25f, 0.5f, 1}), {0.25f, 0.5f, 1, 1}},
                          Case{5126, false, "VEC4", floats({0.25f, 0.5f, 1, 0.75f}), {0.25f, 0.5f, 1, 0.75f}},
                          Case{5121, true, "VEC4", "\xFF\x33\x33\x66", {1, 0.2f, 0.2f, 0.4f}},
                          Case{5123, true, "VEC4", "\xFF\xFF\x33\x33\x33\x33\x66\x66", {1, 0.2f, 0.2f, 0.4f}},
                          Case{5121, false, "VEC4", "\xFF\x33\x33\x66", {1, 0.2f, 0.2f, 0.4f}},  // as some write
                          Case{5126, false, "VEC3", floats({NAN, 0, 0}), {-1, -1, -1, -1}},
                          Case{5126, false, "VEC3", floats({1, 1, 1}), {-1, -1, -1, -1}}}) {
        CAPTURE(c.type);
        std::string binary = floats({0, 0, 0, 1, 0, 0, 1, 1, 0});
        for (int i = 0; i < 3; ++i) binary += c.bytes;
        const std::string text =
            R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"mesh":1}],)"
            R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]},)"
            R"({"primitives":[{"attributes":{"POSITION":0,"COLOR_0":1}}]}],"buffers":[{"byteLength":)" +
            std::to_string(binary.size()) +
            R"(}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,)"
            R"("byteLength":)" +
            std::to_string(binary.size() - 36) +
            R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"count":3,)"
            R"("componentType":)" +
            std::to_string(c.componentType) + R"(,"normalized":)" + (c.normalized ? "true" : "false") + R"(,"type":")" +
            c.type + R"("}]})";
        REQUIRE(writeGlb(folder.file("a.glb"), text, std::as_bytes(std::span(binary))));
        auto model = importModel(folder.file("a.glb"));
        if (!model) FAIL(model.failure().text());
        if (c.colour.r < 0) {
            CHECK(model->colours.empty());
            continue;
        }
        REQUIRE(model->colours.size() == 6);
        CHECK(model->colours[0] == glm::vec4(1));
        for (int k = 0; k < 4; ++k) CHECK(model->colours[5][k] == doctest::Approx(c.colour[k]));
    }
}
