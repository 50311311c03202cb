// The importer: glTF's ways of storing triangles against one known mesh, and files damaged at random.
#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>

#include "runtime/core/file.hpp"
#include "shaders/shared/random.h"
#include "tests/bake/baking.hpp"
#include "tests/bake/small_models.hpp"
#include "tests/support/data.hpp"
#include "tools/bake/import_model.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

struct Folder {
    std::filesystem::path path;
    Folder() : path(std::filesystem::temp_directory_path() / ("espalier_import_" + std::to_string(long(this)))) {
        std::filesystem::create_directories(path);
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    std::string file(const std::string& name) const { return (path / name).string(); }
};

// A unit square of four vertices: positions (48 bytes), UVs as bytes of 16-bit numbers (16), indices (12).
std::vector<std::byte> squareBytes() {
    const float positions[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const uint16_t uvs[8] = {0, 0, 65535, 0, 65535, 65535, 0, 65535};
    const uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
    const uint16_t sparseAt[2] = {2, 0};
    const float sparse[3] = {1, 1, 5};
    const uint16_t strip[4] = {0, 1, 3, 2};
    std::vector<std::byte> out;
    auto add = [&](const auto& values) {
        auto bytes = std::as_bytes(std::span(values));
        out.insert(out.end(), bytes.begin(), bytes.end());
    };
    add(positions);  // 0
    add(uvs);        // 48
    add(indices);    // 64
    add(sparseAt);   // 76
    add(sparse);     // 80
    add(strip);      // 92
    return out;      // 100
}

struct Parts {
    std::string primitive = R"("attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2)";
    std::string node = R"("mesh":0)";
    std::string accessor0 = R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC3")";
    std::string view0 = R"("buffer":0,"byteOffset":0,"byteLength":48)";
    std::string more;
};

std::string squareText(const Parts& p) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{)" + p.node +
           R"(}],"meshes":[{"primitives":[{)" + p.primitive + R"(}]}],"buffers":[{"uri":"square.bin","byteLength":100}],
        "bufferViews":[{)" +
           p.view0 + R"(},{"buffer":0,"byteOffset":48,"byteLength":16},{"buffer":0,"byteOffset":64,"byteLength":12},
        {"buffer":0,"byteOffset":76,"byteLength":4},{"buffer":0,"byteOffset":80,"byteLength":12},{"buffer":0,"byteOffset":92,"byteLength":8}],
        "accessors":[{)" +
           p.accessor0 + R"(},{"bufferView":1,"componentType":5123,"normalized":true,"count":4,"type":"VEC2"},
        {"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"},{"bufferView":5,"componentType":5123,"count":4,"type":"SCALAR"}])" +
           p.more + "}";
}

Result<Model> importSquare(const Folder& folder, const Parts& parts, const ImportOptions& options = {}) {
    REQUIRE(writeFile(folder.file("square.bin"), squareBytes()));
    REQUIRE(writeFile(folder.file("square.gltf"), std::string_view(squareText(parts))));
    return importModel(folder.file("square.gltf"), options);
}

glm::vec3 normalOf(const Model& m, size_t t) {
    const uint32_t* v = &m.indices[t * 3];
    return glm::normalize(glm::cross(m.positions[v[1]] - m.positions[v[0]], m.positions[v[2]] - m.positions[v[0]]));
}

}  // namespace

