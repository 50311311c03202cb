// The time that graphs show: the bar below the view, its keys, and playing. A graph's time is a number of frames, each
// as long as the last; the wall clock only says which frame is due.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "sample_game/graph_editor.hpp"
#include "sample_game/graph_parts.hpp"
#include "sample_game/panels.hpp"

namespace sample {
namespace {

using espalier::document::SetGraphTime;
using espalier::scene::kMostGraphFrame;

void goTo(Workspace& work, int64_t frame) {
    const uint32_t to = uint32_t(std::clamp<int64_t>(frame, 0, kMostGraphFrame));
    if (to != work.scene().graphFrame) work.perform(SetGraphTime{to, work.scene().graphRate});
}

void play(Workspace& work, bool on) {
    work.graphs.playing = on;
    work.graphs.playedFrom = glfwGetTime();
    work.graphs.playedFrame = work.scene().graphFrame;
}

// Two bars, or a triangle that points; two letters wide.
enum class Sign { start, back, play, pause, ahead };
bool signButton(const char* id, Sign sign, const char* tip) {
    const float high = ImGui::GetFrameHeight(), wide = 1.5f * high;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::Button(id, {wide, high});
    const ImU32 colour = ImGui::GetColorU32(ImGuiCol_Text);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 c{std::floor(at.x + wide / 2), std::floor(at.y + high / 2)};
    const float r = std::floor(.24f * high), bar = std::max(1.f, std::floor(.1f * high));
    const auto triangle = [&](float x, float way) {
        list.AddTriangleFilled({x - way * .8f * r, c.y - r}, {x - way * .8f * r, c.y + r}, {x + way * .9f * r, c.y},
                               colour);
    };
    const auto upright = [&](float x) { list.AddRectFilled({x - bar, c.y - r}, {x + bar, c.y + r}, colour); };
    if (sign == Sign::play) triangle(c.x, 1.2f);
    if (sign == Sign::pause) upright(c.x - .6f * r), upright(c.x + .6f * r);
    if (sign == Sign::start) upright(c.x - 1.1f * r), triangle(c.x + .2f * r, -1);
    if (sign == Sign::back) triangle(c.x - .2f * r, -1), upright(c.x + 1.1f * r);
    if (sign == Sign::ahead) triangle(c.x + .2f * r, 1), upright(c.x - 1.1f * r);
    toolTip(tip);
    return pressed;
}

// A frame is set by a click or a drag anywhere on it.
void scrubBar(Workspace& work, float width) {
    const float high = ImGui::GetFrameHeight(), s = work.scale;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("scrub", {width, high});
    const uint32_t frame = work.scene().graphFrame;
    uint32_t& last = work.graphs.lastFrame;
    if (ImGui::IsItemActive()) {
        work.graphs.playing = false;
        const float part = std::clamp((ImGui::GetIO().MousePos.x - at.x) / width, 0.f, 1.f);
        goTo(work, std::llround(double(part) * last));
    } else {
        last = std::max(last, frame);  // what was typed or stepped to lies on the bar
    }
    toolTip("Drag: another frame  (Left, Right: the one before, the next)");
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, {at.x + width, at.y + high}, ImGui::GetColorU32(ImGuiCol_FrameBg), 3 * s);
    // Marks at round numbers, as many as their numbers leave room for.
    const float perFrame = width / float(std::max(1u, last));
    uint32_t step = 1;
    for (const uint32_t more : {1u, 2u, 5u, 10u, 20u, 50u, 100u, 200u, 500u, 1000u, 10000u, 100000u, 1000000u})
        if (float(step = more) * perFrame > 60 * s) break;
    for (uint32_t f = 0; f <= last; f += step) {
        const float x = std::floor(at.x + float(f) * perFrame);
        const std::string text = std::to_string(f);
        list.AddLine({x, at.y + .7f * high}, {x, at.y + high}, ImGui::GetColorU32(ImGuiCol_TextDisabled));
        if (x + ImGui::CalcTextSize(text.c_str()).x + 6 * s < at.x + width)
            list.AddText({x + 3 * s, at.y + 3 * s}, ImGui::GetColorU32(ImGuiCol_TextDisabled), text.c_str());
    }
    const float x = at.x + float(frame) * perFrame;
    list.AddRectFilled({x - 2 * s, at.y}, {x + 2 * s, at.y + high}, ImGui::GetColorU32(ImGuiCol_SliderGrabActive),
                       2 * s);
}

void frameAndRate(Workspace& work) {
    int frame = int(work.scene().graphFrame);
    ImGui::SetNextItemWidth(5 * ImGui::GetFontSize());
    if (ImGui::InputInt("##frame", &frame, 0, 0, ImGuiInputTextFlags_EnterReturnsTrue)) {
        work.graphs.playing = false;
        goTo(work, frame);
    }
    toolTip("The frame that graphs show");
    ImGui::SameLine();
    float rate = work.scene().graphRate;
    ImGui::SetNextItemWidth(4.5f * ImGui::GetFontSize());
    if (ImGui::InputFloat("##rate", &rate, 0, 0, "%.4g / s", ImGuiInputTextFlags_EnterReturnsTrue)) {
        rate = std::clamp(std::isfinite(rate) ? rate : 0.f, 1.f, espalier::scene::kMostGraphRate);
        work.perform(SetGraphTime{work.scene().graphFrame, rate});
        play(work, work.graphs.playing);
    }
    toolTip("Frames in a second of the graphs' time; where drawing takes longer, playing leaves frames out");
    ImGui::SameLine();
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.2f s", double(work.scene().graphFrame) / double(work.scene().graphRate));
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", seconds);
}

}  // namespace

