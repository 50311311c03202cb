// Rows, words, tips and windows of the panels.
#include "sample_game/widgets.hpp"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <map>

#include "sample_game/theme.hpp"
#include "tools/scene/picture.hpp"

namespace sample {
namespace {

constexpr float kTipDelay = .5f;  // seconds

// What a list of choices shows of the one that is taken, where there is no room for the whole.
struct Cut {
    ImGuiID list = 0;  // the one that was laid out last; 0: none that is cut
    std::string whole;
};

Cut& cut() {
    static Cut last;
    return last;
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

bool toolTipWaits() {
    const ImGuiContext& gui = *ImGui::GetCurrentContext();
    return gui.HoveredId != 0 && gui.HoveredIdNotActiveTimer < kTipDelay;
}

void tip(const char* text) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + tipWidth());
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

}  // namespace sample
