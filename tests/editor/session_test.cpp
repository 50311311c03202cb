// A session over projects that others delete or that can't be written: what is told, and where what isn't saved is
// kept.
#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "tests/editor/window.hpp"
#include "tools/document/durable.hpp"
#include "tools/document/project.hpp"

using namespace espalier::document;
namespace fs = std::filesystem;

namespace {

float maskOf(const std::string& project) {
    Editing opened(project);
    espalier::scene::GreyPicture mask;
    REQUIRE(opened.document->readLayer(0, "mask", mask, opened.error));
    return *std::ranges::min_element(mask.texels);
}

// The only autosave beside the user's settings.
std::string keptIn(const Folder& folder) {
    const std::vector<std::string> found = autosavesIn(folder.path / "config");
    CHECK(found.size() <= 1);
    return found.empty() ? "" : found.front();
}

}  // namespace

TEST_CASE("a town without surfaces is flown over and seen from afar by its own size") {
    const Folder folder;
    Window window(folder, content("town.json"));
    REQUIRE(window.work.scene().surfaces.empty());
    const auto [low, high] = window.work.bounds();
    CHECK(glm::distance(low, high) > 50);
    CHECK(glm::distance(low, high) < 2000);
    window.work.frameAll();
    const float before = window.work.camera.distance();
    window.work.camera.zoom(-10);
    CHECK(window.work.camera.distance() > 3 * before);
}

TEST_CASE("a project that is named with a slash at its end, as shells complete it, is the same project") {
    const Folder folder;
    const std::string garden = folder.file("garden");
    {
        Window window(folder, smallScene(folder));
        REQUIRE_MESSAGE(window.save(garden), window.work.error);
    }
    Window window(folder, garden + "/");
    CHECK(window.session.folder() == garden);
    CHECK(window.session.name(window.work) == "garden");
    CHECK(window.work.scene().name == "garden");
    window.session.replays(garden + "/");
    CHECK(window.session.name(window.work) == "garden");
}

TEST_CASE("a project whose folder is deleted counts as not saved, is kept elsewhere and can be saved anew") {
    const Folder folder;
    const std::string garden = folder.file("garden");
    Window window(folder, smallScene(folder));
    window.fill(.25f);
    REQUIRE_MESSAGE(window.save(garden), window.work.error);
    window.wait();
    CHECK(window.work.error == "");
    CHECK(!window.session.modified(window.work));

    fs::remove_all(garden);
    window.wait();
    CHECK(window.session.modified(window.work));
    CHECK_MESSAGE(contains(window.work.error, garden + " holds no project any more"), window.work.error);
    CHECK(!fs::exists(garden));  // what somebody has deleted isn't made again unasked
    const std::string kept = keptIn(folder);
    REQUIRE(!kept.empty());
    CHECK(contains(window.work.error, fs::path(kept).parent_path().string()));
    CHECK(maskOf(kept) == .25f);

    REQUIRE_MESSAGE(window.save(garden), window.work.error);
    window.wait();
    CHECK(window.work.error == "");
    CHECK(!window.session.modified(window.work));
    CHECK(maskOf(garden) == .25f);
    CHECK(keptIn(folder) == "");
}

TEST_CASE(
    "what a project's folder can't take is kept elsewhere, found when it is opened again, and told until remedied") {
    const Folder folder;
    const std::string garden = folder.file("garden"), layers = garden + "/layers";
    fs::path place;  // of what is kept
    {
        Window window(folder, smallScene(folder));
        window.fill(.25f);
        REQUIRE_MESSAGE(window.save(garden), window.work.error);
        fs::rename(layers, folder.file("aside"));
        folder.write("garden/layers", "a file where the folder should be");
        window.fill(.5f);
        window.wait();
        CHECK_MESSAGE(contains(window.work.error, layers), window.work.error);
        CHECK(maskOf(keptIn(folder)) == .5f);
        CHECK(!window.save(garden));
        CHECK(contains(window.work.error, layers));
        REQUIRE(window.save(folder.file("other")));  // another place
        CHECK(window.work.error == "");
        CHECK(keptIn(folder) == "");

        REQUIRE(window.save(folder.file("other")));
        fs::rename(folder.file("other/layers"), folder.file("aside2"));
        folder.write("other/layers", "a file where the folder should be");
        window.fill(.75f);
        window.wait();
        CHECK(window.work.error != "");
        REQUIRE(window.work.document->perform(Undo{}, window.work.error));  // as it is saved: nothing is to be kept
        window.wait();
        CHECK(keptIn(folder) == "");
        window.fill(.75f);
        window.wait();
        place = fs::path(keptIn(folder)).parent_path();
        fs::copy(place, folder.file("copy"), fs::copy_options::recursive);
    }
    // As if it had ended there.
    fs::remove(folder.file("other/layers"));
    fs::rename(folder.file("aside2"), folder.file("other/layers"));
    fs::copy(folder.file("copy"), place, fs::copy_options::recursive);
    Window again(folder, folder.file("other"));
    REQUIRE(again.session.autosaves().recovery() == keptIn(folder));
    CHECK(maskOf(again.session.autosaves().recovery()) == .75f);
    again.session.autosaves().forgetRecovery(true);
    CHECK(keptIn(folder) == "");
}

