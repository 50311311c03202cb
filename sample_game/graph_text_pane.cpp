// The graph as text beside its canvas, edited both ways; its way into the file; and points over the view.
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "sample_game/graph_parts.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/theme.hpp"

namespace sample {
namespace {

using namespace espalier::document;

struct GraphTyping {
    std::string shown;
    const std::string* outside = nullptr;  // what the widget is to hold instead
    uint32_t gesture = 0;
    double changedAt = -1e9;
};

int onGraphEdit(ImGuiInputTextCallbackData* data) {
    auto& typing = *static_cast<GraphTyping*>(data->UserData);
    if (data->EventFlag == ImGuiInputTextFlags_CallbackResize) {
        typing.shown.resize(size_t(data->BufTextLen));
        data->Buf = typing.shown.data();
    } else if (typing.outside) {
        const int cursor = data->CursorPos;
        data->DeleteChars(0, data->BufTextLen);
        data->InsertChars(0, typing.outside->c_str());
        data->CursorPos = std::min(cursor, data->BufTextLen);
        data->ClearSelection();
        typing.outside = nullptr;
    }
    return 0;
}

// The document's undo, but only of texts: who types doesn't look at the scene.
void undoTyping(Workspace& work, GraphTyping& typing) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool z = ImGui::IsKeyPressedMap(ImGuiKey_Z), y = ImGui::IsKeyPressedMap(ImGuiKey_Y);
    if (!io.KeyCtrl || (!z && !y)) return;
    typing.gesture = 0;
    const bool back = z && !io.KeyShift;
    const char* step = back ? work.document->undoName() : work.document->redoName();
    if (step && std::string_view(step) == kEditGraph)
        back ? work.perform(Undo{}) : work.perform(Redo{});
    else
        work.say(back ? "Nothing more of the text to undo" : "Nothing of the text to redo");
}

struct SeenPoints {
    EspGraph graph{};
    std::string node;
    uint32_t evaluations = 0;
    EspGraphPartKind kind = ESP_GRAPH_POINTS;
    uint32_t curves = 0, samples = 0;
    std::vector<glm::vec3> places;
};

// Of the node's parts that have no look of their own; more than so many are seen as a share of them.
std::vector<SeenPoints> pointsOf(const Workspace& work, EspGraph graph, const std::string& node, uint32_t made) {
    std::vector<SeenPoints> all;
    EspGraphPart part;
    for (uint32_t p = 0, count = 1; p < count; ++p) {
        const EspResult read = espReadGraphPlaces(work.context.get(), graph, node.c_str(), nullptr, p, &part);
        if (read != ESP_OK && p == 0) break;
        if (read != ESP_OK) continue;
        count = part.partCount;
        if (part.kind == ESP_GRAPH_MESH) continue;
        SeenPoints& seen = all.emplace_back(SeenPoints{graph, node, made, part.kind, part.curves, part.samples, {}});
        for (uint32_t i = 0; i < part.positionCount; ++i) seen.places.push_back(vec(part.positions + 3 * i));
    }
    return all;
}

void drawPoints(const Workspace& work, const SeenPoints& seen, ImDrawList& list) {
    constexpr size_t kMost = 20000;
    const size_t step = seen.places.size() / kMost + 1;
    const ImU32 colour = nodeColour(seen.kind == ESP_GRAPH_CURVES ? ESP_NODE_CURVES : ESP_NODE_POINTS);
    const float r = 2 * work.scale;
    if (seen.kind == ESP_GRAPH_POINTS)
        for (size_t i = 0; i < seen.places.size(); i += step)
            if (const auto at = work.place(seen.places[i]))
                list.AddRectFilled({at->x - r, at->y - r}, {at->x + r, at->y + r}, colour);
    if (seen.kind != ESP_GRAPH_CURVES || seen.curves == 0) return;
    for (size_t c = 0; c < seen.curves; c += step)
        for (uint32_t s = 1; s < seen.samples; ++s) {
            const auto a = work.place(seen.places[size_t(s - 1) * seen.curves + c]);
            const auto b = work.place(seen.places[size_t(s) * seen.curves + c]);
            if (a && b) list.AddLine({a->x, a->y}, {b->x, b->y}, colour, 1.4f * work.scale);
        }
}

}  // namespace

