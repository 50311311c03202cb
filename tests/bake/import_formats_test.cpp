// OBJ and PLY: the same square and the same cube told in every way that files do, and mistakes with their places.
#include <doctest/doctest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/core/file.hpp"
#include "tests/bake/baking.hpp"
#include "tests/support/data.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/bake/bake.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

Result<Model> importText(const ScratchFolder& folder, const std::string& name, const std::string& text) {
    REQUIRE(writeFile(folder.file(name), std::string_view(text)));
    return importModel(folder.file(name));
}

glm::vec3 areaOf(const Model& m) {
    glm::vec3 sum(0);
    for (size_t i = 0; i + 2 < m.indices.size(); i += 3)
        sum += glm::cross(m.positions[m.indices[i + 1]] - m.positions[m.indices[i]],
                          m.positions[m.indices[i + 2]] - m.positions[m.indices[i]]) *
               0.5f;
    return sum;
}

// The sum of the triangles' areas, each taken as it is: folded triangulations would be too large.
float plainArea(const Model& m) {
    float sum = 0;
    for (size_t i = 0; i + 2 < m.indices.size(); i += 3)
        sum += glm::length(glm::cross(m.positions[m.indices[i + 1]] - m.positions[m.indices[i]],
                                      m.positions[m.indices[i + 2]] - m.positions[m.indices[i]])) *
               0.5f;
    return sum;
}

template <class T>
void put(std::string& out, T value, bool big) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (big) std::reverse(bytes, bytes + sizeof value);
    out.append(bytes, sizeof value);
}

// A quad and a triangle beside it, five vertices, with a list and elements that nobody asked for.
std::string binaryPly(bool big) {
    std::string out = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                      "_endian 1.0\ncomment by hand\nelement camera 2\nproperty double f\nelement vertex 5\n"
                      "property float x\nproperty double y\nproperty short z\nproperty list uchar int tags\n"
                      "property float s\nproperty float t\nelement face 2\nproperty uchar flags\n"
                      "property list ushort uint vertex_index\nend_header\n";
    for (double f : {1.0, 2.0}) put(out, f, big);
    const float x[5] = {0, 1, 1, 0, 2}, y[5] = {0, 0, 1, 1, 0};
    for (int i = 0; i < 5; ++i) {
        put(out, x[i], big);
        put(out, double(y[i]), big);
        put(out, int16_t(-3), big);
        put(out, uint8_t(2), big);
        for (int32_t tag : {7, 8}) put(out, tag, big);
        put(out, x[i] * 0.5f, big);
        put(out, y[i], big);
    }
    for (auto face : {std::vector<uint32_t>{0, 1, 2, 3}, std::vector<uint32_t>{1, 4, 2}}) {
        put(out, uint8_t(9), big);
        put(out, uint16_t(face.size()), big);
        for (uint32_t v : face) put(out, v, big);
    }
    return out;
}

}  // namespace

TEST_CASE("OBJ: quads, negative indices, groups, split and continued lines make the same square") {
    ScratchFolder folder;
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    for (std::string faces : {"f 1/1 2/2 3/3 4/4\n", "f -4/-4 -3/-3 -2/-2 -1/-1\n", "f 1/1 2/2 3/3\nf 1/1 3/3 4/4",
                              "o a\ng b c\ns off\nf 1/1 2/2 \\\n 3/3 4/4 # the rest\n", "f 1/1 2/2 3/3 4/4\r\n"}) {
        CAPTURE(faces);
        auto model = importText(folder, "square.obj", corners + faces);
        if (!model) FAIL(model.failure().text());
        CHECK(model->positions.size() == 4);
        CHECK(model->indices.size() == 6);
        CHECK(areaOf(*model) == glm::vec3(0, 0, 1));
        // v counts upwards in OBJ, downwards here.
        for (size_t i = 0; i < 4; ++i)
            CHECK(model->uvs[i] == glm::vec2(model->positions[i].x, 1 - model->positions[i].y));
        CHECK(model->normals.empty());
    }
    // A position with two UVs is two vertices; corners without UVs have none.
    auto split = importText(folder, "split.obj", corners + "f 1/1 2/2 3/3\nf 1/4 3/3 4/4\nf 1 2 3\n");
    REQUIRE(split);
    CHECK(split->positions.size() == 8);
    CHECK(std::isnan(split->uvs[7].x));
    auto plain = importText(folder, "plain.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 2\nf 1//1 2//1 3//1\n");
    REQUIRE(plain);
    CHECK(plain->uvs.empty());
    CHECK(plain->normals.at(2) == glm::vec3(0, 0, 1));
}

