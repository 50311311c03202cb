// What editors that came to a sudden end have left behind: asked about, kept, and taken by nobody unasked.
#include <chrono>

#include "sample_game/dialogue.hpp"
#include "sample_game/panels.hpp"
#include "tests/editor/imgui_keys.hpp"
#include "tests/editor/widgets.hpp"
#include "tools/document/project.hpp"

using namespace espalier::document;
namespace fs = std::filesystem;

namespace {

// Leaves behind what an editor of `file` had kept when it came to a sudden end.
void crash(const Folder& folder, const std::string& file, float mask) {
    const fs::path kept = folder.path / "kept";
    {
        Window window(folder, file);
        window.fill(mask);
        window.wait();
        fs::create_directories(kept);
        for (const char* part : {"config", "garden"})
            if (fs::exists(folder.path / part)) fs::copy(folder.path / part, kept / part, fs::copy_options::recursive);
    }
    for (const auto& part : fs::directory_iterator(kept)) {
        fs::remove_all(folder.path / part.path().filename());
        fs::rename(part.path(), folder.path / part.path().filename());
    }
    fs::remove_all(kept);
    // Copies were made in any order; an autosave is younger than its project.
    for (const std::string& autosave : autosavesIn(folder.path))
        fs::last_write_time(autosave, fs::file_time_type::clock::now() + std::chrono::seconds(2));
}

struct Dialogue : Editor {
    static constexpr const char* kTitle = "Unsaved work";
    Dialogue(const Folder& folder, const std::string& file, bool escape = false)
        : Editor(folder, file, sample::Tool::look) {
        setKey(ImGuiKey_Escape, escape);
        panels = [this] { sample::showDialogues(work, session); };
        for (int i = 0; i < 3; ++i) frame({});
    }
    ~Dialogue() { sample::closeDialogues(); }
    void press(const char* button) { pressWidget(*this, kTitle, {button}); }
    bool asks() const {
        const ImGuiWindow* window = ImGui::FindWindowByName(kTitle);
        return window && window->WasActive;
    }
};

}  // namespace

TEST_CASE("what an editor left behind is thrown away by a second click only") {
    const Folder folder;
    const std::string scene = smallScene(folder);
    crash(folder, scene, .25f);
    REQUIRE(autosavesIn(folder.path / "config").size() == 1);
    Dialogue dialogue(folder, scene);
    REQUIRE(dialogue.asks());
    dialogue.press("Throw it away");
    CHECK(autosavesIn(folder.path / "config").size() == 1);
    CHECK(dialogue.asks());
    ImGui::GetIO().MouseClickedLastCount[0] = 2;  // of a double click
    dialogue.press("Yes, throw it away");
    CHECK(autosavesIn(folder.path / "config").size() == 1);
    ImGui::GetIO().MouseClickedLastCount[0] = 1;
    dialogue.press("Yes, throw it away");
    CHECK(autosavesIn(folder.path / "config").size() == 0);
    CHECK(!dialogue.asks());
}

TEST_CASE("what an editor left behind can wait, beside what is done meanwhile, and is offered again") {
    const Folder folder;
    const std::string scene = smallScene(folder);
    crash(folder, scene, .25f);
    std::string offered;
    {
        Dialogue dialogue(folder, scene);
        offered = dialogue.session.autosaves().recovery();
        dialogue.press("Decide later");
        CHECK(!dialogue.asks());
        dialogue.fill(.75f);
        dialogue.wait();
        CHECK(autosavesIn(folder.path / "config").size() == 2);
        dialogue.frame({});
        CHECK(!dialogue.asks());
    }
    Dialogue again(folder, scene);
    CHECK(again.asks());
    CHECK(again.session.autosaves().recovery() == offered);
    again.press("Open it");
    CHECK(again.session.openNext == offered);
    CHECK(!again.asks());
}

TEST_CASE("of several editors' work that waits, each is offered in turn") {
    const Folder folder;
    const std::string scene = smallScene(folder);
    crash(folder, scene, .25f);
    // A second one, which had put that off.
    const fs::path kept = folder.path / "config/espalier/unsaved";
    REQUIRE(fs::exists(kept));
    const fs::path first = fs::directory_iterator(kept)->path();
    fs::copy(first, first.string() + "-2", fs::copy_options::recursive);
    Dialogue dialogue(folder, scene);
    const std::string one = dialogue.session.autosaves().recovery();
    dialogue.press("Decide later");
    CHECK(dialogue.asks());
    const std::string other = dialogue.session.autosaves().recovery();
    CHECK(other != "");
    CHECK(other != one);
    dialogue.press("Decide later");
    CHECK(!dialogue.asks());
    dialogue.fill(.75f);
    dialogue.wait();
    CHECK(autosavesIn(folder.path / "config").size() == 3);
}

