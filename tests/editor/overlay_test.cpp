// Figures and legend lie over the picture, and in nobody's way.
#include <algorithm>

#include "tests/editor/user.hpp"

using namespace espalier::document;
using sample::Tool;

namespace {

// The most that anything of a window hides of what is behind it, 0 to 255.
uint32_t opacityOf(const char* name) {
    const ImGuiWindow* window = ImGui::FindWindowByName(name);
    REQUIRE((window && window->WasActive));
    uint32_t most = 0;
    for (const ImDrawVert& vertex : window->DrawList->VtxBuffer) most = std::max(most, vertex.col >> IM_COL32_A_SHIFT);
    return most;
}

}  // namespace

TEST_CASE("seeds behind the figures and a legend are clicked and dragged, and seen through these meanwhile") {
    const Folder folder;
    User user(folder, smallScene(folder), Tool::seeds);
    auto& work = user.work;
    faceWall(user, 1.4f);
    work.layout.figures = true;
    user.panels = [&] {
        sample::beginGesture(work);
        sample::showFigures(work, 0, false);
        sample::showLegend(work);
    };
    REQUIRE(work.perform(SetView{"layer", "mask"}));
    for (const char* name : {"figures", "legend"}) {
        CAPTURE(name);
        user.point({work.window.x / 2, work.window.y / 2});
        user.rest();
        const ImGuiWindow* window = ImGui::FindWindowByName(name);
        REQUIRE((window && window->WasActive));
        const uint32_t apart = opacityOf(name);
        const glm::vec2 at{window->Rect().GetCenter().x, window->Rect().GetCenter().y};
        (void)user.under(at);  // there is something behind it
        user.tap(at);
        CHECK(user.all<AddSeeds>().size() == 1);
        REQUIRE(work.selected.size() == 1);
        CHECK(opacityOf(name) < apart / 3);
        const uint32_t key = *work.selected.begin();
        const auto planted = work.document->seed(key)->position;
        user.hold(at);
        user.rest();
        user.point(at + glm::vec2(12, 6));
        user.rest();
        user.letGo();
        user.rest();
        CHECK(work.document->seed(key)->position != planted);
        user.done.clear();
        // Who only looks around reads them.
        work.choose(Tool::look);
        REQUIRE(work.perform(SetView{"layer", "mask"}));
        user.point(at);
        user.rest();
        CHECK(opacityOf(name) == apart);
        work.choose(Tool::seeds);
        REQUIRE(work.perform(SetView{"layer", "mask"}));
        user.done.clear();
    }
}

TEST_CASE("figures tell the latest growth alone, memory in use and taken, and what roofs had no room for") {
    const Folder folder;
    Editor editor(folder, smallScene(folder), Tool::look);
    auto& work = editor.work;
    work.layout.figures = true;
    std::string words;
    editor.panels = [&] { words = wordsOf([&] { sample::showFigures(work, 0, false); }); };
    work.stats.expandMs = 40, work.roofs.expandMs = 500;
    work.grownMs = 41;  // the houses grew long before
    work.stats.totalBytes = 123u << 20, work.stats.reservedBytes = 456u << 20;
    for (int i = 0; i < 3; ++i) editor.frame({});
    CHECK_MESSAGE(contains(words, "41 ms"), words);
    CHECK_MESSAGE(contains(words, "123 of 456 MiB"), words);
    for (const char* row : {"Tiles left out", "Roofs' parts stopped"}) CHECK(!contains(words, row));
    work.roofs.overflow = 17, work.roofs.stopped = 19;
    editor.frame({});
    for (const char* row : {"Tiles left out", "17", "Roofs' parts stopped", "19"})
        CHECK_MESSAGE(contains(words, row), words);
}

TEST_CASE("a legend tells what a layer's values are called, and which way surfaces face that have a colour") {
    const Folder folder;
    Editor editor(folder, smallScene(folder), Tool::look);
    auto& work = editor.work;
    std::string words;
    editor.panels = [&] { words = wordsOf([&] { sample::showLegend(work); }); };
    REQUIRE(work.perform(SetView{"layer", "mask"}));
    for (int i = 0; i < 2; ++i) editor.frame({});
    for (const char* name : {"mask", "nowhere", "freely"}) CHECK_MESSAGE(contains(words, name), words);
    REQUIRE(work.perform(SetView{"normals", ""}));
    for (int i = 0; i < 2; ++i) editor.frame({});
    for (const char* way : {"east", "west", "up", "down", "south", "north"}) CHECK_MESSAGE(contains(words, way), words);
    REQUIRE(work.perform(SetView{"shaded", ""}));
    for (int i = 0; i < 2; ++i) editor.frame({});
    CHECK(words == "");
}
