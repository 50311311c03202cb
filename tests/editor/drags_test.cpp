// Drags of colours' pickers: however far they go they are one step of undo, or none where they aren't the document's,
// and Esc takes them back.
#include <algorithm>

#include "tests/editor/user.hpp"

using namespace espalier::document;
using sample::Tool;

namespace {

struct PickerUser : User {
    PickerUser(const Folder& folder, Tool tool) : User(folder, smallScene(folder), tool) { work.window = {1280, 1400}; }

    // By the field at the end of its row.
    void openPicker(const std::vector<Part>& field) {
        rest();
        const ImGuiID wanted = widget("panel", field);
        for (float y = 0; y < work.window.y; y += 6)
            for (float x = work.panelUnits(); x > work.panelUnits() - 80; x -= 6) {
                mouse = {x, y};
                frame({});
                if (ImGui::GetCurrentContext()->HoveredId == wanted) return tap(mouse);
            }
        FAIL("it isn't in the panel");
    }
    const ImGuiWindow& picker() const {
        for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
            if (window->WasActive && (window->Flags & ImGuiWindowFlags_Popup)) return *window;
        FAIL("no picker is open");
        return *ImGui::GetCurrentContext()->Windows[0];
    }
    // The middle of its square of shades.
    glm::vec2 shades() {
        const ImGuiID wanted = ImHashStr("sv", 0, ImHashStr("##picker", 0, picker().ID));
        const ImRect within = picker().Rect();
        ImRect found(1e6f, 1e6f, -1e6f, -1e6f);
        for (float y = within.Min.y; y < within.Max.y; y += 8)
            for (float x = within.Min.x; x < within.Max.x; x += 8) {
                mouse = {x, y};
                frame({});
                if (ImGui::GetCurrentContext()->HoveredId == wanted) found.Add(ImVec2(x, y));
            }
        REQUIRE(found.GetWidth() > 40);
        return {(found.Min.x + found.Max.x) / 2, (found.Min.y + found.Max.y) / 2};
    }
    void drag(glm::vec2 from, bool cancelled) {
        hold(from);
        rest();
        for (int i = 1; i <= 6; ++i) {
            point(from + glm::vec2(5, -4) * float(i));
            rest();
        }
        if (cancelled) strike(GLFW_KEY_ESCAPE);
        rest();
        letGo();
        rest();
    }
};

}  // namespace

TEST_CASE("a drag in the picker of a grammar's colour is one step of undo, and Esc takes it back") {
    const Folder folder;
    PickerUser painter(folder, Tool::look);
    auto& work = painter.work;
    painter.panel = [&] { sample::grammarsPanel(work); };
    EspParamInfo info{};
    int number = 0;
    for (; espParamInfo(work.context.get(), work.scene().grammars[0].id, uint32_t(number), &info) == ESP_OK; ++number)
        if (info.kind == ESP_PARAM_COLOUR) break;
    REQUIRE(info.kind == ESP_PARAM_COLOUR);
    const auto colour = [&] {
        EspParamInfo now{};
        REQUIRE(espParamInfo(work.context.get(), work.scene().grammars[0].id, uint32_t(number), &now) == ESP_OK);
        return glm::vec3(now.value[0], now.value[1], now.value[2]);
    };
    const glm::vec3 first = colour();
    painter.openPicker({0, info.name, "##value", "##ColorButton"});
    const glm::vec2 shades = painter.shades();
    painter.drag(shades, false);
    const glm::vec3 dragged = colour();
    CHECK(dragged != first);
    CHECK(painter.all<SetParam>().size() > 3);
    CHECK(work.document->undoSteps() == 1);
    painter.drag(shades + glm::vec2(-30, 20), true);
    CHECK(colour() == dragged);
    CHECK(work.document->undoSteps() == 1);
    painter.drag(shades + glm::vec2(-20, 10), false);
    CHECK(work.document->undoSteps() == 2);
    REQUIRE(work.perform(Undo{}));
    CHECK(colour() == dragged);
    REQUIRE(work.perform(Undo{}));
    CHECK(colour() == first);
}

TEST_CASE("a drag in the picker of the brush's colour is no step of undo, and Esc takes it back") {
    const Folder folder;
    PickerUser painter(folder, Tool::paint);
    auto& work = painter.work;
    work.chooseLayer("colour");
    painter.panel = [&] { sample::brushPanel(work); };
    painter.rest();
    const auto colour = [&] { return glm::vec3(work.brush.colour[0], work.brush.colour[1], work.brush.colour[2]); };
    const glm::vec3 first = colour();
    painter.openPicker({"##colour", "##ColorButton"});
    const glm::vec2 shades = painter.shades();
    painter.done.clear();
    painter.drag(shades, false);
    const glm::vec3 dragged = colour();
    CHECK(dragged != first);
    painter.drag(shades + glm::vec2(-30, 20), true);
    CHECK(colour() == dragged);
    CHECK(painter.done.empty());
    CHECK(work.document->undoSteps() == 0);
}