void playGraphs(Workspace& work, double now) {
    auto& graphs = work.graphs;
    graphs.playing = graphs.playing && work.editing && !work.scene().graphs.empty();
    if (!graphs.playing) return;
    const double passed = (now - graphs.playedFrom) * double(work.scene().graphRate);
    const uint64_t frame = graphs.playedFrame + uint64_t(std::max(0., passed));
    goTo(work, int64_t(frame % (uint64_t(graphs.lastFrame) + 1)));
}

bool takeTimeKey(Workspace& work, const KeyEvent& event) {
    if (!work.editing || work.scene().graphs.empty()) return false;
    const int64_t frame = work.scene().graphFrame;
    const bool control = event.mods & GLFW_MOD_CONTROL, shift = event.mods & GLFW_MOD_SHIFT;
    if (event.key == GLFW_KEY_SPACE && !control) {
        if (!event.repeated) play(work, !work.graphs.playing);
    } else if ((event.key == GLFW_KEY_LEFT && shift) || (event.key == GLFW_KEY_HOME && control)) {
        goTo(work, 0);
        play(work, work.graphs.playing);
    } else if (event.key == GLFW_KEY_LEFT || event.key == GLFW_KEY_RIGHT) {
        work.graphs.playing = false;
        goTo(work, frame + (event.key == GLFW_KEY_LEFT ? -1 : 1));
    } else {
        return false;
    }
    return true;
}

void showTimeBar(Workspace& work, float top) {
    const float s = work.scale, left = work.panelUnits();
    ImGui::SetNextWindowPos({left, top});
    ImGui::SetNextWindowSize({work.window.x - left, kTimeBar * s});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8 * s, 4 * s});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    constexpr int kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                           ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav | kQuiet;
    if (ImGui::Begin("time", nullptr, kFlags)) {
        if (signButton("##start", Sign::start, "To frame 0  (Ctrl+Home or Shift+Left)")) {
            goTo(work, 0);
            play(work, work.graphs.playing);
        }
        ImGui::SameLine(0, 2 * s);
        if (signButton("##back", Sign::back, "The frame before  (Left)")) {
            work.graphs.playing = false;
            goTo(work, int64_t(work.scene().graphFrame) - 1);
        }
        ImGui::SameLine(0, 2 * s);
        const bool plays = work.graphs.playing;
        if (signButton("##play", plays ? Sign::pause : Sign::play, plays ? "Pause  (Space)" : "Play  (Space)"))
            play(work, !plays);
        ImGui::SameLine(0, 2 * s);
        if (signButton("##ahead", Sign::ahead, "The next frame  (Right)")) {
            work.graphs.playing = false;
            goTo(work, int64_t(work.scene().graphFrame) + 1);
        }
        ImGui::SameLine();
        frameAndRate(work);
        ImGui::SameLine();
        const float nodes = ImGui::CalcTextSize("Nodes F6").x + 2 * ImGui::GetStyle().FramePadding.x;
        scrubBar(work, std::max(20 * s, ImGui::GetContentRegionAvail().x - nodes - ImGui::GetStyle().ItemSpacing.x));
        ImGui::SameLine();
        if (chosenButton("Nodes F6", work.graphs.nodes, {nodes, 0})) showNodes(work, !work.graphs.nodes);
        toolTip("The graph's nodes, below  (F6)");
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
}

void showNodes(Workspace& work, bool shown) {
    if (work.scene().graphs.empty()) return work.say("This scene has no graph: Edit, New graph makes one");
    work.graphs.nodes = shown;
    work.redraw = true;
}

void addGraph(Workspace& work) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const auto taken = [&](const fs::path& file) {
        const auto same = [&](const auto& graph) { return graph.file == file.string(); };
        return fs::exists(file, ignored) || std::ranges::any_of(work.scene().graphs, same);
    };
    const fs::path folder = fs::current_path(ignored);
    fs::path file = folder / "new.graph";
    for (int i = 2; taken(file); ++i) file = folder / ("new-" + std::to_string(i) + ".graph");
    if (!work.perform(espalier::document::AddGraph{file.string(), "graph 1\n"})) return;
    work.graphs.open = uint32_t(work.scene().graphs.size() - 1);
    work.graphs.nodes = true;
    work.say("A new graph: Tab over the canvas adds nodes");
}

}  // namespace sample
