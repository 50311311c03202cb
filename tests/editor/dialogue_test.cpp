// Dialogues and fields as they are clicked and typed into.
#include "sample_game/dialogue.hpp"

#include <imgui_internal.h>

#include "sample_game/folder_list.hpp"
#include "sample_game/panels.hpp"
#include "tests/editor/imgui_keys.hpp"
#include "tests/editor/widgets.hpp"

namespace {

// A window whose dialogues are laid out, and a mouse that ImGui sees.
struct Asked : Editor {
    explicit Asked(const Folder& folder) : Asked(folder, smallScene(folder)) {}
    Asked(const Folder& folder, const std::string& scene) : Editor(folder, scene, sample::Tool::look) {
        panels = [this] { sample::showDialogues(work, session); };
    }
    ~Asked() { sample::closeDialogues(); }
    void twice(glm::vec2 at) {
        move(at);
        for (const bool down : {true, false, true, false}) {
            ImGui::GetIO().MouseDown[0] = down;
            frame({});
        }
    }
    void settle() {
        for (int i = 0; i < 4; ++i) frame({});
    }
    // The middle of a row of the list.
    glm::vec2 row(int index) const {
        for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
            if (window->WasActive && contains(window->Name, "/folder_")) {
                const float line = ImGui::GetFontSize() + ImGui::GetStyle().ItemSpacing.y;
                return {window->Pos.x + 40,
                        window->Pos.y + ImGui::GetStyle().WindowPadding.y + (float(index) + .4f) * line};
            }
        FAIL("no list is shown");
        return {};
    }
};

// A slider of the time of the day that is typed into.
struct Field {
    Gui gui;
    float hour = 9;
    bool frame(bool begins = false, ImGuiKey key = ImGuiKey_COUNT) {
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = {400, 300};
        if (key != ImGuiKey_COUNT) setKey(key, true);
        ImGui::NewFrame();
        ImGui::Begin("panel");
        if (begins) ImGui::SetKeyboardFocusHere();
        const int minutes = int(std::lround(hour * 60));
        char text[16];
        std::snprintf(text, sizeof text, "%d:%02d", minutes / 60, minutes % 60);
        const bool changed = sample::labelledSlider("Time", &hour, 0, 24, text, false, sample::hoursOf);
        ImGui::End();
        ImGui::Render();
        if (key != ImGuiKey_COUNT) setKey(key, false);
        return changed;
    }
    void type(const std::string& text) {
        frame(true);
        for (int i = 0; i < 3; ++i) frame();
        for (const char letter : text) {
            ImGui::GetIO().AddInputCharacter(unsigned(letter));
            frame();
        }
    }
};

}  // namespace

TEST_CASE("a second click on a project opens it, and one on a folder leads into it") {
    const Folder folder;
    std::filesystem::create_directories(folder.path / "list/garden");
    std::filesystem::create_directories(folder.path / "list/garden/inner");
    std::filesystem::create_directories(folder.path / "list/zoo");
    folder.write("list/garden/project.json", readAll(content("town.json")));
    Asked asked(folder);
    sample::askToOpen(folder.file("list/"), "");
    asked.settle();
    asked.twice(asked.row(1));
    asked.settle();
    CHECK(asked.session.openNext == folder.file("list/garden"));
    asked.session.openNext.clear();

    sample::askToOpen(folder.file("list/"), "");
    asked.settle();
    asked.move(asked.row(2));
    ImGui::GetIO().MouseDown[0] = true;
    asked.frame({});
    ImGui::GetIO().MouseDown[0] = false;
    asked.settle();
    CHECK(std::string(sample::dialogues().file.data()) == folder.file("list/zoo/"));
    CHECK(asked.session.openNext.empty());
}

TEST_CASE("what is no scene is told of where it is named, before unsaved work is asked about") {
    const Folder folder;
    std::filesystem::create_directories(folder.path / "list/garden");
    folder.write("list/garden/project.json", "{}");
    Asked asked(folder);
    sample::askToOpen(folder.file("list/"), "");
    asked.settle();
    asked.twice(asked.row(1));
    asked.settle();
    CHECK(asked.session.openNext.empty());
    CHECK_MESSAGE(contains(sample::dialogues().why, "project.json:1:"), sample::dialogues().why);
    CHECK(!sample::dialogues().next);
}

