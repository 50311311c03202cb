// What the user sets values with: bars that are dragged, clicked and typed into, colours, and what of it is one step of
// undo.
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "sample_game/widgets.hpp"
#include "tools/scene/picture.hpp"

namespace sample {
namespace {

constexpr float kDragShare = .5f;     // of ImGui's own threshold, which follows the scale
constexpr double kSecondClick = .35;  // seconds after one click until another makes no double click with it

// What a slider is to have.
struct Wanted {
    ImGuiID slider = 0;  // 0: none
    float value = 0;
    ImRect place;         // of the slider
    int seen = 0;         // the last frame in which it was laid out
    double released = 0;  // of a click: when, on ImGui's clock; 0: it is still held
};

// By a press without a drag: it goes there unless a double click comes of it.
Wanted& lastClick() {
    static Wanted click;
    return click;
}

// By what is typed in its place, or by a click that waits no longer. It is taken once the field is left, however that
// comes about: half a number may be one that grows far too much.
Wanted& typed() {
    static Wanted value;
    return value;
}

// What was there before a drag.
struct Drag {
    ImGuiID owner = 0;   // 0: none
    ImGuiID active = 0;  // the control that is dragged, the owner or a part of it
    std::array<float, 3> before{};
    bool cancelled = false;  // it is to be taken back
};

Drag& dragged() {
    static Drag drag;
    return drag;
}

// Of the slider `self`. True: its field was left, and *value is what was typed there.
bool takeTyped(ImGuiID self, float* value) {
    if (typed().slider != self || ImGui::GetCurrentContext()->ActiveId == self) return false;
    *value = std::exchange(typed(), {}).value;
    return true;
}

// Before anything else is done with what belongs to `owner`.
void takeBackDrag(ImGuiID owner, std::span<float> values) {
    Drag& drag = dragged();
    if (drag.owner != owner) return;
    if (drag.cancelled) std::copy_n(drag.before.begin(), values.size(), values.begin());
    if (drag.cancelled || ImGui::GetCurrentContext()->ActiveId != drag.active) drag = {};
}

// Of the item or group that was just laid out.
void noteDrag(ImGuiID owner, const std::array<float, 3>& before) {
    if (ImGui::IsItemActivated()) dragged() = {owner, ImGui::GetCurrentContext()->ActiveId, before};
}

// Of the slider that was just laid out at `place`, which would go to `wanted`. True: it goes somewhere, to *value.
bool followMouse(float* value, float wanted, bool changed, const ImRect& place) {
    Wanted& click = lastClick();
    const ImGuiID slider = ImGui::GetItemID();
    if (ImGui::IsItemActive() && ImGui::IsMouseDown(0) &&
        !ImGui::IsMouseDragging(0, kDragShare * ImGui::GetIO().MouseDragThreshold)) {
        const bool begins = ImGui::IsItemActivated() && !ImGui::IsMouseDoubleClicked(0);
        if (begins && changed) click = {slider, wanted, place};
        if (click.slider == slider) click.seen = ImGui::GetFrameCount();
        return false;
    }
    if (click.slider == slider && ImGui::IsItemActive()) click = {};  // dragged
    if (click.slider == slider) {
        click.seen = ImGui::GetFrameCount();
        if (click.released == 0) click.released = ImGui::GetTime();
        if (ImGui::GetTime() < click.released + kSecondClick) return false;
        *value = std::exchange(click, {}).value;
        return true;
    }
    if (changed) *value = wanted;
    return changed;
}

// The field that a slider has become, where ImGui's own takes digits only. True: it says something else by now.
bool typeInto(const ImRect& place, const char* id, float& value, float low, float high, const char* now,
              ReadTyped read) {
    char text[64];
    std::snprintf(text, sizeof text, "%s", now);
    float typed = value;
    if (!ImGui::TempInputText(place, ImGui::GetID(id), id, text, sizeof text, ImGuiInputTextFlags_AutoSelectAll) ||
        !read(text, typed))
        return false;
    typed = std::clamp(typed, low, high);
    return std::exchange(value, typed) != typed;
}

// From the low end to where the value is, below a slider that is about to be laid out there.
void drawBar(const ImRect& place, float share) {
    const float rounding = ImGui::GetStyle().FrameRounding;
    const ImVec2 end(place.Min.x + std::clamp(share, 0.f, 1.f) * place.GetWidth(), place.Max.y);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(place.Min, place.Max, ImGui::GetColorU32(ImGuiCol_FrameBg), rounding);
    ImGui::PushClipRect(place.Min, end, true);
    list.AddRectFilled(place.Min, place.Max, ImGui::GetColorU32(ImGuiCol_SliderGrab, .55f), rounding);
    ImGui::PopClipRect();
}

}  // namespace

bool slider(const char* id, float* value, float low, float high, const char* format, bool byRatio, ReadTyped read) {
    const float way = byRatio ? std::log(high / low) : high - low;
    const float share = way > 0 ? (byRatio ? std::log(*value / low) : *value - low) / way : 0;
    const ImGuiID self = ImGui::GetID(id);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImRect place(at, {at.x + ImGui::CalcItemWidth(), at.y + ImGui::GetFrameHeight()});
    const bool typing = ImGui::TempInputIsActive(self);
    takeBackDrag(self, {value, 1});
    const bool left = takeTyped(self, value);  // by a key, or by a click on what comes before it
    if (!typing) drawBar(place, share);
    // The bar is drawn already: what ImGui draws over it lets it through, but for the number.
    const ImVec4 none{0, 0, 0, 0}, lit{1, 1, 1, .07f};
    if (!typing) ImGui::PushStyleColor(ImGuiCol_FrameBg, none);
    ImGui::PushStyleColor(ImGuiCol_FrameBgHovered, lit);
    ImGui::PushStyleColor(ImGuiCol_FrameBgActive, lit);
    ImGui::PushStyleColor(ImGuiCol_SliderGrab, none);
    ImGui::PushStyleColor(ImGuiCol_SliderGrabActive, none);
    ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, 1);
    float wanted = *value;
    const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp | (byRatio ? ImGuiSliderFlags_Logarithmic : 0);
    bool changed = typing && read ? typeInto(place, id, wanted, low, high, format, read)
                                  : ImGui::SliderFloat(id, &wanted, low, high, format, flags);
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) {
        lastClick() = {};
        ImGui::SetKeyboardFocusHere(-1);
    }
    if (!typing) noteDrag(self, {*value});
    if (typing)
        typed() = wanted != *value ? Wanted{self, wanted, place, ImGui::GetFrameCount()} : Wanted{};
    else
        changed = followMouse(value, wanted, changed, place);
    if (typing) changed = takeTyped(self, value);
    ImGui::PopStyleVar();
    ImGui::PopStyleColor(typing ? 4 : 5);
    return changed || left;
}

