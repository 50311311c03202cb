#pragma once

// ImGui's keys as tests press them. ImGui 1.87 has replaced the arrays of keys by events.

#include <imgui.h>

#include <algorithm>
#include <iterator>

// From the next frame on the key is down, or up.
inline void setKey(ImGuiKey key, bool down) {
    ImGuiIO& io = ImGui::GetIO();
#if IMGUI_VERSION_NUM >= 18700
    io.ConfigInputTrickleEventQueue = false;  // all in the next frame
    io.AddKeyEvent(key, down);
#else
    io.KeyMap[key] = key;
    io.KeysDown[key] = down;
#endif
}

inline void setControl(bool down) {
    ImGuiIO& io = ImGui::GetIO();
#if IMGUI_VERSION_NUM >= 18900
    io.AddKeyEvent(ImGuiMod_Ctrl, down);
#elif IMGUI_VERSION_NUM >= 18700
    io.AddKeyEvent(ImGuiKey_ModCtrl, down);
#else
    io.KeyCtrl = down;
    io.KeyMods = down ? ImGuiKeyModFlags_Ctrl : ImGuiKeyModFlags_None;
#endif
}

inline bool isAnyKeyDown() {
    const ImGuiIO& io = ImGui::GetIO();
#if IMGUI_VERSION_NUM >= 18700
    return std::any_of(std::begin(io.KeysData), std::end(io.KeysData),
                       [](const ImGuiKeyData& key) { return key.Down; });
#else
    return std::any_of(std::begin(io.KeysDown), std::end(io.KeysDown), [](bool down) { return down; });
#endif
}
