#pragma once

#include <imgui_internal.h>

#include <initializer_list>
#include <string>

#include "tests/editor/window.hpp"

// The identity of what was laid out in the last frame; path: what was pushed around it, and its label.
inline ImGuiID widget(const std::string& window, std::initializer_list<const char*> path) {
    const ImGuiWindow* found = ImGui::FindWindowByName(window.c_str());
    REQUIRE_MESSAGE((found && found->WasActive), window << " isn't shown");
    ImGuiID id = found->ID;
    for (const char* part : path) id = ImHashStr(part, 0, id);
    return id;
}

// Presses a button, a box or a choice by its name, which like a click begins a gesture. Nothing of that name: nothing
// happens; what is disabled is pressed, too.
inline void pressWidget(Editor& editor, const std::string& window, std::initializer_list<const char*> path) {
    editor.work.newGesture();
    ImGui::ActivateItem(widget(window, path));
    for (int i = 0; i < 3; ++i) editor.frame({});
}

// Opens a list of choices and takes one of them.
inline void chooseFrom(Editor& editor, const std::string& window, std::initializer_list<const char*> combo,
                       const char* choice) {
    pressWidget(editor, window, combo);
    pressWidget(editor, "##Combo_00", {choice});
}
