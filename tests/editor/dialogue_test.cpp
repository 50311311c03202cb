// Dialogues and fields as they are clicked and typed into.
#include "sample_game/dialogue.hpp"

#include <imgui_internal.h>

#include "sample_game/folder_list.hpp"
#include "sample_game/panels.hpp"
#include "tests/editor/window.hpp"

namespace {

// A window whose dialogues are laid out, and a mouse that ImGui sees.
struct Asked : Editor {
    explicit Asked(const Folder& folder) : Editor(folder, smallScene(folder), sample::Tool::look) {
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
        for (int i = 0; i < ImGuiKey_COUNT; ++i) io.KeyMap[i] = i;
        std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
        if (key != ImGuiKey_COUNT) io.KeysDown[key] = true;
        ImGui::NewFrame();
        ImGui::Begin("panel");
        if (begins) ImGui::SetKeyboardFocusHere();
        const int minutes = int(std::lround(hour * 60));
        char text[16];
        std::snprintf(text, sizeof text, "%d:%02d", minutes / 60, minutes % 60);
        const bool changed = sample::labelledSlider("Time", &hour, 0, 24, text, false, sample::hoursOf);
        ImGui::End();
        ImGui::Render();
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
    folder.write("list/garden/project.json", "{}");
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
    CHECK(field.hour == doctest::Approx(14.5));
    field.frame(false, ImGuiKey_Enter);
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
    CHECK(field.hour == doctest::Approx(15.5));
}