TEST_CASE(
    "of what was kept in a project's folder, and beside the settings once that took no more, the latest is offered") {
    const Folder folder;
    const std::string garden = folder.file("garden"), layers = garden + "/layers", copy = folder.file("copy");
    const std::string own = garden + "/autosave.json";
    {
        Window window(folder, smallScene(folder));
        REQUIRE_MESSAGE(window.save(garden), window.work.error);
        window.fill(.25f);
        window.wait();
        CHECK(maskOf(own) == .25f);
        fs::copy(garden, copy, fs::copy_options::recursive);
        fs::remove_all(layers);
        folder.write("garden/layers", "a file where the folder should be");
        window.fill(.5f);
        window.wait();
        CHECK(maskOf(keptIn(folder)) == .5f);
        CHECK(!fs::exists(own));  // what it holds is older
        fs::copy(folder.file("config"), folder.file("kept"), fs::copy_options::recursive);
    }
    // As if it had ended there, and the older one couldn't be removed.
    fs::remove_all(garden);
    fs::rename(copy, garden);
    fs::remove_all(folder.file("config"));
    fs::rename(folder.file("kept"), folder.file("config"));
    const std::string kept = keptIn(folder);
    const auto now = fs::file_time_type::clock::now();
    fs::last_write_time(own, now + std::chrono::seconds(2));
    fs::last_write_time(kept, now + std::chrono::seconds(4));
    Window again(folder, garden);
    CHECK(again.session.autosaves().recovery() == kept);
    again.session.autosaves().forgetRecovery(true);
    CHECK(again.session.autosaves().recovery() == own);
    again.session.autosaves().putOffRecovery();
    CHECK(again.session.autosaves().recovery() == "");
}

TEST_CASE(
    "an autosave that was copied somewhere to rescue it takes nothing else there with it when it is saved or given "
    "up") {
    const Folder folder;
    // As deep as where it was kept: it names the scene's files by their way from there.
    const std::string scene = smallScene(folder), rescued = folder.file("config/espalier/rescued/copy");
    {
        Window window(folder, scene);
        window.fill(.25f);
        window.wait();
        const fs::path kept = fs::path(keptIn(folder)).parent_path();
        fs::create_directories(fs::path(rescued).parent_path());
        fs::copy(kept, rescued, fs::copy_options::recursive);
    }
    folder.write("config/espalier/rescued/copy/notes.txt", "not ours");
    for (const bool saves : {true, false}) {
        fs::copy_file(rescued + "/autosave.json", folder.file("again.json"), fs::copy_options::overwrite_existing);
        {
            Window window(folder, rescued + "/autosave.json");
            window.fill(saves ? .5f : .75f);
            if (saves) CHECK_MESSAGE(window.save(folder.file("garden")), window.work.error);
        }
        CHECK(fs::exists(rescued + "/notes.txt"));
        CHECK(!fs::exists(rescued + "/autosave.json"));
        fs::copy_file(folder.file("again.json"), rescued + "/autosave.json");
    }
    CHECK(maskOf(folder.file("garden")) == .5f);
}

