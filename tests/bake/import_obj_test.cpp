// OBJ files as people have them: blemishes, names, libraries, options of textures, colours.
#include <doctest/doctest.h>

#include <cmath>

#include "runtime/core/srgb.hpp"
#include "tests/bake/gltf_maker.hpp"
#include "tests/bake/model_folder.hpp"
#include "tests/bake/small_pictures.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

const std::string kUvSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";
const std::string kSquareFace = "f 1/1/1 2/2/1 3/3/1 4/4/1\n";

Model readObj(const ModelFolder& folder, const std::string& text, const std::string& name = "a.obj") {
    return folder.read(name, text);
}

}  // namespace

TEST_CASE("OBJ: what a model can do without is a warning with its line") {
    ModelFolder folder;
    struct Case {
        std::string text, warning;
    };
    for (const Case& c :
         {Case{kUvSquare + "vn nan nan nan\n" + kSquareFace + "f 1/1/2 2/2/2 3/3/2\n", "a.obj:10: warning"},
          {kUvSquare + "vn 0 0 0\n" + kSquareFace, "a.obj:10: warning: a normal that is no direction"},
          {kUvSquare + "vt nan nan\n" + kSquareFace + "f 1/5 2/5 3/5\n", "a.obj:10: warning"},
          {kUvSquare + "vt x\n" + kSquareFace, "a texture coordinate that is no number"},
          {kUvSquare + "v nan nan nan\n" + kSquareFace, "a.obj:10: warning: a vertex without three numbers"},
          {kUvSquare + "v\n" + kSquareFace, "named by no face"},
          {kUvSquare + "f 1/0/0 2/2/1 3/3/1 4/4/1\n", "a normal that does not exist"},
          {kUvSquare + "f 1/9/-7 2/2/1 3/3/1 4/4/1\n", "a texture coordinate that does not exist"},
          {kUvSquare + kSquareFace + "f 1\nf 1 2\nf\n", "a.obj:11: warning: a face of fewer than 3 corners"},
          {kUvSquare + kSquareFace + "l 1 2\np 3\n", "a.obj:11: warning: points, lines"}}) {
        CAPTURE(c.text);
        const Model model = readObj(folder, c.text);
        CHECK(triangleArea(model) >= 1);
        CHECK(warns(model, c.warning));
        BakeOptions options;
        options.resolution = 64;
        CHECK(bake(model, options));
    }
    CHECK(warns(readObj(folder, kUvSquare + kSquareFace + "f 1\nf 1 2\nf\n"), "(3 times)"));
    // One bad normal costs no other.
    const Model model = readObj(folder, kUvSquare + "vn nan 0 0\nf 1/1/2 2/2/1 3/3/1 4/4/1\n");
    CHECK(model.normals[0] == glm::vec3(0));
    CHECK(model.normals[1] == glm::vec3(0, 0, 1));
}

TEST_CASE("OBJ: lines end in any way, and may begin with a byte order mark") {
    ModelFolder folder;
    for (const char* end : {"\n", "\r\n", "\r"}) {
        std::string text = "\xEF\xBB\xBF";
        for (char c : kUvSquare + "# a comment\\\n" + "f 1/1/1 2/2/1 \\\n3/3/1\t4/4/1 # the rest\n")
            text += c == '\n' ? std::string(end) : std::string(1, c);
        const Model model = readObj(folder, text);
        CHECK(triangleArea(model) == 1);
        CHECK(model.warnings.empty());
        folder.put("bad.obj", text + "f 1 2 9" + end);
        CHECK(messageOf(importModel(folder.file("bad.obj"))).find("bad.obj:13: vertex 9") != std::string::npos);
    }
    CHECK(triangleArea(readObj(folder, kUvSquare + "f 1 2 3 4\\")) == 1);  // the last line goes on into nothing
}