bool labelledSlider(const char* label, float* value, float low, float high, const char* format, bool byRatio,
                    ReadTyped read) {
    rowLabel(label);
    ImGui::PushID(label);
    const bool changed = slider("##value", value, low, high, format, byRatio, read);
    ImGui::PopID();
    return changed;
}

bool hoursOf(const char* text, float& hours) {
    int hour = 0, minute = 0;
    if (std::sscanf(text, "%d:%d", &hour, &minute) != 2)
        return std::sscanf(text, "%f", &hours) == 1 && std::isfinite(hours);
    if (hour < 0 || minute < 0 || minute > 59) return false;
    hours = float(hour) + float(minute) / 60;
    return true;
}

bool clickWaits() {
    return lastClick().slider != 0;
}

bool sliderWaits() {
    return clickWaits() || typed().slider != 0;
}

bool sliderWaits(float x, float y) {
    const auto elsewhere = [&](const Wanted& wanted) { return wanted.slider != 0 && !wanted.place.Contains({x, y}); };
    return elsewhere(lastClick()) || elsewhere(typed());
}

void leaveFields() {
    if (clickWaits()) typed() = std::exchange(lastClick(), {});
    ImGui::ClearActiveID();
}

bool keepingDrag(const char* id, std::span<float> values, const std::function<bool()>& layOut) {
    const ImGuiID self = ImGui::GetID(id);
    takeBackDrag(self, values);
    std::array<float, 3> before{};
    std::ranges::copy(values, before.begin());
    const bool changed = layOut();
    noteDrag(self, before);
    return changed;
}

bool editColour(const char* id, float* rgb) {
    return keepingDrag(id, {rgb, 3}, [&] {
        float shown[3];
        for (int i = 0; i < 3; ++i) shown[i] = espalier::scene::srgbOf(rgb[i]);
        if (!ImGui::ColorEdit3(id, shown, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_DisplayHex)) return false;
        for (int i = 0; i < 3; ++i) rgb[i] = espalier::scene::linearOf(shown[i]);
        return true;
    });
}

void beginGesture(Workspace& work) {
    static ImGuiID before = 0;  // what was active as the last frame began
    const ImGuiContext& gui = *ImGui::GetCurrentContext();
    const bool tabbed = gui.ActiveId != 0 && gui.ActiveId != before && !gui.ActiveIdHasBeenEditedBefore;
    if (ImGui::IsMouseClicked(0) || tabbed) work.newGesture();
    before = gui.ActiveId;
    for (Wanted* wanted : {&lastClick(), &typed()})
        if (wanted->seen + 1 < ImGui::GetFrameCount()) *wanted = {};  // its panel is gone
}

bool holdsControl() {
    const ImGuiContext& gui = *ImGui::GetCurrentContext();
    return ImGui::IsMouseDown(0) && gui.ActiveId != 0 && !gui.MovingWindow && !ImGui::GetIO().WantTextInput;
}

bool cancelDrag(Workspace& work) {
    if (!holdsControl()) return false;
    lastClick() = {};
    work.takeBack(work.gesture());
    if (dragged().active == ImGui::GetCurrentContext()->ActiveId) dragged().cancelled = true;  // not the document's
    ImGui::ClearActiveID();
    return true;
}

void finishDrag() {
    if (holdsControl()) ImGui::ClearActiveID();
}

uint32_t widgetGesture(Workspace& work) {
    // A colour's text is taken up as it is typed, and again as its field is left.
    return ImGui::IsAnyItemActive() || ImGui::IsItemDeactivated() ? work.gesture() : work.newGesture();
}

}  // namespace sample
