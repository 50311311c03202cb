// A file is what its bytes say; what can't be read is named. And what the program assimp reads.
#include <doctest/doctest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>

#include "tests/bake/model_folder.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

const std::string kPlainSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

// While one lives, programs are looked for in `folders` alone.
class OnlyPath {
  public:
    explicit OnlyPath(const std::string& folders) : before_(::getenv("PATH") ? ::getenv("PATH") : "") {
        ::setenv("PATH", folders.c_str(), 1);
    }
    ~OnlyPath() { ::setenv("PATH", before_.c_str(), 1); }

  private:
    std::string before_;
};

// A program of that name that does what the lines of a shell script say.
void putProgram(const ModelFolder& folder, const std::string& lines) {
    REQUIRE(writeFile(folder.file("assimp"), "#!/bin/sh\n" + lines));
    REQUIRE(::chmod(folder.file("assimp").c_str(), 0700) == 0);
}

}  // namespace

TEST_CASE("files of another kind are named, with what to do") {
    using namespace std::string_view_literals;
    ModelFolder folder;
    const OnlyPath nothing(folder.path.string());
    struct Case {
        std::string_view bytes, kind, advice;
    };
    std::string tar(300, '\0');
    tar.replace(257, 5, "ustar");
    for (const Case& c :
         {Case{"Kaydara FBX Binary  \0\x1A\0"sv, "FBX", "assimp-utils"},
          {"; FBX 7.4.0 project file\n"sv, "FBX", "assimp-utils"},
          {"<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"x\">"sv, "COLLADA", "assimp-utils"},
          {"BLENDER-v300"sv, "Blender", "glTF"},
          {"PXR-USDC\0\0"sv, "USD", "glTF"},
          {"#usda 1.0\n"sv, "USD", "glTF"},
          {"PK\3\4\x14\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x0A\0\0\0model.usdc"sv, "USD", "glTF"},
          {"PK\3\4\x14\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x09\0\0\0model.obj"sv, "ZIP", "unpack"},
          {"ISO-10303-21;\nHEADER;"sv, "STEP", "glTF"},
          {"7z\xBC\xAF\x27\x1C\0\4"sv, "7z", "unpack"},
          {tar, "tar", "unpack"},
          {"\x89PNG\r\n\x1A\n"sv, "PNG", "no model"},
          {"<!DOCTYPE html><html>"sv, "web page", "download"},
          {"version https://git-lfs.github.com/spec/v1\n"sv, "Git LFS", "git lfs pull"},
          {"\xFF\xFEv\0 \0"sv, "UTF-16", "UTF-8"},
          {"glTF\1\0\0\0\x14\0\0\0"sv, "glTF 1.0", "2.0"},
          {""sv, "empty", ""}})
        for (const char* name : {"a.glb", "a.obj", "a.ply", "a.stl", "a"}) {
            const std::string said = folder.refusal(name, c.bytes);
            CAPTURE(said);
            CHECK(said.starts_with(folder.file(name)));
            CHECK(said.find(c.kind) != std::string::npos);
            CHECK(said.find(c.advice) != std::string::npos);
        }
    CHECK(folder.refusal("a.obj", "\x1F\x8B\x08\0\0\0\0\0").find("gzip") != std::string::npos);
    CHECK(folder.refusal("a.txt", "hello").find("neither glTF") != std::string::npos);
    CHECK(folder.refusal("renamed.txt", kPlainSquare) == "imported");
    CHECK(folder.refusal("renamed.glb", kPlainSquare) == "imported");
}

TEST_CASE("the program assimp is asked for other kinds, and may fail in any way") {
    ModelFolder folder;
    const std::string fbx = "; FBX 7.4.0 project file\n";
    const OnlyPath only(folder.path.string() + ":/usr/bin:/bin");
    // It is given a copy that is named after its kind, and its result's pictures are beside the model.
    putProgram(folder,
               "[ \"$1\" = export ] && [ \"$(head -c 5 \"$2\")\" = '; FBX' ] || exit 9\n"
               "case \"$2\" in *.fbx) cp '" +
                   folder.file("there.gltf") + "' \"$3\";; *) exit 8;; esac\n");
    folder.put("there.gltf", R"({"asset":{"version":"2.0"},"scene":0,
        "scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
        "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{"source":0}],
        "images":[{"uri":"gone.png"}],"buffers":[{"byteLength":36,
        "uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}]})");
    folder.put("a.glb", fbx);
    std::vector<InputFile> inputs;
    ImportOptions options;
    options.inputs = &inputs;
    auto model = importModel(folder.file("a.glb"), options);
    if (!model) FAIL(model.failure().text());
    CHECK(model->indices.size() == 3);
    REQUIRE(model->warnings.size() == 2);
    CHECK(toString(model->warnings[0]).find("the program assimp has converted it") != std::string::npos);
    CHECK(toString(model->warnings[1]).find(folder.file("gone.png")) != std::string::npos);
    // What is remembered of the model depends on the program.
    CHECK(std::ranges::any_of(inputs, [&](const InputFile& f) { return f.path == folder.file("assimp") && f.hash; }));

    for (auto [lines, why] :
         {std::pair<std::string, std::string>{"echo 'ERROR: Failed to load file: torn'\nexit 3\n", "torn"},
          {"exit 3\n", "code 3"},
          {"kill -SEGV $$\n", "Segmentation fault"},
          {"exit 0\n", "nothing usable"},
          {"echo '{}' > \"$3\"\n", "not glTF 2.0"}}) {
        CAPTURE(lines);
        putProgram(folder, lines);
        const std::string said = folder.refusal("a.glb", fbx);
        CAPTURE(said);
        CHECK(said.find(why) != std::string::npos);
    }
    // Nothing is left behind.
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::temp_directory_path()))
        CHECK(entry.path().filename().string().find("espalier-convert") == std::string::npos);
}

TEST_CASE("COLLADA and FBX are read where the program assimp is installed") {
    ModelFolder folder;
    if (std::system("command -v assimp > /dev/null") != 0) {
        MESSAGE("skipped: the program assimp is not installed (Debian: assimp-utils)");
        return;
    }
    folder.put("square.obj", kPlainSquare);
    for (std::string format : {"collada", "fbxa", "x"}) {
        CAPTURE(format);
        const std::string model = folder.file("model.bin"), made = folder.file("made." + format);
        REQUIRE(std::system(("assimp export '" + folder.file("square.obj") + "' '" + made + "' -f" + format +
                             " > /dev/null 2>&1")
                                .c_str()) == 0);
        std::filesystem::rename(made, model);
        auto read = importModel(model);
        if (!read) FAIL(read.failure().text());
        glm::vec3 low(1e9f), high(-1e9f);
        for (uint32_t i : read->indices)
            low = glm::min(low, read->positions[i]), high = glm::max(high, read->positions[i]);
        // FBX counts centimetres unless it says otherwise.
        CHECK(high.x - low.x == doctest::Approx(format == "fbxa" ? 0.01 : 1));
    }
}
