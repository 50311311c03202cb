// The surface file: what is written is read; what is damaged is refused with a message and no crash.
#include "runtime/surface/surface.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "runtime/core/file.hpp"
#include "shaders/shared/random.h"
#include "tests/bake/small_models.hpp"
#include "tests/support/same_bits.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// A folder of its own that goes when the test does.
struct Folder {
    std::filesystem::path path;
    Folder()
        : path(std::filesystem::temp_directory_path() /
               ("espalier_surface_" + std::to_string(std::rand()) + std::to_string(long(this)))) {
        std::filesystem::create_directories(path);
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    std::string file(const char* name) const { return (path / name).string(); }
};

SurfaceData sample() {
    Model model = cubeCross(3);
    Picture picture;
    picture.width = 4;
    picture.height = 2;
    for (int i = 0; i < 32; ++i) picture.rgba.push_back(uint8_t(i * 7));
    model.images.push_back(picture);
    Material plain, textured;
    textured.baseColor = {0.5f, 0.25f, 1, 1};
    textured.baseColorImage = 0;
    textured.alphaCutoff = 0.5f;
    textured.doubleSided = true;
    textured.wrapU = Wrap::clamp;
    textured.wrapV = Wrap::mirror;
    model.materials = {plain, textured};
    for (size_t t = 0; t < model.indices.size() / 3; ++t) model.triangleMaterial.push_back(t % 3 == 0);
    BakeOptions options;
    options.resolution = 64;
    options.levels = 3;
    auto baked = bake(model, options);
    if (!baked) FAIL(baked.failure().text());
    return std::move(baked->surface);
}

std::vector<std::byte> bytesOf(const std::string& path) {
    auto read = readFile(path);
    REQUIRE(read);
    return std::move(*read);
}

}  // namespace

TEST_CASE("what is written is read: the walk's data bit for bit, the mesh within its quantisation") {
    Folder folder;
    SurfaceData a = sample();
    REQUIRE(writeSurface(a, folder.file("a.glb")));
    auto read = readSurface(folder.file("a.glb"));
    if (!read) FAIL(read.failure().text());
    const SurfaceData& b = *read;
    CHECK(b.hash == a.hash);
    CHECK(b.source == a.source);
    CHECK(b.boundsMin == a.boundsMin);
    CHECK(b.boundsMax == a.boundsMax);
    CHECK(sameBits(a.crossings, b.crossings));
    CHECK(sameBits(a.charts, b.charts));
    CHECK(sameBits(a.triangles, b.triangles));
    REQUIRE(b.levels.size() == 3);
    for (size_t l = 0; l < 3; ++l) {
        CHECK(a.levels[l].size == b.levels[l].size);
        CHECK(sameBits(a.levels[l].texels, b.levels[l].texels));
        CHECK(sameBits(a.levels[l].aux, b.levels[l].aux));
        CHECK(sameBits(a.levels[l].crossingHead, b.levels[l].crossingHead));
        CHECK(sameBits(a.levels[l].crossingRefs, b.levels[l].crossingRefs));
    }
    CHECK(a.indices.size() == b.indices.size());
    REQUIRE(b.ranges.size() == 2);
    REQUIRE(b.materials.size() == 2);
    CHECK(b.materials[1].baseColor == a.materials[1].baseColor);
    CHECK(b.materials[1].baseColorImage == 0);
    CHECK(b.materials[1].alphaCutoff == 0.5f);
    CHECK(b.materials[1].doubleSided);
    CHECK(b.materials[1].wrapU == Wrap::clamp);
    CHECK(b.materials[1].wrapV == Wrap::mirror);
    CHECK(b.materials[0].wrapU == Wrap::repeat);
    const std::vector<std::byte> file = bytesOf(folder.file("a.glb"));
    const std::string text(reinterpret_cast<const char*>(file.data()), file.size());
    CHECK(text.find(R"("wrapS":33071,"wrapT":33648)") != text.npos);  // as other viewers read it
    REQUIRE(b.images.size() == 1);
    CHECK(b.images[0].width == 4);
    CHECK(sameBits(a.images[0].rgba, b.images[0].rgba));
    // Each drawn corner lies on the surface where its walk UV says.
    for (const DrawVertex& v : b.vertices) {
        float best = 1e9f;
        for (const TrianglePlane& t : b.triangles) {
            glm::vec2 d = v.walkUv - t.uv0;
            best = std::min(best, glm::length(t.position + t.du * d.x + t.dv * d.y - v.position));
        }
        REQUIRE(best < 1e-3f);
        CHECK(glm::length(v.normal) == doctest::Approx(1).epsilon(0.01));
        CHECK(std::abs(v.tangent.w) == 1);
    }
    REQUIRE(writeSurface(b, folder.file("b.glb")));
    auto again = readSurface(folder.file("b.glb"));
    REQUIRE(again);
    CHECK(again->hash == a.hash);
}