TEST_CASE("lists, strips, fans, unindexed triangles, sparse and normalised accessors") {
    Folder folder;
    Parts parts;
    auto list = importSquare(folder, parts);
    if (!list) FAIL(list.failure().text());
    CHECK(list->indices == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
    CHECK(list->uvs[2] == glm::vec2(1, 1));
    CHECK(list->normals.empty());

    parts.primitive = R"("attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":3,"mode":5)";
    auto strip = importSquare(folder, parts);
    REQUIRE(strip);
    REQUIRE(strip->indices.size() == 6);
    for (size_t t = 0; t < 2; ++t) CHECK(normalOf(*strip, t).z == doctest::Approx(1));

    parts.primitive = R"("attributes":{"POSITION":0,"TEXCOORD_0":1},"mode":6)";
    auto fan = importSquare(folder, parts);
    REQUIRE(fan);
    REQUIRE(fan->indices.size() == 6);
    for (size_t t = 0; t < 2; ++t) CHECK(normalOf(*fan, t).z == doctest::Approx(1));

    parts = {};
    parts.accessor0 +=
        R"(,"sparse":{"count":1,"indices":{"bufferView":3,"componentType":5123},"values":{"bufferView":4}})";
    auto sparse = importSquare(folder, parts);
    if (!sparse) FAIL(sparse.failure().text());
    CHECK(sparse->positions[2] == glm::vec3(1, 1, 5));
    CHECK(sparse->positions[1] == glm::vec3(1, 0, 0));
}

TEST_CASE("transparent materials and those that are named are bare, but for what is said to be ground") {
    Folder folder;
    Parts parts;
    const std::string square = parts.primitive;
    parts.primitive.clear();
    for (int m = 0; m < 6; ++m) parts.primitive += (m ? "},{" : "") + square + ",\"material\":" + std::to_string(m);
    const std::string opaque = R"({"name":"Old Stone"})";
    const std::string others =
        R"({"name":"Pane","alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]}},
        {"name":"Bottle","extensions":{"KHR_materials_transmission":{"transmissionFactor":0.9}}},
        {"name":"Poster","alphaMode":"BLEND"},{"name":"Leaves","alphaMode":"MASK"},
        {"name":"Tile","extensions":{"KHR_materials_transmission":{}}})";
    parts.more = ",\"materials\":[" + opaque + "," + others + "]";
    const auto bareOf = [](const Model& model) {
        std::string out;
        for (const Material& m : model.materials) out += m.bare ? '1' : '0';
        return out;
    };
    auto model = importSquare(folder, parts);
    if (!model) FAIL(model.failure().text());
    CHECK(model->materialNames[0] == "Old Stone");
    CHECK(bareOf(*model) == "011000");
    CHECK(model->warnings.empty());

    ImportOptions options;
    options.bare = {"*STONE", "l?aves", "door*"};
    options.ground = {"bottle", "leaves"};
    auto named = importSquare(folder, parts, options);
    REQUIRE(named);
    CHECK(bareOf(*named) == "110000");
    REQUIRE(named->warnings.size() == 1);
    CHECK(toString(named->warnings[0]).find("square.gltf") != std::string::npos);
    CHECK(toString(named->warnings[0]).find("--bare 'door*' names none of its materials: Old Stone, Pane, Bottle") !=
          std::string::npos);

    // What is of glass throughout is something to grow on.
    parts.primitive = square + ",\"material\":1";
    auto glass = importSquare(folder, parts);
    REQUIRE(glass);
    CHECK(bareOf(*glass) == "000000");
}

TEST_CASE("nodes' transforms are applied; mirroring ones keep the outside outside") {
    Folder folder;
    Parts parts;
    parts.node = R"("mesh":0,"translation":[10,0,0],"rotation":[0,0.7071068,0,0.7071068],"scale":[2,1,1])";
    auto turned = importSquare(folder, parts);
    REQUIRE(turned);
    CHECK(glm::length(turned->positions[1] - glm::vec3(10, 0, -2)) < 1e-5f);
    parts.node = R"("mesh":0,"scale":[-1,1,1])";
    auto mirrored = importSquare(folder, parts);
    REQUIRE(mirrored);
    CHECK(normalOf(*mirrored, 0).z == doctest::Approx(1));
    CHECK(mirrored->positions[1].x == -1);
}

TEST_CASE("what a damaged document says is refused with the place") {
    Folder folder;
    auto refused = [&](Parts parts) {
        auto model = importSquare(folder, parts);
        std::string text = messageOf(model);
        CHECK(text.find("square.gltf") != std::string::npos);
        CAPTURE(text);
        CHECK(text != "imported");
        return text;
    };
    Parts parts;
    parts.view0 = R"("buffer":0,"byteOffset":90,"byteLength":48)";
    CHECK(refused(parts).find("bufferViews[0]") != std::string::npos);
    parts.view0 = R"("buffer":0,"byteOffset":18446744073709551600,"byteLength":48)";
    refused(parts);
    parts.view0 = R"("buffer":7,"byteLength":48)";
    refused(parts);
    parts = {};
    parts.accessor0 = R"("bufferView":0,"componentType":5126,"count":5,"type":"VEC3")";
    CHECK(refused(parts).find("accessors[0]") != std::string::npos);
    parts.accessor0 = R"("bufferView":0,"componentType":5126,"count":4294967295,"type":"VEC3")";
    refused(parts);
    parts.accessor0 =
        R"("bufferView":0,"byteOffset":18446744073709551612,"componentType":5126,"count":4,"type":"VEC3")";
    refused(parts);
    parts.accessor0 = R"("componentType":5126,"count":3,"type":"VEC3")";  // all zero, and too few for the indices
    refused(parts);
    parts = {};
    parts.node = R"("mesh":3)";
    refused(parts);
    parts.node = R"("mesh":0,"children":[0])";
    refused(parts);
    parts.node = R"("mesh":0,"scale":[1e308,1e308,1e308],"children":[])";
    auto huge = importSquare(folder, parts);
    CHECK((!huge || !bake(*huge, {})));
    parts = {};
    parts.more = R"(,"extensionsRequired":["EXT_unheard_of"])";
    CHECK(refused(parts).find("EXT_unheard_of") != std::string::npos);
    std::string deep = R"(,"extras":)";
    for (int i = 0; i < 100000; ++i) deep += '[';
    for (int i = 0; i < 100000; ++i) deep += ']';
    parts.more = deep;
    refused(parts);
}

