// The list of kinds that nodes may be added of, with its search; and the field in which a node gets another name.
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <vector>

#include "sample_game/graph_editor.hpp"
#include "sample_game/graph_parts.hpp"
#include "sample_game/panels.hpp"

namespace sample {
namespace {

using namespace espalier::document;

constexpr const char *kList = "node list", *kRename = "node name";

// What keys have to know between frames.
struct ListState {
    bool waits = false;  // it was asked for, and can't be typed into yet
    bool shown = false;  // the canvas was, in the last frame
    glm::vec2 low{0}, high{0};
};
ListState& listState() {
    static ListState state;
    return state;
}

std::string lower(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

// Nodes of the kind can be wired to the port that was dragged.
bool fitsPort(const GraphDesk& desk, const NodeKind& kind) {
    if (!desk.list.port) return true;
    const NodeCanvas::Box& box = desk.canvas.boxes[desk.list.port->node];
    if (!desk.list.port->output && box.kind && !box.kind->inputs[desk.list.port->index].opener.empty())
        return kind.name == box.kind->inputs[desk.list.port->index].opener;
    const auto type = desk.typeOf(*desk.list.port);
    if (!type) return true;
    if (desk.list.port->output)
        return std::ranges::any_of(kind.inputs,
                                   [&](const NodePort& port) { return espNodeTypeTakes(port.type, *type) != 0; });
    return std::ranges::any_of(kind.outputs, [&](const NodePort& port) {
        return espNodeTypeTakes(*type, port.type) || (port.asFirst && isGeometry(*type));
    });
}

// Those whose name begins with what is searched come first, then those that hold it, then those whose help does.
std::vector<const NodeKind*> found(const GraphDesk& desk) {
    const std::string wanted = lower(desk.list.search);
    std::vector<const NodeKind*> lists[3];
    for (const NodeKind& kind : nodeKinds()) {
        if (!fitsPort(desk, kind)) continue;
        const size_t at = lower(kind.name).find(wanted);
        if (at == 0)
            lists[0].push_back(&kind);
        else if (at != std::string::npos)
            lists[1].push_back(&kind);
        else if (lower(kind.help + " " + kind.group).find(wanted) != std::string::npos)
            lists[2].push_back(&kind);
    }
    if (wanted.empty()) std::ranges::stable_sort(lists[0], {}, &NodeKind::group);
    for (const size_t more : {1, 2}) lists[0].insert(lists[0].end(), lists[more].begin(), lists[more].end());
    return lists[0];
}

void choose(Workspace& work, GraphDesk& desk, const NodeKind& kind) {
    ImGui::CloseCurrentPopup();
    // What was dragged may have gone meanwhile.
    if (desk.list.port && desk.model.find(desk.list.node) != int(desk.list.port->node)) desk.list.port.reset();
    addNode(work, desk, kind);
}

void showFound(Workspace& work, GraphDesk& desk, const std::vector<const NodeKind*>& kinds, bool enter, bool moved) {
    std::string group;
    for (size_t i = 0; i < kinds.size(); ++i) {
        if (!desk.list.search[0] && kinds[i]->group != group)
            ImGui::TextDisabled("%s", (group = kinds[i]->group).c_str());
        const bool chosen = int(i) == desk.list.chosen;
        if (ImGui::Selectable(("  " + kinds[i]->name).c_str(), chosen) || (enter && chosen))
            return choose(work, desk, *kinds[i]);
        if (chosen && moved) ImGui::SetScrollHereY();
        toolTip(kinds[i]->help.c_str());
    }
    if (kinds.empty()) ImGui::TextDisabled("No kind of node fits");
}

void listPopup(Workspace& work, GraphDesk& desk) {
    auto& list = desk.list;
    ImGui::SetNextWindowSize({15 * ImGui::GetFontSize(), 20 * ImGui::GetFontSize()});
    if (!ImGui::BeginPopup(kList)) {
        if (list.open) listState().waits = false;
        list.open = false;
        return;
    }
    list.open = true;
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1);
    const std::string before = list.search;
    const bool enter = ImGui::InputTextWithHint("##search", "Search", list.search, sizeof list.search,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
    if (ImGui::IsItemActive()) listState().waits = false;
    const std::vector<const NodeKind*> kinds = found(desk);
    const int step = int(ImGui::IsKeyPressedMap(ImGuiKey_DownArrow)) - int(ImGui::IsKeyPressedMap(ImGuiKey_UpArrow));
    if (before != list.search) list.chosen = 0;
    list.chosen = std::clamp(list.chosen + step, 0, std::max(0, int(kinds.size()) - 1));
    ImGui::BeginChild("kinds", {0, 0}, false);
    const size_t nodes = desk.model.nodes.size();
    showFound(work, desk, kinds, enter, step != 0 || before != list.search);
    ImGui::EndChild();
    if (enter || desk.model.nodes.size() != nodes) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void renamePopup(Workspace& work, GraphDesk& desk) {
    static char name[64] = "";
    static std::string old;
    if (!desk.renaming.empty()) {
        old = desk.renaming;
        desk.renaming.clear();
        std::snprintf(name, sizeof name, "%s", old.c_str());
        ImGui::OpenPopup(kRename);
    }
    if (!ImGui::BeginPopup(kRename)) return;
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(14 * ImGui::GetFontSize());
    if (ImGui::InputText("##name", name, sizeof name,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll)) {
        if (name != old && work.perform(RenameNode{desk.graph, old, name}, work.newGesture())) desk.selected = {name};
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

}  // namespace

void askForNode(GraphDesk& desk, glm::vec2 at, std::optional<NodeCanvas::Port> port) {
    desk.list = {};
    desk.list.asked = true;
    desk.list.at = at;
    desk.list.port = port;
    if (port) desk.list.node = desk.nameAt(port->node);
    listState().waits = true;
}

void showNodeList(Workspace& work, GraphDesk& desk) {
    listState().shown = true;
    listState().low = desk.low;
    listState().high = desk.high;
    if (std::exchange(desk.list.asked, false)) {
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        ImGui::SetNextWindowPos(mouse, ImGuiCond_Always, {0, mouse.y > .5f * work.window.y ? 1.f : 0.f});
        ImGui::OpenPopup(kList);
    }
    listPopup(work, desk);
    renamePopup(work, desk);
}

bool nodeListAwaits() {
    return listState().waits;
}

bool asksForNode(int key, bool control, bool shift, float x, float y) {
    const ListState& state = listState();
    if (!state.shown || !ImGui::GetCurrentContext()->OpenPopupStack.empty() || control) return false;
    if (x < state.low.x || y < state.low.y || x >= state.high.x || y >= state.high.y) return false;
    constexpr int kTab = 258, kA = 65;  // GLFW's
    return (key == kTab && !shift) || (key == kA && shift);
}

void forgetNodeList() {
    listState() = {};
}

}  // namespace sample