TEST_CASE("a material is bare if its extras say so, whatever else they hold") {
    Folder folder;
    SurfaceData surface = sample();
    surface.materials[1].bare = true;
    REQUIRE(writeSurface(surface, folder.file("a.glb")));
    const std::vector<std::byte> written = bytesOf(folder.file("a.glb"));
    const std::string text(reinterpret_cast<const char*>(written.data()), written.size());
    const std::string own = R"({"bare":true})";
    const size_t at = text.find(own);
    REQUIRE(at != std::string::npos);
    const auto bareWith = [&](std::string extras) {
        while ((extras.size() - own.size()) % 4 != 0) extras += ' ';
        std::string changed = std::string(text).replace(at, own.size(), extras);
        for (size_t word : {8, 12}) {  // lengths of the file and of its text
            uint32_t length;
            std::memcpy(&length, changed.data() + word, 4);
            length += uint32_t(extras.size() - own.size());
            std::memcpy(changed.data() + word, &length, 4);
        }
        REQUIRE(writeFile(folder.file("b.glb"), std::string_view(changed)));
        auto read = readSurface(folder.file("b.glb"));
        if (!read) FAIL(read.failure().text());
        CHECK(!read->materials[0].bare);
        return read->materials[1].bare;
    };
    CHECK(bareWith(own));
    CHECK(bareWith(R"({"author":"a tool that passed by","bare":true,"tags":[1,2]})"));
    for (const char* other : {R"({"bare":false})", R"({"bare":"true"})", R"({"bare":1})", R"({"bald":true})", "[true]"})
        CHECK(!bareWith(std::string(other)));
}

TEST_CASE("pictures that hold more than a file of its size can are refused before they are decoded") {
    Folder folder;
    SurfaceData data = sample();
    const uint8_t begins[] = {0x89, 'P', 'N', 'G', 13, 10, 26, 10, 0, 0, 0, 13, 'I', 'H', 'D', 'R', 0,
                              0,    64,  0,   0,   0,  64, 0,  1,  0, 0, 0, 0,  0,   0,   0,   0};  // 16384 a side
    data.images[0].encoded.assign(std::begin(begins), std::end(begins));
    data.images.push_back(data.images[0]);
    REQUIRE(writeSurface(data, folder.file("s.glb")));
    Result<SurfaceData> read = readSurface(folder.file("s.glb"));
    REQUIRE_FALSE(read);
    CHECK(read.failure().text().find("images[1]: absurdly much for the file's size") != std::string::npos);
}

TEST_CASE("a truncated file is refused wherever it ends") {
    Folder folder;
    REQUIRE(writeSurface(sample(), folder.file("a.glb")));
    std::vector<std::byte> bytes = bytesOf(folder.file("a.glb"));
    for (size_t keep = 0; keep < bytes.size(); keep += keep < 64 ? 1 : bytes.size() / 61) {
        REQUIRE(writeFile(folder.file("cut.glb"), std::span(bytes).first(keep)));
        auto read = readSurface(folder.file("cut.glb"));
        REQUIRE(!read);
        CHECK(read.failure().text().find("cut.glb") != std::string::npos);
    }
}

TEST_CASE("flipped bits are refused, or touch nothing that a kernel follows") {
    Folder folder;
    SurfaceData a = sample();
    REQUIRE(writeSurface(a, folder.file("a.glb")));
    const std::vector<std::byte> bytes = bytesOf(folder.file("a.glb"));
    uint32_t textLength;
    std::memcpy(&textLength, bytes.data() + 12, 4);
    uint64_t state = 12345;
    size_t refused = 0, tries = 400;
    for (size_t i = 0; i < tries; ++i) {
        state = mix64(state + 1);
        std::vector<std::byte> flipped = bytes;
        // Every other flip in the text, where sizes and indices stand.
        size_t at = i % 2 ? 20 + size_t(state % textLength) : size_t(state % bytes.size());
        flipped[at] ^= std::byte(1u << (state >> 61));
        REQUIRE(writeFile(folder.file("flip.glb"), flipped));
        auto read = readSurface(folder.file("flip.glb"));
        if (!read) {
            ++refused;
            CHECK(!read.failure().diagnostics.front().message.empty());
        } else {
            CHECK(read->hash == a.hash);
        }
        if (at >= 20 + textLength + 8) CHECK(!read);  // the binary chunk is under a hash
    }
    CHECK(refused > tries / 2);
}

