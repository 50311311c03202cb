// espalier-export as a user runs it; its files as tinygltf, gltf-validator and assimp read them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/tools/program.hpp"
// It is read only, and none of its pictures.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace {

tinygltf::Model read(const std::string& file) {
    tinygltf::Model model;
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*,
                             int, void*) { return true; },
                          nullptr);
    std::string error, warning;
    REQUIRE_MESSAGE(reader.LoadBinaryFromFile(&model, &error, &warning, file), error);
    return model;
}

nlohmann::json objectsOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    uint32_t size = 0;
    REQUIRE(bytes.size() > 20);
    std::memcpy(&size, bytes.data() + 12, sizeof size);
    return nlohmann::json::parse(bytes.substr(20, size));
}

size_t trianglesOf(const tinygltf::Model& model, const tinygltf::Mesh& mesh) {
    size_t count = 0;
    for (const tinygltf::Primitive& p : mesh.primitives) count += model.accessors[size_t(p.indices)].count / 3;
    return count;
}

// Of all nodes of the scene, instances too.
size_t trianglesShown(const tinygltf::Model& model) {
    size_t count = 0;
    const std::function<void(int)> visit = [&](int index) {
        const tinygltf::Node& node = model.nodes[size_t(index)];
        size_t instances = 1;
        const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
        if (extension != node.extensions.end())
            instances =
                model.accessors[size_t(extension->second.Get("attributes").Get("TRANSLATION").GetNumberAsInt())].count;
        if (node.mesh >= 0) count += instances * trianglesOf(model, model.meshes[size_t(node.mesh)]);
        for (int child : node.children) visit(child);
    };
    for (int root : model.scenes.at(0).nodes) visit(root);
    return count;
}

// What the program has said of its file.
size_t trianglesSaid(const std::string& output) {
    const size_t at = output.rfind(".glb: ");
    return at == std::string::npos ? 0 : size_t(std::atoll(output.c_str() + at + 6));
}

std::string exported(const Folder& folder, const char* scene, const std::string& options, size_t& said) {
    const std::string file = folder.file("out.glb");
    const Ran ran = run(program("espalier-export") + " " + content(scene) + " " + options + " -o " + file);
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    said = trianglesSaid(ran.output);
    return file;
}

bool succeeds(const std::string& command) {
    return run(command).code == 0;
}

// Whether there is a validator; npm gets it the first time, where there is npm and what it asks.
bool validatorThere() {
    const std::string node = ESPALIER_NODE, there = "test -d " + node + "/node_modules/gltf-validator";
    return succeeds("command -v node && command -v npm") &&
           (succeeds(there) || (succeeds("timeout 120 npm install --no-fund --no-audit --prefix " + node +
                                         " gltf-validator@2.0.0-dev.3.10") &&
                                succeeds(there)));
}

}  // namespace

