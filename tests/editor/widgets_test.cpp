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

    panel.press({"Reset to plan"});
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

    panel.choose({"##kind"}, "Hip");  // pitched alike: the plan's
    CHECK(panel.house().slope == planned.slope);
    panel.undo();
    panel.choose({"##kind"}, "Gable");
    CHECK(panel.house() == planned);
    panel.choose({"##kind"}, "Half-hip");
    CHECK(panel.house().slope == planned.slope);
    panel.undo();
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
        const float light = heightOf(widget(childOf("Espalier", "rest"), {group, "Light and view"}));
        CHECK(light < 90);
        CHECK(light < heightOf(widget(childOf("Espalier", "rest"), {0, "###ivy_guided"})));
    }
}

TEST_CASE("the tools stay in sight however far the panel is scrolled") {
    const Folder folder;
    Editor editor(folder, smallScene(folder), sample::Tool::paint);
    editor.panels = [&] { sample::showPanel(editor.work); };
    for (int i = 0; i < 3; ++i) editor.frame({});
    ImGuiWindow* rest = ImGui::FindWindowByName(childOf("Espalier", "rest").c_str());
    REQUIRE(rest);
    REQUIRE(rest->ScrollMax.y > 100);
    const auto toolAt = [&](glm::vec2 at) {
        editor.mouse = at;
        editor.frame({});
        editor.frame({});
        return ImGui::GetCurrentContext()->HoveredId == widget("Espalier", {"Look Q"});
    };
    const glm::vec2 look{30, ImGui::GetFrameHeight() + 18};
    REQUIRE(toolAt(look));
    ImGui::SetScrollY(rest, rest->ScrollMax.y);
    CHECK(toolAt(look));
    CHECK(rest->Scroll.y > 100);
}
