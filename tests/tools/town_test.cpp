// Towns as scenes show them: among plants, turned and moved, on ground.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "tests/tools/program.hpp"

TEST_CASE("a scene shows ivy and houses, and a town without a surface is a scene too") {
    const Folder folder;
    const std::string capture = program("espalier-capture");
    const Ran village = run(capture + " " + content("village.json") + " --size 64x36 -o " + folder.file("a"));
    CHECK_MESSAGE(village.code == 0, village.output);
    CHECK(village.output.find("3 seeds") != std::string::npos);
    CHECK(village.output.find("13 houses") != std::string::npos);

    std::ofstream(folder.file("bare.json"))
        << "{\"town\": {\"file\": \"" << content("town.json")
        << "\", \"turn\": 30, \"ground\": [0.2, 0.2, 0.2]},\n \"grammars\": [{\"file\": \""
        << content("grammars/town.grammar") << "\"}]}";
    const Ran bare = run(capture + " " + folder.file("bare.json") + " --size 64x36 -o " + folder.file("b"));
    CHECK_MESSAGE(bare.code == 0, bare.output);
    CHECK(bare.output.find("13 houses") != std::string::npos);

    std::ofstream(folder.file("wrong.json"))
        << "{\"town\": {\"file\": \"town.json\", \"grammar\": 3, \"ground\": 1},\n \"grammars\": [{\"file\": \"a\"}]}";
    const Ran wrong = run(capture + " " + folder.file("wrong.json") + " -o " + folder.file("c"));
    CHECK(wrong.code != 0);
    CHECK(wrong.output.find("wrong.json:1:44: 'grammar' must be a place in the list of grammars, from 0") !=
          std::string::npos);
    CHECK(wrong.output.find("'ground' must be true, false or a colour") != std::string::npos);
}

TEST_CASE("a layer that lies over roofs alone is exported as it is seen from above, and comes back") {
    const Folder folder;
    const auto exported = [&](const std::string& scene, const std::string& name, const std::string& more) {
        const Ran ran = run(program("espalier-capture") + " " + content(scene.c_str()) + " --size 64x36 -o " +
                            folder.file("frames") + more + " --export moss=" + folder.file(name));
        REQUIRE_MESSAGE(ran.code == 0, ran.output);
        return folder.file(name);
    };
    const std::string moss = exported("weathered.json", "moss.png", ""), none = exported("town.json", "none.png", "");
    const std::string again = exported("town.json", "again.png", " --layer moss=" + moss);
    const std::string compare = program("espalier-compare") + " --tolerance 0 --share 1 ";
    CHECK(run(compare + moss + " " + none).code == 1);
    CHECK(run(compare + moss + " " + again).code == 0);
    // Beside surfaces it is still the town's: one picture.
    const std::string few = " --max-nodes 2000";
    const std::string painted = exported("sample.json", "sample.png", " --layer moss=" + moss + few);
    const std::string blank = exported("sample.json", "blank.png", few);
    CHECK(run(compare + painted + " " + blank).code == 1);
    CHECK(!std::filesystem::exists(folder.file("sample-1.png")));
}

TEST_CASE("a house that a run has changed is drawn as that of a scene which opens like that, to the bit") {
    const Folder folder;
    const auto scene = [&](const char* name, const std::string& houses) {
        folder.write(name, R"({"town": {"file": "town.json")" + houses + R"(}, "grammars": [{"file": ")" +
                               content("grammars/town.grammar") +
                               R"("}], "camera": {"eye": [-4, 4, 9], "target": [2, 1.5, -3], "fov": 45}})");
    };
    folder.write("town.json", R"({"buildings": [{"id": "a", "outer": [[0,0],[5,0],[5,5],[0,5]]}]})");
    scene("plain.json", "");
    scene("changed.json", R"(, "houses": [{"house": 0, "shape": "gable", "slope": 1, "eave_height": 6}])");
    folder.write("run.jsonl", R"({"espalier_run": 1, "scene": "plain.json", "width": 320, "height": 180, "step": 0.1}
{"frame": 1, "house": {"house": 0, "shape": "gable", "slope": 1, "eave_height": 6, "edges": [], "corners": [], "rings": [], "look": {"covering": "any", "colour": [], "overhang": 0, "chimneys": "any"}}}
)");
    const std::string capture = program("espalier-capture");
    const Ran ran = run(capture + " --replay " + folder.file("run.jsonl") + " -o " + folder.file("run"));
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    const Ran opened = run(capture + " --size 320x180 " + folder.file("changed.json") + " -o " + folder.file("opened"));
    REQUIRE_MESSAGE(opened.code == 0, opened.output);
    CHECK(readAll(folder.file("run/frame_0001.png")) == readAll(folder.file("opened/frame_0000.png")));
    CHECK(readAll(folder.file("run/frame_0000.png")) != readAll(folder.file("opened/frame_0000.png")));
}
