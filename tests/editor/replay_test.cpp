// Recorded runs that are seen again in a window.
#include "sample_game/replay.hpp"

#include "tests/editor/window.hpp"

using namespace espalier::document;

TEST_CASE("what was one step of undo in a run is one step in its replay, wherever the camera moved meanwhile") {
    const Folder folder;
    const std::string scene = smallScene(folder), path = folder.file("run.jsonl");
    Window window(folder, scene);
    std::string error;
    Recorder recorder;
    REQUIRE(recorder.begin(path, {1, scene, 96, 54, .1f}, error));
    StrokeBegin stroke;
    stroke.layer = "mask";
    stroke.radius = .8f;
    const SetCamera camera{{2, 2, 6}, {0, 1, 0}, .7f};
    const std::pair<Action, uint32_t> done[] = {
        {SetParam{0, {"reach", {1.2f}}}, 5}, {camera, 0},      {SetParam{0, {"reach", {1.4f}}}, 5},
        {FillLayer{"mask", .5f}, 0},         {camera, 0},      {FillLayer{"mask", .25f}, 0},
        {SetParam{0, {"reach", {1.6f}}}, 6}, {stroke, 7},      {StrokeDabs{{{0, .5f, .4f, 0, 0, 1, 1}}}, 7},
        {SetView{"layer", "mask"}, 0},       {StrokeEnd{}, 7},
    };
    for (const auto& [action, gesture] : done) recorder.note(action, gesture);
    REQUIRE_MESSAGE(recorder.end(error), error);

    sample::Replay replay;
    REQUIRE_MESSAGE(replay.read(path, error), error);
    replay.begin(0);
    for (double now = 0; replay.step(window.work, now); now += .1) REQUIRE(now < 10);
    CHECK_MESSAGE(window.work.error == "", window.work.error);
    CHECK(window.work.document->undoSteps() == 5);
    CHECK(window.work.document->undoName() == std::string("Paint mask"));
    for (int i = 0; i < 4; ++i) REQUIRE(window.work.perform(Undo{}));
    CHECK(window.work.document->undoName() == std::string("Length of the stems"));
    REQUIRE(window.work.perform(Undo{}));
    CHECK(!window.work.document->undoName());
}

TEST_CASE("a replay that fails within a stroke ends it and says where") {
    const Folder folder;
    const std::string scene = smallScene(folder), path = folder.file("run.jsonl");
    Window window(folder, scene);
    std::string error;
    Recorder recorder;
    REQUIRE(recorder.begin(path, {1, scene, 96, 54, .1f}, error));
    StrokeBegin stroke;
    stroke.layer = "mask";
    recorder.note(stroke, 7);
    recorder.note(StrokeDabs{{{0, .5f, .4f, 0, 0, 1, 1}}}, 7);
    recorder.note(FillLayer{"mask", .5f}, 8);  // amid a stroke
    REQUIRE_MESSAGE(recorder.end(error), error);

    sample::Replay replay;
    REQUIRE_MESSAGE(replay.read(path, error), error);
    replay.begin(0);
    for (double now = 0; replay.step(window.work, now); now += .1) REQUIRE(now < 10);
    CHECK(!replay.on());
    CHECK(!window.work.document->stroking());
    CHECK_MESSAGE(contains(window.work.error, path + ":4: "), window.work.error);
}

TEST_CASE("a run whose last line is cut off is replayed up to there, and what is missing is told at its end") {
    const Folder folder;
    const std::string scene = smallScene(folder), path = folder.file("run.jsonl");
    Window window(folder, scene);
    std::string error;
    Recorder recorder;
    REQUIRE(recorder.begin(path, {1, scene, 96, 54, .1f}, error));
    recorder.note(FillLayer{"mask", .5f}, 0);
    recorder.note(FillLayer{"mask", .25f}, 0);
    REQUIRE_MESSAGE(recorder.end(error), error);
    const std::string whole = readAll(path);
    folder.write("run.jsonl", whole.substr(0, whole.size() - 9));

    sample::Replay replay;
    REQUIRE_MESSAGE(replay.read(path, error), error);
    replay.begin(0);
    for (double now = 0; replay.step(window.work, now); now += .1) REQUIRE(now < 10);
    CHECK(window.work.document->undoSteps() == 1);
    CHECK_MESSAGE(contains(window.work.message, "Replayed: run.jsonl"), window.work.message);
    CHECK_MESSAGE(contains(window.work.message, "cut off"), window.work.message);
}
