// Where glTF's scenes, nodes and GPU instances put a triangle; expected places are worked out by hand.
#include <doctest/doctest.h>

#include <span>

#include "runtime/core/file.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/bake/import_model.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// One triangle, (0,0,0), (1,0,0), (0,1,0), and of two instances translations, turns and scales.
Result<Model> importTriangle(const std::string& body, int scene = -1) {
    const float s = 0.70710678f;
    const float numbers[] = {0, 0, 0, 1, 0, 0, 0, 1, 0,  // 0: the triangle
                             5, 0, 0, 0, 7, 0,           // 36: translations
                             0, 0, s, s, 0, 0, 0, 1,     // 60: a quarter turn about z, none
                             2, 3, 1, 1, 1, 4};          // 92: scales; 116 bytes
    ScratchFolder folder;
    REQUIRE(writeFile(folder.file("t.bin"), std::as_bytes(std::span(numbers))));
    std::string text = R"({"asset":{"version":"2.0"},"buffers":[{"uri":"t.bin","byteLength":116}],"bufferViews":[
        {"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
        {"buffer":0,"byteOffset":60,"byteLength":32},{"buffer":0,"byteOffset":92,"byteLength":24}],"accessors":[
        {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
        {"bufferView":1,"componentType":5126,"count":2,"type":"VEC3"},
        {"bufferView":2,"componentType":5126,"count":2,"type":"VEC4"},
        {"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"}],)" +
                       body + "}";
    REQUIRE(writeFile(folder.file("t.gltf"), std::string_view(text)));
    ImportOptions options;
    options.scene = scene;
    return importModel(folder.file("t.gltf"), options);
}

const std::string kMesh = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)";

void checkPositions(Result<Model> model, const std::vector<glm::vec3>& expected) {
    if (!model) FAIL(model.failure().text());
    REQUIRE(model->positions.size() == expected.size());
    for (size_t i = 0; i < expected.size(); ++i) {
        CAPTURE(i);
        CHECK(glm::length(model->positions[i] - expected[i]) < 1e-5f);
    }
}

}  // namespace

TEST_CASE("the scene asked for is read, else the file's default, else the first") {
    const std::string nodes = R"("nodes":[{"mesh":0,"translation":[10,0,0]},{"mesh":0,"translation":[0,0,20]}],
        "scenes":[{"nodes":[0]},{"nodes":[1]}])";
    const std::vector<glm::vec3> first = {{10, 0, 0}, {11, 0, 0}, {10, 1, 0}};
    const std::vector<glm::vec3> second = {{0, 0, 20}, {1, 0, 20}, {0, 1, 20}};
    checkPositions(importTriangle(kMesh + nodes), first);
    checkPositions(importTriangle(kMesh + nodes + R"(,"scene":1)"), second);
    checkPositions(importTriangle(kMesh + nodes + R"(,"scene":1)", 0), first);
    checkPositions(importTriangle(kMesh + nodes, 1), second);
    auto none = importTriangle(kMesh + nodes, 2);
    REQUIRE(!none);
    CHECK(none.failure().text().find("scene 2 does not exist: the file has 2") != std::string::npos);
}

TEST_CASE("GPU instances stand at their node's place times their own") {
    auto node = [](const std::string& attributes) {
        return kMesh + R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[0,0,-1],"scale":[2,2,2],
            "extensions":{"EXT_mesh_gpu_instancing":{"attributes":{)" +
               attributes + "}}}}]";
    };
    checkPositions(importTriangle(node(R"("TRANSLATION":1)")),
                   {{10, 0, -1}, {12, 0, -1}, {10, 2, -1}, {0, 14, -1}, {2, 14, -1}, {0, 16, -1}});
    // Scaled by (2, 3, 1), turned x to y and y to -x, moved by (5, 0, 0); then by the node.
    checkPositions(importTriangle(node(R"("TRANSLATION":1,"ROTATION":2,"SCALE":3)")),
                   {{10, 0, -1}, {10, 4, -1}, {4, 0, -1}, {0, 14, -1}, {2, 14, -1}, {0, 16, -1}});
    auto uneven = importTriangle(node(R"("TRANSLATION":0,"SCALE":3)"));
    REQUIRE(!uneven);
    CHECK(uneven.failure().text().find("SCALE has 2 instances of 3") != std::string::npos);
}
