// Panels and dialogues whose widgets are pressed one by one: what each does to the document and on disk.
#include "tests/editor/widgets.hpp"

#include <chrono>

#include "sample_game/dialogue.hpp"
#include "sample_game/panels.hpp"
#include "tools/document/project.hpp"

using namespace espalier::document;
using espalier::scene::House;
using espalier::scene::houseNow;
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
        for (int i = 0; i < ImGuiKey_COUNT; ++i) ImGui::GetIO().KeyMap[i] = i;
        ImGui::GetIO().KeysDown[ImGuiKey_Escape] = escape;
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

// The panel of the first house of a town.
struct HousePanel : Editor {
    explicit HousePanel(const Folder& folder) : Editor(folder, content("street.json"), sample::Tool::houses) {
        panels = [this] {
            ImGui::SetNextWindowSize({320, 700});
            ImGui::Begin("panel");
            sample::housesPanel(work);
            ImGui::End();
        };
        work.house = 0;
        for (int i = 0; i < 3; ++i) frame({});
    }
    House house() const { return houseNow(work.context.get(), 0); }
    std::vector<Part> ofHouse(std::vector<Part> path) const {
        path.insert(path.begin(), int(*work.house));
        return path;
    }
    void press(const std::vector<Part>& path) { pressWidget(*this, "panel", ofHouse(path)); }
    void choose(const std::vector<Part>& combo, const char* choice) {
        chooseFrom(*this, "panel", ofHouse(combo), choice);
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
        offered = dialogue.session.recovery();
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
    CHECK(again.session.recovery() == offered);
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
    const std::string one = dialogue.session.recovery();
    dialogue.press("Decide later");
    CHECK(dialogue.asks());
    const std::string other = dialogue.session.recovery();
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
    ImGui::GetIO().KeysDown[ImGuiKey_Escape] = false;
    for (int i = 0; i < 3; ++i) dialogue.frame({});
    CHECK(dialogue.asks());
    ImGui::GetIO().KeysDown[ImGuiKey_Escape] = true;
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
    dialogue.session.refuseRecovery("out of memory");
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
    CHECK(!two.session.holdsBack());
    one.fill(.25f);
    one.wait();
    CHECK(two.session.holdsBack());
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
    CHECK(!two.session.holdsBack());
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
    CHECK(two.session.holdsBack());
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
        offered = dialogue.session.recovery();
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
        CHECK(again.session.recovery() == offered);
        ImGui::GetIO().KeysDown[ImGuiKey_Escape] = true;  // later
        for (int i = 0; i < 3; ++i) again.frame({});
        ImGui::GetIO().KeysDown[ImGuiKey_Escape] = false;
        CHECK(again.session.holdsBack());
        again.fill(1);
        CHECK(!sample::askToSave(again.work, again.session));  // that it would go is asked about
        CHECK_MESSAGE(contains(sample::dialogues().why, "hasn't saved"), sample::dialogues().why);
        CHECK(autosavesIn(garden) == std::vector{offered});
        CHECK(again.save(garden));
        CHECK(!again.session.holdsBack());
        again.fill(.25f);
        again.wait();  // in the project again
        CHECK(autosavesIn(garden) == std::vector{offered});
    }
}

TEST_CASE("each widget of a house's panel does what it says, as one step of undo") {
    const Folder folder;
    HousePanel panel(folder);
    const auto steps = [&] { return panel.work.document->undoSteps(); };
    REQUIRE(panel.house().look);
    size_t before = steps();
    const auto oneStep = [&] { return steps() == ++before; };

    const float planned = panel.house().slope;
    REQUIRE(planned > 0);
    panel.choose({"##kind"}, "Gambrel");
    CHECK(panel.house().shape == "gambrel");
    CHECK(panel.house().slope == 0);  // the kind's own
    CHECK(oneStep());
    panel.choose({"Covering", "##choice"}, "Slate");
    CHECK(panel.house().look->covering == "slate");
    CHECK(oneStep());
    panel.choose({"Chimneys", "##choice"}, "None");
    CHECK(panel.house().look->chimneys == "none");
    CHECK(panel.house().look->covering == "slate");
    CHECK(oneStep());
    panel.press({"Colour"});
    CHECK(panel.house().look->colour.size() == 3);
    CHECK(oneStep());
    panel.press({"Colour"});
    CHECK(panel.house().look->colour.empty());
    CHECK(oneStep());
    panel.press({"Overhang"});
    CHECK(panel.house().look->overhang == .4f);
    CHECK(oneStep());
    panel.press({"Pitch", "Pitch"});
    CHECK(panel.house().slope > 0);
    CHECK(oneStep());
    panel.press({"Pitch", "Pitch"});
    CHECK(panel.house().slope == 0);
    CHECK(oneStep());
    CHECK(panel.work.error == "");

    panel.press({"As it was planned"});
    CHECK(panel.all<ResetHouse>().size() == 1);
    CHECK(panel.house().shape != "gambrel");
    CHECK(panel.house().look->covering != "slate");
    CHECK(oneStep());
    panel.undo();
    CHECK(panel.house().shape == "gambrel");
    CHECK(panel.house().look->covering == "slate");
}