TEST_CASE("polygons are filled, concave ones too, whichever way they face") {
    ScratchFolder folder;
    // A comb of four teeth over a bar, as one polygon; its area is known.
    const float comb[][2] = {{0, 0}, {7, 0}, {7, 4}, {6, 4}, {6, 1}, {5, 1}, {5, 4}, {4, 4},
                             {4, 1}, {3, 1}, {3, 4}, {2, 4}, {2, 1}, {1, 1}, {1, 4}, {0, 4}};
    const float area = 7 * 1 + 4 * 1 * 3;
    for (int axis = 0; axis < 3; ++axis)
        for (bool turned : {false, true}) {
            std::string text, face = "f";
            for (const auto& c : comb) {
                float p[3] = {};
                p[(axis + 1) % 3] = c[0];
                p[(axis + 2) % 3] = c[1];
                text += "v " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
            }
            for (int i = 0; i < 16; ++i) face += " " + std::to_string(turned ? 16 - i : 1 + i);
            auto model = importText(folder, "comb.obj", text + face + "\n");
            REQUIRE(model);
            CHECK(model->indices.size() == 14 * 3);
            CHECK(plainArea(*model) == doctest::Approx(area));
            CHECK(areaOf(*model)[axis] == doctest::Approx(turned ? -area : area));
        }
    // Outlines that cross themselves or have no area still end.
    CHECK(importText(folder, "bow.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n"));
    CHECK(importText(folder, "point.obj", "v 0 0 0\nf 1 1 1 1 1\n"));
}

TEST_CASE("OBJ: materials with colours, roughness and pictures; what is missing is a warning") {
    ScratchFolder folder;
    REQUIRE(writeFile(folder.file("two words.mtl"),
                      std::string_view("newmtl red wall\nKd 0.5 0.25 0\nd 0.5\nPr 0.75\nnewmtl other\nNs 0\n"
                                       "map_Kd -s 2 2 2 -clamp on nowhere at all.png\n")));
    auto model =
        importText(folder, "m.obj",
                   "mtllib two words.mtl\nmtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nusemtl red wall\n"
                   "f 1 2 3\nusemtl other\nf 1 2 3\nusemtl unheard\nf 1 2 3\n");
    if (!model) FAIL(model.failure().text());
    REQUIRE(model->materials.size() == 3);
    CHECK(model->triangleMaterial == std::vector<uint32_t>{0, 1, 2, 0});
    CHECK(model->materials[1].baseColor == glm::vec4(0.5f, 0.25f, 0, 0.5f));
    CHECK(model->materials[1].roughness == 0.75f);
    CHECK(model->materialNames == std::vector<std::string>{"", "red wall", "other"});
    CHECK(model->materials[1].bare);
    CHECK(!model->materials[2].bare);
    CHECK(model->materials[2].roughness == 1);
    REQUIRE(model->warnings.size() == 3);
    CHECK(contains(toString(model->warnings[0]), "two words.mtl:7"));
    CHECK(contains(toString(model->warnings[0]), "nowhere at all.png"));
    CHECK(contains(toString(model->warnings[1]), "gone.mtl"));
    CHECK(contains(toString(model->warnings[2]), "m.obj:11"));
}

TEST_CASE("OBJ: mistakes name the file and the line") {
    ScratchFolder folder;
    const std::string v = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    for (auto [text, message] : {std::pair<std::string, std::string>{v + "f 1 2 4\n", "bad.obj:4: vertex 4"},
                                 {v + "f 1 2 -4\n", "bad.obj:4: vertex -4"},
                                 {v + "f 1 2 0\n", "bad.obj:4: vertex 0"},
                                 {v + "f 1 2 x\n", "bad.obj:4: 'x'"},
                                 {v + "f 1 2 99999999999999999999\n", "bad.obj:4"},
                                 {v + "f / / /\n", "bad.obj:4"},
                                 {"v 0 0\n" + v + "f 1 2 3\n", "bad.obj:1: a vertex without three numbers"},
                                 {v + "v 0 0 nan\nf 1 2 4\n", "bad.obj:4: a vertex without three numbers"},
                                 {v + "v 0 0 1e400\nf 1 2 4\n", "named by the face of line 5"},
                                 {v + "v 0 0 1e39\nf 1 2 4\n", "bad.obj:4"},
                                 {v + "l 1 2\n", "no faces"},
                                 {v + "f 1 2\n", "no faces"},
                                 {"", "empty"}}) {
        CAPTURE(text);
        std::string said = messageOf(importText(folder, "bad.obj", text));
        CAPTURE(said);
        CHECK(contains(said, message));
    }
}