TEST_CASE("a project is saved among other files only when that is said twice, and into an empty folder at once") {
    const Folder folder;
    std::filesystem::create_directories(folder.path / "full");
    std::filesystem::create_directories(folder.path / "empty");
    folder.write("full/note.txt", "not ours");
    for (const char* name : {"full", "empty"}) {
        CAPTURE(name);
        Asked asked(folder);
        const auto enter = [&] {
            setKey(ImGuiKey_Enter, true);
            asked.frame({});
            setKey(ImGuiKey_Enter, false);
            asked.settle();
            asked.session.background().finish();
            asked.settle();
        };
        sample::put(sample::dialogues().project, folder.file(name));
        sample::ask("Save the project");
        asked.settle();
        CHECK(sample::usesPanels());
        enter();
        const std::string project = folder.file(name) + "/project.json";
        const bool full = std::string(name) == "full";
        CHECK(std::filesystem::exists(project) == !full);
        if (!full) continue;
        CHECK_MESSAGE(contains(sample::dialogues().why, "holds other files"), sample::dialogues().why);
        enter();
        CHECK(std::filesystem::exists(project));
        CHECK(std::filesystem::exists(folder.file("full/note.txt")));
        CHECK(!sample::usesPanels());
    }
}

TEST_CASE("each file that an export of several surfaces writes is told, and each that an import reads") {
    const Folder folder;
    const std::string ruin = smallSurface(), ivy = content("grammars/ivy_guided.grammar");
    Asked asked(folder, folder.write("walls.json", R"({"surfaces": [{"file": ")" + ruin + R"("}, {"file": ")" + ruin +
                                                       R"(", "position": [0, 0, 40]}], "grammars": [{"file": ")" + ivy +
                                                       R"("}]})"));
    std::string words;
    asked.panels = [&] { words = wordsOf([&] { sample::showDialogues(asked.work, asked.session); }); };
    const std::string file = folder.file("mask.exr");
    const auto enter = [&](bool import) {
        sample::askForLayer("mask", import);
        sample::put(sample::dialogues().picture, file);
        asked.settle();
        CHECK_MESSAGE(contains(words, "first surface"), words);
        CHECK_MESSAGE(contains(words, "-1, -2"), words);
        setKey(ImGuiKey_Enter, true);
        asked.frame({});
        setKey(ImGuiKey_Enter, false);
        asked.settle();
        asked.session.background().finish();
        asked.settle();
        CHECK_MESSAGE(asked.work.error.empty(), asked.work.error);
    };
    enter(false);
    CHECK(std::filesystem::exists(folder.file("mask-1.exr")));
    CHECK(asked.work.message == "Written: " + file + ", mask-1.exr");
    enter(true);
    CHECK(asked.work.message == "Read: " + file + ", mask-1.exr");
    std::filesystem::remove(folder.file("mask-1.exr"));
    enter(true);
    CHECK_MESSAGE(asked.work.message.starts_with("Read: " + file + " (mask-1.exr isn't there"), asked.work.message);
}

TEST_CASE("what went wrong with one path isn't said of another") {
    const Folder folder;
    Asked asked(folder);
    sample::askToOpen(folder.file("none.json"), "it isn't there");
    asked.settle();
    CHECK(sample::dialogues().turn == sample::Dialogues::Turn::failed);
    ImGui::GetIO().AddInputCharacter('x');
    asked.settle();
    CHECK(sample::dialogues().turn == sample::Dialogues::Turn::asks);
}

TEST_CASE("a path is typed over what was asked for before, each time that it is asked for") {
    const Folder folder;
    Asked asked(folder);
    const auto type = [&](const std::string& text) {
        for (const char letter : text) ImGui::GetIO().AddInputCharacter(unsigned(letter));
        asked.settle();
    };
    for (const char* name : {"a.json", "b.json", "c.json"}) {
        CAPTURE(name);
        sample::ask("Open");
        asked.settle();
        type(name);
        CHECK(std::string(sample::dialogues().file.data()) == name);
        setKey(ImGuiKey_Escape, true);
        asked.frame({});
        setKey(ImGuiKey_Escape, false);
        asked.settle();
        CHECK(!sample::usesPanels());
    }
}

TEST_CASE("~ is the user's folder") {
    const char* before = std::getenv("HOME");
    const std::string had = before ? before : "";
    ::setenv("HOME", "/home/ada", 1);
    CHECK(sample::expanded("~/x") == "/home/ada/x");
    CHECK(sample::expanded("~") == "/home/ada");
    CHECK(sample::expanded("~x") == "~x");
    CHECK(sample::expanded("a/~/x") == "a/~/x");
    ::unsetenv("HOME");
    CHECK(sample::expanded("~/x") == "~/x");
    if (before) ::setenv("HOME", had.c_str(), 1);
}

TEST_CASE("a time of the day is typed as it is shown") {
    float hours = 0;
    CHECK(sample::hoursOf("7:05", hours));
    CHECK(hours == doctest::Approx(7 + 5 / 60.));
    for (const char* other : {"", ":30", "7:75", "-1:20", "noon", "nan"}) CHECK(!sample::hoursOf(other, hours));
    for (const char* whole : {"7", "7:", "7.0"}) {
        REQUIRE(sample::hoursOf(whole, hours));
        CHECK(hours == 7);
    }

    Field field;
    field.type("14:30");
    CHECK_MESSAGE(field.hour == 9, "not before it is known to be whole");
    CHECK(field.frame(false, ImGuiKey_Enter));
    for (int i = 0; i < 3; ++i) field.frame();
    CHECK(field.hour == doctest::Approx(14.5));
    field.type("6:1");
    field.frame(false, ImGuiKey_Enter);
    CHECK(field.hour == doctest::Approx(6 + 1 / 60.));
    field.type("17:45");
    field.frame(false, ImGuiKey_Escape);
    for (int i = 0; i < 3; ++i) field.frame();
    CHECK_MESSAGE(field.hour == doctest::Approx(6 + 1 / 60.), "as it was");
    field.type("15.5");
    CHECK(field.hour == doctest::Approx(6 + 1 / 60.));
    field.frame(false, ImGuiKey_Enter);
    CHECK(field.hour == doctest::Approx(15.5));
}