TEST_CASE("Esc puts off what waits, but not the Esc that was pressed before it was asked about") {
    const Folder folder;
    const std::string scene = smallScene(folder);
    crash(folder, scene, .25f);
    Dialogue dialogue(folder, scene, true);
    CHECK(dialogue.asks());
    setKey(ImGuiKey_Escape, false);
    for (int i = 0; i < 3; ++i) dialogue.frame({});
    CHECK(dialogue.asks());
    setKey(ImGuiKey_Escape, true);
    for (int i = 0; i < 3; ++i) dialogue.frame({});
    CHECK(!dialogue.asks());
    CHECK(autosavesIn(folder.path / "config").size() == 1);
}

TEST_CASE("what was left behind and can't be opened is asked about again, and isn't written over") {
    const Folder folder;
    const std::string garden = folder.file("garden");
    {
        Window window(folder, smallScene(folder));
        REQUIRE(window.save(garden));
    }
    crash(folder, garden, .25f);
    const std::string kept = readAll(garden + "/autosave.json");
    Dialogue dialogue(folder, garden);
    dialogue.press("Open it");
    CHECK(dialogue.session.openNext == garden + "/autosave.json");
    CHECK(!dialogue.asks());
    // As the application does when it fails.
    dialogue.session.openNext.clear();
    dialogue.session.autosaves().refuseRecovery("out of memory");
    for (int i = 0; i < 3; ++i) dialogue.frame({});
    CHECK(dialogue.asks());
    std::string words;
    const auto layOut = dialogue.panels;
    dialogue.panels = [&] { words = wordsOf(layOut); };
    dialogue.frame({});
    dialogue.panels = layOut;
    CHECK_MESSAGE(contains(words, "out of memory"), words);
    dialogue.fill(.75f);
    dialogue.wait();
    CHECK(readAll(garden + "/autosave.json") == kept);
    dialogue.press("Decide later");
    CHECK(!dialogue.asks());
    dialogue.wait();
    CHECK(readAll(garden + "/autosave.json") == kept);
    CHECK(autosavesIn(folder.path / "config").size() == 1);
}

TEST_CASE("a grammar that is saved elsewhere while one is asked about what was left behind doesn't take its place") {
    const Folder folder;
    const std::string garden = folder.file("garden"), autosave = garden + "/autosave.json";
    {
        Window window(folder, sceneOfItsOwn(folder));
        REQUIRE(window.save(garden));
    }
    crash(folder, garden, .25f);
    const std::string kept = readAll(autosave);
    {
        Dialogue dialogue(folder, garden);
        std::ofstream(folder.path / "own.grammar", std::ios::app) << "// saved elsewhere\n";
        dialogue.wait();
        CHECK(dialogue.all<SetText>().empty());
        dialogue.press("Open it");
        dialogue.session.end(dialogue.work);  // as it is open
        CHECK(readAll(autosave) == kept);
    }
    Window recovered(folder, autosave);
    std::ofstream(autosave) << "{}";
    recovered.wait();  // it is kept once more, whatever lay there
    const std::string now = readAll(autosave);
    CHECK_MESSAGE(contains(now, "\"mask\": 0.25"), now);
}

TEST_CASE("the second editor of a project asks before its save takes what the first had kept") {
    const Folder folder;
    const std::string garden = folder.file("garden");
    Window one(folder, smallScene(folder));
    REQUIRE(one.save(garden));
    Dialogue two(folder, garden);
    two.fill(.5f);
    CHECK(!two.session.autosaves().holdsBack());
    one.fill(.25f);
    one.wait();
    CHECK(two.session.autosaves().holdsBack());
    CHECK(!sample::askToSave(two.work, two.session));
    CHECK_MESSAGE(contains(sample::dialogues().why, "hasn't saved"), sample::dialogues().why);
    CHECK(autosavesIn(garden).size() == 1);
    // Of two doubts both are told.
    REQUIRE(one.save(garden));
    one.fill(.75f);
    one.wait();
    REQUIRE(two.session.changedByOthers());
    CHECK(!sample::askToSave(two.work, two.session));
    for (const char* doubt : {"saved by somebody else", "hasn't saved"})
        CHECK_MESSAGE(contains(sample::dialogues().why, doubt), sample::dialogues().why);
    REQUIRE(two.save(garden));
    CHECK(autosavesIn(garden).empty());
    CHECK(!two.session.autosaves().holdsBack());
}