TEST_CASE("another kind of roof has a pitch of its own, or the plan's, unless the user has set one") {
    const Folder folder;
    HousePanel panel(folder);
    const House planned = panel.house();
    REQUIRE(planned.slope > 0);
    REQUIRE(planned.shape == "gable");
    panel.choose({"##kind"}, "Mansard");
    CHECK(panel.house().shape == "mansard");
    CHECK(panel.house().slope == 0);
    EspHouseInfo own;
    REQUIRE(espHouseInfo(panel.work.context.get(), 0, &own) == ESP_OK);
    House kept = planned;
    kept.shape = "mansard";
    REQUIRE(panel.work.perform(SetHouse{kept}));
    EspHouseInfo before;
    REQUIRE(espHouseInfo(panel.work.context.get(), 0, &before) == ESP_OK);
    CHECK(own.ridgeHeight != doctest::Approx(before.ridgeHeight));
    panel.undo();

    panel.choose({"##kind"}, "Gable");
    CHECK(panel.house() == planned);
    panel.undo();
    panel.undo();
    CHECK(panel.house() == planned);
    CHECK(panel.work.document->undoSteps() == 0);

    House steep = planned;
    steep.slope = 1.5f;
    REQUIRE(panel.work.perform(SetHouse{steep}));
    for (const char* kind : {"Mansard", "Hip", "Gable"}) {
        panel.choose({"##kind"}, kind);
        CHECK(panel.house().slope == 1.5f);
    }
}

TEST_CASE("an edge's end and pitch are its own") {
    const Folder folder;
    HousePanel panel(folder);
    panel.work.houseEdge = 1;
    panel.frame({});
    panel.choose({"##end"}, "Gable");
    REQUIRE(panel.house().edges.size() == 1);
    CHECK(panel.house().edges[0].edge == 1);
    CHECK(panel.house().edges[0].end == "gable");
    panel.choose({"##end"}, "Eave");
    panel.press({1, "Pitch##edge", "Pitch##edge"});
    CHECK(panel.house().edges[0].slope > 0);
    panel.press({1, "Pitch##edge", "Pitch##edge"});
    panel.choose({"##end"}, "As the kind says");
    CHECK(panel.house().edges.empty());
}

TEST_CASE("F4 opens the text of the grammar whose group is open") {
    const Folder folder;
    Editor editor(folder, content("village.json"), sample::Tool::look);
    editor.panels = [&] {
        ImGui::Begin("panel");
        sample::grammarsPanel(editor.work);
        ImGui::End();
    };
    const auto opens = [&](sample::Tool tool) {
        editor.work.choose(tool);
        for (int i = 0; i < 3; ++i) editor.frame({});
        for (const bool shown : {true, false}) {
            editor.key(GLFW_KEY_F4);
            CHECK(editor.work.layout.grammar == shown);
        }
        return std::filesystem::path(editor.work.scene().grammars[editor.work.openGrammar].file).stem().string();
    };
    CHECK(opens(sample::Tool::look).starts_with("ivy"));
    CHECK(opens(sample::Tool::houses) == "town");
    CHECK(opens(sample::Tool::look).starts_with("ivy"));
}

TEST_CASE("F5 tells where a scene has no atlas, and leaves what was chosen for others") {
    const Folder folder;
    for (const bool there : {true, false}) {
        CAPTURE(there);
        Editor editor(folder, there ? smallScene(folder) : content("town.json"), sample::Tool::look);
        for (const bool before : {false, true}) {
            editor.work.layout.atlas = before;
            editor.work.message.clear();
            editor.key(GLFW_KEY_F5);
            CHECK(editor.work.layout.atlas == (there ? !before : before));
            CHECK_MESSAGE(editor.work.message.empty() == there, editor.work.message);
        }
    }
}