TEST_CASE("OBJ: names of materials and libraries as programs write them") {
    ModelFolder folder;
    folder.put("one.mtl",
               "\xEF\xBB\xBFnewmtl Material #1\nKd 1 0 0\nnewmtl Material #2 \t\nKd 0 1 0\n"
               "newmtl \"in quotes\"\rKd 0 0 1\rnewmtl plain # a comment\nKd 0.5 0.5 0.5\n");
    folder.put("two words.mtl", "newmtl of two words\nKd 0 1 1\n");
    folder.put("two.mtl", "newmtl of two\nKd 1 1 0\n");
    for (const char* libraries :
         {"mtllib one.mtl two.mtl two words.mtl\n", "mtllib one.mtl\nmtllib two words.mtl\nmtllib two.mtl\n",
          "mtllib \"two words.mtl\" one.mtl \"two.mtl\"\n",
          "mtllib ./one.mtl\t\nmtllib two words.mtl # both\nmtllib TWO.MTL\r\n"}) {
        CAPTURE(libraries);
        const Model model =
            readObj(folder, libraries + kUvSquare + "usemtl Material #2\n" + kSquareFace + "usemtl Material #1 \n" +
                                kSquareFace + "usemtl in quotes\n" + kSquareFace + "usemtl plain\n" + kSquareFace +
                                "usemtl of two words\t\n" + kSquareFace + "usemtl \"of two\"\n" + kSquareFace);
        CHECK(model.warnings.empty());
        std::vector<glm::vec3> colours;
        for (size_t t = 0; t < model.triangleMaterial.size(); t += 2)
            colours.push_back(glm::vec3(model.materials[model.triangleMaterial[t]].baseColor));
        CHECK(colours ==
              std::vector<glm::vec3>{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, glm::vec3(0.5f), {0, 1, 1}, {1, 1, 0}});
    }
    const Model model =
        readObj(folder, "mtllib gone.mtl one.mtl\n" + kUvSquare + "usemtl nobody\n" + kSquareFace + kSquareFace);
    CHECK(warns(model, "gone.mtl"));
    CHECK(warns(model, "a.obj:11: warning: material 'nobody' is not defined"));
    CHECK(model.warnings.size() == 2);
    folder.put("wide.mtl", std::string_view("\xFF\xFEn\0e\0w\0m\0t\0l\0", 14));
    CHECK(warns(readObj(folder, "mtllib wide.mtl\n" + kUvSquare + kSquareFace),
                "a.obj:1: warning: materials left out: 'wide.mtl' is text in UTF-16"));
}

TEST_CASE("MTL: a texture's options are understood, also before names with blanks") {
    ModelFolder folder;
    folder.put("wall.png", greyPng(2, 255));
    folder.put("a wall.png", greyPng(2, 200));
    folder.put("-wall.png", greyPng(2, 100));
    struct Case {
        std::string statement;
        glm::vec4 uvs;  // of the square's corners: the least and the greatest
        uint8_t grey;
    };
    const glm::vec4 plain(0, 0, 1, 1);
    for (const Case& c : {Case{"wall.png", plain, 255},
                          {"\"a wall.png\" # the south side", plain, 200},
                          {"-s 4 3 1 wall.png", {0, -2, 4, 1}, 255},
                          {"-s 2 wall.png", {0, 0, 2, 1}, 255},
                          {"-o 0.5 0.25 0 a wall.png", {0.5f, -0.25f, 1.5f, 0.75f}, 200},
                          {"-s 2 2 2 -o 1 0 0 -clamp on -blendu off -blendv on -mm 0 1 -t 0 0 0 -texres 512 -imfchan r "
                           "-boost 2 -bm 1 -cc off -type sphere a wall.png",
                           {1, -1, 3, 1},
                           200},
                          {"-unheard 5 wall.png", plain, 255},
                          {"-wall.png", plain, 100},
                          {"WALL.PNG", plain, 255},
                          {"C:\\kit\\wall.png", plain, 255}}) {
        CAPTURE(c.statement);
        folder.put("a.mtl", "newmtl a\nMap_Kd " + c.statement + "\n");
        const Model model = readObj(folder, "mtllib a.mtl\n" + kUvSquare + "usemtl a\n" + kSquareFace);
        for (const Diagnostic& warning : model.warnings) MESSAGE(toString(warning));
        REQUIRE(model.images.size() == 1);
        CHECK(model.images[0].rgba[0] == c.grey);
        glm::vec2 low(1e9f), high(-1e9f);
        for (glm::vec2 uv : model.materialUvs.empty() ? model.uvs : model.materialUvs)
            low = glm::min(low, uv), high = glm::max(high, uv);
        CHECK(glm::vec4(low, high) == c.uvs);
        CHECK(model.warnings.empty());
        const bool clamped = c.statement.find("-clamp on") != std::string::npos;
        CHECK((model.materials[1].wrapU == Wrap::clamp && model.materials[1].wrapV == Wrap::clamp) == clamped);
    }
    // The walk's UVs stay, and a vertex of two materials becomes two where they scale unlike.
    folder.put("a.mtl", "newmtl a\nmap_Kd -s 2 2 wall.png\nnewmtl b\nmap_Kd wall.png\n");
    const Model model =
        readObj(folder, "mtllib a.mtl\n" + kUvSquare + "usemtl a\n" + kSquareFace + "usemtl b\n" + kSquareFace);
    CHECK(model.positions.size() == 8);
    CHECK(model.uvs[2] == glm::vec2(1, 0));
    CHECK(model.materialUvs[2] == glm::vec2(2, -1));
    CHECK(model.materialUvs[6] == glm::vec2(1, 0));
}

