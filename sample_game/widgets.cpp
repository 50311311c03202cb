// Rows, bars, tips and windows of the panels.
#include "sample_game/widgets.hpp"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "sample_game/theme.hpp"
#include "tools/scene/picture.hpp"

namespace sample {
namespace {

constexpr float kTipDelay = .5f;  // seconds

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

// What a list of choices shows of the one that is taken, where there is no room for the whole.
struct Cut {
    ImGuiID list = 0;  // the one that was laid out last; 0: none that is cut
    std::string whole;
};

Cut& cut() {
    static Cut last;
    return last;
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

// Of its words, the widest they may be.
float tipWidth() {
    return std::min(ImGui::GetFontSize() * 45, ImGui::GetIO().DisplaySize.x - 2 * ImGui::GetStyle().WindowPadding.x);
}

// The next tip covers nothing of the window that its widget is in, if there is room beside that.
void tipBeside(const ImRect& window, const std::string& text) {
    const ImVec2 pad = ImGui::GetStyle().WindowPadding, all = ImGui::GetIO().DisplaySize;
    const ImVec2 words = ImGui::CalcTextSize(text.c_str(), nullptr, false, tipWidth());
    const ImVec2 size{words.x + 2 * pad.x, words.y + 2 * pad.y};
    const float right = window.Max.x + pad.x, left = window.Min.x - pad.x - size.x;
    if (right + size.x > all.x && left < 0) return;
    const float y = std::clamp(ImGui::GetItemRectMin().y, 0.f, std::max(0.f, all.y - size.y));
    ImGui::SetNextWindowPos({right + size.x <= all.x ? right : left, y});
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

bool beginWindow(const Workspace& work, const char* title, bool* open, glm::vec2 at, glm::vec2 size, int flags) {
    struct Place {
        glm::vec2 at{0}, size{0};
        bool operator==(const Place&) const = default;
    };
    struct Had {
        Place wanted, shown;  // as the user has put it, and as there is room for it
    };
    static std::map<ImGuiID, Had> all;
    Had& had = all[ImHashStr(title)];
    const ImGuiWindow* is = ImGui::FindWindowByName(title);
    const bool known = is && had.wanted != Place{} && work.windowsAnew == 0;
    const float top = ImGui::GetFrameHeight(), bottom = work.window.y - ImGui::GetFrameHeight() - 4 * work.scale;
    // A window that is made small for a while leaves them large enough to be of use.
    const glm::vec2 least = glm::vec2(300, 200) * work.scale, room = glm::max({work.window.x, bottom - top}, least);
    const bool held = ImGui::IsMouseDown(0);
    ImGui::SetNextWindowSizeConstraints({least.x, least.y}, {room.x, room.y});
    if (known && !held) {
        glm::vec2 fits = glm::clamp(had.wanted.size, least, room);
        ImGui::SetNextWindowSize({fits.x, fits.y});
        if (is->Collapsed) fits.y = is->TitleBarHeight();
        ImGui::SetNextWindowPos({std::max(0.f, std::min(had.wanted.at.x, work.window.x - fits.x)),
                                 std::max(top, std::min(had.wanted.at.y, bottom - fits.y))});
    } else if (!known) {
        const ImGuiCond when = work.windowsAnew > 0 ? ImGuiCond_Always : ImGuiCond_FirstUseEver;
        ImGui::SetNextWindowPos({at.x, at.y}, when);
        ImGui::SetNextWindowSize({size.x, size.y}, when);
    }
    const bool shown = ImGui::Begin(title, open, flags | kQuiet);
    const ImGuiWindow& window = *ImGui::GetCurrentWindow();
    const Place now{{window.Pos.x, window.Pos.y}, {window.SizeFull.x, window.SizeFull.y}};
    if (!known || (held && now.at != had.shown.at)) had.wanted.at = now.at;
    if (!known || (held && now.size != had.shown.size)) had.wanted.size = now.size;
    had.shown = now;
    return shown;
}

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

bool toolTipWaits() {
    const ImGuiContext& gui = *ImGui::GetCurrentContext();
    return gui.HoveredId != 0 && gui.HoveredIdNotActiveTimer < kTipDelay;
}

void tip(const char* text) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(tipWidth());
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void toolTip(const char* text) {
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) || ImGui::IsItemActive() || toolTipWaits()) return;
    const bool list = cut().list != 0 && cut().list == ImGui::GetItemID();
    const std::string words = list ? cut().whole + "\n" + text : text;
    tipBeside(ImGui::GetCurrentWindow()->RootWindow->Rect(), words);
    tip(words.c_str());
}

void sameLineIfRoom(float width) {
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    if (ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width <= right) ImGui::SameLine();
}

void noteAt(const Workspace& work, glm::vec2 at, const char* text) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float s = work.scale;
    const ImVec2 from{at.x + 14 * s, at.y - 8 * s}, size = ImGui::CalcTextSize(text);
    list.AddRectFilled({from.x - 4 * s, from.y - 2 * s}, {from.x + size.x + 4 * s, from.y + size.y + 2 * s},
                       IM_COL32(0, 0, 0, 150), 3 * s);
    list.AddText(from, IM_COL32_WHITE, text);
}

bool chosenButton(const char* label, bool on, glm::vec2 size) {
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    const bool pressed = ImGui::Button(label, {size.x, size.y});
    if (on) ImGui::PopStyleColor();
    return pressed;
}

namespace scene = espalier::scene;

uint32_t shownColour(const float (&rgb)[3]) {
    return ImColor(scene::srgbOf(rgb[0]), scene::srgbOf(rgb[1]), scene::srgbOf(rgb[2]));
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
        for (int i = 0; i < 3; ++i) shown[i] = scene::srgbOf(rgb[i]);
        if (!ImGui::ColorEdit3(id, shown, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_DisplayHex)) return false;
        for (int i = 0; i < 3; ++i) rgb[i] = scene::linearOf(shown[i]);
        return true;
    });
}

