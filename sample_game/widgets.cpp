// Rows, bars, tips and windows of the panels.
#include "sample_game/widgets.hpp"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace sample {
namespace {

constexpr float kTipDelay = .5f;  // seconds

// The slider that has been taken up and hasn't changed anything yet.
ImGuiID& untouched() {
    static ImGuiID id = 0;
    return id;
}

// From the low end to where the value is, below a slider that is about to be laid out here.
void drawBar(float width, float share) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float bottom = at.y + ImGui::GetFrameHeight();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, {at.x + width, bottom}, ImGui::GetColorU32(ImGuiCol_FrameBg), style.FrameRounding);
    ImGui::PushClipRect(at, {at.x + std::clamp(share, 0.f, 1.f) * width, bottom}, true);
    list.AddRectFilled(at, {at.x + width, bottom}, ImGui::GetColorU32(ImGuiCol_SliderGrab, .55f), style.FrameRounding);
    ImGui::PopClipRect();
}

}  // namespace

bool beginWindow(const Workspace& work, const char* title, bool* open, glm::vec2 at, glm::vec2 size, int flags) {
    const float top = ImGui::GetFrameHeight(), bottom = work.window.y - ImGui::GetFrameHeight() - 4 * work.scale;
    const glm::vec2 least = 120.f * glm::vec2(work.scale), room = glm::max({work.window.x, bottom - top}, least);
    ImGui::SetNextWindowSizeConstraints({least.x, least.y}, {room.x, room.y});
    ImGui::SetNextWindowPos({at.x, at.y}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({size.x, size.y}, ImGuiCond_FirstUseEver);
    const bool shown = ImGui::Begin(title, open, flags | kQuiet);
    const ImVec2 is = ImGui::GetWindowPos(), extent = ImGui::GetWindowSize();
    const ImVec2 wanted{std::max(0.f, std::min(is.x, work.window.x - extent.x)),
                        std::max(top, std::min(is.y, bottom - extent.y))};
    if (!ImGui::IsMouseDown(0) && (wanted.x != is.x || wanted.y != is.y)) ImGui::SetWindowPos(wanted);
    return shown;
}

bool slider(const char* id, float* value, float low, float high, const char* format, bool byRatio) {
    const float way = byRatio ? std::log(high / low) : high - low;
    const float share = way > 0 ? (byRatio ? std::log(*value / low) : *value - low) / way : 0;
    const bool typing = ImGui::TempInputIsActive(ImGui::GetID(id));
    if (!typing) drawBar(ImGui::CalcItemWidth(), share);
    // The bar is drawn already: what ImGui draws over it lets it through, but for the number.
    const ImVec4 none{0, 0, 0, 0}, lit{1, 1, 1, .07f};
    if (!typing) ImGui::PushStyleColor(ImGuiCol_FrameBg, none);
    ImGui::PushStyleColor(ImGuiCol_FrameBgHovered, lit);
    ImGui::PushStyleColor(ImGuiCol_FrameBgActive, lit);
    ImGui::PushStyleColor(ImGuiCol_SliderGrab, none);
    ImGui::PushStyleColor(ImGuiCol_SliderGrabActive, none);
    ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, 1);
    const bool changed = ImGui::SliderFloat(
        id, value, low, high, format, ImGuiSliderFlags_AlwaysClamp | (byRatio ? ImGuiSliderFlags_Logarithmic : 0));
    // A double click's second press goes on with what the first has begun.
    if (ImGui::IsItemActivated() && !ImGui::IsMouseDoubleClicked(0)) untouched() = ImGui::GetItemID();
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) ImGui::SetKeyboardFocusHere(-1);
    ImGui::PopStyleVar();
    ImGui::PopStyleColor(typing ? 4 : 5);
    return changed;
}

bool labelledSlider(const char* label, float* value, float low, float high, const char* format, bool byRatio) {
    rowLabel(label);
    ImGui::PushID(label);
    const bool changed = slider("##value", value, low, high, format, byRatio);
    ImGui::PopID();
    return changed;
}

bool toolTipWaits() {
    const ImGuiContext& gui = *ImGui::GetCurrentContext();
    return gui.HoveredId != 0 && gui.HoveredIdNotActiveTimer < kTipDelay;
}

void toolTip(const char* text) {
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive() && !toolTipWaits()) ImGui::SetTooltip("%s", text);
}

void sameLineIfRoom(float width) {
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    if (ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width <= right) ImGui::SameLine();
}

void hint(const char* text) {
    ImGui::PushStyleColor(ImGuiCol_Text, {1, .8f, .45f, 1});
    ImGui::TextWrapped("%s", text);
    ImGui::PopStyleColor();
}

void rowLabel(const char* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine(ImGui::GetFontSize() * 6.2f);
    ImGui::SetNextItemWidth(-1);
}

uint32_t widgetGesture(Workspace& work) {
    static_assert(sizeof(ImGuiID) == sizeof(uint32_t));
    // A new one each time that a widget is taken up; kept while it is held.
    const bool begins = std::exchange(untouched(), 0) == ImGui::GetItemID();
    if (begins || ImGui::IsItemActivated() || !ImGui::IsItemActive()) return work.newGesture();
    return work.gesture();
}

}  // namespace sample
