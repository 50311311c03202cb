// espalier-bake as a user runs it: exit codes, messages, files.
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "runtime/core/file.hpp"
#include "runtime/emit/terminals.hpp"
#include "tests/bake/small_models.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

struct Runner {
    std::filesystem::path folder;
    std::string output;  // of the last run, both streams

    Runner() : folder(std::filesystem::temp_directory_path() / ("espalier_program_" + std::to_string(long(this)))) {
        std::filesystem::create_directories(folder);
        BakeOptions options;
        options.resolution = 64;
        auto baked = bake(cube(2), options);
        REQUIRE(baked);
        REQUIRE(writeSurface(baked->surface, file("cube.glb")));  // a valid glTF like any other
    }
    ~Runner() {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    std::string file(const char* name) const { return (folder / name).string(); }
    bool has(const char* name) const { return std::filesystem::exists(folder / name); }
    bool says(const char* text) const { return output.find(text) != std::string::npos; }

    // The exit code; above 128 where a signal ended it.
    int run(const std::string& arguments) {
        std::string log = file("log.txt");
        std::string command =
            "cd '" + folder.string() + "' && '" ESPALIER_BAKE_PROGRAM "' " + arguments + " > '" + log + "' 2>&1";
        const int status = std::system(command.c_str());
        auto text = readTextFile(log);
        output = text ? *text : "";
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    // Of a PNG, as its first bytes state it: width and height.
    std::pair<uint32_t, uint32_t> sizeOf(const std::string& name) const {
        auto bytes = readFile(folder / name);
        REQUIRE(bytes);
        REQUIRE(bytes->size() > 24);
        auto number = [&](size_t at) {
            uint32_t n = 0;
            for (size_t i = 0; i < 4; ++i) n = n << 8 | uint32_t((*bytes)[at + i]);
            return n;
        };
        return {number(16), number(20)};
    }
};

// A cube of so many squares along an edge, a side so long, as the text of a file.
std::string objOfCube(int squares, glm::vec3 size, glm::vec3 middle) {
    const Model model = cube(squares);
    std::string text;
    for (const glm::vec3& p : model.positions) {
        const glm::vec3 at = middle + p * size * .5f;
        text += "v " + std::to_string(at.x) + " " + std::to_string(at.y) + " " + std::to_string(at.z) + "\n";
    }
    for (size_t i = 0; i < model.indices.size(); ++i)
        text += (i % 3 == 0 ? "\nf " : " ") + std::to_string(model.indices[i] + 1);
    return text + "\n";
}

}  // namespace

TEST_CASE("espalier-bake writes surface, report and pictures") {
    Runner r;
    CAPTURE(r.output);
    REQUIRE(
        r.run("cube.glb -o out/surface.glb --resolution 128 --levels 2 --report out/r.json --images out/pictures") ==
        0);
    auto surface = readSurface(r.file("out/surface.glb"));
    if (!surface) FAIL(surface.failure().text());
    CHECK(surface->levels.size() == 2);
    CHECK(surface->levels[0].size == 128);
    CHECK(surface->source == "cube.glb");
    for (const char* picture : {"charts.png", "links.png", "contacts.png", "stretch.png"})
        CHECK(r.sizeOf(std::string("out/pictures/") + picture) == std::pair(128u, 128u));
    auto text = readTextFile(r.file("out/r.json"));
    REQUIRE(text);
    auto report = nlohmann::json::parse(*text, nullptr, false);
    REQUIRE(report.is_object());
    CHECK(report["charts"] == 6);
    CHECK(report["texels"]["inner"].get<int>() > 1000);
    CHECK(report["crossings"]["seam"] == 48);
    CHECK(report["crossings"]["dangling"] == 0);
    CHECK(report["walkable_area"].get<double>() == doctest::Approx(24).epsilon(0.001));
    for (const char* key : {"p50", "p95", "max"}) CHECK(report["stretch"].contains(key));
    for (const char* key : {"p50", "p999"}) CHECK(report["round_trip_texels"].contains(key));
    CHECK(report["gap_texels"].contains("p999"));
    CHECK(report["seconds"].is_object());
    CHECK(report["warnings"].is_array());
    CHECK(r.says("100 %"));
    // Where there is room for words, a legend stands below.
    REQUIRE(r.run("cube.glb -o out/surface.glb --resolution 512 --levels 1 --images out/pictures") == 0);
    for (const char* picture : {"charts.png", "links.png", "contacts.png", "stretch.png"}) {
        CHECK(r.sizeOf(std::string("out/pictures/") + picture).first == 512);
        CHECK(r.sizeOf(std::string("out/pictures/") + picture).second >= 512 + 30);
    }
}

TEST_CASE("layers painted over an earlier surface are carried to the new one, and what is lost is told") {
    Runner r;
    CAPTURE(r.output);
    REQUIRE(r.run("cube.glb -o old/s.glb --resolution 64 --images old") == 0);  // any picture will do as a layer
    CHECK(r.run("cube.glb -o new/s.glb --resolution 128 --from old/s.glb --layer old/charts.png --report new/r.json") ==
          0);
    CHECK(r.says("old/charts.png: carried: 0 m² of new ground"));
    CHECK(r.has("new/charts.png"));
    CHECK(r.run("cube.glb -o old/t.glb --from old/s.glb --layer old/charts.png") == 1);
    CHECK(r.says("would overwrite"));
    CHECK(r.run("cube.glb -o new/t.glb --from cube.glb --layer log.txt") == 1);
    CHECK(r.says("log.txt: "));
    CHECK(!r.has("new/t.glb"));
    // Nothing of a bake stays whose surface has no place, and what it would have replaced does.
    std::filesystem::create_directories(r.folder / "taken/s.glb");
    const std::string bakes = "cube.glb -o taken/s.glb --resolution 64 --from old/s.glb --report taken/r.json --layer ";
    REQUIRE(writeFile(r.file("taken/links.png"), "what was there"));
    CHECK(r.run(bakes + "old/charts.png --layer old/links.png") == 1);
    CHECK(r.says("taken/s.glb"));
    CHECK(!r.has("taken/charts.png"));
    CHECK(!r.has("taken/r.json"));
    CHECK(readTextFile(r.file("taken/links.png")).value() == "what was there");
    CHECK(r.run("cube.glb -o new/u.glb --from old/s.glb --layer old/charts.png --layer taken/../old/charts.png") == 1);
    CHECK(r.says("two carried layers have this name"));
}

TEST_CASE("seeds whose ground a change takes away are listed, by scenes of one surface and of several") {
    Runner r;
    CAPTURE(r.output);
    Model higher = cube(2);
    for (glm::vec3& p : higher.positions) p.y += p.y > 0.5f ? 1.0f : 0.0f;  // the top goes from 1 to 2
    BakeOptions options;
    options.resolution = 64;
    auto baked = bake(higher, options);
    REQUIRE(baked);
    REQUIRE(writeSurface(baked->surface, r.file("higher.glb")));
    auto write = [&](const char* name, const std::string& text) { REQUIRE(writeFile(r.file(name), text)); };
    const std::string seeds = R"({"file": "ivy.grammar", "seeds": [{"position": )";
    write("one.json",
          R"({"surface": "cube.glb", "grammars": [)" + seeds + R"([1.02, 0, 0]}, {"position": [0, 1, 0]}]}]})");
    REQUIRE(r.run("higher.glb -o new/cube.glb --resolution 64 --from cube.glb --seeds one.json") == 0);
    CHECK(r.says("grammars[0].seeds[1] at 0, 1, 0 has lost its ground"));
    CHECK(!r.says("seeds[0]"));
    CHECK(r.says("one.json: warning: 1 of 2 seeds"));
    REQUIRE(r.run("cube.glb -o new/same.glb --resolution 64 --from cube.glb --seeds one.json") == 0);
    CHECK(r.says("one.json: all 2 seeds on this surface keep their ground"));
    CHECK(!r.says("warning: "));
    // Turned by 90° and twice as large, the side towards +x looks to -z; the third seed is of the other surface.
    write("two.json",
          R"({"surfaces": [{"file": "other.glb"}, {"file": "cube.glb", "position": [9, 0, 0], "turn": 90, "scale": 2}],
                          "grammars": [)" +
              seeds + R"([9, 2, 0]}, {"position": [9.5, 0.5, -2]}, {"position": [0, 1, 0]}]}]})");
    REQUIRE(r.run("higher.glb -o new/cube.glb --resolution 64 --from cube.glb --seeds two.json") == 0);
    CHECK(r.says("grammars[0].seeds[0] at 9, 2, 0 has lost its ground"));
    CHECK(r.says("1 of 2 seeds"));
    const std::string deep = R"({"surface": "cube.glb", "grammars": )" + std::string(1'000'000, '[');
    const std::string nested = deep + std::string(1'000'000, ']') + "}";
    for (const char* wrong : {nested.c_str(), "[]", "{",
                              R"({"surface": "cube.glb", "grammars": [)"
                              R"({"seeds": [{"position": [1, 2]}]}]})",
                              R"({"surfaces": [{"file": "cube.glb", "scale": 0}]})", R"({"surfaces": [7, 7]})"}) {
        write("wrong.json", wrong);
        CHECK(r.run("higher.glb -o bad/cube.glb --from cube.glb --seeds wrong.json") == 1);
        CHECK(r.says("wrong.json"));
        CHECK(!r.has("bad/cube.glb"));
    }
    CHECK(r.run("higher.glb -o bad/cube.glb --from cube.glb") == 2);
    CHECK(r.says("--seeds"));
}

TEST_CASE("--help and --version answer; mistakes end with a message, a code and no files") {
    Runner r;
    CHECK(r.run("--help") == 0);
    CHECK(r.says("--resolution"));
    CHECK(r.run("--version") == 0);
    CHECK(r.says("espalier-bake"));
    CHECK(r.run("") == 2);
    CHECK(r.run("cube.glb") == 2);
    CHECK(r.run("cube.glb -o s.glb --resolution 100 --report r.json") == 2);
    CHECK(r.says("resolution"));
    CHECK(r.run("cube.glb -o s.glb --scene 5 --report r.json") == 1);
    CHECK(r.says("scene 5 does not exist"));
    for (const char* tolerance : {"nan", "1e300", "-1"})
        CHECK(r.run("cube.glb -o s.glb --report r.json --tolerance " + std::string(tolerance)) == 2);
    CHECK(r.run("cube.glb -o s.glb --report cube.glb") == 2);
    CHECK(r.run("cube.glb -o s.glb --report ./s.glb") == 2);
    CHECK(r.says("would overwrite"));
    CHECK(r.run("missing.glb -o s.glb --report r.json") == 1);
    CHECK(r.says("missing.glb"));
    CHECK(r.run("cube.glb -o cube.glb") == 2);
    CHECK(r.run("cube.glb -o cube.glb/s.glb --report r.json") == 1);
    CHECK(r.says("cube.glb/s.glb"));
    REQUIRE(writeFile(r.file("bad.glb"), std::string_view("glTF and no more")));
    CHECK(r.run("bad.glb -o s.glb --report r.json") == 1);
    CHECK(r.says("bad.glb"));
    CHECK(!r.has("s.glb"));
    CHECK(!r.has("r.json"));
    CHECK(readSurface(r.file("cube.glb")));
}

TEST_CASE("--pieces makes a palette of a folder: each model by its name, of size 1, with coarser levels") {
    Runner r;
    std::filesystem::create_directories(r.folder / "models");
    REQUIRE(writeFile(r.file("models/old box.obj"), objOfCube(16, {3, 2, 3}, {5, -1, 0})));
    REQUIRE(writeFile(r.file("models/7.obj"), objOfCube(1, {1, 4, .5f}, {0, 0, 0})));
    REQUIRE(r.run("models -o palette.glb --pieces") == 0);
    CAPTURE(r.output);
    CHECK(r.says("oldbox: "));
    CHECK(r.says("piece7: 12 triangles, 1 levels"));
    auto bytes = readFile(r.folder / "palette.glb");
    REQUIRE(bytes);
    auto palette = parseTerminals(*bytes, "palette.glb", {"none"});
    if (!palette) FAIL(palette.failure().text());
    const auto sizeOf = [&](const char* name) {
        const auto kind = std::find(palette->kinds.begin(), palette->kinds.end(), name);
        REQUIRE(kind != palette->kinds.end());
        glm::vec3 low(9), high(-9);
        for (const TerminalVariant& variant : palette->variants)
            if (variant.kind == uint32_t(kind - palette->kinds.begin()))
                for (uint32_t i = 0; i < variant.lods[0].indexCount; ++i) {
                    const TerminalLod& lod = variant.lods[0];
                    const glm::vec3 p =
                        palette->vertices[lod.firstVertex + palette->indices[lod.firstIndex + i]].position;
                    low = glm::min(low, p), high = glm::max(high, p);
                }
        return std::pair(low, high);
    };
    const auto near = [](glm::vec3 a, glm::vec3 b) { return glm::length(a - b) < .01f; };
    CHECK(near(sizeOf("oldbox").first, {-.5f, 0, -.5f}));
    CHECK(near(sizeOf("oldbox").second, {.5f, 2 / 3.f, .5f}));
    CHECK(near(sizeOf("piece7").second, {.5f, 4, .25f}));
    CHECK(r.run("models -o palette.glb --pieces --quiet") == 0);
    CHECK(r.output.empty());
    CHECK(r.run("models/7.obj -o models/7.obj --pieces") == 2);
    REQUIRE(writeFile(r.file("models/bad.obj"), std::string_view("v 0 0 0\n")));
    CHECK(r.run("models -o other.glb --pieces") == 1);
    CHECK(r.says("bad.obj"));
    CHECK(!r.has("other.glb"));
}

TEST_CASE("--terminal makes a leaf of a model: its stalk at the origin, 1 long along +Y, looking along +Z") {
    Runner r;
    const auto leafOf = [&](const char* name) {
        auto bytes = readFile(r.folder / name);
        REQUIRE(bytes);
        auto mesh = parseTerminals(*bytes, name, {"none"});
        if (!mesh) FAIL(mesh.failure().text());
        REQUIRE(mesh->variants.size() == 1);
        glm::vec3 low(9), high(-9), normal(0);
        const TerminalLod& lod = mesh->variants[0].lods[0];
        for (uint32_t i = 0; i < lod.indexCount; i += 3) {
            glm::vec3 p[3];
            for (uint32_t k = 0; k < 3; ++k) {
                p[k] = mesh->vertices[lod.firstVertex + mesh->indices[lod.firstIndex + i + k]].position;
                low = glm::min(low, p[k]), high = glm::max(high, p[k]);
            }
            normal += glm::cross(p[1] - p[0], p[2] - p[0]);
        }
        CHECK(low.y == doctest::Approx(0));
        CHECK(high.y == doctest::Approx(1));
        CHECK(high.x == doctest::Approx(.25));
        CHECK(low.x == doctest::Approx(-.25));
        CHECK(normal.z > 0);
    };
    // Lying on the ground with its tip at the back; standing; standing and looking to the right.
    const char* const leaves[] = {"v 5 1 9\nv 6 1 9\nv 6 1 7\nv 5 1 7\nf 1 2 3 4\n",
                                  "v 5 1 9\nv 6 1 9\nv 6 3 9\nv 5 3 9\nf 1 2 3 4\n",
                                  "v 5 1 9\nv 5 1 8\nv 5 3 8\nv 5 3 9\nf 1 2 3 4\n"};
    for (const char* leaf : leaves) {
        CAPTURE(leaf);
        REQUIRE(writeFile(r.file("leaf.obj"), std::string_view(leaf)));
        REQUIRE(r.run("leaf.obj -o leaf.terminal.glb --terminal") == 0);
        CHECK(r.says("terminal: 2 triangles, 1 levels"));
        leafOf("leaf.terminal.glb");
    }
    CHECK(r.run("leaf.obj -o leaf.obj --terminal") == 2);
    CHECK(r.run("leaf.obj -o x.glb --terminal --pieces") == 2);
    REQUIRE(writeFile(r.file("bad.obj"), std::string_view("v 0 0 0\n")));
    CHECK(r.run("bad.obj -o x.glb --terminal") == 1);
    CHECK(r.says("bad.obj"));
    CHECK(!r.has("x.glb"));
}

TEST_CASE("what isn't for a model, a folder or a town is refused by its name, and nothing is made") {
    Runner r;
    std::filesystem::create_directories(r.folder / "models");
    std::filesystem::copy_file(r.folder / "cube.glb", r.folder / "models/cube.glb");
    REQUIRE(writeFile(r.file("plan.json"), std::string_view(R"({"buildings": [{"id": "a", "outer": )"
                                                            R"([[0, 0], [9, 0], [9, 9], [0, 9]]}]})")));
    REQUIRE(writeFile(r.file("square.obj"), std::string_view("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")));
    const std::vector<const char*> ofModel{
        "--report r.json",   "--images out", "--from cube.glb --layer log.txt", "--from cube.glb --seeds log.txt",
        "--weights log.txt", "--terminal"},
        ofModels{"--resolution 64", "--levels 1", "--tolerance 0", "--uv-set 0",
                 "--scene 0",       "--bare a",   "--ground a",    "--keep-layout"},
        ofFolder{"--jobs 1", "--shard 1/1"},
        ofTown{"--grammar a.grammar", "--grammar a --walls", "--grammar a --meshes a", "--house a"};
    const auto refuses = [&](const char* input, const char* kind, const std::vector<const char*>& options) {
        for (const char* option : options) {
            CAPTURE(option);
            CHECK(r.run(std::string(input) + " -o out " + option) == 2);
            CAPTURE(r.output);
            const std::string name = std::string(option).substr(0, std::string_view(option).find(' '));
            CHECK(r.says((name + ": is not for " + kind + ", ").c_str()));
            CHECK(!r.has("out"));
        }
    };
    refuses("cube.glb", "a model", ofFolder);
    refuses("cube.glb", "a model", ofTown);
    refuses("models", "a folder of models", ofModel);
    refuses("models", "a folder of models", ofTown);
    refuses("plan.json", "a town", ofModel);
    refuses("plan.json", "a town", ofModels);
    refuses("plan.json", "a town", ofFolder);
    for (const char* wrong : {"plan.json --walls", "plan.json --meshes a", "cube.glb --weights log.txt --keep-layout",
                              "cube.glb --resolution 64 --levels 5", "cube.glb --resolution 16384",
                              "square.obj --scene 0", "square.obj --uv-set 0"}) {
        CAPTURE(wrong);
        CHECK(r.run(std::string(wrong) + " -o out") == 2);
        CHECK(!r.has("out"));
    }
    CHECK(r.says("is of glTF models"));
    CHECK(r.run("plan.json -o out --house a -q") == 0);
    CHECK(r.has("out"));
}
