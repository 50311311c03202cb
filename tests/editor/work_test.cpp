// Saves, exports and imports beside what else is done: what an edit, a cancel or an end at any of their steps leaves.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <thread>

#include "sample_game/background.hpp"
#include "tests/editor/editing.hpp"
#include "tools/document/layer_files.hpp"
#include "tools/document/project.hpp"
#include "tools/document/write_lock.hpp"

using namespace espalier::document;
using sample::Background;

namespace {

std::vector<float> texels(Editing& editing, size_t surface = 0) {
    espalier::scene::GreyPicture picture;
    REQUIRE_MESSAGE(editing.document->readLayer(surface, "mask", picture, editing.error), editing.error);
    return picture.texels;
}

// What the layer was filled with; where the atlas has nothing it keeps its 1.
float lowest(Editing& editing, size_t surface = 0) {
    return std::ranges::min(texels(editing, surface));
}

// Every file of a folder with its bytes.
std::map<std::string, std::string> filesIn(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files[entry.path().string()] = readAll(entry.path());
    return files;
}

// Two walls, each with a layer of its own.
std::string twoRuins(const Folder& folder) {
    const std::string ruin = smallSurface();
    return folder.write("walls.json", R"({"surfaces": [{"file": ")" + ruin + R"("}, {"file": ")" + ruin +
                                          R"(", "position": [0, 0, 40]}],
  "grammars": [{"file": ")" + content("grammars/ivy_guided.grammar") +
                                          R"(", "params": {"reach": 1},
    "seeds": [{"position": [-1.35, 0.12, 0.36], "seed": 1}]}]})");
}

void endWithoutWaiting(Work& work) {
    while (work.step()) continue;
}

}  // namespace

TEST_CASE("what is saved is the document as it was when the save began, whatever is done meanwhile") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const std::string garden = folder.file("garden");
    REQUIRE(editing.perform(FillLayer{"mask", .25f}));
    Work work(saving(*editing.document, garden));
    editing.document->beforeEdits([&] { work.settle(); });
    CHECK(work.reading());
    REQUIRE(editing.perform(FillLayer{"mask", .75f}));
    CHECK(!work.reading());
    (void)work.step();  // it is being written, or is already
    REQUIRE(editing.perform(SetParam{0, {"reach", {.5f}}}));
    REQUIRE_MESSAGE(work.finish(editing.error), editing.error);
    CHECK(work.progress() == 1);
    editing.document->beforeEdits({});
    Editing saved(garden);
    CHECK(lowest(saved) == .25f);
    CHECK(saved.param(0, "reach") == 1);
    CHECK(lowest(editing) == .75f);
}

TEST_CASE("a save that is cancelled or ended at any step leaves the old project, and no file too many") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const std::string garden = folder.file("garden");
    REQUIRE(editing.perform(FillLayer{"mask", .25f}));
    REQUIRE(saveProject(*editing.document, garden, editing.error));
    const auto before = filesIn(garden);
    int cancelled = 0;
    for (const bool waits : {true, false})
        for (int steps = 0; steps < 6; ++steps) {
            CAPTURE(steps);
            REQUIRE(editing.perform(FillLayer{"mask", .5f + .01f * float(steps)}));
            {
                Work work(saving(*editing.document, garden));
                for (int i = 0; i < steps; ++i) (void)work.step();
                work.cancel();
                if (waits) endWithoutWaiting(work);
                cancelled += work.state() == Work::State::cancelled;
                CHECK(work.error() == "");
            }
            if (filesIn(garden) == before) continue;
            // It was done before it was cancelled.
            Editing saved(garden);
            REQUIRE(lowest(saved) == .5f + .01f * float(steps));
            REQUIRE(editing.perform(FillLayer{"mask", .25f}));
            REQUIRE(saveProject(*editing.document, garden, editing.error));
        }
    CHECK(cancelled >= 1);  // at the latest what hadn't begun
}

TEST_CASE("autosaves don't pile up, and files that aren't a project's own stay in its folders") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const std::string garden = folder.file("garden");
    std::filesystem::create_directories(garden + "/layers");
    folder.write("garden/layers/own.exr", "a user's");
    REQUIRE(editing.perform(FillLayer{"mask", .25f}));
    REQUIRE(saveProject(*editing.document, garden, editing.error));
    for (const float value : {.5f, .6f, .7f}) {
        REQUIRE(editing.perform(FillLayer{"mask", value}));
        REQUIRE_MESSAGE(autosave(*editing.document, garden, editing.error), editing.error);
        CHECK(filesIn(garden).size() == 6);  // both texts, a layer of each, the bake under them, and the user's
    }
    Editing old(garden), recovered(recoverable(garden));
    CHECK(lowest(old) == .25f);
    CHECK(lowest(recovered) == .7f);
    REQUIRE(saveProject(*editing.document, garden, editing.error));
    CHECK(filesIn(garden).size() == 4);
    CHECK(readAll(garden + "/layers/own.exr") == "a user's");
}

