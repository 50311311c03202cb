// A recording and what it is replayed from: whatever was done before it, and whatever is done to its project later.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "tests/editor/window.hpp"
#include "tools/document/layer_files.hpp"
#include "tools/document/project.hpp"
#include "tools/document/run.hpp"

using namespace espalier::document;

namespace {

void begin(Window& window, const std::string& path) {
    bool records = false;
    window.session.startRecording(window.work, path, 64, 64, [&](bool good) { records = good; });
    window.session.background().finish();
    REQUIRE_MESSAGE(records, window.work.error);
}

uint64_t hashOf(Window& window) {
    REQUIRE(espUpdate(window.work.context.get()) == ESP_OK);
    EspStats stats;
    REQUIRE(espReadStats(window.work.context.get(), &stats) == ESP_OK);
    return stats.hash;
}

// What the run leads to.
uint64_t replayed(const std::string& path) {
    Run run;
    std::string error;
    REQUIRE_MESSAGE(readRun(path, run, error), error);
    Editing editing(run.head.scene);
    for (const RunLine& line : run.lines) REQUIRE_MESSAGE(editing.perform(line.action, line.gesture), editing.error);
    return editing.hash();
}

}  // namespace

TEST_CASE("a run that begins after edits names the seeds that its replay has, and undoes none of them") {
    const Folder folder;
    const std::string path = folder.file("run.jsonl");
    Window window(folder, wallScene(folder, false));
    auto& document = *window.work.document;
    const auto plant = [&](uint32_t grammar, float x) {
        const SeedRecord seed{document.freshKey(), grammar, {x, .1f, 0}, {0, 1, 0}, 7};
        REQUIRE(window.work.perform(AddSeeds{{seed}, {uint32_t(document.scene().seeds.size())}}));
        return seed;
    };
    plant(0, .3f);
    REQUIRE(window.work.perform(Undo{}));
    const SeedRecord ivy = plant(0, .5f);  // stands behind the other grammar's seeds
    window.work.selected = {ivy.key};
    begin(window, path);
    CHECK(!document.undoName());
    CHECK(!window.work.perform(Undo{}));
    REQUIRE(window.work.selected.size() == 1);
    const auto* chosen = document.seed(*window.work.selected.begin());
    REQUIRE(chosen);
    CHECK(chosen->position == ivy.position);
    SeedRecord moved = document.recordOf(*chosen);
    moved.position[0] = -.2f;
    REQUIRE(window.work.perform(ChangeSeeds{{moved}}));
    plant(1, 1.4f);
    REQUIRE(window.work.perform(RemoveSeeds{{1}}));
    REQUIRE(window.work.perform(Undo{}));
    CHECK(document.undoName() == std::string("Plant a seed"));
    window.session.stopRecording(window.work);
    CHECK(replayed(path) == hashOf(window));
}

// Each of these is named by its seed's key, which a run's beginning changes.
TEST_CASE("what was done before a run can be undone and done again when it has ended, however seeds were named in it") {
    const Folder folder;
    const std::string path = folder.file("run.jsonl");
    Window window(folder, wallScene(folder, false));
    auto& document = *window.work.document;
    // The list, in its order: it tells seeds of one number apart.
    const auto listed = [&] {
        std::vector<std::pair<uint32_t, std::array<float, 3>>> seeds;
        for (const auto& seed : document.scene().seeds) seeds.emplace_back(seed.grammar, seed.position);
        return seeds;
    };
    std::vector<uint64_t> hashes{hashOf(window)};
    std::vector<decltype(listed())> seeds{listed()};
    const auto step = [&](const Action& action) {
        REQUIRE_MESSAGE(window.work.perform(action), window.work.error);
        hashes.push_back(hashOf(window));
        seeds.push_back(listed());
    };
    const auto plant = [&](uint32_t grammar, float x) {
        const SeedRecord seed{document.freshKey(), grammar, {x, .1f, 0}, {0, 1, 0}, 40};
        step(AddSeeds{{seed}, {uint32_t(document.scene().seeds.size())}});
        return seed;
    };
    plant(1, 1.2f);
    const SeedRecord gone = plant(1, .9f);
    SeedRecord ivy = plant(0, .5f);
    step(RemoveSeeds{{gone.key}});
    ivy.position[0] = .3f;
    step(ChangeSeeds{{ivy}});
    step(FreezeSeeds{{ivy.key}, true});
    step(FillLayer{"mask", .5f});
    const size_t before = document.undoSteps();
    REQUIRE(before == 7);

    begin(window, path);
    CHECK(document.undoSteps() == 0);
    CHECK(listed() == seeds.back());
    const SeedRecord late{document.freshKey(), 0, {-.4f, .1f, 0}, {0, 1, 0}, 99};
    REQUIRE(window.work.perform(AddSeeds{{late}, {0}}));
    REQUIRE(window.work.perform(Undo{}));
    CHECK(!window.work.perform(Undo{}));
    CHECK_MESSAGE(contains(window.work.error, "since the recording began"), window.work.error);
    REQUIRE(window.work.perform(Redo{}));
    window.session.stopRecording(window.work);
    CHECK(replayed(path) == hashOf(window));

    CHECK(document.undoSteps() == before + 1);
    REQUIRE(window.work.perform(Undo{}));
    const auto recorded = listed();
    for (size_t i = before; i-- > 0;) {
        CAPTURE(i);
        REQUIRE_MESSAGE(window.work.perform(Undo{}), window.work.error);
        CHECK(listed() == seeds[i]);
        CHECK(hashOf(window) == hashes[i]);
    }
    CHECK(!window.work.perform(Undo{}));
    for (size_t i = 1; i < before; ++i) {
        CAPTURE(i);
        REQUIRE_MESSAGE(window.work.perform(Redo{}), window.work.error);
        CHECK(listed() == seeds[i]);
        CHECK(hashOf(window) == hashes[i]);
    }
    // Behind the last one the run goes on from what it began with.
    REQUIRE(window.work.perform(Redo{}));
    CHECK(listed() == recorded);
    REQUIRE_MESSAGE(window.work.perform(Redo{}), window.work.error);
    CHECK(replayed(path) == hashOf(window));
}

