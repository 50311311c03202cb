// PLY files as people have them: strips, corners with UVs of their own, pictures, colours, blemishes. And STL.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

#include "runtime/core/srgb.hpp"
#include "tests/bake/model_folder.hpp"
#include "tests/bake/small_pictures.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

Model readPly(const ModelFolder& folder, const std::string& text, const std::string& name = "a.ply") {
    return folder.read(name, text);
}

// With its sign: of triangles in the plane z = 0 that face up.
double areaUp(const Model& m) {
    double sum = 0;
    for (size_t i = 0; i + 2 < m.indices.size(); i += 3) {
        const glm::vec3 a = m.positions[m.indices[i]], b = m.positions[m.indices[i + 1]],
                        c = m.positions[m.indices[i + 2]];
        sum += glm::cross(b - a, c - a).z / 2;
    }
    return sum;
}

// A header for vertices of these properties besides their positions, and what follows.
std::string plyText(size_t vertices, const std::string& properties, const std::string& rest,
                    const std::string& comments = "") {
    return "ply\nformat ascii 1.0\n" + comments + "element vertex " + std::to_string(vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\n" + properties + rest;
}
const std::string kCornerList = "property list uchar int vertex_indices\n";

}  // namespace

TEST_CASE("PLY: strips begin anew at -1 and turn every second triangle") {
    ModelFolder folder;
    // Two ladders of two squares each; the second repeats corners to lead on.
    const Model model =
        readPly(folder, plyText(6, "",
                                "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                                "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n"
                                "14 1 0 3 2 5 4 -1 1 0 3 3 3 2 5\n"));
    CHECK(model.indices.size() == 3 * (4 + 1 + 1));
    CHECK(areaUp(model) == doctest::Approx(0.5 * 6));
}

TEST_CASE("PLY: corners have UVs of their own, and faces their pictures") {
    ModelFolder folder;
    folder.put("one.png", greyPng(2, 10));
    folder.put("two two.png", greyPng(2, 20));
    const Model model = readPly(
        folder, plyText(4, "",
                        "element face 3\n" + kCornerList +
                            "property list uchar float texcoord\nproperty int texnumber\nend_header\n"
                            "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                            "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0 0 1 1 0 1 0\n4 0 1 2 3 8 0 0 .5 0 .5 .5 0 .5 1\n",
                        "comment TextureFile one.png\ncomment TextureFile two two.png\n"));
    CHECK(areaUp(model) == 2);
    CHECK(model.positions.size() == 4 + 3);  // three corners of the square have another UV
    CHECK(model.triangleMaterial == std::vector<uint32_t>{0, 0, 1, 1});
    REQUIRE(model.images.size() == 2);
    CHECK(model.images[size_t(model.materials[1].baseColorImage)].rgba[0] == 20);
    CHECK(model.uvs[model.indices[2]] == glm::vec2(1, 0));  // v counts upwards there
    CHECK(model.warnings.empty());
    const Model missing = readPly(
        folder, plyText(3, "property float s\nproperty float t\n",
                        "element face 1\n" + kCornerList + "end_header\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n3 0 1 2\n",
                        "comment TextureFile gone.png\n"));
    CHECK(missing.uvs[1] == glm::vec2(1, 1));
    CHECK(warns(missing, "gone.png"));
}

