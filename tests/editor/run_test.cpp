// Recorded runs: as text, back, and replayed by the capture tool.
#include "tools/document/run.hpp"
#include "tests/editor/editing.hpp"

using namespace espalier::document;

TEST_CASE("every action comes back from its line") {
    const Action actions[] = {
        SetParam{1, {"reach", {.1f}}},
        SetParam{0, {"colour", {.1f, .2f, 1e-9f}}},
        SetText{0, "Ivy -> \"x\"\n\t\\ \u00e4", {{"a", {1}}, {"b", {1, 2, 3}}}},
        AddSeeds{{{3, 1, {1, 2, 3}, {.1f, .2f, -.3f}, 4294967295u}}, {0}},
        RemoveSeeds{{1, 2, 3}},
        ChangeSeeds{{{3, 1, {1, 2, 3}, {0, 0, 1}, 7, {{"reach", {2}}}}}},
        SetLight{17.25f, -.5f, false},
        SetWalk{"paper"},
        StrokeBegin{"mask", "erase", .25f, 1, .5f, .1f, {0, 1.5f}, {-1e6f, 2}, .3f, true},
        StrokeDabs{{{1, 2, 3, 0, 1, 0, 1}, {4, 5, 6, 0, 1, 0, .5f}}},
        StrokeEnd{},
        FillLayer{"mask", .5f},
        LoadLayer{"mask", "mask.exr", 0},
        FreezeSeeds{{1, 2}, true},
        PruneBranch{"00f1020304050607", true},
        SetHouse{{3, "gable", .7f, 5, {{1, "eave", .5f}}, {{0, 0}, {1, 0}, {1, 1.5f}}}},
        SetHouse{{0, "hip", 1, 3, {}, {{0, 0}, {9, 0}, {9, 9}, {3, 3}, {3, 4}, {4, 3}}, {3, 3}}},
        ResetHouse{3},
        LoadTownLayer{"moss", "moss.png"},
        SetField{1, {"flow", {0, -1, .5f}, .25f, {{"wedge", {1, 2, 3}, {0, 0, 1}, .5f}}}, true},
        SetField{0, {"flow", {0, -1, 0}, 1, {}, false, true, 20, "flow.ply"}, true},
        BrushField{0, "flow", {"smooth", .25f, .5f, {{1, 2, 3}, {4, 5, 6}}}, true},
        TrimField{0, "flow", 2, 7, true},
        AddSurface{"wall.surface.glb", {1, 2, -3}, .5f, 2},
        PlaceSurface{1, {1, 2, -3}, .5f, 2, true},
        AddGrammar{"ivy.grammar"},
        SetLook{1, "leaf", "leaf.terminal.glb", "leaf.png", {.1f, .5f, .2f}},
        SetBookmark{3, true, {1, 2, 3}, {4, 5, 6}, .7f},
        ShowPlants{{1, 2}, false},
        ShowSurfaces{{0}, false},
        LockSurface{1, true},
        ShowHouses{{2, 4}, false},
        LockHouse{3, true},
        LockLayer{"mask", true},
        AddGraph{"some.graph", "graph 1\na = Cube\n"},
        SetGraphText{0, "graph 1\nb = Sphere\n"},
        AddNodes{0, "graph 1\nc = Torus\n"},
        RemoveNodes{0, {"a", "b"}, true},
        SetNodeInput{0, "b", "radius", "0.25"},
        ConnectNodes{0, "b", "geometry", "a.mesh", 2},
        MoveNodes{0, {"a"}, {{1, -2.5f}}},
        RenameNode{0, "a", "box"},
        ShowNodes{0, {"b"}},
        MuteNodes{0, {"b"}, true},
        SetGraphTime{12, 24},
        SetCamera{{1, 2, 3}, {4, 5, 6}, .7f},
        SetView{"layer", "mask"},
        Undo{},
        Redo{},
    };
    CHECK(std::size(actions) == std::variant_size_v<Action> - 3 + 3);  // the inverses aside, three come twice
    for (const Action& action : actions) {
        const std::string line = toJson({12, 3, action});
        CAPTURE(line);
        CHECK(!contains(line, "\n"));
        RunLine back;
        std::string error;
        REQUIRE_MESSAGE(fromJson(line, back, error), error);
        CHECK(back.frame == 12);
        CHECK(back.gesture == 3);
        CHECK(back.action.index() == action.index());
        CHECK(toJson(back) == line);
    }
    RunLine back;
    std::string error;
    REQUIRE(fromJson(toJson({0, 0, actions[1]}), back, error));
    CHECK(std::get<SetParam>(back.action).param == std::get<SetParam>(actions[1]).param);
}