TEST_CASE("what is opened again over itself goes on where it was kept, and a recording of it has what wasn't saved") {
    const Folder folder;
    const std::string rescued = folder.file("rescued"), run = folder.file("run.jsonl");
    {
        Editing editing(smallScene(folder));
        REQUIRE(editing.perform(FillLayer{"mask", .25f}));
        REQUIRE_MESSAGE(autosave(*editing.document, rescued, editing.error), editing.error);
    }
    Window window(folder, rescued + "/autosave.json");
    const sample::Session::Origin origin = window.session.origin(window.work);
    REQUIRE(saveProject(*window.work.document, folder.file("reload"), window.work.error));
    window.session.goesOn = true;
    window.session.end(window.work);
    Window reloaded(folder, folder.file("reload"));
    reloaded.session.setOrigin(reloaded.work, origin);
    reloaded.session.startRecording(reloaded.work, run, 64, 64, [](bool good) { CHECK(good); });
    reloaded.session.background().finish();
    reloaded.session.stopRecording(reloaded.work);
    Run read;
    REQUIRE_MESSAGE(readRun(run, read, reloaded.work.error), reloaded.work.error);
    CHECK(contains(read.head.scene, "run.jsonl.project"));
    reloaded.fill(.5f);
    reloaded.wait();
    CHECK(maskOf(rescued + "/autosave.json") == .5f);
}

TEST_CASE(
    "a recording begins when what it begins with is saved beside the frames, and what is typed wrong records nothing") {
    const Folder folder;
    Window window(folder, smallScene(folder));
    sample::Session& session = window.session;
    std::string told;
    const auto ended = [&](bool good) { told = good ? "records" : "failed"; };
    session.startRecording(window.work, folder.file("plain.jsonl"), 64, 64, ended);
    CHECK(told == "records");  // of what was opened: nothing is to be saved
    session.stopRecording(window.work);

    window.fill(.5f);
    told.clear();
    session.startRecording(window.work, folder.file("run.jsonl"), 64, 64, ended);
    CHECK(told == "");
    CHECK(!session.recording());
    session.background().finish();
    CHECK(told == "records");
    CHECK(session.recording());
    session.stopRecording(window.work);
    Run run;
    std::string error;
    REQUIRE_MESSAGE(readRun(folder.file("run.jsonl"), run, error), error);
    CHECK(maskOf(run.head.scene) == .5f);

    told.clear();
    session.startRecording(window.work, folder.file("cancelled.jsonl"), 64, 64, ended);
    session.background().cancelLast();
    session.background().finish();
    CHECK(told == "failed");
    CHECK(window.work.error == "");  // it was cancelled
    folder.write("file", "");
    session.startRecording(window.work, folder.file("file/x.jsonl"), 64, 64, ended);
    session.background().finish();
    CHECK(told == "failed");
    CHECK(contains(window.work.error, "file/x.jsonl"));
    CHECK(!session.recording());
}

TEST_CASE("what was taken back before its autosave's turn came isn't kept as unsaved work") {
    const Folder folder;
    const std::string garden = folder.file("garden");
    Window window(folder, smallScene(folder));
    REQUIRE_MESSAGE(window.save(garden), window.work.error);
    window.fill(.25f);
    window.work.busy = true;  // as while a slider is dragged
    window.now += window.session.autosaveEvery;
    (void)window.session.step(window.work, window.now);
    REQUIRE(window.work.perform(Undo{}));
    REQUIRE(!window.session.modified(window.work));
    window.work.busy = false;
    window.wait();
    CHECK(!fs::exists(garden + "/autosave.json"));
}

TEST_CASE("a file that is written anew is read and written by whom it was before") {
    const Folder folder;
    const std::string file = folder.write("private.grammar", "one");
    const auto mode = [&] { return fs::status(file).permissions(); };
    for (const fs::perms wanted : {fs::perms(0600), fs::perms(0664)}) {
        fs::permissions(file, wanted);
        std::string error;
        REQUIRE_MESSAGE(writeTextDurably(file, "another", error), error);
        CHECK(mode() == wanted);
    }
}

TEST_CASE("a house that was chosen is found again where its plan has got others before it") {
    const Folder folder;
    const std::string scene = wallScene(folder, true), plan = folder.file("houses.json");
    Window before(folder, scene);
    before.work.house = 1;
    before.work.houseEdge = 2;
    const auto hands = before.work.hands();
    std::string text = readAll(plan);
    text.replace(text.find("[{"), 2, R"([{"id": "new", "outer": [[-30,0],[-20,0],[-20,8],[-30,8]]}, {)");
    folder.write("houses.json", text);
    Window after(folder, scene);
    REQUIRE(espHouseCount(after.work.context.get()) == 3);
    after.work.takeUp(hands);
    CHECK(after.work.house == 2);
    CHECK(after.work.houseEdge == 2);
}