TEST_CASE("the beginning of a run stays as it was when the project that was open is saved while it is recorded") {
    const Folder folder;
    const std::string garden = folder.file("garden"), path = folder.file("run.jsonl");
    {
        Editing editing(smallScene(folder));
        REQUIRE_MESSAGE(saveProject(*editing.document, garden, editing.error), editing.error);
    }
    Window window(folder, garden);
    begin(window, path);
    StrokeBegin stroke;
    stroke.layer = "mask";
    stroke.value = 0;
    stroke.radius = .8f;
    REQUIRE(window.work.perform(stroke, 1));
    REQUIRE(window.work.perform(StrokeDabs{{{0, .5f, .4f, 0, 0, 1, 1}}}, 1));
    REQUIRE(window.work.perform(StrokeEnd{}, 1));
    REQUIRE(window.save(garden));
    REQUIRE(window.work.perform(Undo{}));
    window.session.stopRecording(window.work);
    Run run;
    REQUIRE(readRun(path, run, window.work.error));
    CHECK(run.head.scene == path + ".project");
    CHECK(replayed(path) == hashOf(window));
}

TEST_CASE("a scene that was opened with something in place of its own begins a run as it is, not by its name") {
    const Folder folder;
    const std::string scene = smallScene(folder), path = folder.file("run.jsonl");
    Window window(folder, scene);
    window.session.begin(window.work, scene, sample::kNeverWritten, false);
    begin(window, path);
    window.session.stopRecording(window.work);
    Run run;
    REQUIRE(readRun(path, run, window.work.error));
    CHECK(run.head.scene == path + ".project");
}

TEST_CASE("a run's beginning takes no other project's place") {
    const Folder folder;
    const std::string path = folder.file("run.jsonl"), theirs = path + ".project";
    Window window(folder, smallScene(folder));
    REQUIRE_MESSAGE(saveProject(*window.work.document, theirs, window.work.error), window.work.error);
    const std::string before = readAll(theirs + "/project.json");
    window.fill(.5f);
    begin(window, path);
    window.session.stopRecording(window.work);
    Run run;
    REQUIRE(readRun(path, run, window.work.error));
    CHECK(run.head.scene != theirs);
    CHECK(readAll(theirs + "/project.json") == before);
    CHECK(replayed(path) == hashOf(window));
}

TEST_CASE("what was asked of a seed's plant isn't said of another that a run's beginning gives its key") {
    const Folder folder;
    Window window(folder, wallScene(folder, false));
    auto& work = window.work;
    const auto& seeds = work.scene().seeds;
    REQUIRE(work.perform(FillLayer{"damp", 0}));  // without which the creeper, the second seed, doesn't grow
    REQUIRE(work.perform(AddSeeds{{{work.document->freshKey(), 0, {-.5f, .1f, 0}, {0, 1, 0}, 7}}, {0}}));
    hashOf(window);
    REQUIRE(work.readStats());
    REQUIRE(work.barren(seeds[2].key));
    begin(window, folder.file("run.jsonl"));
    const auto ivy = std::ranges::find(seeds, 2u, &espalier::scene::Seed::key);
    REQUIRE((ivy != seeds.end() && ivy->grammar == 0));
    CHECK(!work.barren(ivy->key));
    window.session.stopRecording(work);
}

