// Names for the letters before the cursor of a grammar's text: when they are offered, taken, and how they are seen.
#include "sample_game/grammar_offer.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <string>
#include <utility>

#include "sample_game/widgets.hpp"

namespace sample {
namespace {

constexpr size_t kFewestLetters = 2;

// Of the language of the grammar in the window.
const std::vector<Completion>& languageOf(const Workspace& work) {
    static std::vector<Completion> words[ESP_GRAMMAR_PATTERNS + 1];
    EspGrammarKind kind = ESP_GRAMMAR_PLANTS;
    (void)espGrammarKind(work.context.get(), work.scene().grammars[work.openGrammar].id, &kind);
    std::vector<Completion>& known = words[kind];
    for (uint32_t i = uint32_t(known.size()); i < espWordCount(kind); ++i)
        if (EspWord word; espWord(kind, i, &word) == ESP_OK) known.push_back({word.name, word.usage});
    return known;
}

}  // namespace

void Offer::follow(const Workspace& work, std::string_view text, size_t cursor, bool typing, bool changed) {
    const bool taken = std::exchange(taken_, false);
    const bool asked = typing && ImGui::GetIO().KeyCtrl && ImGui::IsKeyPressedMap(ImGuiKey_Space);
    const size_t letters = typing ? lettersBefore(text, cursor) : 0;
    if (asked && open_)
        ++marked_;
    else if (asked || (changed && !taken && letters >= kFewestLetters))
        open_ = true, marked_ = 0;
    else if (taken || letters == 0 || cursor != cursor_)
        open_ = false;
    cursor_ = cursor;
    list_.clear();
    if (open_) list_ = completionsOf(text, cursor, languageOf(work));
    open_ = !list_.empty();
    if (open_) marked_ %= list_.size();
}

void Offer::take(ImGuiInputTextCallbackData& data) {
    const size_t cursor = size_t(data.CursorPos);
    const size_t letters = lettersBefore({data.Buf, size_t(data.BufTextLen)}, cursor);
    if (list_.empty() || letters == 0) return;
    std::string name = insertedBy(list_[std::min(marked_, list_.size() - 1)]);
    if (name.back() == '(' && data.Buf[cursor] == '(') name.pop_back();
    data.DeleteChars(int(cursor - letters), int(letters));
    data.InsertChars(data.CursorPos, name.c_str());
    taken_ = true;
}

// Below the cursor, or above where there is no room; the marked name tells how it is taken.
void Offer::draw(const Workspace& work, ImVec2 below) const {
    if (!open_) return;
    const float high = ImGui::GetFontSize(), pad = 4 * work.scale, gap = 2 * high;
    float names = 0, usages = 0;
    const auto usageOf = [&](size_t i) {
        const std::string& usage = list_[i].usage;
        return i == marked_ ? usage + (usage.empty() ? "Tab" : "   Tab") : usage;
    };
    for (size_t i = 0; i < list_.size(); ++i) {
        names = std::max(names, ImGui::CalcTextSize(list_[i].name.c_str()).x);
        usages = std::max(usages, ImGui::CalcTextSize(usageOf(i).c_str()).x);
    }
    const ImVec2 size{names + gap + usages + 2 * pad, high * float(list_.size()) + 2 * pad};
    ImVec2 at{below.x - pad, below.y};
    if (at.y + size.y > work.window.y) at.y -= size.y + high;
    at.x = std::max(0.f, std::min(at.x, work.window.x - size.x));
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_PopupBg), pad);
    list.AddRect(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_Border), pad);
    for (size_t i = 0; i < list_.size(); ++i) {
        const float y = at.y + pad + high * float(i);
        if (i == marked_)
            list.AddRectFilled({at.x + 1, y}, {at.x + size.x - 1, y + high}, ImGui::GetColorU32(ImGuiCol_Header));
        list.AddText({at.x + pad, y}, ImGui::GetColorU32(ImGuiCol_Text), list_[i].name.c_str());
        list.AddText({at.x + pad + names + gap, y}, ImGui::GetColorU32(ImGuiCol_TextDisabled), usageOf(i).c_str());
    }
}

}  // namespace sample
