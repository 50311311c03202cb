// Small glTF files that were reported, each with its right value (reports/README.tsv of the data folder).
#include <doctest/doctest.h>

#include "tests/bake/gltf_maker.hpp"
#include "tests/support/data.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

struct Row {
    const char* file;
    glm::vec3 low, high;
    double area;
    const char* warning;  // a part of it; empty: none
};

}  // namespace

TEST_CASE("reported glTF files have the right bounds, areas and warnings") {
    const glm::vec3 low(-1, 0, -0.5f), high(1, 3, 0.5f);
    const Row rows[] = {
        {"gltf_draco_norm_pos", low, high, 22, ""},
        {"gltf_draco_norm_uv", low, high, 22, ""},
        {"gltf_empty_primitive", low, high, 22, "no triangles"},
        {"gltf_hidden", low, high, 22, "hidden"},
        {"gltf_skin_root", {-0.5f, -0.5f, -0.5f}, {0.5f, 1.8f, 0.5f}, 5.52, ""},
        {"gltf_skin_rotated", {-0.5f, -0.5f, -0.5f}, {0.5f, 1.8f, 0.5f}, 5.52, ""},
        {"gltf_sparse_indices", {0, 0, 0}, {1, 1, 0}, 1, ""},
        {"gltf_specgloss_factor", low, high, 22, ""},
        {"gltf_specgloss_texture", low, high, 22, ""},
    };
    for (const Row& row : rows) {
        auto path = dataFile(std::string("reports/") + row.file + ".glb");
        if (!path) continue;
        CAPTURE(row.file);
        auto model = importModel(*path);
        if (!model) FAIL(model.failure().text());
        const auto [from, to] = boundsOf(*model);
        CHECK(glm::length(from - row.low) < 1e-4f);
        CHECK(glm::length(to - row.high) < 1e-4f);
        CHECK(triangleArea(*model) == doctest::Approx(row.area).epsilon(1e-4));
        CAPTURE(warningsOf(model->warnings));
        CHECK(model->warnings.empty() == (row.warning[0] == 0));
        CHECK(says(warningsOf(model->warnings), row.warning));
    }
}

TEST_CASE("reported glTF files have the right UVs, colours and textures") {
    const auto read = [](const char* name) {
        Result<Model> none = Failure("", "");
        auto path = dataFile(std::string("reports/") + name + ".glb");
        if (!path) return none;
        Result<Model> model = importModel(*path);
        if (!model) FAIL(model.failure().text());
        return model;
    };
    if (auto model = read("gltf_draco_norm_uv")) {
        glm::vec2 most(0);
        for (glm::vec2 uv : model->uvs) most = glm::max(most, uv);
        CHECK(most == glm::vec2(1));
    }
    if (auto model = read("gltf_specgloss_factor"))
        CHECK(model->materials[0].baseColor == glm::vec4(.8f, .05f, .02f, 1));
    if (auto model = read("gltf_specgloss_texture")) CHECK(model->materials[0].baseColorImage >= 0);
    if (auto model = read("gltf_webp_required"))
        CHECK((model->materials[0].baseColorImage >= 0 || says(warningsOf(model->warnings), "EXT_texture_webp")));
}
