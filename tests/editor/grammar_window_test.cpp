// The window with a grammar's text as it is typed into: what compiles, what goes on growing, and what the keys mean.
#include <algorithm>
#include <array>

#include "sample_game/panels.hpp"
#include "sample_game/remarks.hpp"
#include "tests/editor/imgui_keys.hpp"
#include "tests/editor/widgets.hpp"

using namespace espalier::document;
using sample::Tool;

namespace {

struct Writer : Editor {
    explicit Writer(const Folder& folder) : Writer(folder, smallScene(folder)) {}
    Writer(const Folder& folder, const std::string& scene) : Editor(folder, scene, Tool::look) {
        work.window = {1280, 720};
        work.layout.grammar = true;
        panels = [this] {
            sample::beginGesture(work);
            sample::showGrammarWindow(work);
        };
        rest();
    }
    ~Writer() { sample::leaveGrammar(); }
    const espalier::scene::LoadedGrammar& grammar() const { return work.scene().grammars[0]; }
    void rest() {
        for (int i = 0; i < 4; ++i) frame({});
    }
    void clickOn(glm::vec2 at) {
        mouse = at;
        for (const bool down : {false, true, false}) {
            ImGui::GetIO().MouseDown[0] = down;
            frame({});
        }
        rest();
    }
    // Of those above the text.
    void clickButton(const char* label) {
        const ImGuiID wanted = widget("###grammar", {label});
        for (float y = 60; y < 140; y += 5)
            for (float x = 680; x < 1280; x += 10) {
                mouse = {x, y};
                frame({});
                if (ImGui::GetCurrentContext()->HoveredId == wanted) return clickOn({x, y});
            }
        FAIL(label << " isn't there");
    }
    // Behind its last letter.
    void enterText() {
        clickOn({1000, 300});
        widgetKey(ImGuiKey_End, true);
    }
    void widgetKey(ImGuiKey key, bool ctrl = false) {
        setControl(ctrl);
        setKey(key, true);
        frame({});
        setKey(key, false);
        setControl(false);
        rest();
    }
    void type(const std::string& text) {
        for (const char letter : text) {
            ImGui::GetIO().AddInputCharacter(unsigned(letter));
            frame({});
        }
        rest();
    }
    uint64_t nodes() {
        EspStats stats;
        REQUIRE(espUpdate(work.context.get()) == ESP_OK);
        REQUIRE(espReadStats(work.context.get(), &stats) == ESP_OK);
        return stats.nodes;
    }
};

}  // namespace

TEST_CASE("what is typed compiles with each letter; a mistake stands at its line while the last good text grows") {
    const Folder folder;
    Writer writer(folder);
    const std::string before = writer.grammar().text;
    const uint64_t grown = writer.nodes();
    REQUIRE(grown > 100);
    writer.enterText();
    writer.type("// a note");
    CHECK(writer.grammar().text == before + "// a note");
    CHECK(writer.grammar().error == "");
    writer.type("\nNew -> Nothing(");
    CHECK(writer.grammar().error != "");
    CHECK(writer.grammar().grows == before + "// a note\n");
    const auto remarks = sample::remarksOf(writer.grammar());
    REQUIRE(!remarks.empty());
    const std::string typed = writer.grammar().text;
    CHECK(remarks.front().line == 1 + std::count(typed.begin(), typed.end(), '\n'));
    CHECK(writer.nodes() == grown);
    // Mended, it grows by what is written now.
    for (int i = 0; i < 15; ++i) writer.widgetKey(ImGuiKey_Backspace);
    CHECK(writer.grammar().text == before + "// a note\n");
    CHECK(writer.grammar().error == "");
    CHECK(writer.nodes() == grown);
}

TEST_CASE("lines' numbers stay beside a text that is scrolled sideways, and a click at one goes into it") {
    const Folder folder;
    Writer writer(folder);
    writer.enterText();
    writer.type("// " + std::string(200, 'a'));
    const ImGuiWindow *text = nullptr, *grammar = ImGui::FindWindowByName("###grammar");
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
        if (window->WasActive && window->ParentWindow == grammar && contains(window->Name, "/text_")) text = window;
    REQUIRE(grammar);
    REQUIRE(text);
    CHECK(text->Scroll.x > 500);
    CHECK(text->Pos.x > grammar->Pos.x + 20);
    writer.widgetKey(ImGuiKey_Escape);
    REQUIRE(!ImGui::IsAnyItemActive());
    CHECK(!sample::usesPanels());
    const ImVec2 before = text->Scroll;
    writer.mouse = {text->Pos.x - 10, text->Pos.y + 60};
    for (const bool down : {false, true, true, true, true, true, false}) {
        ImGui::GetIO().MouseDown[0] = down;
        writer.frame({});
    }
    writer.rest();
    CHECK(text->Scroll.y == before.y);
    CHECK(ImGui::IsAnyItemActive());
    CHECK(sample::usesPanels());
}