TEST_CASE("PLY: text, both byte orders and gzip hold the same model") {
    ScratchFolder folder;
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float32 x\nproperty float y\nproperty float z\n"
        "property float u\nproperty float v\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 -3 0 0\n1 0 -3 .5 0\n1 1 -3 +0.5 1e0\n0 1 -3 0 1\n2 0 -3 1 0\n4 0 1 2 3\n3 1 4 2\n";
    std::vector<std::pair<std::string, std::string>> files = {
        {"text.ply", text}, {"little.ply", binaryPly(false)}, {"big.ply", binaryPly(true)}, {"packed.ply.gz", ""}};
    for (const auto& [name, bytes] : files) {
        CAPTURE(name);
        if (bytes.empty()) {
            gzFile packed = gzopen(folder.file(name).c_str(), "wb");
            REQUIRE(gzwrite(packed, text.data(), unsigned(text.size())) == int(text.size()));
            REQUIRE(gzclose(packed) == Z_OK);
        } else {
            REQUIRE(writeFile(folder.file(name), std::string_view(bytes)));
        }
        auto model = importModel(folder.file(name));
        if (!model) FAIL(model.failure().text());
        CHECK(model->positions.size() == 5);
        CHECK(model->indices.size() == 9);
        CHECK(model->positions[4] == glm::vec3(2, 0, -3));
        CHECK(model->uvs[2] == glm::vec2(0.5f, 0));
        CHECK(areaOf(*model) == glm::vec3(0, 0, 1.5f));
        // Half of the file is too little, and said so.
        auto whole = readFile(folder.file(name));
        REQUIRE(whole);
        whole->resize(whole->size() - 6);
        REQUIRE(writeFile(folder.file("cut" + name), *whole));
        CHECK(contains(messageOf(importModel(folder.file("cut" + name))), "cut" + name));
    }
}

TEST_CASE("PLY: mistakes name the file and the place") {
    ScratchFolder folder;
    const std::string begin =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    for (
        auto [text, message] :
        {std::pair<std::string, std::string>{begin + faces + "0 0 0\n1 0 0\n1 1 0\n3 0 1 3\n", ":13: face 0: vertex 3"},
         {begin + faces + "0 0 0\n1 0 0\n1 1 0\n3 0 1 -1\n", "face 0"},
         {begin + faces + "0 0 0\n1 x 0\n1 1 0\n3 0 1 2\n", ":11: vertex 1"},
         {begin + faces + "0 0 0\n1 nan 0\n1 1 0\n3 0 1 2\n", ":13: face 0: vertex 1"},
         {begin + "element face 4000000000\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 0 0 1 1 0\n",
          "4000000000"},
         {begin + "element face 1\nproperty list float int vertex_indices\nend_header\n", ":8:"},
         {begin, "no end_header"},
         {"ply\nend_header\n", "no format"},
         {"ply\nformat ascii 2.0\nend_header\n", ":2:"},
         {"ply\nformat ascii 1.0\nproperty float x\nend_header\n", ":3:"},
         {"plywood", "does not begin"},
         {begin + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n"
                  "3 0 1 3\n",
          "tristrips 0: vertex 3"},
         {"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
          "no faces"}}) {
        CAPTURE(text);
        std::string said = messageOf(importText(folder, "bad.ply", text));
        CAPTURE(said);
        CHECK(contains(said, "bad.ply"));
        CHECK(contains(said, message));
    }
    std::string binary = binaryPly(false);
    binary[binary.size() - 1] = '\x7F';
    CHECK(contains(messageOf(importText(folder, "bad.ply", binary)), "byte " + std::to_string(binary.size())));
}

TEST_CASE("a file that unpacks to absurdly much is refused before it does") {
    ScratchFolder folder;
    std::string zeros(size_t(1) << 24, 0);
    gzFile packed = gzopen(folder.file("bomb.ply.gz").c_str(), "wb9");
    for (int i = 0; i < 40; ++i) REQUIRE(gzwrite(packed, zeros.data(), unsigned(zeros.size())) > 0);
    REQUIRE(gzclose(packed) == Z_OK);
    CHECK(contains(messageOf(importModel(folder.file("bomb.ply.gz"))), "bomb.ply.gz"));
    CHECK(contains(messageOf(importModel("/dev/zero")), "no ordinary file"));
    CHECK(contains(messageOf(importText(folder, "what.txt", "hello")), "neither glTF"));
}