TEST_CASE("what the first editor of a project left stays when the second reads its files again") {
    const Folder folder;
    const std::string garden = folder.file("garden"), autosave = garden + "/autosave.json";
    auto one = std::make_unique<Window>(folder, smallScene(folder));
    REQUIRE(one->save(garden));
    Dialogue two(folder, garden);
    const auto origin = two.session.origin(two.work);
    one->fill(.25f);
    one->wait();
    const std::string kept = readAll(autosave);
    one.reset();
    folder.write("garden/autosave.json", kept);  // it came to a sudden end
    two.session.setOrigin(two.work, origin);
    CHECK(two.session.autosaves().holdsBack());
    two.fill(.5f);
    two.wait();
    CHECK(readAll(autosave) == kept);
}

TEST_CASE("what has lost something on being opened isn't written over before it is edited") {
    const Folder folder;
    const std::string garden = folder.file("garden"), autosave = garden + "/autosave.json";
    {
        Window window(folder, smallScene(folder));
        REQUIRE(window.save(garden));
    }
    crash(folder, garden, .25f);
    std::string kept = readAll(autosave);
    const size_t reach = kept.find("\"reach\"");
    REQUIRE(reach != std::string::npos);
    kept.replace(reach, 7, "\"gone\"");
    folder.write("garden/autosave.json", kept);
    Window window(folder, autosave);
    REQUIRE(!window.work.scene().notes.empty());
    window.wait();
    CHECK(readAll(autosave) == kept);
    window.fill(.5f);
    window.wait();
    CHECK(readAll(autosave) != kept);
}

TEST_CASE("an autosave is made anew when another program puts another project in its project's place") {
    const Folder folder;
    const std::string garden = folder.file("garden");
    Window window(folder, smallScene(folder));
    REQUIRE(window.save(garden));
    window.fill(.25f);
    window.wait();
    REQUIRE(recoverable(garden) == garden + "/autosave.json");
    folder.write("garden/project.json", readAll(garden + "/project.json") + "\n");
    CHECK(recoverable(garden) == "");
    window.wait();
    window.wait();
    CHECK(recoverable(garden) == garden + "/autosave.json");
}

TEST_CASE("a project's own autosave can wait, too, until the project is saved") {
    const Folder folder;
    const std::string garden = folder.file("garden");
    {
        Window window(folder, smallScene(folder));
        REQUIRE(window.save(garden));
    }
    crash(folder, garden, .25f);
    REQUIRE(autosavesIn(garden).size() == 1);
    std::string offered;
    {
        Dialogue dialogue(folder, garden);
        REQUIRE(dialogue.asks());
        offered = dialogue.session.autosaves().recovery();
        dialogue.press("Decide later");
        CHECK(!dialogue.asks());
        dialogue.fill(.75f);
        dialogue.wait();  // kept elsewhere
        CHECK(autosavesIn(folder.path / "config").size() == 1);
        dialogue.undo();
        dialogue.wait();  // nothing of its own is to be kept
        CHECK(autosavesIn(folder.path / "config").size() == 0);
        CHECK(autosavesIn(garden) == std::vector{offered});
        dialogue.fill(.5f);
        dialogue.wait();
        CHECK(autosavesIn(garden) == std::vector{offered});
        CHECK(autosavesIn(folder.path / "config").size() == 1);
    }
    {
        Dialogue again(folder, garden);
        REQUIRE(again.asks());
        CHECK(again.session.autosaves().recovery() == offered);
        setKey(ImGuiKey_Escape, true);  // later
        for (int i = 0; i < 3; ++i) again.frame({});
        setKey(ImGuiKey_Escape, false);
        CHECK(again.session.autosaves().holdsBack());
        again.fill(1);
        CHECK(!sample::askToSave(again.work, again.session));  // that it would go is asked about
        CHECK_MESSAGE(contains(sample::dialogues().why, "hasn't saved"), sample::dialogues().why);
        CHECK(autosavesIn(garden) == std::vector{offered});
        CHECK(again.save(garden));
        CHECK(!again.session.autosaves().holdsBack());
        again.fill(.25f);
        again.wait();  // in the project again
        CHECK(autosavesIn(garden) == std::vector{offered});
    }
}
