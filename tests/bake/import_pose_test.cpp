// Skins and morph targets: how a mesh stands before any animation, and what is said of what can't be applied.
#include <doctest/doctest.h>

#include "tests/bake/gltf_maker.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// A square whose lower corners hang on one joint, its upper ones on another. Nodes: the mesh, both joints.
template <class Weight>
GltfMaker rigged(const std::vector<Weight>& weights, bool normalized) {
    GltfMaker maker = squareMaker();
    maker.primitive()["attributes"]["JOINTS_0"] =
        maker.add(std::vector<uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    maker.primitive()["attributes"]["WEIGHTS_0"] = maker.add(weights, "VEC4", normalized);
    maker.root["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {1000, 1000, 1000}}, {"scale", {7, 7, 7}}},
                           {{"name", "lower"}},
                           {{"name", "upper"}, {"translation", {0, 0, 4}}}};
    maker.root["scenes"] = {{{"nodes", {0, 1, 2}}}};
    maker.root["skins"] = {{{"joints", {1, 2}}}};
    return maker;
}

std::vector<float> wholeWeights() {
    return {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
}

glm::vec3 normalOf(const Model& m) {
    return glm::normalize(glm::cross(m.positions[m.indices[1]] - m.positions[m.indices[0]],
                                     m.positions[m.indices[2]] - m.positions[m.indices[0]]));
}

}  // namespace

TEST_CASE("joints carry a mesh, and its node's transform does nothing") {
    const Model floats = rigged(wholeWeights(), false).importOrFail();
    CHECK(floats.positions[0] == glm::vec3(0, 0, 0));
    CHECK(floats.positions[2] == glm::vec3(1, 1, 4));
    CHECK(floats.warnings.empty());
    // A quarter and three quarters, in every type of weights.
    const auto check = [](GltfMaker maker) {
        const Model model = maker.importOrFail();
        CHECK(model.positions[0].z == doctest::Approx(1).epsilon(0.01));
        CHECK(model.positions[2].z == doctest::Approx(3).epsilon(0.01));
    };
    check(rigged<float>({.75f, .25f, 0, 0, .75f, .25f, 0, 0, .75f, .25f, 0, 0, .75f, .25f, 0, 0}, false));
    check(rigged<uint8_t>({191, 64, 0, 0, 191, 64, 0, 0, 191, 64, 0, 0, 191, 64, 0, 0}, true));
    check(rigged<uint16_t>({49151, 16384, 0, 0, 49151, 16384, 0, 0, 49151, 16384, 0, 0, 49151, 16384, 0, 0}, true));
    // Weights that don't sum to one are shares.
    check(rigged<float>({3, 1, 0, 0, 3, 1, 0, 0, 3, 1, 0, 0, 3, 1, 0, 0}, false));
}

TEST_CASE("a second set of joints counts; a third is named") {
    GltfMaker maker = rigged<float>({.5f, 0, 0, 0, .5f, 0, 0, 0, .5f, 0, 0, 0, .5f, 0, 0, 0}, false);
    maker.primitive()["attributes"]["JOINTS_1"] =
        maker.add(std::vector<uint16_t>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    maker.primitive()["attributes"]["WEIGHTS_1"] =
        maker.add(std::vector<float>{.5f, 0, 0, 0, .5f, 0, 0, 0, .5f, 0, 0, 0, .5f, 0, 0, 0}, "VEC4");
    Model model = maker.importOrFail();
    CHECK(model.positions[0].z == doctest::Approx(2));
    CHECK(model.positions[2].z == doctest::Approx(4));
    CHECK(model.warnings.empty());
    maker.primitive()["attributes"]["JOINTS_2"] = maker.primitive()["attributes"]["JOINTS_1"];
    CHECK(says(warningsOf(maker.importOrFail().warnings), "JOINTS_0 and JOINTS_1"));
}

TEST_CASE("inverse bind matrices undo where joints were bound; parents of joints count") {
    GltfMaker maker = rigged(wholeWeights(), false);
    // Both were bound 4 m up, and now stand there; their parent halves all.
    std::vector<float> inverse(32, 0.0f);
    for (size_t j = 0; j < 2; ++j) {
        for (size_t k = 0; k < 4; ++k) inverse[j * 16 + k * 5] = 1;
        inverse[j * 16 + 14] = -4;
    }
    maker.root["skins"][0]["inverseBindMatrices"] = maker.add(inverse, "MAT4");
    maker.root["nodes"][1]["translation"] = {0, 0, 4};
    maker.root["nodes"].push_back({{"scale", {0.5, 0.5, 0.5}}, {"children", {1, 2}}});
    maker.root["scenes"] = {{{"nodes", {0, 3}}}};
    const Model model = maker.importOrFail();
    CHECK(model.positions[0] == glm::vec3(0));
    CHECK(model.positions[2] == glm::vec3(0.5f, 0.5f, 0));
}

TEST_CASE("joints that mirror keep the outside outside, and normals turn with joints") {
    GltfMaker maker = rigged(wholeWeights(), false);
    maker.primitive()["attributes"]["NORMAL"] =
        maker.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    maker.root["nodes"][1]["scale"] = {-1, 1, 1};
    maker.root["nodes"][2] = {{"scale", {-1, 1, 1}}};
    Model model = maker.importOrFail();
    CHECK(model.positions[1].x == -1);
    CHECK(normalOf(model).z == doctest::Approx(1));
    CHECK(model.normals[0].z == doctest::Approx(1));
    for (int joint : {1, 2}) maker.root["nodes"][size_t(joint)] = {{"rotation", {0, 0.70710678, 0, 0.70710678}}};
    model = maker.importOrFail();
    CHECK(normalOf(model).x == doctest::Approx(1));
    CHECK(model.normals[0].x == doctest::Approx(1));
}

TEST_CASE("a skin that can't be read is named, and its mesh stands where its node is") {
    GltfMaker maker = rigged(wholeWeights(), false);
    const auto sound = maker.root;
    const auto with = [&](auto&& change, const std::string& why) {
        maker.root = sound;
        change(maker.root);
        const Model model = maker.importOrFail();
        CHECK(model.positions[0] == glm::vec3(1000));
        CAPTURE(warningsOf(model.warnings));
        CHECK(says(warningsOf(model.warnings), why));
    };
    using Json = nlohmann::json;
    with([](Json& root) { root["skins"] = Json::array(); }, "skins[0] does not exist");
    with([](Json& root) { root["skins"] = {{{"joints", Json::array()}}}; }, "skins[0] has no joints");
    with([](Json& root) { root["skins"] = {{{"name", "lost"}}}; }, "skins[0] has no joints");
    with([](Json& root) { root["skins"] = {{{"joints", {1, 99}}}}; }, "joint node 99 does not exist");
    with([](Json& root) { root["skins"] = {{{"joints", {1, "two"}}}}; }, "joint node -1 does not exist");
    with([](Json& root) { root["skins"][0]["inverseBindMatrices"] = 0; }, "accessors[0]");
    with([](Json& root) { root["meshes"][0]["primitives"][0]["attributes"].erase("JOINTS_0"); }, "name no joints");
}

TEST_CASE("a mesh that two skins carry is read for each, whichever has fewer joints") {
    for (bool fewFirst : {false, true}) {
        CAPTURE(fewFirst);
        GltfMaker maker = rigged(wholeWeights(), false);
        const nlohmann::json few = {{"joints", {2}}}, all = {{"joints", {1, 2}}};
        maker.root["skins"] = {fewFirst ? few : all, fewFirst ? all : few};
        maker.root["nodes"].push_back({{"mesh", 0}, {"skin", 1}});
        maker.root["scenes"] = {{{"nodes", {0, 1, 2, 3}}}};
        const Model model = maker.importOrFail();
        REQUIRE(model.positions.size() == 8);
        // By both joints the upper corners are lifted; by the upper one alone all are, since the other isn't there.
        const size_t whole = fewFirst ? 4 : 0, part = 4 - whole;
        CHECK(model.positions[whole].z == 0);
        CHECK(model.positions[whole + 2].z == 4);
        CHECK(model.positions[part].z == 4);
        CHECK(model.positions[part + 2].z == 4);
        CHECK(says(warningsOf(model.warnings), "2 vertices have no usable weights"));
    }
}

TEST_CASE("vertices with joints or weights that make no sense are counted") {
    GltfMaker maker = rigged<float>({1, 0, 0, 0, 0, 0, 0, 0, -1, 2, 0, 0, 1, 0, 0, 0}, false);
    maker.root["skins"] = {{{"joints", {1}}}};  // the upper corners' joint 1 is gone
    const Model model = maker.importOrFail();
    CAPTURE(warningsOf(model.warnings));
    CHECK(says(warningsOf(model.warnings), "3 vertices have no usable weights"));
    CHECK(boundsOf(model).second == glm::vec3(1, 1, 0));
}

TEST_CASE("morph targets are added by the weights of the mesh, or of the node") {
    GltfMaker maker = squareMaker();
    maker.primitive()["attributes"]["NORMAL"] =
        maker.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int lift = maker.add(std::vector<float>{0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2}, "VEC3");
    const int lean = maker.add(std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
    // The second moves one corner, and says so sparsely.
    const int at = maker.addValues(std::vector<uint16_t>{3, 0}), by = maker.addValues(std::vector<float>{0, 8, 0});
    const int corner = maker.addAccessor({{"componentType", 5126},
                                          {"count", 4},
                                          {"type", "VEC3"},
                                          {"sparse",
                                           {{"count", 1},
                                            {"indices", {{"bufferView", at}, {"componentType", 5123}}},
                                            {"values", {{"bufferView", by}}}}}});
    maker.primitive()["targets"] = {{{"POSITION", lift}, {"NORMAL", lean}}, {{"POSITION", corner}}};
    CHECK(maker.importOrFail().positions[0].z == 0);

    maker.root["meshes"][0]["weights"] = {0.5, 0.25};
    Model model = maker.importOrFail();
    CHECK(model.positions[0] == glm::vec3(0, 0, 1));
    CHECK(model.positions[3] == glm::vec3(0, 3, 1));
    CHECK(glm::length(model.normals[0] - glm::normalize(glm::vec3(0.5f, 0, 1))) < 1e-6f);

    // Two nodes of one mesh, each with weights of its own.
    maker.root["nodes"] = {{{"mesh", 0}, {"weights", {0, 0}}}, {{"mesh", 0}, {"weights", {2, 0}}}};
    maker.root["scenes"] = {{{"nodes", {0, 1}}}};
    model = maker.importOrFail();
    REQUIRE(model.positions.size() == 8);
    CHECK(model.positions[0].z == 0);
    CHECK(model.positions[4].z == 4);

    maker.root["nodes"] = {{{"mesh", 0}}};
    maker.root["scenes"] = {{{"nodes", {0}}}};
    maker.primitive()["targets"][0]["POSITION"] = maker.add(std::vector<float>{0, 0, 2}, "VEC3");
    model = maker.importOrFail();
    CHECK(model.positions[0].z == 0);
    CHECK(says(warningsOf(model.warnings), "morph targets are not applied"));
}
