// Files that users have sent, of OBJ, PLY and other kinds: each with its right value.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/bake/gltf_maker.hpp"
#include "tests/bake/model_folder.hpp"
#include "tests/support/data.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

std::optional<Model> reported(const std::string& name) {
    const auto file = dataFile("reports/" + name);
    if (!file) return std::nullopt;
    CAPTURE(name);
    auto model = importModel(*file);
    if (!model) FAIL(model.failure().text());
    return std::move(*model);
}

Baked bakedOf(const Model& model) {
    return bakeOrFail(model, 128);
}

glm::vec3 sizeOf(const Model& model) {
    glm::vec3 low(1e30f), high(-1e30f);
    for (uint32_t i : model.indices) low = glm::min(low, model.positions[i]), high = glm::max(high, model.positions[i]);
    return high - low;
}

}  // namespace

TEST_CASE("reported: models in coordinates of a map") {
    if (const auto model = reported("obj_house_utm.obj")) {
        const glm::vec3 off = glm::abs(sizeOf(*model) - glm::vec3(10.25f, 3.2f, 9.35f));
        CHECK(std::max({off.x, off.y, off.z}) < 1e-3f);
        CHECK(bakedOf(*model).report.triangles == 36);
    }
    if (const auto model = reported("gltf_house_utm.glb")) {
        const BakeReport report = bakedOf(*model).report;
        CHECK(report.triangles == 20);
        CHECK(report.walkableArea == doctest::Approx(126.72).epsilon(1e-5));
    }
    for (const char* name : {"obj_stairs_local.obj", "obj_stairs_rd.obj", "obj_stairs_utm.obj"})
        if (const auto model = reported(name))
            CHECK(bakedOf(*model).report.walkableArea == doctest::Approx(16.584).epsilon(6e-4));
}

TEST_CASE("reported: polygons of more than a thousand corners") {
    if (const auto model = reported("obj_comb_1026.obj")) CHECK(triangleArea(*model) == doctest::Approx(56.30));
    if (const auto model = reported("obj_floor_L_1200.obj")) CHECK(triangleArea(*model) == doctest::Approx(64));
}

TEST_CASE("reported: blemishes are warnings") {
    struct Case {
        const char* name;
        size_t triangles;
        double area;
        size_t warnings;
    };
    for (const Case& c : {Case{"obj_nan_normal.obj", 12, 22, 1}, Case{"obj_nan_uv.obj", 12, 22, 1},
                          Case{"obj_normal_zero.obj", 12, 22, 1}, Case{"obj_face_of_one.obj", 12, 22, 1},
                          Case{"obj_cr.obj", 12, 22, 0}, Case{"obj_bom_vertex/box.obj", 12, 22, 0},
                          Case{"ply_nan.ply", 96, 3.026, 1}, Case{"ply_tristrips.ply", 32, 6.273, 0}})
        if (const auto model = reported(c.name)) {
            CAPTURE(c.name);
            CHECK(model->warnings.size() == c.warnings);
            const Baked baked = bakedOf(*model);
            CHECK(baked.report.triangles == c.triangles);
            CHECK(baked.report.walkableArea == doctest::Approx(c.area).epsilon(1e-3));
        }
}

TEST_CASE("reported: names of materials, libraries and pictures") {
    for (const char* name : {"obj_bom/box.obj", "obj_quotes/box.obj", "obj_two_libs/box.obj"})
        if (const auto model = reported(name)) {
            CAPTURE(name);
            CHECK(model->warnings.empty());
            const uint32_t brick = model->triangleMaterial.at(0);
            CHECK(model->materialNames.at(brick) == "brick");
            CHECK(model->materials.at(brick).baseColor == glm::vec4(0.8f, 0.05f, 0.03f, 1));
            CHECK((model->materials.at(brick).baseColorImage >= 0) == (std::string(name) == "obj_quotes/box.obj"));
        }
    if (const auto model = reported("obj_hash/box.obj")) {
        const auto materials = bakedOf(*model).report.materials;
        REQUIRE(materials.size() == 3);
        CHECK(materials[1].name == "Material #1");
        CHECK(materials[1].area == doctest::Approx(8));
        CHECK(model->materials[1].baseColor.r > model->materials[1].baseColor.b);
        CHECK(materials[2].name == "Material #2");
        CHECK(materials[2].area == doctest::Approx(14));
        CHECK(model->materials[2].baseColor.b > model->materials[2].baseColor.r);
    }
    if (const auto model = reported("obj_scale/box.obj")) {
        glm::vec2 low(1e9f), high(-1e9f);
        for (const DrawVertex& v : bakedOf(*model).surface.vertices)
            low = glm::min(low, v.uv), high = glm::max(high, v.uv);
        CHECK(high - low == glm::vec2(4, 3));
    }
}

TEST_CASE("reported: colours of vertices") {
    if (const auto model = reported("gltf_colour_float.glb")) CHECK(bakedOf(*model).surface.materials.at(0).coloured);
    if (const auto model = reported("ply_colours.ply"))
        for (const DrawVertex& v : bakedOf(*model).surface.vertices) {
            const glm::vec4 colour = unpackColour(v.colour);
            CHECK((colour.r > colour.g) == (v.position.y > 1.5f));
            CHECK(std::max(colour.r, colour.g) > 0.5f);
        }
}

TEST_CASE("reported: a file of another kind is named") {
    if (const auto file = dataFile("reports/fbx_named_glb.glb"))
        CHECK(messageOf(importModel(*file)).find("FBX") != std::string::npos);
}