TEST_CASE("MTL: transparency, roughness, normal maps and cut-outs") {
    ModelFolder folder;
    folder.put("wall.png", greyPng(2, 255));
    folder.put("hole.png", greyPng(2, 64));
    folder.put("normals.png", rgbPng(2, {128, 127, 250}));
    const auto material = [&](const std::string& statements) {
        folder.put("a.mtl", "newmtl a\n" + statements);
        return readObj(folder, "mtllib a.mtl\n" + kUvSquare + "usemtl a\n" + kSquareFace);
    };
    CHECK(material("Tr 0.25\n").materials[1].baseColor.a == 0.75f);
    CHECK(material("Tr 0.25\n").materials[1].bare == false);  // a model that is transparent throughout
    CHECK(material("d 0.5\nTr 0.25\n").materials[1].baseColor.a == 0.5f);
    CHECK(material("Tr 1\n").materials[1].baseColor.a == 1);  // meant as d
    CHECK(material("Kd 0.5\n").materials[1].baseColor == glm::vec4(0.5f, 0.5f, 0.5f, 1));
    for (const char* key : {"norm", "bump", "map_Bump", "map_bump"}) {
        const Model model = material(key + std::string(" -bm 0.5 normals.png\n"));
        CHECK(model.materials[1].normalImage == 0);
        CHECK(model.materials[1].normalScale == 0.5f);
    }
    const Model heights = material("map_Bump wall.png\n");
    CHECK(heights.materials[1].normalImage == -1);
    CHECK(warns(heights, "a.mtl:2: warning: a bump map of heights"));

    for (const char* statements : {"map_d hole.png\nmap_Kd wall.png\n", "map_Kd wall.png\nmap_d hole.png\n"}) {
        const Model cut = material(statements);
        CHECK(cut.materials[1].alphaCutoff == 0.5f);
        const Picture& picture = cut.images[size_t(cut.materials[1].baseColorImage)];
        CHECK(picture.rgba[0] == 255);
        CHECK(picture.rgba[3] == 64);
        CHECK(picture.encoded.empty());
    }
    CHECK(material("map_Kd wall.png\nmap_d wall.png\n").images.size() == 1);
    CHECK(warns(material("map_Kd -s 2 2 wall.png\nmap_d hole.png\n"), "-s and -o differ"));
    // Pictures that are laid on otherwise are so relative to the colours.
    const Model scaled =
        material("norm normals.png\nmap_Kd -s 2 2 -o 0.5 0 wall.png\nKe 0 0 0\nmap_Ke -s 2 2 -o 0.5 0 wall.png\n");
    const Material& m = scaled.materials[1];
    CHECK(m.emissive == glm::vec3(1));
    CHECK(m.emissiveMap == TextureMap());
    for (size_t v = 0; v < scaled.uvs.size(); ++v) {
        const auto rows = rowsOf(m.normalMap);
        const glm::vec3 drawn(scaled.materialUvs[v], 1);
        CHECK(glm::vec2(glm::dot(rows[0], drawn), glm::dot(rows[1], drawn)) == scaled.uvs[v]);
    }
    CHECK(material("Ke 1 0.5 0\n").materials[1].emissive == glm::vec3(1, 0.5f, 0));
}

TEST_CASE("OBJ: libraries and pictures lie in folders of their own") {
    ModelFolder folder;
    folder.put("kit/materials/a.mtl",
               "newmtl a\nmap_Kd ..\\pictures\\wall.png\nnewmtl b\nmap_Kd near.png\n"
               "newmtl c\nmap_Kd beside.png\nnewmtl d\nmap_Kd ../../../secret.png\n");
    folder.put("kit/pictures/wall.png", greyPng(2, 10));
    folder.put("kit/materials/near.png", greyPng(2, 20));
    folder.put("kit/models/beside.png", greyPng(2, 30));
    const Model model = readObj(folder, "mtllib ../materials/a.mtl\n" + kUvSquare + kSquareFace, "kit/models/a.obj");
    REQUIRE(model.images.size() == 3);
    for (size_t i = 0; i < 3; ++i) CHECK(model.images[i].rgba[0] == 10 * (i + 1));
    REQUIRE(model.warnings.size() == 1);
    CHECK(warns(model, "2 folders above"));
}

TEST_CASE("OBJ: vertices have colours, from 0 to 1 or to 255") {
    ModelFolder folder;
    for (const char* red : {"1 0.5 0", "255 127.5 0"}) {
        const Model model =
            readObj(folder, std::string("v 0 0 0 ") + red + "\nv 1 0 0 " + red + "\nv 1 1 0\nf 1 2 3\n");
        REQUIRE(model.colours.size() == 3);
        CHECK(model.colours[0].r == 1);
        CHECK(model.colours[0].a == 1);
        CHECK(model.colours[0].g == doctest::Approx(linearOfSrgb(0.5f)));
        CHECK(model.colours[2] == glm::vec4(1));
    }
    CHECK(readObj(folder, "v 0 0 0 1\nv 1 0 0 1\nv 1 1 0 1\nf 1 2 3\n").colours.empty());              // weights
    CHECK(readObj(folder, "v 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 1 1 0 1 1 1\nf 1 2 3\n").colours.empty());  // white
    CHECK(readObj(folder, "v 0 0 0 # 1 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n").colours.empty());
    CHECK(readObj(folder, "v 0 0 0 nan 0 0\nv 1 0 0 0 0 0\nv 1 1 0\nf 1 2 3\n").colours[0] == glm::vec4(1));
}
