// Keys of scene files: what is read is written as it was, and what is wrong is refused with its place.
#include <doctest/doctest.h>

#include <fstream>

#include "tests/support/scratch_folder.hpp"
#include "tools/scene/scene_file.hpp"

using namespace espalier::scene;
using espalier::test::ScratchFolder;

namespace {

std::string sceneWith(const std::string& more, const std::string& field = "") {
    return "{\"surfaces\": [{\"file\": \"a.glb\"" + field +
           "}],\n \"grammars\": [{\"file\": \"a.grammar\", \"seeds\": []}]" + more + "}\n";
}

struct Read {
    SceneFile file;
    std::string error;
    bool read = false;

    Read(const ScratchFolder& folder, const std::string& text) {
        const std::string path = folder.file("scene.json");
        std::ofstream(path) << text;
        read = readSceneFile(path, file, error);
    }
};

}  // namespace

TEST_CASE("a scene may hold graphs alone, and is written as it was read") {
    const ScratchFolder folder;
    const Read scene(folder, "{\"graphs\": [\"a.graph\", \"b.graph\"]}\n");
    REQUIRE_MESSAGE(scene.read, scene.error);
    REQUIRE(scene.file.graphs.size() == 2);
    CHECK(scene.file.graphs[1].file.ends_with("b.graph"));
    const Read again(folder, writeSceneText(folder.file("scene.json"), scene.file));
    REQUIRE_MESSAGE(again.read, again.error);
    CHECK(again.file.graphs == scene.file.graphs);
    for (const char* wrong : {"{\"graphs\": []}", "{\"graphs\": \"a.graph\"}", "{\"graphs\": [3]}"})
        CHECK_FALSE(Read(folder, wrong).read);
}

TEST_CASE("wind, palettes and exact fields are read, and written as they were read") {
    const ScratchFolder folder;
    const Read scene(folder,
                     sceneWith(",\n \"wind\": {\"velocity\": [3, 0, -1.5], \"gusts\": 0.25}, \"pieces\": \"p.glb\"",
                               ", \"fields\": {\"flow\": {\"exact\": true, \"elements\": []}}"));
    REQUIRE_MESSAGE(scene.read, scene.error);
    const auto check = [](const SceneFile& file) {
        REQUIRE(file.wind);
        CHECK(*file.wind == std::array<float, 3>{3, 0, -1.5f});
        CHECK(file.gusts == .25f);
        CHECK(file.pieces.ends_with("p.glb"));
        REQUIRE(file.surfaces[0].fields.size() == 1);
        CHECK(file.surfaces[0].fields[0].exact);
    };
    check(scene.file);
    const Read again(folder, writeSceneText(folder.file("scene.json"), scene.file));
    REQUIRE_MESSAGE(again.read, again.error);
    check(again.file);
    EspLook look{};
    again.file.applyLook(look);
    CHECK(look.wind[0] == 3);
    CHECK(look.wind[2] == -1.5f);
    CHECK(look.gusts == .25f);
}

TEST_CASE("a studio's floor is read and written; without a kind the ground is a meadow") {
    const ScratchFolder folder;
    const Read studio(folder, sceneWith(",\n \"ground\": {\"level\": 2, \"kind\": \"studio\"}"));
    REQUIRE_MESSAGE(studio.read, studio.error);
    const Read again(folder, writeSceneText(folder.file("scene.json"), studio.file));
    REQUIRE_MESSAGE(again.read, again.error);
    const Read meadow(folder, sceneWith(",\n \"ground\": {\"level\": 2}"));
    const Read none(folder, sceneWith(""));
    const auto groundOf = [](const Read& scene) {
        EspLook look{};
        scene.file.applyLook(look);
        return look.ground;
    };
    CHECK(groundOf(studio) == ESP_GROUND_STUDIO);
    CHECK(groundOf(again) == ESP_GROUND_STUDIO);
    CHECK(groundOf(meadow) == ESP_GROUND_MEADOW);
    CHECK(groundOf(none) == ESP_GROUND_NONE);
}

TEST_CASE("mistakes in them are refused by line and key") {
    const ScratchFolder folder;
    const std::pair<std::string, const char*> wrong[] = {
        {sceneWith(",\n \"wind\": [1, 2, 3]"), ":3:"},
        {sceneWith(",\n \"wind\": {\"velocity\": [1, 2]}"), "velocity"},
        {sceneWith(",\n \"wind\": {\"gusts\": 2}"), "gusts"},
        {sceneWith(",\n \"wind\": {\"speed\": 2}"), "speed"},
        {sceneWith(",\n \"pieces\": 7"), ":3:"},
        {sceneWith(",\n \"ground\": {\"level\": 0, \"kind\": \"sea\"}"), "studio"},
        {sceneWith(",\n \"ground\": {\"level\": 0, \"kind\": \"none\"}"), "studio"},
        {sceneWith(",\n \"ground\": {\"level\": 0, \"kind\": 1}"), ":3:"},
        {sceneWith("", ", \"fields\": {\"f\": {\"exact\": 1}}"), "exact"}};
    for (const auto& [text, why] : wrong) {
        const Read scene(folder, text);
        CHECK_FALSE(scene.read);
        CHECK_MESSAGE(scene.error.find(why) != std::string::npos, scene.error);
    }
}
