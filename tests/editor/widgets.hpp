#pragma once

#include <imgui_internal.h>

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "tests/editor/window.hpp"

// One of the words and numbers that tell widgets apart.
struct Part {
    const char* word = nullptr;
    int number = 0;
    Part(const char* text) : word(text) {}
    Part(int of) : number(of) {}
};

// The identity of what was laid out in the last frame; path: what was pushed around it, and its label.
inline ImGuiID widget(const std::string& window, const std::vector<Part>& path) {
    const ImGuiWindow* found = ImGui::FindWindowByName(window.c_str());
    REQUIRE_MESSAGE((found && found->WasActive), window << " isn't shown");
    ImGuiID id = found->ID;
    for (const Part& part : path)
        id = part.word ? ImHashStr(part.word, 0, id) : ImHashData(&part.number, sizeof part.number, id);
    return id;
}

// The window in a window that BeginChild made by this name.
inline std::string childOf(const char* window, const char* name) {
    char whole[100];
    std::snprintf(whole, sizeof whole, "%s/%s_%08X", window, name, widget(window, {name}));
    return whole;
}

// All words that are written while it lays something out: of one window, and of a tip that it shows.
inline std::string wordsOf(const std::function<void()>& layOut) {
    ImGui::SetClipboardText("");
    ImGui::LogToClipboard();  // until the first window ends
    layOut();
    return ImGui::GetClipboardText();
}

// Presses a button, a box or a choice by its name, which like a click begins a gesture. Nothing of that name: nothing
// happens; what is disabled is pressed, too.
inline void pressWidget(Editor& editor, const std::string& window, const std::vector<Part>& path) {
    editor.work.newGesture();
#if IMGUI_VERSION_NUM >= 18900
    ImGui::ActivateItemByID(widget(window, path));
#else
    ImGui::ActivateItem(widget(window, path));
#endif
    for (int i = 0; i < 3; ++i) editor.frame({});
}

// Opens a list of choices and takes one of them.
inline void chooseFrom(Editor& editor, const std::string& window, const std::vector<Part>& combo, const char* choice) {
    pressWidget(editor, window, combo);
    pressWidget(editor, "##Combo_00", {choice});
}
