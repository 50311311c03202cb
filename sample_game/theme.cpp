// A dark, neutral look that leaves colour to the picture. The fonts are DejaVu Sans and its sister of one width, where
// Debian has them installed.
#include "sample_game/theme.hpp"

#include <imgui.h>

#include <filesystem>

namespace sample {
namespace {

const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
const char* kTextFont = "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf";
// Latin, Greek, Cyrillic, punctuation, superscripts, arrows, what labels and units of grammars are written with.
const ImWchar kGlyphs[] = {0x20,   0x24F,  0x370,  0x3FF,  0x400,  0x4FF,  0x2010, 0x2027,
                           0x2070, 0x209F, 0x2190, 0x21FF, 0x2200, 0x22FF, 0};

ImVec4 grey(float value, float alpha = 1) {
    return {value, value, value * 1.02f, alpha};
}

void addFont(const char* file, float size) {
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    std::error_code ignored;
    size = float(int(size + .5f));
    if (std::filesystem::exists(file, ignored)) {
        fonts.AddFontFromFileTTF(file, size, nullptr, kGlyphs);
    } else {
        ImFontConfig config;
        config.SizePixels = size;
        fonts.AddFontDefault(&config);
    }
}

}  // namespace

ImFont* textFont() {
    return ImGui::GetIO().Fonts->Fonts.back();
}

void applyTheme(float scale) {
    ImGui::GetIO().Fonts->Clear();
    addFont(kFont, 15 * scale);
    addFont(kTextFont, 14 * scale);

    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowPadding = {12, 10};
    style.FramePadding = {8, 4};
    style.ItemSpacing = {8, 6};
    style.WindowRounding = 0;
    style.FrameRounding = style.GrabRounding = style.PopupRounding = 3;
    style.WindowBorderSize = 0;
    style.ScrollbarSize = 12;
    const ImVec4 green{.36f, .56f, .30f, 1}, greenBright{.46f, .70f, .38f, 1};
    ImVec4* c = style.Colors;
    c[ImGuiCol_Text] = grey(.90f);
    c[ImGuiCol_TextDisabled] = grey(.66f);
    c[ImGuiCol_WindowBg] = grey(.105f);  // there is no picture below the panel
    c[ImGuiCol_PopupBg] = grey(.13f, .98f);
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = grey(.17f);
    c[ImGuiCol_Border] = grey(.25f);
    c[ImGuiCol_FrameBg] = grey(.19f);
    c[ImGuiCol_FrameBgHovered] = grey(.25f);
    c[ImGuiCol_FrameBgActive] = grey(.29f);
    c[ImGuiCol_Button] = grey(.22f);
    c[ImGuiCol_ButtonHovered] = grey(.30f);
    c[ImGuiCol_ButtonActive] = green;
    c[ImGuiCol_Header] = grey(.18f);
    c[ImGuiCol_HeaderHovered] = grey(.26f);
    c[ImGuiCol_HeaderActive] = grey(.30f);
    c[ImGuiCol_SliderGrab] = green;
    c[ImGuiCol_SliderGrabActive] = greenBright;
    c[ImGuiCol_PlotHistogram] = green;  // bars of progress
    c[ImGuiCol_CheckMark] = greenBright;
    c[ImGuiCol_ModalWindowDimBg] = {0, 0, 0, .45f};
    c[ImGuiCol_Separator] = grey(.24f);
    c[ImGuiCol_ResizeGrip] = grey(.28f);
    c[ImGuiCol_ResizeGripHovered] = c[ImGuiCol_ResizeGripActive] = greenBright;
    c[ImGuiCol_TextSelectedBg] = {green.x, green.y, green.z, .55f};
    c[ImGuiCol_ScrollbarBg] = grey(.10f, 0);
    c[ImGuiCol_ScrollbarGrab] = grey(.28f);
    style.ScaleAllSizes(scale);
    ImGui::GetIO().MouseDoubleClickMaxDist = ImGui::GetIO().MouseDragThreshold = 6 * scale;  // pixels
    ImGui::GetStyle() = style;
}

}  // namespace sample