TEST_CASE("buttons that have nothing to act on do nothing, even if they are pressed") {
    const Folder folder;
    folder.write("own.grammar", readAll(content("grammars/ivy_guided.grammar")));
    std::string scene = readAll(smallScene(folder));
    const std::string name = content("grammars/ivy_guided.grammar");
    scene.replace(scene.find(name), name.size(), "own.grammar");
    Editor editor(folder, folder.write("own.json", scene), sample::Tool::branch);
    editor.panels = [&] {
        ImGui::Begin("panel");
        sample::branchPanel(editor.work);
        ImGui::End();
        sample::showGrammarWindow(editor.work);
    };
    editor.work.layout.grammar = true;
    fs::remove(folder.path / "own.grammar");
    for (int i = 0; i < 3; ++i) editor.frame({});
    for (const char* button : {"Freeze plant", "Prune  Del"}) pressWidget(editor, "panel", {button});
    pressWidget(editor, "###grammar", {"Take from file"});
    CHECK(editor.work.document->undoSteps() == 0);
}

TEST_CASE("words that there is no room for end in an ellipsis, between letters, and their widget works all the same") {
    const Folder folder;
    Editor editor(folder, smallScene(folder), sample::Tool::look);
    const std::string words = "Gr\u00fc\u00dfe aus G\u00fctersloh";
    bool on = false;
    editor.panels = [&] {
        ImGui::SetNextWindowSize({90, 200});
        ImGui::Begin("panel");
        const float whole = ImGui::CalcTextSize(words.c_str()).x;
        CHECK(sample::shortened(words, whole) == words);
        for (float room = whole - 1; room > 20; room -= 5) {
            const std::string shown = sample::shortened(words, room);
            CHECK(ImGui::CalcTextSize(shown.c_str()).x <= room);
            REQUIRE(shown.ends_with("\u2026"));
            CHECK(words.starts_with(shown.substr(0, shown.size() - 3)));
            CHECK((shown.size() < 4 || (words[shown.size() - 3] & 0xC0) != 0x80));
        }
        CHECK(sample::shortened(words, 0) == "\u2026");
        (void)sample::checkBox(words.c_str(), &on);
        ImGui::End();
    };
    for (int i = 0; i < 3; ++i) editor.frame({});
    pressWidget(editor, "panel", {("###" + words).c_str()});
    CHECK(on);
}

TEST_CASE("what a list of choices has no room for ends in an ellipsis, and its tip says the whole") {
    const Folder folder;
    Editor editor(folder, smallScene(folder), sample::Tool::look);
    const std::string words = "A choice of many words";
    std::string text, chosen = words;
    float width = 100;
    const auto layOut = [&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({400, 200});
        ImGui::Begin("panel");
        ImGui::SetNextItemWidth(width);
        if (sample::beginCombo("##choice", chosen)) {
            for (const char* choice : {words.c_str(), "None"})
                if (ImGui::Selectable(choice)) chosen = choice;
            ImGui::EndCombo();
        }
        sample::toolTip("What it is for");
        ImGui::End();
    };
    editor.panels = [&] { text = wordsOf(layOut); };
    const auto rest = [&](glm::vec2 at) {
        editor.mouse = at;
        for (int i = 0; i < 60; ++i) ImGui::GetIO().DeltaTime = .05f, editor.frame({});
    };
    rest({600, 400});
    CHECK(contains(text, "\u2026"));
    CHECK(!contains(text, words));
    rest({40, 40});  // on it
    CHECK_MESSAGE(contains(text, words), text);
    CHECK(contains(text, "What it is for"));
    width = 390;
    rest({600, 400});
    CHECK(contains(text, words));
    CHECK(!contains(text, "\u2026"));
    width = 100;
    chooseFrom(editor, "panel", {"##choice"}, "None");
    CHECK(chosen == "None");
    rest({40, 40});
    CHECK(!contains(text, words));
}

TEST_CASE("light and view stand before what grammars have, with every tool") {
    const Folder folder;
    Editor editor(folder, smallScene(folder), sample::Tool::look);
    editor.panels = [&] { sample::showPanel(editor.work); };
    const auto heightOf = [&](ImGuiID id) {
        for (editor.mouse = {60, 0}; editor.mouse.y < editor.work.window.y; editor.mouse.y += 3) {
            editor.frame({});
            if (ImGui::GetCurrentContext()->HoveredId == id) return editor.mouse.y;
        }
        FAIL("it isn't in the panel");
        return 0.f;
    };
    for (const sample::Tool tool : {sample::Tool::look, sample::Tool::seeds, sample::Tool::branch}) {
        editor.work.choose(tool);
        for (int i = 0; i < 3; ++i) editor.frame({});
        const char* group = tool == sample::Tool::look ? "look" : "tool";
        const float light = heightOf(widget("Espalier", {group, "Light and view"}));
        CHECK(light < 90);
        CHECK(light < heightOf(widget("Espalier", {0, "###ivy_guided"})));
    }
}