TEST_CASE("a missing texture is a warning that names it, a missing buffer an error that names it") {
    Folder folder;
    Parts parts;
    parts.primitive += R"(,"material":0)";
    parts.more =
        R"(,"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1],"baseColorTexture":{"index":0}}}],
        "textures":[{"source":0}],"images":[{"uri":"gone.png"}])";
    auto model = importSquare(folder, parts);
    if (!model) FAIL(model.failure().text());
    REQUIRE(model->warnings.size() == 1);
    CHECK(model->warnings[0].message.find("gone.png") != std::string::npos);
    CHECK(model->materials[0].baseColorImage == -1);
    CHECK(model->materials[0].baseColor.r == 0.5f);
    std::filesystem::remove(folder.file("square.bin"));
    CHECK(messageOf(importModel(folder.file("square.gltf"))).find("square.bin") != std::string::npos);
    CHECK(!importModel(folder.file("nowhere.glb")));
    CHECK(!importModel(folder.path.string()));
}

TEST_CASE("a baked surface is itself a model that can be imported") {
    Folder folder;
    Model model = cubeCross(4);
    BakeOptions options;
    options.resolution = 64;
    auto baked = bake(model, options);
    REQUIRE(baked);
    REQUIRE(writeSurface(baked->surface, folder.file("cube.glb")));
    auto again = importModel(folder.file("cube.glb"));
    if (!again) FAIL(again.failure().text());
    CHECK(again->indices.size() == model.indices.size());
    auto twice = bake(*again, options);
    if (!twice) FAIL(twice.failure().text());
    CHECK(twice->report.charts == 1);
    CHECK(twice->report.seamCrossings == baked->report.seamCrossings);
}

TEST_CASE("files damaged at random never crash the importer") {
    Folder folder;
    BakeOptions options;
    options.resolution = 64;
    auto baked = bake(cube(2), options);
    REQUIRE(baked);
    REQUIRE(writeSurface(baked->surface, folder.file("own.glb")));
    std::vector<std::string> files = {folder.file("own.glb")};
    for (const char* name :
         {"derived/hermes_draco.glb", "derived/hermes_gltfpack_cc.glb", "models/gltf_transform/BoxMeshopt.gltf",
          "models/quaternius/1Story_GableRoof_Mat.glb", "models/kaykit_dungeon/pillar.glb",
          "reports/gltf_skin_root.glb", "reports/gltf_webp_required.glb", "reports/gltf_draco_norm_uv.glb",
          "reports/gltf_specgloss_texture.glb", "reports/gltf_sparse_indices.glb"})
        if (auto path = dataFile(name)) files.push_back(*path);
    uint64_t state = 99;
    size_t refused = 0, total = 0;
    files.push_back("tests/fuzz/corpus/gltf/rigged.gltf");
    for (const std::string& file : files) {
        auto bytes = readFile(file);
        REQUIRE(bytes);
        std::string ending = std::filesystem::path(file).extension().string();
        for (int i = 0; i < 60; ++i) {
            std::vector<std::byte> damaged = *bytes;
            // One to eight flips, half of them near the front, where structure is.
            state = mix64(state + 1);
            for (uint64_t k = 0; k <= (state & 7u); ++k) {
                uint64_t r = mix64(state + k * 77);
                size_t range = r & 1u ? std::min<size_t>(damaged.size(), 4000) : damaged.size();
                damaged[(r >> 8) % range] ^= std::byte(1u << ((r >> 1) & 7u));
            }
            if (i % 10 == 0) damaged.resize(damaged.size() * size_t(i + 5) / 70);
            REQUIRE(writeFile(folder.file("damaged" + ending), damaged));
            auto model = importModel(folder.file("damaged" + ending));
            ++total;
            if (!model) {
                ++refused;
                CHECK(!model.failure().diagnostics.front().message.empty());
            } else if (i % 4 == 0) {
                (void)bake(*model, options);
            }
        }
    }
    CHECK(refused > total / 10);
}