void writeGraphButton(Workspace& work, const GraphDesk& desk) {
    const auto& graph = work.scene().graphs[desk.graph];
    static FileText files;
    const std::string* inFile = files.of(graph.file);
    ImGui::BeginDisabled(inFile && sameText(*inFile, graph.text));
    if (ImGui::Button("Write to file") && writeGrammar(graph.file, graph.text, work.error)) {
        work.error.clear();
        work.message = "Written, which undo doesn't take back: " + graph.file;
    }
    toolTip(("Into " + graph.file + "\nA project keeps the graph as it is here, too").c_str());
    ImGui::EndDisabled();
}

void graphText(Workspace& work, GraphDesk& desk) {
    static GraphTyping typing;
    const auto& graph = work.scene().graphs[desk.graph];
    const float below = graph.error.empty() ? 0 : 5 * ImGui::GetFontSize();
    ImGui::PushID(int(desk.graph));
    const ImGuiID activeId = ImGui::GetCurrentContext()->ActiveId;
    const bool active = activeId != 0 && activeId == ImGui::GetID("##graph");
    if (typing.shown != graph.text) {
        typing.shown = graph.text;
        if (active) typing.outside = &graph.text;
    }
    ImGui::PushFont(textFont());
    const bool changed = ImGui::InputTextMultiline(
        "##graph", typing.shown.data(), typing.shown.size() + 1, {-1, ImGui::GetContentRegionAvail().y - below},
        ImGuiInputTextFlags_AllowTabInput | ImGuiInputTextFlags_CallbackResize | ImGuiInputTextFlags_CallbackAlways |
            ImGuiInputTextFlags_NoUndoRedo,
        onGraphEdit, &typing);
    ImGui::PopFont();
    if (ImGui::IsItemActive()) undoTyping(work, typing);
    // Escape leaves the text. ImGui would take back all that was typed since it was clicked at.
    const bool left = ImGui::IsItemDeactivated() && ImGui::IsKeyPressedMap(ImGuiKey_Escape);
    ImGui::PopID();
    if (changed && !left && typing.shown != graph.text) {
        if (ImGui::GetTime() - typing.changedAt > 1.5 || !typing.gesture) typing.gesture = work.newGesture();
        typing.changedAt = ImGui::GetTime();
        work.perform(SetGraphText{desk.graph, typing.shown}, typing.gesture);
    }
    if (graph.error.empty()) return;
    ImGui::PushStyleColor(ImGuiCol_Text, kBad);
    ImGui::TextWrapped("%s", graph.error.c_str());
    ImGui::PopStyleColor();
}

// Points and curves have no look of their own: shown, they are marks over the view.
void drawShownPoints(Workspace& work) {
    static std::vector<SeenPoints> seen;
    static std::string key;
    std::string now;
    std::vector<std::pair<EspGraph, std::string>> wanted;
    const GraphDesk* desk = graphDesk(work);
    const EspGraph graph = work.scene().graphs[desk->graph].id;
    for (const std::string& name : desk->model.shown) {
        const EspNodeState state = nodeState(work, name);
        if (!state.made || (state.points == 0 && state.curves == 0)) continue;
        wanted.emplace_back(graph, name);
        now += name + " " + std::to_string(state.evaluations) + " " + std::to_string(graph.id) + "\n";
    }
    if (now != key) {
        key = now;
        seen.clear();
        for (const auto& [of, name] : wanted)
            for (SeenPoints& part : pointsOf(work, of, name, 0)) seen.push_back(std::move(part));
    }
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (const SeenPoints& part : seen) drawPoints(work, part, list);
}

}  // namespace sample