TEST_CASE("a save waits for what another program writes into the project, and takes none of it away") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const std::string garden = folder.file("garden");
    REQUIRE(editing.perform(FillLayer{"mask", .25f}));
    REQUIRE(saveProject(*editing.document, garden, editing.error));
    const size_t files = filesIn(garden).size();
    // A layer that no text names yet, and files that are being written or were left behind.
    const std::string layer = "garden/layers/mask-0-0123456789abcdef.exr";
    const std::string mine = "garden/.unfinished-" + std::to_string(::getpid()) + "-own.grammar";
    const char* const gone = "garden/.unfinished-999999999-project.json";
    folder.write(layer.c_str(), "");
    folder.write(mine.c_str(), "");
    folder.write(gone, "");
    {
        WriteLock other;
        Progress progress;
        REQUIRE(other.take(garden, std::chrono::seconds(1), progress, editing.error));
        WriteLock late;
        CHECK(!late.take(garden, std::chrono::seconds(0), progress, editing.error));
        CHECK_MESSAGE(contains(editing.error, ".writing: another program"), editing.error);
        editing.error.clear();
        REQUIRE(editing.perform(FillLayer{"mask", .5f}));
        Work waits(saving(*editing.document, garden)), given(saving(*editing.document, garden));
        for (int i = 0; i < 20; ++i) {
            CHECK(waits.step());
            CHECK(given.step());
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        CHECK(std::filesystem::exists(folder.file(layer.c_str())));
        CHECK(std::filesystem::exists(folder.file(gone)));
        given.cancel();
        CHECK(!given.finish(editing.error));
        CHECK(given.state() == Work::State::cancelled);
        waits.cancel();
    }
    REQUIRE_MESSAGE(saveProject(*editing.document, garden, editing.error), editing.error);
    CHECK(!std::filesystem::exists(folder.file(layer.c_str())));
    CHECK(!std::filesystem::exists(folder.file(gone)));
    CHECK(std::filesystem::exists(folder.file(mine.c_str())));
    CHECK(filesIn(garden).size() == files + 1);
    Editing saved(garden);
    CHECK(lowest(saved) == .5f);
}

TEST_CASE("an export of several pictures is all of them or, cancelled, none") {
    const Folder folder;
    Editing editing(twoRuins(folder));
    const std::filesystem::path out = folder.path / "out";
    std::filesystem::create_directories(out);
    const auto plan = [&] { return exporting(*editing.document, "mask", (out / "mask.exr").string()); };
    REQUIRE(editing.perform(FillLayer{"mask", .25f}));
    REQUIRE(Work(plan()).finish(editing.error));
    const auto before = filesIn(out);
    REQUIRE(before.size() == 2);
    REQUIRE(editing.perform(FillLayer{"mask", .5f}));
    {
        Work work(plan());
        while (work.progress() < .6f && work.step()) continue;  // the first of two is encoded
        work.cancel();
        endWithoutWaiting(work);
        // All of it may have been done before it was cancelled.
        CHECK((filesIn(out) == before) == (work.state() == Work::State::cancelled));
        CHECK(filesIn(out).size() == 2);
    }
    REQUIRE(Work(plan()).finish(editing.error));
    const auto after = filesIn(out);
    CHECK(after.size() == 2);
    for (const auto& [file, bytes] : after) CHECK(bytes != before.at(file));
}

TEST_CASE("an import that is cancelled or fails halfway leaves all layers, and one that is done is one step back") {
    const Folder folder;
    Editing editing(twoRuins(folder));
    const std::string file = folder.file("mask.exr");
    REQUIRE(editing.perform(FillLayer{"mask", .25f}));
    REQUIRE(exportLayer(*editing.document, "mask", file, editing.error));
    REQUIRE(editing.perform(FillLayer{"mask", .5f}));
    {
        Work work(importing(*editing.document, "mask", file, 7));
        while (lowest(editing) == .5f) REQUIRE(work.step());
        CHECK(lowest(editing, 1) == .5f);
        work.cancel();
        endWithoutWaiting(work);
        CHECK(work.state() == Work::State::cancelled);
        for (size_t i = 0; i < 2; ++i) CHECK(lowest(editing, i) == .5f);
    }
    const size_t steps = editing.document->undoSteps();
    REQUIRE(Work(importing(*editing.document, "mask", file, 8)).finish(editing.error));
    CHECK(editing.document->undoSteps() == steps + 1);
    for (size_t i = 0; i < 2; ++i) CHECK(lowest(editing, i) == .25f);
    REQUIRE(editing.perform(Undo{}));
    for (size_t i = 0; i < 2; ++i) CHECK(lowest(editing, i) == .5f);
    folder.write("mask-1.exr", "no picture");
    CHECK(!Work(importing(*editing.document, "mask", file, 9)).finish(editing.error));
    CHECK_MESSAGE(contains(editing.error, "mask-1.exr"), editing.error);
    for (size_t i = 0; i < 2; ++i) CHECK(lowest(editing, i) == .5f);
    CHECK(editing.document->undoSteps() == steps);
}

namespace {

// Jobs that write down what becomes of them.
struct Told {
    Background background;
    std::string all;
    Background::Job job(const std::string& title, const std::string& name) {
        Work::Plan plan;
        plan.beside = [](Progress& progress, std::string&) { return progress.at(1); };
        return {title,
                [this, plan, name] {
                    all += " begin " + name;
                    return plan;
                },
                [this, name](const Work& over) {
                    all += (over.state() == Work::State::done ? " end " : " cancel ") + name;
                }};
    }
    void run() {
        while (background.busy()) (void)background.step();
    }
};

}  // namespace

TEST_CASE("what is asked for at a time is done one after the other, the same again once, an autosave last of all") {
    Told t;
    t.background.ask(t.job("Saving", "a"));
    (void)t.background.step();
    for (const char* name : {"b", "c"}) t.background.ask(t.job("Saving", name));
    t.background.ask(t.job("Exporting", "d"));
    t.run();
    CHECK(t.all == " begin a end a begin c end c begin d end d");

    t.all.clear();
    t.background.ask(t.job("", "kept"));
    t.background.ask(t.job("Saving", "a"));
    t.run();
    CHECK(t.all == " begin a end a");  // an autosave that hasn't begun isn't needed

    t.all.clear();
    t.background.ask(t.job("Saving", "a"));
    t.background.ask(t.job("Exporting", "b"));
    t.background.cancelLast();
    t.background.finish();
    CHECK(t.all == " begin a end a begin b cancel b");
    CHECK(!t.background.busy());
}
