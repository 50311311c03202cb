// The manual, as the project's documentation has it, and what this program is.
#include <imgui.h>

#include <cstring>
#include <sstream>
#include <vector>

#include "sample_game/panels.hpp"
#include "sample_game/theme.hpp"
#include "tools/scene/text_file.hpp"
#include "tools/scene/user_folders.hpp"

namespace sample {
namespace {

enum class Part { heading, text, verbatim };
struct Paragraph {
    Part kind;
    std::string text;
};

// Without pictures and the rules of tables; links by their words. Lines of a paragraph are one.
std::vector<Paragraph> readManual() {
    std::string text, error;
    if (!espalier::scene::readText(espalier::scene::contentFolder() + "/manual.md", text, error))
        return {{Part::text, error}};
    std::vector<Paragraph> out;
    bool verbatim = false, goesOn = false;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("```")) {
            verbatim = !verbatim;
            goesOn = false;
            continue;
        }
        if (verbatim) {
            out.push_back({Part::verbatim, line});
            continue;
        }
        const bool drawn = line.starts_with("![") || line.starts_with("|--") || line.starts_with("| |");
        if (line.empty() || drawn) {
            goesOn = false;
            continue;
        }
        std::erase(line, '*');
        std::erase(line, '`');
        for (size_t at = 0; (at = line.find("](", at)) != std::string::npos;) {
            const size_t end = line.find(')', at), begin = line.rfind('[', at);
            if (end == std::string::npos || begin == std::string::npos) break;
            line = line.substr(0, begin) + line.substr(begin + 1, at - begin - 1) + line.substr(end + 1);
            at = begin;
        }
        if (line[0] == '#') {
            out.push_back({Part::heading, line.substr(line.find_first_not_of("# "))});
            goesOn = false;
        } else if (goesOn && !std::strchr("|-123456789", line[0])) {
            out.back().text += " " + line.substr(line.find_first_not_of(' '));
        } else {
            out.push_back({Part::text, line});
            goesOn = true;
        }
    }
    return out;
}

void showManual(Workspace& work) {
    static const std::vector<Paragraph> manual = readManual();
    ImGui::SetNextWindowPos({.5f * work.window.x, .5f * work.window.y}, ImGuiCond_Appearing, {.5f, .5f});
    ImGui::SetNextWindowSize({.55f * work.window.x, .8f * work.window.y}, ImGuiCond_Appearing);
    if (ImGui::Begin("Manual", &work.manual, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | kQuiet)) {
        for (const Paragraph& paragraph : manual) {
            if (paragraph.kind == Part::heading) ImGui::Spacing();
            ImGui::PushStyleColor(
                ImGuiCol_Text, paragraph.kind == Part::heading
                                   ? kGood
                                   : ImGui::GetStyleColorVec4(paragraph.kind == Part::verbatim ? ImGuiCol_TextDisabled
                                                                                               : ImGuiCol_Text));
            ImGui::TextWrapped("%s", paragraph.text.c_str());
            ImGui::PopStyleColor();
            if (paragraph.kind == Part::text) ImGui::Spacing();
        }
    }
    ImGui::End();
}

void showAbout(Workspace& work) {
    ImGui::SetNextWindowPos({.5f * work.window.x, .5f * work.window.y}, ImGuiCond_Always, {.5f, .5f});
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings | kQuiet;
    if (ImGui::Begin("About Espalier", &work.about, flags)) {
        ImGui::Text("Espalier %s grows plants, roofs and patterns over a game's own geometry.", espVersion());
        ImGui::Text("Device: %s", espDeviceName(work.context.get()));
        ImGui::Text("Driver: %s", espDriverName(work.context.get()));
        ImGui::Text("Settings: %s", espalier::scene::configFolder().c_str());
        ImGui::Text("Caches: %s", espalier::scene::cacheFolder().c_str());
        ImGui::TextDisabled("MIT licensed.");
    }
    ImGui::End();
}

}  // namespace

void showManualAndAbout(Workspace& work) {
    if (work.manual) showManual(work);
    if (work.about) showAbout(work);
}

}  // namespace sample