namespace {

// Sliders of plain numbers between two buttons, and a mouse.
struct Row {
    Gui gui;
    float value = 1, other = 3;
    int changes = 0;
    ImVec2 above, at, below;
    void frame(ImVec2 mouse = {390, 290}, bool down = false, ImGuiKey key = ImGuiKey_COUNT, bool begins = false) {
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = {400, 300};
        io.MousePos = mouse;
        io.MouseDown[0] = down;
        io.DeltaTime = 1.f / 3;  // clicks of unlike frames are no double click
        if (key != ImGuiKey_COUNT) setKey(key, true);
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({0, 0});
        ImGui::Begin("panel");
        const auto middle = [] {
            const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
            return ImVec2((a.x + b.x) / 2, (a.y + b.y) / 2);
        };
        (void)ImGui::Button("above");
        above = middle();
        if (begins) ImGui::SetKeyboardFocusHere();
        changes += sample::slider("##value", &value, 0, 100, "%.0f");
        at = middle();
        (void)sample::slider("##other", &other, 0, 100, "%.0f");  // to which Tab leads
        (void)ImGui::Button("below");
        below = middle();
        ImGui::End();
        ImGui::Render();
        if (key != ImGuiKey_COUNT) setKey(key, false);
    }
    void type(const char* text) {
        for (int i = 0; i < 3; ++i) frame();
        frame({390, 290}, false, ImGuiKey_COUNT, true);
        for (int i = 0; i < 3; ++i) frame();
        for (const char* letter = text; *letter; ++letter) {
            ImGui::GetIO().AddInputCharacter(unsigned(*letter));
            frame();
        }
    }
    void rest() {
        for (int i = 0; i < 4; ++i) frame();
    }
};

}  // namespace

TEST_CASE("what is typed in a slider's place is taken once, however its field is left, but for Esc") {
    Row row;
    const auto leave = [&](const char* way) {
        const std::string by = way;
        if (by == "above" || by == "below" || by == "nothing") {
            const ImVec2 to = by == "above" ? row.above : by == "below" ? row.below : ImVec2{390, 290};
            row.frame(to);
            row.frame(to, true);
            row.frame(to, false);
        } else {
            row.frame({390, 290}, false, by == "Tab" ? ImGuiKey_Tab : by == "Enter" ? ImGuiKey_Enter : ImGuiKey_Escape);
        }
        row.rest();
    };
    float typed = 50;
    for (const char* way : {"Enter", "Tab", "above", "below", "nothing"}) {
        CAPTURE(way);
        const float before = row.value;
        row.changes = 0;
        row.type(std::to_string(int(typed)).c_str());
        CHECK(row.value == before);
        leave(way);
        CHECK(row.value == typed);
        CHECK(row.changes == 1);
        CHECK(row.other == 3);
        if (std::string(way) == "Tab") leave("Escape");  // out of the other one
        typed += 1;
    }
    const float before = row.value;
    row.type("7");
    leave("Escape");
    CHECK(row.value == before);
}

TEST_CASE("Esc takes back the drag of a slider, also of one that isn't the document's") {
    const Folder folder;
    Window window(folder, smallScene(folder));
    Row row;
    row.rest();
    row.value = 20;
    const ImVec2 from = row.at, to{row.at.x + 40, row.at.y};
    row.frame(from);
    row.frame(from, true);
    row.frame(to, true);
    row.frame(to, true);
    CHECK(row.value > 25);
    CHECK(sample::cancelDrag(window.work));
    for (int i = 0; i < 3; ++i) row.frame({to.x + 10.f * float(i), to.y}, true);
    CHECK(row.value == 20);
    row.rest();
    CHECK(row.value == 20);
    CHECK(!sample::cancelDrag(window.work));
}

TEST_CASE("a question about what is opened next is none about the end of the program") {
    const Folder folder;
    Asked asked(folder);
    asked.fill(.5f);
    CHECK(!sample::asksToQuit());
    CHECK(!sample::askToLeave(asked.work, asked.session, folder.file("other.json")));
    CHECK(!sample::asksToQuit());
    CHECK(!sample::askToLeave(asked.work, asked.session));
    CHECK(sample::asksToQuit());
    sample::dialogues() = {};
}