TEST_CASE("PLY: vertices and faces have colours") {
    ModelFolder folder;
    struct Case {
        std::string properties, values;
        glm::vec4 linear;
    };
    const glm::vec4 half(linearOfSrgb(0.5f), 1, 0, 1);
    for (const Case& c : {Case{"property float red\nproperty float green\nproperty float blue\n", " 0.5 1 0", half},
                          {"property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n",
                           " 255 0 0 51",
                           {1, 0, 0, 0.2f}},
                          {"property ushort diffuse_red\nproperty ushort diffuse_green\nproperty ushort diffuse_blue\n",
                           " 65535 0 65535",
                           {1, 0, 1, 1}},
                          {"property float r\nproperty float g\nproperty float b\n", " 127.5 255 0", half},
                          {"property float red\nproperty float green\n", " 0.5 1", glm::vec4(-1)}}) {
        CAPTURE(c.properties);
        const Model model = readPly(folder, plyText(3, c.properties,
                                                    "element face 1\n" + kCornerList + "end_header\n0 0 0" + c.values +
                                                        "\n1 0 0" + c.values + "\n1 1 0" + c.values + "\n3 0 1 2\n"));
        CHECK(model.colours.size() == (c.linear.r < 0 ? 0 : 3));
        for (glm::vec4 colour : model.colours)
            for (int k = 0; k < 4; ++k) CHECK(colour[k] == doctest::Approx(c.linear[k]).epsilon(1e-5));
    }
    const Model faces =
        readPly(folder, plyText(4, "",
                                "element face 2\n" + kCornerList +
                                    "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
                                    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 2 3 0 255 0\n"));
    CHECK(faces.positions.size() == 6);
    CHECK(faces.colours[faces.indices[0]] == glm::vec4(1, 0, 0, 1));
    CHECK(faces.colours[faces.indices[3]] == glm::vec4(0, 1, 0, 1));
}

TEST_CASE("PLY: what a model can do without is a warning") {
    ModelFolder folder;
    const std::string rest = "element face 2\n" + kCornerList + "end_header\n";
    const Model nan =
        readPly(folder, plyText(5, "property float nx\nproperty float ny\nproperty float nz\n",
                                rest + "0 0 0 nan 0 0\n1 0 0 0 0 1\n1 1 0 0 0 1\nnan nan nan 0 0 1\n9e30 0 0 0 0 1\n"
                                       "3 0 1 2\n2 0 1\n"));
    CHECK(areaUp(nan) == 0.5);
    CHECK(warns(nan, "named by no face (2 times)"));
    CHECK(warns(nan, "a.ply:13: warning: a normal that is not a number"));
    CHECK(warns(nan, "a face of fewer than 3 corners left out"));
    CHECK(nan.normals[0] == glm::vec3(0));
    CHECK(nan.normals[1] == glm::vec3(0, 0, 1));
    BakeOptions options;
    options.resolution = 64;
    CHECK(bake(nan, options));
    const Model uvs = readPly(folder, plyText(3, "property float u\nproperty float v\n",
                                              "element face 1\n" + kCornerList +
                                                  "end_header\n0 0 0 nan nan\n1 0 0 1 0\n1 1 0 1 1\n3 0 1 2\n"));
    CHECK(std::isnan(uvs.uvs[0].x));
    CHECK(warns(uvs, "a texture coordinate that is not a number"));
    CHECK(bake(uvs, options));
    // As programs of Windows write what is no number, behind a byte order mark.
    const Model other = readPly(folder, "\xEF\xBB\xBF" + plyText(6, "",
                                                                 "element face 1\n" + kCornerList +
                                                                     "end_header\n0 0 0\n1 0 0\n1 1 0\n1.#QNAN "
                                                                     "-1.#IND 0\n-nan(ind) nan 1.#INF\n-1.#INF00 "
                                                                     "0 0\n3 0 1 2\n"));
    CHECK(areaUp(other) == 0.5);
    CHECK(warns(other, "named by no face (3 times)"));
}

TEST_CASE("PLY: lines end in any way, and a binary body begins right behind them") {
    ModelFolder folder;
    for (const char* end : {"\n", "\r\n", "\r"}) {
        std::string text;
        for (char c : plyText(3, "", "element face 1\n" + kCornerList + "end_header\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n"))
            text += c == '\n' ? std::string(end) : std::string(1, c);
        CHECK(areaUp(readPly(folder, text)) == 0.5);
        std::string cut = folder.refusal("a.ply", text.substr(0, text.size() - std::strlen(end) - 3));
        CHECK(cut.find("a.ply:13") != std::string::npos);
    }
    // A first coordinate whose first byte is a line feed.
    std::string binary =
        "ply\rformat binary_little_endian 1.0\relement vertex 3\rproperty float x\rproperty float y\r"
        "property float z\relement face 1\rproperty list uchar uchar vertex_indices\rend_header\r";
    uint32_t bits = 0x3F80000Au;
    float corner[9] = {0, 0, 0, 1, 0, 0, 1, 1, 0};
    std::memcpy(&corner[0], &bits, 4);
    corner[0] -= 1;
    std::memcpy(&corner[0], &bits, 4);
    binary.append(reinterpret_cast<const char*>(corner), sizeof corner);
    binary += std::string("\3\0\1\2", 4);
    CHECK(readPly(folder, binary).positions[0].x > 1);
}

TEST_CASE("STL: text and binary, whatever they are called") {
    ModelFolder folder;
    const std::string text =
        "solid a cube # with names\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n"
        "   vertex 1 0 0\n   vertex 1 1 0\n  endloop\n endfacet\nfacet normal 0 0 1\nouter loop\n"
        "vertex 0 0 0\nvertex 1 1 0\nvertex 0 1e0 0\nendloop\nendfacet\nendsolid\n";
    std::string binary = "solid, as some binary files begin";
    binary.resize(80);
    binary += std::string("\2\0\0\0", 4);
    const float corners[2][9] = {{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0}};
    for (const auto& facet : corners) {
        binary += std::string(12, '\0');
        binary.append(reinterpret_cast<const char*>(facet), sizeof facet);
        binary += std::string(2, '\0');
    }
    std::string capitals = text;
    for (char& c : capitals) c = c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
    for (const char* name : {"a.stl", "a.obj", "a.bin"})
        for (const std::string& bytes : {text, capitals, binary}) {
            const Model model = readPly(folder, bytes, name);
            CHECK(areaUp(model) == 1);
            CHECK(model.warnings.empty());
            BakeOptions options;
            options.resolution = 64;
            const Baked baked = bakeOrFail(model, options);
            CHECK(baked.surface.charts.size() == 1);  // the triangles are one sheet
        }
    CHECK(folder.refusal("a.stl", text.substr(0, 60)).find("holds no facets") != std::string::npos);
    CHECK(folder.refusal("a.stl", "solid\nfacet\nouter loop\nvertex 0 0 x\n").find("a.stl:4") != std::string::npos);
    CHECK(folder.refusal("a.stl", "solid\nfacet\nouter loop\nvertex 0 0 nan\nvertex 1 0 0\nvertex 1 1 0\nendloop\n")
              .find("facet 0") != std::string::npos);
    CHECK(warns(readPly(folder, text + "outer loop\nvertex 0 0 0\nendloop\n", "a.stl"), "fewer than 3 corners"));
    CHECK(folder.refusal("a.stl", binary.substr(0, 120)).find("a.stl: ") != std::string::npos);
}
