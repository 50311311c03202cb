// The reader of terminal meshes against whole, truncated and damaged files.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>

#include "runtime/core/glb.hpp"
#include "runtime/emit/terminals.hpp"

using namespace espalier;

namespace {

// bark_lod0 and leaf_lod0, both one triangle.
std::vector<std::byte> smallFile() {
    const float vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    const uint16_t indices[] = {0, 1, 2, 0};
    std::string text = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":80}],"bufferViews":[
        {"buffer":0,"byteOffset":0,"byteLength":72},{"buffer":0,"byteOffset":72,"byteLength":8}],"accessors":[
        {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
        {"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"},
        {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],"meshes":[
        {"name":"bark_lod0","primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2}]},
        {"name":"leaf_lod0","primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2}]}]})";
    std::array<std::byte, 80> binary{};
    std::memcpy(binary.data(), vertices, 72);
    std::memcpy(binary.data() + 72, indices, 8);
    return glbContainer(text, binary);
}

Result<TerminalData> readBytes(const std::vector<std::byte>& bytes) {
    const std::filesystem::path path = std::filesystem::temp_directory_path() / "espalier_terminals_test.glb";
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    Result<TerminalData> data = readTerminals(path);
    std::filesystem::remove(path);
    return data;
}

}  // namespace

TEST_CASE("terminals are read by their names") {
    Result<TerminalData> data = readBytes(smallFile());
    REQUIRE_MESSAGE(data, (data ? "" : data.failure().text()));
    REQUIRE(data->variants.size() == 2);
    CHECK(data->variants[0].kind == 0);
    CHECK(data->variants[1].kind == 1);
    CHECK(data->variants[1].lods[0].indexCount == 3);
    CHECK(data->vertices[2].position == glm::vec3(0, 1, 1));
}

TEST_CASE("a LOD's error is its distance to the finest mesh, of large meshes too") {
    // Two unit squares of n × n quads: a flat one, and one whose columns of vertices stand .1 above and below it in
    // turn.
    const uint32_t n = 160;
    TerminalData data;
    data.materials.emplace_back();
    auto grid = [&](uint32_t quads, float height) {
        TerminalLod lod;
        lod.firstVertex = uint32_t(data.vertices.size());
        lod.firstIndex = uint32_t(data.indices.size());
        for (uint32_t y = 0; y <= quads; ++y)
            for (uint32_t x = 0; x <= quads; ++x)
                data.vertices.push_back(
                    {{float(x) / float(quads), float(y) / float(quads), x % 2 ? height : -height}, 0, {}});
        for (uint32_t i = 0; i < quads * quads; ++i) {
            const uint32_t a = i / quads * (quads + 1) + i % quads, c = a + quads + 1;
            for (uint32_t k : {a, a + 1, c + 1, a, c + 1, c}) data.indices.push_back(k);
        }
        lod.vertexCount = uint32_t(data.vertices.size()) - lod.firstVertex;
        lod.indexCount = uint32_t(data.indices.size()) - lod.firstIndex;
        return lod;
    };
    TerminalVariant variant;
    variant.lods = {grid(n, 0), grid(n, .1f)};
    data.variants.push_back(variant);
    // From the flat one's vertices the slopes are half a quad away, almost level with them.
    const double slope = .2 * n, there = .5 / n * slope / std::sqrt(1 + slope * slope), back = .1;
    measureTerminalErrors(data);
    CHECK(data.variants[0].lods[1].error ==
          doctest::Approx(std::sqrt((there * there + back * back) / 2)).epsilon(1e-4));
    data.materials[0].alphaCutoff = .5f;  // a cut-out is judged from the finest mesh only
    measureTerminalErrors(data);
    CHECK(data.variants[0].lods[1].error == doctest::Approx(there).epsilon(1e-4));
}

TEST_CASE("a missing file is named") {
    Result<TerminalData> data = readTerminals("/nowhere/terminals.glb");
    REQUIRE(!data);
    CHECK(data.failure().text().find("/nowhere/terminals.glb") != std::string::npos);
}

TEST_CASE("damaged files are refused or read, never followed out of bounds") {
    const std::vector<std::byte> whole = smallFile();
    for (size_t keep = 0; keep < whole.size(); keep += 13) {
        CAPTURE(keep);
        CHECK(!readBytes({whole.begin(), whole.begin() + long(keep)}));
    }
    std::mt19937 random(3);
    for (int round = 0; round < 400; ++round) {
        std::vector<std::byte> bytes = whole;
        for (int flips = 1 + int(random() % 4); flips > 0; --flips)
            bytes[random() % bytes.size()] ^= std::byte(1 << random() % 8);
        Result<TerminalData> data = readBytes(bytes);
        if (!data) continue;
        for (const TerminalVariant& variant : data->variants)
            for (const TerminalLod& lod : variant.lods)
                for (uint32_t i = 0; i < lod.indexCount; ++i)
                    REQUIRE(data->indices[lod.firstIndex + i] < lod.vertexCount);
    }
}

TEST_CASE("a tree without end is refused, not copied until the stack ends") {
    std::string text =
        R"({"asset":{"version":"2.0"},"materials":)" + std::string(400000, '[') + std::string(400000, ']') + "}";
    Result<TerminalData> data = readBytes(glbContainer(text, {}));
    REQUIRE(!data);
    CHECK(data.failure().text().find("materials holds something else") != std::string::npos);
}
