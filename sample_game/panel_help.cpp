// All keys, over everything: F1.
#include <imgui.h>

#include <algorithm>
#include <iterator>

#include "sample_game/panels.hpp"
#include "sample_game/theme.hpp"

namespace sample {

void showHelp(Workspace& work) {
    if (!work.layout.help) return;
    struct Row {
        const char *keys, *what;
    };
    const Row camera[] = {{"Tab", "between the game and the editor"},
                          {"W A S D, mouse", "walk and look (game); G flies, Space jumps, Shift runs"},
                          {"Middle drag, Alt+drag", "turn around; with Shift sideways"},
                          {"Right drag", "look around; with W A S D Q E fly, the wheel sets how fast"},
                          {"Wheel", "to and from what the mouse points at"},
                          {"Home", "show all that plants grow on; in the game back to its start"},
                          {"F or numpad .", "show what is chosen; with the brush in hand numpad . only"},
                          {"Numpad 1 3 7", "from the front, the right, above; Ctrl: the other side"},
                          {"Numpad 2 4 6 8, + -", "turn by 15 degrees, nearer, further"},
                          {"Numpad 5", "parallel lines stay parallel, and back"},
                          {"Numpad 0", "the start view"},
                          {"Ctrl+1 to 9, Shift+1 to 9", "keep the view under a digit, show it again"}};
    const Row paint[] = {{"B, then drag", "paint the chosen layer"},
                         {"Ctrl+drag, Shift+drag", "erase (back to as it comes), smooth"},
                         {"X", "the opposite value: to take away what would be painted"},
                         {"[ and ]", "smaller, larger brush"},
                         {"F, Shift+F, then move", "size, strength; click to keep it"},
                         {"V", "show or hide what is painted"}};
    const Row seeds[] = {
        {"S, then click", "plant; drag gives the direction"},
        {"Ctrl+drag", "plant a row"},
        {"Click, Shift+click, Shift+drag", "choose one, one more, several"},
        {"Drag a seed, its arrow", "move, turn what is chosen"},
        {"G, R", "move, turn the chosen seeds; a click ends it; Esc, Ctrl+Z or the right button take it back"},
        {"Shift+D or Ctrl+D", "copies of the chosen seeds, to be moved as with G"},
        {"A, Alt+A, X or Del", "choose all, none, remove"},
        {"Shift+R", "other random numbers for all"},
        {"T, then drag", "ivy grows along the line that you draw; Shift: also where another line is"},
        {"T, then click a line", "drag its points, or the line between them; Del removes a point, or the line"},
        {"H, Shift+H, Alt+H", "hide the chosen plants, all others, show all; numpad / : the chosen alone, and back"},
        {"P, then click", "a branch; [ picks its parent, Del prunes it"},
        {"H, then click", "a house; drag its corners, choose its edges"},
        {"E, then click", "an element of a field; drag gives its direction; [ ] size of the comb"},
        {"Ctrl+drag, Del", "a new corner in an edge, the chosen edge's corner goes"}};
    const Row all[] = {{"Ctrl+Z, Ctrl+Shift+Z or Ctrl+Y", "undo, redo: of everything"},
                       {"Ctrl+S, Ctrl+Shift+S", "save, save as"},
                       {"Ctrl+N, Ctrl+O, Ctrl+E, Ctrl+Q", "new scene, open, export the layer, quit"},
                       {"1 2 3 4 5 6", "shaded, charts, normals, levels of detail, branches from the seed, overdraw"},
                       {"F2 F3 F4 F5 F6", "panel, statistics, grammar, atlas, nodes of a graph"},
                       {"Space, Left, Right, Ctrl+Home", "of graphs: play, step, back to frame 0"},
                       {"F12", "write a screenshot"},
                       {"Esc, Q", "puts the tool away; Esc stops growth that takes long"}};
    const float top = ImGui::GetFrameHeight();  // the menu's bar
    ImGui::SetNextWindowPos({work.window.x / 2, (top + work.window.y) / 2}, ImGuiCond_Always, {.5f, .5f});
    // Two tables side by side where there is room, so that all is seen at once; else it may have to be scrolled.
    const bool wide = work.window.x > 1040 * work.scale;
    ImGui::SetNextWindowSize({std::min((wide ? 1040 : 640) * work.scale, work.window.x), 0});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {work.window.x, std::max(work.window.y - top, top)});
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize | kQuiet;
    if (ImGui::Begin("Keys and mouse", &work.layout.help, flags)) {
        ImGui::TextWrapped(
            "A path of ivy up a wall: T, then drag up the wall. A model comes to the scene when you drop it onto the "
            "window.");
        const auto table = [&](const char* title, const Row* rows, size_t count) {
            ImGui::Spacing();
            ImGui::TextColored(kGood, "%s", title);
            if (!ImGui::BeginTable(title, 2)) return;
            ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthFixed, 205 * work.scale);
            ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch);
            for (size_t i = 0; i < count; ++i) {
                ImGui::TableNextRow();
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(rows[i].keys);
                ImGui::TableNextColumn();
                ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
                ImGui::TextWrapped("%s", rows[i].what);
                ImGui::PopStyleColor();
            }
            ImGui::EndTable();
        };
        if (wide && ImGui::BeginTable("halves", 2, ImGuiTableFlags_SizingStretchSame)) {
            ImGui::TableNextColumn();
            table("Camera", camera, std::size(camera));
            table("Everything", all, std::size(all));
            ImGui::TableNextColumn();
            table("Painting", paint, std::size(paint));
            table("Seeds, branches, roofs", seeds, std::size(seeds));
            ImGui::EndTable();
        } else if (!wide) {
            table("Camera", camera, std::size(camera));
            table("Painting", paint, std::size(paint));
            table("Seeds, branches, roofs", seeds, std::size(seeds));
            table("Everything", all, std::size(all));
        }
    }
    ImGui::End();
}

}  // namespace sample