TEST_CASE("a window in a small window is small, and as it was once there is room again") {
    const Folder folder;
    Writer writer(folder);
    const auto place = [] {
        const ImGuiWindow* window = ImGui::FindWindowByName("###grammar");
        REQUIRE(window);
        return std::array{window->Pos.x, window->Pos.y, window->Size.x, window->Size.y};
    };
    // Dragged by its title to a place of the user's.
    const auto first = place();
    writer.mouse = {first[0] + 200, first[1] + 8};
    for (const float by : {0.f, 0.f, 0.f, 10.f, 30.f, 60.f}) {
        ImGui::GetIO().MouseDown[0] = true;
        writer.mouse.x = first[0] + 200 - by;
        writer.frame({});
    }
    ImGui::GetIO().MouseDown[0] = false;
    writer.rest();
    const auto before = place();
    CHECK(before[0] == first[0] - 60);
    writer.work.window = {400, 300};
    writer.rest();
    CHECK(place()[0] + place()[2] <= 400);
    CHECK(place()[1] + place()[3] <= 300);
    writer.clickOn({200, place()[1] + 8});  // on its title: it stays
    writer.work.window = {1280, 720};
    writer.rest();
    CHECK(place() == before);
}

TEST_CASE("in a grammar's text Ctrl+Z goes back over what was typed and leaves the scene alone") {
    const Folder folder;
    Writer writer(folder);
    const std::string before = writer.grammar().text;
    writer.fill(.5f);
    writer.enterText();
    writer.type("// one");
    REQUIRE(writer.grammar().text == before + "// one");
    REQUIRE(writer.work.document->undoSteps() == 2);
    writer.widgetKey(ImGuiKey_Z, true);
    CHECK(writer.grammar().text == before);
    CHECK(writer.work.document->undoSteps() == 1);
    writer.widgetKey(ImGuiKey_Z, true);
    CHECK(writer.work.document->undoSteps() == 1);
    CHECK_MESSAGE(contains(writer.work.message, "Nothing more of the text"), writer.work.message);
    writer.widgetKey(ImGuiKey_Y, true);
    CHECK(writer.grammar().text == before + "// one");
    // Outside the text the same keys are the scene's.
    writer.widgetKey(ImGuiKey_Escape);
    CHECK(writer.grammar().text == before + "// one");
    writer.undo();
    writer.undo();
    CHECK(writer.grammar().text == before);
    CHECK(writer.work.document->undoSteps() == 0);
}

TEST_CASE("letters that are typed into a grammar's text choose no tool, and neither do those after Esc has left it") {
    const Folder folder;
    Writer writer(folder);
    writer.enterText();
    writer.key(GLFW_KEY_B);
    CHECK(writer.work.tool == Tool::look);
    writer.widgetKey(ImGuiKey_Escape);
    REQUIRE(sample::grammarFocused());
    writer.key(GLFW_KEY_B);
    CHECK(writer.work.tool == Tool::look);
    // A second Esc leaves the window.
    writer.key(GLFW_KEY_ESCAPE);
    writer.rest();
    CHECK(!sample::grammarFocused());
    writer.key(GLFW_KEY_B);
    CHECK(writer.work.tool == Tool::paint);
}

TEST_CASE("a text that was written to its file is taken back by undo, and the file stays; both are told, and unsaved") {
    const Folder folder;
    Writer writer(folder, sceneOfItsOwn(folder));
    const std::string file = folder.file("own.grammar"), before = writer.grammar().text, typed = before + "// typed\n";
    REQUIRE(writer.work.perform(writer.work.document->withText(0, typed)));
    writer.rest();
    writer.work.error = "what failed before";
    writer.clickButton("Write to file");
    CHECK(readAll(file) == typed);
    CHECK_MESSAGE(writer.work.error.empty(), writer.work.error);
    CHECK_MESSAGE(contains(writer.work.message, file), writer.work.message);
    CHECK_MESSAGE(contains(writer.work.message, "undo"), writer.work.message);
    CHECK(writer.session.modified(writer.work));  // the project's own text is saved with it
    CHECK(writer.work.document->undoSteps() == 1);
    // At once, before anybody has looked at files.
    writer.undo();
    writer.wait();
    CHECK(writer.grammar().text == before);
    CHECK(readAll(file) == typed);
    CHECK(writer.work.document->undoSteps() == 0);
    CHECK(!writer.session.modified(writer.work));
    // What somebody else writes then is news all the same.
    folder.write("own.grammar", before + "// theirs\n");
    writer.wait();
    CHECK(writer.grammar().text == before + "// theirs\n");
}
