// The bars at the top and bottom and the panel's tools where there is little room: nothing is cut off, and the panel is
// as wide as at first when that is asked for.
#include <algorithm>
#include <map>

#include "tests/editor/user.hpp"

using namespace espalier::document;
using sample::Tool;

namespace {

// The bars and the panel as the window lays them out.
struct Framed : User {
    Framed(const Folder& folder, const std::string& file) : User(folder, file, Tool::look) {
        panels = [this] {
            sample::beginGesture(work);
            sample::showMenu(work, session);
            sample::showPanel(work);
            logStatus();
        };
        ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_HasMouseCursors;  // edges can be dragged
        rest();
    }
    // What the line at the bottom says, in a window so wide.
    std::string statusAt(float width) {
        work.window.x = width;
        rest();
        return status;
    }
    // Where the mouse is over something of the window, or of the menu that is open.
    glm::vec2 find(ImGuiID wanted, glm::vec2 from, glm::vec2 to) {
        for (float y = from.y; y < to.y; y += 4)
            for (float x = from.x; x < to.x; x += 8) {
                mouse = {x, y};
                frame({});
                if (ImGui::GetCurrentContext()->HoveredId == wanted) return mouse;
            }
        FAIL("it isn't there");
        return {};
    }

  private:
    std::string status;
    void logStatus() {
        status = wordsOf([this] { sample::showStatus(work, false, false); });
        status.erase(0, status.find_first_not_of("\r\n "));
        status.erase(status.find_last_not_of("\r\n ") + 1);
    }
};

float widthOf(const std::string& text) {
    return ImGui::CalcTextSize(text.c_str()).x;
}

}  // namespace

TEST_CASE("hints in a narrow line give way one by one, each as a whole, and the way to all keys last") {
    const Folder folder;
    Framed editor(folder, smallScene(folder));
    for (const Tool tool : {Tool::look, Tool::paint, Tool::seeds, Tool::branch}) {
        CAPTURE(int(tool));
        editor.work.choose(tool);
        const std::string all = editor.statusAt(4000), always = "Tab: walk   F1: all keys";
        REQUIRE(all.ends_with("   " + always));
        const std::string own = all.substr(0, all.size() - always.size());
        size_t before = all.size() + 1;
        for (float width = widthOf(all) + 60; width > 150; width -= 70) {
            CAPTURE(width);
            const std::string shown = editor.statusAt(width);
            CHECK(shown.size() <= before);
            before = shown.size();
            CHECK(widthOf(shown) <= width);
            if (shown.empty()) continue;
            REQUIRE(shown.ends_with(always));
            CHECK(own.starts_with(shown.substr(0, shown.size() - always.size())));
        }
        CHECK(editor.statusAt(widthOf(always) + 40).size() >= always.size());  // as long as there is room for that
    }
}

TEST_CASE("news in a narrow line stands before all hints, and what there is no room for ends in an ellipsis") {
    const Folder folder;
    Framed editor(folder, smallScene(folder));
    const std::string news = "Written: /home/somebody/a/folder/of/projects/that/lies/deep/within/others/picture.png";
    editor.work.message = news;
    CHECK(editor.statusAt(4000).ends_with(news));
    CHECK(editor.statusAt(widthOf(news) + 60) == news);
    const std::string cut = editor.statusAt(300);
    REQUIRE(cut.ends_with("\u2026"));
    CHECK(news.starts_with(cut.substr(0, cut.size() - 3)));
    CHECK(widthOf(cut) <= 300);
}

TEST_CASE("the panel that was drawn wide is as wide as at first once windows are as at first, and stays so") {
    const Folder folder;
    Framed editor(folder, smallScene(folder));
    const auto wide = [] { return ImGui::FindWindowByName("Espalier")->Size.x; };
    const float first = wide();
    CHECK(first == sample::Layout{}.panelWidth);
    editor.hold({first - 1, 400});
    editor.rest();
    editor.point({first + 150, 400});
    editor.rest();
    editor.letGo();
    editor.rest();
    CHECK(wide() == doctest::Approx(first + 150).epsilon(.02));
    editor.tap(editor.find(widget("##MainMenuBar", {"##menubar", "View", ""}), {0, 8}, {400, 12}));
    editor.tap(editor.find(widget("##Menu_00", {"Reset windows", ""}), {0, 20}, {600, 500}));
    for (int i = 0; i < 3; ++i) {
        CHECK(wide() == first);
        CHECK(editor.work.layout.panelWidth == first);
        editor.rest();
    }
}

TEST_CASE("a menu leads back to the start view, and who tells of the camera's moves hears of it") {
    const Folder folder;
    Framed editor(folder, smallScene(folder));
    const glm::vec3 start = editor.work.camera.eye();
    editor.work.frameAll();
    REQUIRE(glm::distance(editor.work.camera.eye(), start) > .1f);
    CHECK(!editor.work.looked);
    editor.tap(editor.find(widget("##MainMenuBar", {"##menubar", "View", ""}), {0, 8}, {400, 12}));
    editor.tap(editor.find(widget("##Menu_00", {"Start view", ""}), {0, 20}, {600, 500}));
    CHECK(glm::distance(editor.work.camera.eye(), start) < 1e-4f);
    CHECK(editor.work.looked);
}

TEST_CASE("tools' buttons take two rows where the panel is narrow, and their words are whole") {
    const Folder folder;
    Framed editor(folder, content("village.json"));
    const auto& gui = *ImGui::GetCurrentContext();
    for (const auto& [width, scale] : {std::pair(320.f, 1.f), {sample::kLeastPanel, 1.f}, {130.f, 1.f}}) {
        CAPTURE(width);
        editor.work.layout.panelWidth = width;
        editor.work.scale = scale;
        editor.rest();
        std::map<std::string, ImRect> found;
        for (float y = 20; y < 110; y += 3)
            for (float x = 1; x < width; x += 2) {
                editor.mouse = {x, y};
                editor.frame({});
                for (const char* label : {"Look", "Paint", "Seeds", "Branch", "Roofs"})
                    for (const char* key : {"", " Q", " B", " S", " P", " H"})
                        if (gui.HoveredId == widget("Espalier", {(label + std::string(key)).c_str()})) {
                            auto& place = found.try_emplace(label, ImVec2(x, y), ImVec2(x, y)).first->second;
                            place.Add(ImVec2(x, y));
                        }
            }
        REQUIRE(found.size() == 5);
        float top = 1e6f, low = 0;
        for (const auto& [label, place] : found) {
            CAPTURE(label);
            CHECK(place.GetWidth() >= widthOf(label));
            top = std::min(top, place.Min.y), low = std::max(low, place.Min.y);
        }
        CHECK((low > top + 10) == (width < 320));
    }
}
