// A session over projects that others delete or that can't be written: what is told, and where what isn't saved is
// kept.
#include <algorithm>
#include <cstdlib>

#include "sample_game/session.hpp"
#include "tests/editor/editing.hpp"

using namespace espalier::document;
namespace fs = std::filesystem;

namespace {

// A window's workspace without the window, and the user's settings in a folder of the test's own.
struct Window {
    sample::Workspace work;
    sample::Session session;
    double now = 0;

    Window(const Folder& folder, const std::string& file) {
        ::setenv("XDG_CONFIG_HOME", folder.file("config").c_str(), 1);
        Editing editing(file);
        work.context = std::move(editing.context);
        work.document = std::move(editing.document);
        session.begin(work, file);
    }
    ~Window() { session.givesUp = true, session.end(work), work.document.reset(); }
    void fill(float value) { REQUIRE(work.perform(FillLayer{"mask", value})); }
    bool save(const std::string& folder) {
        bool saved = false;
        session.save(work, folder, [&](bool good) { saved = good; });
        session.background().finish();
        return saved;
    }
    // As much time as files are looked at in, and autosaves are made.
    void wait() {
        for (int i = 0; i < 5; ++i) {
            now += session.autosaveEvery;
            (void)session.step(work, now);
            session.background().finish();
        }
    }
};

float maskOf(const std::string& project) {
    Editing opened(project);
    espalier::scene::GreyPicture mask;
    REQUIRE(opened.document->readLayer(0, "mask", mask, opened.error));
    return *std::ranges::min_element(mask.texels);
}

// The only autosave beside the user's settings.
std::string keptIn(const Folder& folder) {
    std::string found;
    if (!fs::exists(folder.path / "config")) return found;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path / "config"))
        if (entry.path().filename() == "autosave.json") {
            CHECK(found.empty());
            found = entry.path().string();
        }
    return found;
}

}  // namespace

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
        fs::copy(fs::path(keptIn(folder)).parent_path(), folder.file("copy"), fs::copy_options::recursive);
    }
    // As if it had ended there.
    fs::remove(folder.file("other/layers"));
    fs::rename(folder.file("aside2"), folder.file("other/layers"));
    std::string name = folder.file("other");
    std::ranges::replace(name, '/', '-');
    fs::copy(folder.file("copy"), folder.file("config/espalier/unsaved/" + name), fs::copy_options::recursive);
    Window again(folder, folder.file("other"));
    REQUIRE(again.session.recovery() == keptIn(folder));
    CHECK(maskOf(again.session.recovery()) == .75f);
    again.session.forgetRecovery(true);
    CHECK(keptIn(folder) == "");
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
