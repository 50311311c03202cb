#pragma once

// Small glTF files made for a test: accessors are added from values, everything else is JSON.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "runtime/core/glb.hpp"
#include "tests/bake/baking.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/bake/import_model.hpp"

namespace espalier::test {

template <class T>
constexpr int componentTypeOf() {
    if constexpr (std::is_same_v<T, int8_t>) return 5120;
    if constexpr (std::is_same_v<T, uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, int16_t>) return 5122;
    if constexpr (std::is_same_v<T, uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, uint32_t>) return 5125;
    return 5126;
}

class GltfMaker {
  public:
    using Json = nlohmann::json;
    Json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0},
                 {"scenes", {{{"nodes", {0}}}}},  {"nodes", {{{"mesh", 0}}}},
                 {"accessors", Json::array()},    {"bufferViews", Json::array()}};

    int addView(std::span<const std::byte> bytes) {
        binary_.resize((binary_.size() + 3) / 4 * 4);
        root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}});
        binary_.insert(binary_.end(), bytes.begin(), bytes.end());
        return int(root["bufferViews"].size()) - 1;
    }
    template <class T>
    int addValues(const std::vector<T>& values) {
        return addView(std::as_bytes(std::span(values)));
    }

    // An accessor of these values; type: SCALAR, VEC3...
    template <class T>
    int add(const std::vector<T>& values, const char* type, bool normalized = false) {
        static const std::map<std::string, size_t> components = {
            {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
        Json accessor = {
            {"componentType", componentTypeOf<T>()}, {"count", values.size() / components.at(type)}, {"type", type}};
        if (!values.empty()) accessor["bufferView"] = addValues(values);
        if (normalized) accessor["normalized"] = true;
        return addAccessor(accessor);
    }
    int addAccessor(const Json& accessor) {
        root["accessors"].push_back(accessor);
        return int(root["accessors"].size()) - 1;
    }

    // The first mesh, of one primitive; placed by the first node.
    void setMesh(const Json& primitive) { root["meshes"] = {{{"primitives", {primitive}}}}; }
    Json& primitive() { return root["meshes"][0]["primitives"][0]; }

    // Writes it and imports it.
    Result<Model> import(const ImportOptions& options = {}) {
        root["buffers"] = {{{"byteLength", binary_.size()}}};
        const ScratchFolder folder;
        REQUIRE(writeGlb(folder.file("made.glb"), root.dump(), binary_));
        return importModel(folder.file("made.glb"), options);
    }
    Model importOrFail() {
        Result<Model> model = import();
        if (!model) FAIL(model.failure().text());
        return std::move(*model);
    }

  private:
    std::vector<std::byte> binary_;
};

// A unit square in the plane z = 0, facing +z.
inline const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
inline const std::vector<uint16_t> kSquareIndices = {0, 1, 2, 0, 2, 3};

inline GltfMaker squareMaker() {
    GltfMaker maker;
    const int positions = maker.add(kSquare, "VEC3"), indices = maker.add(kSquareIndices, "SCALAR");
    maker.setMesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    return maker;
}

inline std::string warningsOf(const std::vector<Diagnostic>& warnings) {
    std::string all;
    for (const Diagnostic& d : warnings) all += toString(d) + "\n";
    return all;
}

inline bool says(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

inline double triangleArea(const Model& m) {
    double sum = 0;
    for (size_t i = 0; i + 2 < m.indices.size(); i += 3)
        sum += double(glm::length(glm::cross(m.positions[m.indices[i + 1]] - m.positions[m.indices[i]],
                                             m.positions[m.indices[i + 2]] - m.positions[m.indices[i]]))) /
               2;
    return sum;
}

// The corners of the box around what triangles name.
inline std::pair<glm::vec3, glm::vec3> boundsOf(const Model& m) {
    glm::vec3 low(1e30f), high(-1e30f);
    for (uint32_t v : m.indices) low = glm::min(low, m.positions[v]), high = glm::max(high, m.positions[v]);
    return {low, high};
}

}  // namespace espalier::test