TEST_CASE("mistakes in runs are told with their line") {
    const Folder folder;
    const std::string head =
        "{\"espalier_run\": 1, \"scene\": \"small.json\", \"width\": 64, \"height\": 36, \"step\": 0.1}\n";
    const auto refused = [&](const std::string& text, const std::string& place, const std::string& cause) {
        const std::string path = folder.write("run.jsonl", text);
        Run run;
        std::string error;
        CHECK(!readRun(path, run, error));
        CAPTURE(error);
        CHECK(contains(error, path + ":" + place));
        CHECK(contains(error, cause));
    };
    refused("", "", "empty");
    refused("{}\n", "1:", "espalier_run");
    refused("{\"espalier_run\": 3, \"scene\": \"\", \"width\": 1, \"height\": 1, \"step\": 1}", "1:", "newer");
    refused("{\"espalier_run\": 1, \"scene\": \"\", \"width\": 0, \"height\": 1, \"step\": 1}", "1:", "0 x 1");
    refused(head + "\n{\"frame\": 0, \"undo\": {}}\n{\"frame\": 0, \"undo\": \n", "4:", "");
    refused(head + "{\"frame\": 0}", "2:", "no action");
    refused(head + "{\"frame\": 0, \"fly\": {}}", "2:", "'fly'");
    refused(head + "{\"frame\": -1, \"undo\": {}}", "2:", "frame");
    refused(head + "{\"frame\": 0, \"undo\": {}, \"redo\": {}}", "2:", "one action");
    refused(head + "{\"frame\": 0, \"light\": {\"hour\": 1, \"exposure\": 0}}", "2:", "'shadows'");
    refused(head + "{\"frame\": 0, \"light\": {\"hour\": true, \"exposure\": 0, \"shadows\": true}}",
            "2:", "'hour' must be a number");
    refused(head + "{\"frame\": 0, \"light\": {\"hour\": 1, \"exposure\": 0, \"shadows\": 1}}",
            "2:", "'shadows' must be true or false");
    refused(head + "{\"frame\": 0, \"fill\": {\"layer\": \"mask\", \"value\": 1, \"valeu\": 1}}",
            "2:", "no key 'valeu'");
    refused(head + "{\"frame\": 0, \"load_layer\": {\"layer\": \"mask\", \"file\": 5, \"surface\": 0}}",
            "2:", "'file' must be a text");
    refused(head + "{\"frame\": 0, \"dabs\": {\"dabs\": [[0, 0]]}}", "2:", "each is a list of 7 numbers");
    refused(head + "{\"frame\": 2, \"undo\": {}}\n{\"frame\": 1, \"redo\": {}}", "3:", "later");
}

TEST_CASE("a recording that the disk has no room for says so in the end") {
    Recorder recorder;
    std::string error;
    REQUIRE(recorder.begin("/dev/full", {1, "scene.json", 96, 54, .1f}, error));
    recorder.note(Undo{}, 0);
    CHECK(!recorder.end(error));
    CHECK(contains(error, "/dev/full: "));
    CHECK(contains(error, "No space left"));
    CHECK(!recorder.on());
}

TEST_CASE("a recorded run is replayed to the same pictures and the growth that was there") {
    const Folder folder;
    const std::string scene = smallScene(folder), path = folder.file("run.jsonl");
    uint64_t grown = 0;
    {
        Editing editing(scene);
        Recorder recorder;
        REQUIRE(recorder.begin(path, {1, scene, 96, 54, .1f}, editing.error));
        editing.document->listen([&](const Action& action, uint32_t gesture) { recorder.note(action, gesture); });
        const auto done = [&](const Action& action, uint32_t gesture = 0) {
            CHECK_MESSAGE(editing.perform(action, gesture), editing.error);
            editing.hash();
            recorder.nextFrame();
        };
        done(SetCamera{{2, 2, 6}, {0, 1, 0}, .7f});
        done(AddSeeds{{{editing.document->freshKey(), 0, {0, .2f, .4f}, {0, 1, 0}, 9}}, {2}});
        done(SetParam{0, {"reach", {1.2f}}}, 1);
        done(SetParam{0, {"reach", {1.4f}}}, 1);
        StrokeBegin stroke;
        stroke.layer = "mask";
        CHECK(editing.perform(stroke, 2));
        done(StrokeDabs{{{0, .5f, .4f, 0, 0, 1, 1}}}, 2);
        CHECK(editing.perform(StrokeEnd{}, 2));
        done(SetLight{8, 0, true});
        done(RemoveSeeds{{1}});
        done(Undo{});
        grown = editing.hash();
        CHECK_MESSAGE(recorder.end(editing.error), editing.error);
    }
    const std::string capture = program("espalier-capture") + " --max-nodes 20000 --replay " + path + " --stats " +
                                folder.file("stats.json") + " -o ";
    const Ran first = run(capture + folder.file("a"));
    REQUIRE_MESSAGE(first.code == 0, first.output);
    REQUIRE(run("env LP_NUM_THREADS=1 " + capture + folder.file("b")).code == 0);
    char hash[20];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(grown));
    CHECK(contains(readAll(folder.file("stats.json")), hash));
    for (int frame = 0; frame < 9; ++frame) {
        const std::string name = "/frame_000" + std::to_string(frame) + ".png";
        REQUIRE(std::filesystem::exists(folder.file("a") + name));
        CHECK(readAll(folder.file("a") + name) == readAll(folder.file("b") + name));
    }
    CHECK(!std::filesystem::exists(folder.file("a") + "/frame_0009.png"));
    CHECK(readAll(folder.file("a") + "/frame_0004.png") != readAll(folder.file("a") + "/frame_0005.png"));
    const Ran some = run(capture + folder.file("c") + " --every 4");
    CHECK(contains(some.output, "3 frames"));
    CHECK(readAll(folder.file("c") + "/frame_0008.png") == readAll(folder.file("a") + "/frame_0008.png"));
}
