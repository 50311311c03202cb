// Recorded runs that are seen again in a window.
#include "sample_game/replay.hpp"

#include "tests/editor/window.hpp"

using namespace espalier::document;

namespace {

// A run on the small scene that is recorded, and then seen again in a window.
struct Recorded {
    Folder folder;
    const std::string scene = smallScene(folder), path = folder.file("run.jsonl");
    Window window{folder, scene};
    std::string error;
    Recorder recorder;
    sample::Replay replayed;

    Recorded() { REQUIRE(recorder.begin(path, {1, scene, 96, 54, .1f}, error)); }
    void end() { REQUIRE_MESSAGE(recorder.end(error), error); }
    void replay() {
        REQUIRE_MESSAGE(replayed.read(path, error), error);
        replayed.begin(0);
        for (double now = 0; replayed.step(window.work, now); now += .1) REQUIRE(now < 10);
    }
};

}  // namespace

TEST_CASE("what was one step of undo in a run is one step in its replay, wherever the camera moved meanwhile") {
    Recorded run;
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
    for (const auto& [action, gesture] : done) run.recorder.note(action, gesture);
    run.end();
    run.replay();
    CHECK_MESSAGE(run.window.work.error == "", run.window.work.error);
    CHECK(run.window.work.document->undoSteps() == 5);
    CHECK(run.window.work.document->undoName() == std::string("Paint mask"));
    for (int i = 0; i < 4; ++i) REQUIRE(run.window.work.perform(Undo{}));
    CHECK(run.window.work.document->undoName() == std::string("Length of the stems"));
    REQUIRE(run.window.work.perform(Undo{}));
    CHECK(!run.window.work.document->undoName());
}

TEST_CASE("a replay that fails within a stroke ends it and says where") {
    Recorded run;
    StrokeBegin stroke;
    stroke.layer = "mask";
    run.recorder.note(stroke, 7);
    run.recorder.note(StrokeDabs{{{0, .5f, .4f, 0, 0, 1, 1}}}, 7);
    run.recorder.note(FillLayer{"mask", .5f}, 8);  // amid a stroke
    run.end();
    run.replay();
    CHECK(!run.replayed.on());
    CHECK(!run.window.work.document->stroking());
    CHECK_MESSAGE(contains(run.window.work.error, run.path + ":4: "), run.window.work.error);
}

TEST_CASE("a run whose last line is cut off is replayed up to there, and what is missing is told at its end") {
    Recorded run;
    run.recorder.note(FillLayer{"mask", .5f}, 0);
    run.recorder.note(FillLayer{"mask", .25f}, 0);
    run.end();
    const std::string whole = readAll(run.path);
    run.folder.write("run.jsonl", whole.substr(0, whole.size() - 9));
    run.replay();
    CHECK(run.window.work.document->undoSteps() == 1);
    CHECK_MESSAGE(contains(run.window.work.message, "Replayed: run.jsonl"), run.window.work.message);
    CHECK_MESSAGE(contains(run.window.work.message, "cut off"), run.window.work.message);
}