TEST_CASE("a run finds the pictures that were read in it from wherever it is replayed") {
    const Folder folder;
    const std::string scene = smallScene(folder), picture = folder.file("given/mask.exr");
    std::filesystem::create_directories(folder.path / "given");
    Window window(folder, scene);
    window.fill(.5f);
    REQUIRE(exportLayer(*window.work.document, "mask", picture, window.work.error));
    REQUIRE(window.work.perform(Undo{}));
    std::filesystem::create_directories(folder.path / "runs");
    const std::string path = folder.file("runs/run.jsonl");
    begin(window, path);
    REQUIRE_MESSAGE(window.work.perform(LoadLayer{"mask", picture, 0}), window.work.error);
    window.session.stopRecording(window.work);
    CHECK_MESSAGE(contains(readAll(path), "\"../given/mask.exr\""), readAll(path));
    Run run;
    REQUIRE(readRun(path, run, window.work.error));
    const auto load = std::ranges::find_if(
        run.lines, [](const RunLine& line) { return std::holds_alternative<LoadLayer>(line.action); });
    REQUIRE(load != run.lines.end());
    CHECK(std::get<LoadLayer>(load->action).file == picture);
    CHECK(replayed(path) == hashOf(window));
}

TEST_CASE("a plant that is frozen right after an edit is the one that the edit made") {
    const Folder folder;
    const std::string scene = smallScene(folder);
    const auto frozen = [&](bool looks) {
        Editing editing(scene);
        editing.hash();
        REQUIRE(editing.perform(SetParam{0, {"reach", {1.6f}}}));
        if (looks) editing.hash();
        REQUIRE_MESSAGE(editing.perform(FreezeSeeds{{1}, true}), editing.error);
        REQUIRE(editing.perform(SetParam{0, {"reach", {.6f}}}));
        return editing.hash();
    };
    CHECK(frozen(false) == frozen(true));
}

TEST_CASE("a recording that can't be written any more ends at once, which is told then and at the end") {
    const Folder folder;
    Window window(folder, smallScene(folder));
    begin(window, "/dev/full");
    REQUIRE(window.session.recording());
    window.session.nextFrame(window.work);
    CHECK(!window.session.recording());
    CHECK_MESSAGE(contains(window.work.error, "/dev/full: "), window.work.error);
    CHECK_MESSAGE(contains(window.work.error, "No space left"), window.work.error);
    REQUIRE(window.work.perform(FillLayer{"mask", .5f}));
    CHECK(window.work.error.empty());
    window.session.nextFrame(window.work);
    CHECK(window.work.error.empty());
    window.session.end(window.work);
    CHECK_MESSAGE(contains(window.work.error, "No space left"), window.work.error);
}

TEST_CASE("a letter that isn't UTF-8 ends neither a recording nor keeps anybody from saving") {
    const Folder folder;
    const std::string path = folder.file("run.jsonl");
    Window window(folder, smallScene(folder));
    begin(window, path);
    const std::string text = window.work.scene().grammars[0].text + "// gr\xfcn\n";
    REQUIRE(window.work.perform(window.work.document->withText(0, text)));
    CHECK_MESSAGE(contains(window.work.scene().grammars[0].error, "UTF-8"), window.work.scene().grammars[0].error);
    window.session.stopRecording(window.work);
    CHECK(window.work.error == "");
    CHECK_MESSAGE(window.save(folder.file("garden")), window.work.error);
    CHECK(replayed(path) == hashOf(window));
    CHECK(Editing(folder.file("garden")).hash() == hashOf(window));
}

TEST_CASE("what is in hand comes back after a reload, but for what isn't there any more") {
    const Folder folder;
    const std::string scene = wallScene(folder, true);
    sample::Workspace::Hands hands;
    {
        Window window(folder, scene);
        window.work.chooseLayer("damp");
        window.work.plantGrammar = 1;
        window.work.openGrammar = 2;
        window.work.house = 1;
        window.work.houseEdge = 3;
        REQUIRE(window.work.perform(SetView{"normals", ""}));
        hands = window.work.hands();
    }
    Window again(folder, scene);
    again.work.message = "of its paint this was lost";
    again.work.takeUp(hands);
    CHECK(again.work.message == "of its paint this was lost");
    CHECK(again.work.scene().look.view == ESP_VIEW_NORMALS);
    CHECK(again.work.brush.layer == "damp");
    CHECK(again.work.plantGrammar == 1);
    CHECK(again.work.openGrammar == 2);
    CHECK(again.work.house == 1u);
    CHECK(again.work.houseEdge == 3u);
    Window bare(folder, smallScene(folder));
    bare.work.brush.layer = "mask";
    bare.work.takeUp(hands);
    CHECK(bare.work.brush.layer == "mask");
    CHECK(bare.work.plantGrammar == 0);
    CHECK(!bare.work.house);
}
