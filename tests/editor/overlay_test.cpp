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