uint32_t viewColour(EspView view, float amount) {
    float rgb[3]{}, most = 0;
    (void)espViewColour(view, amount, rgb, &most);
    return shownColour(rgb);
}

void hint(const char* text) {
    ImGui::PushStyleColor(ImGuiCol_Text, kWarning);
    ImGui::TextWrapped("%s", text);
    ImGui::PopStyleColor();
}

void aside(const char* text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::TextWrapped("%s", text);
    ImGui::PopStyleColor();
}

std::string shortened(const std::string& text, float room) {
    constexpr const char* kEllipsis = "\u2026";
    if (ImGui::CalcTextSize(text.c_str()).x <= room) return text;
    const auto within = [](char c) { return (c & 0xC0) == 0x80; };  // of a letter of several bytes
    std::string shown = text;
    while (!shown.empty() && ImGui::CalcTextSize((shown + kEllipsis).c_str()).x > room) {
        while (shown.size() > 1 && within(shown.back())) shown.pop_back();
        shown.pop_back();
    }
    return shown + kEllipsis;
}

void label(const char* text) {
    const std::string shown = shortened(text, ImGui::GetContentRegionAvail().x);
    ImGui::TextUnformatted(shown.c_str());
    if (shown != text) toolTip(text);
}

bool checkBox(const char* label, bool* on) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float room = ImGui::GetContentRegionAvail().x - ImGui::GetFrameHeight() - style.ItemInnerSpacing.x;
    const std::string shown = shortened(label, room);
    const bool cut = shown != label;
    const bool changed = ImGui::Checkbox(cut ? (shown + "###" + label).c_str() : label, on);
    if (cut) toolTip(label);
    return changed;
}

bool beginCombo(const char* id, const std::string& shown) {
    const float room = ImGui::CalcItemWidth() - ImGui::GetFrameHeight() - ImGui::GetStyle().FramePadding.x;
    const std::string fits = shortened(shown, room);
    const bool open = ImGui::BeginCombo(id, fits.c_str());
    cut() = !open && fits != shown ? Cut{ImGui::GetItemID(), shown} : Cut{};
    return open;
}

void rowLabel(const char* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine(ImGui::GetFontSize() * 6.2f);
    ImGui::SetNextItemWidth(-1);
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
