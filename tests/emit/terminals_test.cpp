// The reader of terminal meshes against whole, truncated and damaged files.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>

#include "runtime/core/glb.hpp"
#include "runtime/emit/terminals.hpp"
#include "tests/emit/fixture.hpp"

using namespace espalier;

namespace {

// bark_lod0 and two levels of a leaf, all one triangle of these indices of a glTF component type.
template <class T>
std::vector<std::byte> smallFile(std::array<T, 3> indices, int componentType) {
    const float vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    std::string text = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":84}],"bufferViews":[
        {"buffer":0,"byteOffset":0,"byteLength":72},{"buffer":0,"byteOffset":72,"byteLength":12}],"accessors":[
        {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
        {"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"},
        {"bufferView":1,"componentType":)" +
                       std::to_string(componentType) + R"(,"count":3,"type":"SCALAR"}],"meshes":[
        {"name":"bark_lod0","primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2}]},
        {"name":"leaf_lod0","primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2}]},
        {"name":"leaf_lod1","extras":{"pixels":16},"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2}]}]})";
    std::array<std::byte, 84> binary{};
    std::memcpy(binary.data(), vertices, 72);
    std::memcpy(binary.data() + 72, indices.data(), sizeof indices);
    return glbContainer(text, binary);
}
std::vector<std::byte> smallFile() {
    return smallFile<uint16_t>({0, 1, 2}, 5123);
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
    const uint32_t n = 160;
    TerminalData data;
    data.materials.emplace_back();
    TerminalVariant variant;
    test::addSquare(data, variant, n);
    test::addSquare(data, variant, n, .1f);
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

TEST_CASE("a cut-out of two triangles is far off, however near the finest mesh it lies") {
    TerminalData data;
    data.materials.emplace_back();
    TerminalVariant variant;
    for (uint32_t quads : {4u, 2u, 1u}) test::addSquare(data, variant, quads);
    data.variants.push_back(variant);
    const auto errors = [&](float alphaCutoff) {
        data.materials[0].alphaCutoff = alphaCutoff;
        measureTerminalErrors(data);
        return glm::vec2(data.variants[0].lods[1].error, data.variants[0].lods[2].error);
    };
    CHECK(errors(0).x < .01f);
    CHECK(errors(0).y < .01f);
    CHECK(errors(.5f).x < .01f);
    CHECK(errors(.5f).y > .15f);
}

TEST_CASE("a file may say how small a thing has to be for a LOD, whatever its distance to the finest mesh") {
    Result<TerminalData> data = readBytes(smallFile());
    REQUIRE(data);
    REQUIRE(data->variants[1].lods.size() == 2);
    CHECK(data->variants[1].lods[1].error == doctest::Approx(1.0 / 16));
    data->variants[1].lods[1].pixels = 0;
    measureTerminalErrors(*data);
    CHECK(data->variants[1].lods[1].error < 1e-3f);  // it is the same mesh
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

TEST_CASE("indices that are no whole numbers of the mesh's own vertices are refused") {
    CHECK(readBytes(smallFile<float>({0, 1, 2}, 5126)));
    for (float wrong : {-1.0f, 0.5f, 3.0f, NAN}) {
        CAPTURE(wrong);
        CHECK(!readBytes(smallFile<float>({0, wrong, 2}, 5126)));
    }
}

TEST_CASE("a pattern for drawing isn't longer than a mesh with many triangles on few vertices asks for") {
    DeviceOptions options;
    auto device = Device::create(options);
    REQUIRE(device);
    TerminalData data = test::simpleTerminals();
    TerminalLod& lod = data.variants.back().lods.back();
    lod.firstIndex = uint32_t(data.indices.size());
    lod.indexCount = 3 * 50000;
    data.indices.resize(data.indices.size() + lod.indexCount);
    auto terminals = Terminals::create(**device, data);
    REQUIRE(terminals);
    CHECK(terminals->table().buckets.back().batch == 1);
    CHECK(terminals->batches().size() < 4 * lod.indexCount + (4 << 20));
}

TEST_CASE("a tree without end is refused, not copied until the stack ends") {
    std::string text =
        R"({"asset":{"version":"2.0"},"materials":)" + std::string(400000, '[') + std::string(400000, ']') + "}";
    Result<TerminalData> data = readBytes(glbContainer(text, {}));
    REQUIRE(!data);
    CHECK(data.failure().text().find("materials holds something else") != std::string::npos);
}
