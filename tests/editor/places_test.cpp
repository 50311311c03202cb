// Where editors keep what isn't saved when there are several of them, no place at all, or a run was replayed before.
#include <cstdlib>

#include "tests/editor/window.hpp"
#include "tools/document/project.hpp"

using namespace espalier::document;
namespace fs = std::filesystem;

namespace {

float maskOf(const std::string& scene) {
    Editing opened(scene);
    espalier::scene::GreyPicture mask;
    REQUIRE(opened.document->readLayer(0, "mask", mask, opened.error));
    return mask.texels.front();
}

}  // namespace

TEST_CASE("two editors of one scene keep what is theirs apart, and are offered only what nobody uses") {
    const Folder folder;
    const std::string scene = smallScene(folder);
    const fs::path config = folder.path / "config";
    {
        Window one(folder, scene), two(folder, scene);
        one.fill(.25f);
        two.fill(.75f);
        one.wait();
        two.wait();
        std::vector<std::string> kept = autosavesIn(config);
        REQUIRE(kept.size() == 2);
        CHECK(maskOf(kept[0]) + maskOf(kept[1]) == 1);
        CHECK(maskOf(kept[0]) != maskOf(kept[1]));
        Window three(folder, scene);
        CHECK(three.session.autosaves().recovery() == "");
        one.fill(.5f);
        one.wait();
        CHECK(autosavesIn(config).size() == 2);
        fs::copy(config, folder.path / "copy", fs::copy_options::recursive);
    }
    CHECK(autosavesIn(config).empty());
    // As if both had ended there.
    fs::remove_all(config);
    fs::rename(folder.path / "copy", config);
    Window again(folder, scene), beside(folder, scene);
    CHECK(again.session.autosaves().recovery() != "");
    CHECK(beside.session.autosaves().recovery() != "");
    CHECK(again.session.autosaves().recovery() != beside.session.autosaves().recovery());
    again.session.autosaves().forgetRecovery(true);
    again.fill(.125f);
    again.wait();
    REQUIRE(autosavesIn(config).size() == 2);
    CHECK(maskOf(beside.session.autosaves().recovery()) != .125f);
}

TEST_CASE("the second editor of a project says so, keeps what is its own beside the settings and leaves the first's") {
    const Folder folder;
    const std::string garden = folder.file("garden");
    Window one(folder, smallScene(folder));
    REQUIRE(one.save(garden));
    Window two(folder, garden);
    CHECK_MESSAGE(contains(two.work.message, "is open in another editor"), two.work.message);
    one.fill(.25f);
    one.wait();
    two.fill(.75f);
    two.wait();
    CHECK(maskOf(garden + "/autosave.json") == .25f);
    const std::vector<std::string> kept = autosavesIn(folder.path / "config");
    REQUIRE(kept.size() == 1);
    CHECK(maskOf(kept[0]) == .75f);
    REQUIRE(two.work.perform(Undo{}));
    two.wait();
    CHECK(autosavesIn(folder.path / "config").empty());
    CHECK(maskOf(garden + "/autosave.json") == .25f);
    CHECK(!one.session.changedByOthers());
    // The second saves there all the same: what the first hasn't saved is kept once more, as what is newer.
    REQUIRE(two.save(garden));
    REQUIRE(!std::filesystem::exists(garden + "/autosave.json"));
    one.wait();
    CHECK(maskOf(garden + "/autosave.json") == .25f);
    CHECK(recoverable(garden) == garden + "/autosave.json");
}

TEST_CASE("who has no folder for settings is told that nothing is kept") {
    const Folder folder;
    Window window(folder, smallScene(folder));
    const char* home = std::getenv("HOME");
    const std::string had = home ? home : "";
    ::unsetenv("XDG_CONFIG_HOME");
    ::unsetenv("HOME");
    window.wait();
    CHECK(window.work.error == "");  // nothing is to be kept
    window.fill(.5f);
    window.wait();
    CHECK_MESSAGE(contains(window.work.error, "couldn't be kept"), window.work.error);
    if (home) ::setenv("HOME", had.c_str(), 1);
    ::setenv("XDG_CONFIG_HOME", folder.file("config").c_str(), 1);
}

TEST_CASE("what a replay has done counts as not saved, is kept by the run's name, and offered after the next one") {
    const Folder folder;
    const std::string scene = smallScene(folder), run = folder.file("run.jsonl");
    const fs::path config = folder.path / "config";
    {
        Window window(folder, scene);
        window.session.replays(run);
        window.fill(.25f);
        window.wait();
        CHECK(autosavesIn(config).empty());  // it is the run's
        window.session.endReplay();
        CHECK(window.session.modified(window.work));
        window.wait();
        REQUIRE(autosavesIn(config).size() == 1);
        CHECK(maskOf(autosavesIn(config)[0]) == .25f);
        window.fill(.75f);
        window.wait();
        REQUIRE(autosavesIn(config).size() == 1);
        CHECK_MESSAGE(contains(autosavesIn(config)[0], "/run.jsonl-"), autosavesIn(config)[0]);
        fs::copy(config, folder.path / "copy", fs::copy_options::recursive);
    }
    fs::remove_all(config);
    fs::rename(folder.path / "copy", config);
    Window again(folder, scene);
    CHECK(again.session.autosaves().recovery() == "");
    again.session.replays(run);
    CHECK(again.session.autosaves().recovery() == "");
    again.session.endReplay();
    REQUIRE(again.session.autosaves().recovery() != "");
    CHECK(maskOf(again.session.autosaves().recovery()) == .75f);
}