TEST_CASE("other files are refused; failed writing leaves nothing") {
    Folder folder;
    CHECK(!readSurface(folder.file("missing.glb")));
    CHECK(!readSurface(folder.path.string()));
    REQUIRE(writeFile(folder.file("text.glb"), std::string_view("solid cube")));
    CHECK(!readSurface(folder.file("text.glb")));
    SurfaceData a = sample();
    REQUIRE(writeFile(folder.file("block"), std::string_view("a file, no folder")));
    CHECK(!writeSurface(a, folder.file("block/a.glb")));
    CHECK(!std::filesystem::exists(folder.file("block/a.glb")));
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path)) files += entry.is_regular_file();
    CHECK(files == 2);
}

TEST_CASE("files of an older version are refused, and what is to be done is said") {
    Folder folder;
    REQUIRE(writeSurface(sample(), folder.file("old.glb")));
    auto bytes = readFile(folder.file("old.glb"));
    REQUIRE(bytes);
    std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    const size_t at = text.find("\"version\":3");
    REQUIRE(at != std::string::npos);
    text[at + 10] = '2';
    REQUIRE(writeFile(folder.file("old.glb"), std::string_view(text)));
    const auto read = readSurface(folder.file("old.glb"));
    REQUIRE(!read);
    CHECK(read.failure().text().find("bake again") != std::string::npos);
}

TEST_CASE("indices out of range are refused even when the hashes fit") {
    Folder folder;
    auto refuses = [&](auto&& change) {
        SurfaceData s = sample();
        change(s);
        s.hash = walkHash(s);
        if (!writeSurface(s, folder.file("wild.glb"))) return true;
        return !readSurface(folder.file("wild.glb"));
    };
    CHECK(!refuses([](SurfaceData&) {}));
    CHECK(refuses([](SurfaceData& s) { s.crossings[3].target = 0xFFFF0000u | 77u; }));
    CHECK(refuses([](SurfaceData& s) { s.crossings[3].target &= 0xFFFFu; }));
    CHECK(refuses([](SurfaceData& s) { s.crossings[3].flags |= 0xFFFF0000u; }));
    CHECK(refuses([](SurfaceData& s) { s.crossings[3].ta.x = 2; }));
    CHECK(refuses([](SurfaceData& s) { s.charts[0].coarsestLevel = 3; }));
    CHECK(refuses([](SurfaceData& s) { s.charts[0].triangleCount += 1; }));
    CHECK(refuses([](SurfaceData& s) { s.triangles[5].chart = 9; }));
    CHECK(refuses([](SurfaceData& s) { s.triangles[5].uv2.y = -1; }));
    CHECK(refuses([](SurfaceData& s) { s.levels[0].crossingRefs[0] = 1u << 20; }));
    CHECK(refuses([](SurfaceData& s) { s.levels[1].crossingHead[9] = 0xFFFFFF01u; }));
    CHECK(refuses([](SurfaceData& s) {
        for (Texel& t : s.levels[0].texels)
            if (texelClass(t.bits) == kTexelInner) t.bits |= 0xFFFFu;
    }));
    CHECK(refuses([](SurfaceData& s) {
        for (size_t i = 0; i < s.levels[0].aux.size(); ++i)
            if (texelClass(s.levels[0].texels[i].bits) == kTexelInner) s.levels[0].aux[i].triangle = 1u << 30;
    }));
    CHECK(refuses([](SurfaceData& s) { s.levels[2].texels.resize(64); }));
}

TEST_CASE("a plain surface of many texels, which packs to next to nothing, is read") {
    Folder folder;
    Model plate;
    plate.name = "plate";
    addPatch(
        plate, 1, [](float s, float t) { return glm::vec3(s, 0, -t); },
        [](float s, float t) { return glm::vec2(0.05f + 0.9f * s, 0.05f + 0.9f * t); });
    BakeOptions options;
    options.resolution = 4096;
    options.levels = 1;
    auto baked = bake(plate, options);
    REQUIRE(baked);
    REQUIRE(writeSurface(baked->surface, folder.file("plate.glb")));
    CHECK(std::filesystem::file_size(folder.file("plate.glb")) < 1'000'000);
    auto read = readSurface(folder.file("plate.glb"));
    if (!read) FAIL(read.failure().text());
    CHECK(read->hash == baked->surface.hash);
}

TEST_CASE("what a reader would refuse isn't written") {
    Folder folder;
    const auto refusal = [&](auto&& change) {
        SurfaceData surface = sample();
        change(surface);
        const Status written = writeSurface(surface, folder.file("many.glb"));
        CHECK(!std::filesystem::exists(folder.file("many.glb")));
        return written ? std::string() : written.failure().text();
    };
    CHECK(refusal([](SurfaceData& s) { s.images.resize(4097, s.images[0]); }).find("4097 images") != std::string::npos);
    CHECK(refusal([](SurfaceData& s) { s.materials.resize(65537); }).find("65537 materials") != std::string::npos);
}