TEST_CASE("exported files show the triangles that they are said to, with shared meshes and materials") {
    const Folder folder;
    const struct {
        const char *scene, *options;
    } cases[] = {{"patterns.json", ""},
                 {"guided.json", "--only ivy"},
                 {"guided.json", "--only ivy --instancing --lods"},
                 {"hamlet.json", "--wind COLOR_0"}};
    for (const auto& c : cases) {
        CAPTURE(c.scene);
        CAPTURE(c.options);
        size_t said = 0;
        const tinygltf::Model model = read(exported(folder, c.scene, c.options, said));
        CHECK(said > 100'000);
        CHECK(trianglesShown(model) == said);
        CHECK(model.materials.size() >= 2);
        for (const tinygltf::Mesh& mesh : model.meshes) {
            CHECK(contains(mesh.name, "_LOD"));
            for (const tinygltf::Primitive& p : mesh.primitives) {
                CHECK(p.attributes.count("TEXCOORD_1") == 1);
                CHECK(p.material >= 0);
                const size_t vertices = model.accessors[size_t(p.attributes.at("POSITION"))].count;
                for (const auto& [name, accessor] : p.attributes)
                    CHECK(model.accessors[size_t(accessor)].count == vertices);
            }
        }
    }
}

TEST_CASE("collision meshes come besides, coarser and without materials") {
    const Folder folder;
    size_t said = 0, collision = 0;
    const tinygltf::Model model = read(exported(folder, "hamlet.json", "--collision", said));
    for (const tinygltf::Mesh& mesh : model.meshes)
        if (contains(mesh.name, "_collision")) {
            collision += trianglesOf(model, mesh);
            CHECK(mesh.primitives.front().material < 0);
        }
    CHECK(collision > 1000);
    CHECK(collision < said);
    CHECK(trianglesShown(model) == said + collision);
}

// tinygltf reads nothing that Draco has packed: so the objects alone.
TEST_CASE("surfaces come besides, with their materials and where they stand") {
    const Folder folder;
    size_t said = 0;
    const nlohmann::json before = objectsOf(exported(folder, "patterns.json", "", said));
    const nlohmann::json after = objectsOf(exported(folder, "patterns.json", "--surfaces", said));
    CHECK(after["materials"].size() == before["materials"].size() + 3);
    CHECK(after["meshes"].size() == before["meshes"].size() + 3);
    CHECK(after["extensionsUsed"] == nlohmann::json{"KHR_draco_mesh_compression"});
    const auto found = std::find_if(after["nodes"].begin(), after["nodes"].end(),
                                    [](const nlohmann::json& node) { return node.value("name", "") == "surfaces"; });
    REQUIRE(found != after["nodes"].end());
    CHECK(found->at("children").size() == 3);
    size_t moved = 0;
    for (const size_t child : found->at("children")) {
        const nlohmann::json& node = after["nodes"].at(child);
        moved += node.contains("translation") ? 1 : 0;
        const nlohmann::json& primitive = after["meshes"].at(node.at("mesh").get<size_t>())["primitives"][0];
        const size_t packed = primitive["extensions"]["KHR_draco_mesh_compression"]["bufferView"];
        CHECK(after["bufferViews"].at(packed)["byteLength"] > 1000);
    }
    CHECK(moved >= 2);
}

TEST_CASE("the validator finds no error") {
    if (!validatorThere()) {
        MESSAGE("skipped: there is no gltf-validator, which npm would get");
        return;
    }
    const Folder folder;
    for (const char* options : {"--only ivy --collision --surfaces", "--only ivy --instancing --lods --wind COLOR_0"}) {
        CAPTURE(options);
        size_t said = 0;
        const std::string file = exported(folder, "guided.json", options, said);
        const Ran ran = run(std::string("node ") + ESPALIER_VALIDATE + " " + ESPALIER_NODE + " " + file);
        CAPTURE(ran.output);
        CHECK(ran.code == 0);
        CHECK(contains(ran.output, "0 errors"));
        CHECK(ran.output.find("0 errors") == 0);
    }
}

TEST_CASE("assimp counts the same faces") {
    if (!succeeds("command -v assimp")) {
        MESSAGE("skipped: there is no assimp");
        return;
    }
    const Folder folder;
    size_t said = 0;
    const std::string file = exported(folder, "patterns.json", "", said);
    const tinygltf::Model model = read(file);
    size_t faces = 0;
    for (const tinygltf::Mesh& mesh : model.meshes) faces += trianglesOf(model, mesh);
    const Ran ran = run("assimp info " + file);
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    const size_t at = ran.output.find("\nFaces:");
    REQUIRE(at != std::string::npos);
    CHECK(size_t(std::atoll(ran.output.c_str() + at + 7)) == faces);
}

TEST_CASE("what can't be exported or written is told, and leaves what was there") {
    const Folder folder;
    const std::string file = folder.write("out.glb", "before");
    const auto tried = [&](const std::string& options, const std::string& out) {
        return run(program("espalier-export") + " " + content("patterns.json") + " " + options + " -o " + out);
    };
    const Ran nothing = tried("--only ivy", file);
    CHECK(nothing.code == 1);
    CHECK(contains(nothing.output, "patterns.json: nothing has grown"));
    const Ran full = tried("", "/dev/full");
    CHECK(full.code == 1);
    CHECK(contains(full.output, "/dev/full"));
    CHECK(contains(full.output, "No space left"));
    const Ran below = tried("", file + "/below.glb");
    CHECK(below.code == 1);
    CHECK(contains(below.output, "below.glb"));
    CHECK(tried("", content("patterns.json")).code == 2);
    CHECK(tried("--only trees", file).code == 2);
    std::ifstream in(file);
    std::string text((std::istreambuf_iterator<char>(in)), {});
    CHECK(text == "before");
}
