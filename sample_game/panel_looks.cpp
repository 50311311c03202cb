// How a grammar's leaves, bark and blossoms look: a colour, a picture or a model that the user chooses.
#include <imgui.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "sample_game/dialogue.hpp"
#include "sample_game/folder_list.hpp"
#include "sample_game/model_bake.hpp"
#include "sample_game/panels.hpp"

namespace sample {
namespace {

namespace fs = std::filesystem;
using namespace espalier::document;
using espalier::scene::TerminalLook;

constexpr const char *kAskModel = "Choose a model", *kAskPicture = "Choose a picture";
constexpr float kFirstColour[] = {.25f, .42f, .06f}, kFirstBark[] = {.20f, .13f, .08f};  // of those that have none yet

// What a dialogue of this file asks for.
struct WantedLook {
    uint32_t grammar = 0;
    std::string terminal;
    PathText model{}, picture{};
};
WantedLook& wantedLook() {
    static WantedLook state;
    return state;
}

const char* titleOf(const std::string& terminal) {
    constexpr std::pair<const char*, const char*> kTerminalTitles[] = {{"bark", "Bark"},        {"leaf", "Leaves"},
                                                                       {"pebble", "Pebbles"},   {"oval", "Oval leaves"},
                                                                       {"blossom", "Blossoms"}, {"tuft", "Tufts"}};
    for (const auto& [name, title] : kTerminalTitles)
        if (terminal == name) return title;
    return "";
}

TerminalLook lookOf(const Workspace& work, uint32_t grammar, const std::string& terminal) {
    if (grammar < work.scene().grammars.size())
        for (const TerminalLook& look : work.scene().grammars[grammar].looks)
            if (look.terminal == terminal) return look;
    return {terminal, {}, {}, {}};
}

bool changeLook(Workspace& work, uint32_t grammar, const TerminalLook& look, uint32_t gesture = 0) {
    const bool good = work.perform(SetLook{grammar, look.terminal, look.mesh, look.picture, look.colour}, gesture);
    work.redraw = true;
    return good;
}

void colourCell(Workspace& work, uint32_t grammar, TerminalLook look) {
    float colour[3];
    const bool own = look.colour.size() == 3;
    const float* const begins = own ? look.colour.data() : look.terminal == "bark" ? kFirstBark : kFirstColour;
    std::copy_n(begins, 3, colour);
    bool on = own;
    if (checkBox("Colour", &on)) {
        look.colour.clear();
        if (on) look.colour.assign(colour, colour + 3);
        changeLook(work, grammar, look);
    }
    toolTip("A hue of their own; it multiplies a picture that you have chosen");
    if (!own) return;
    ImGui::SameLine();
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    if (editColour("##colour", colour)) {
        look.colour.assign(colour, colour + 3);
        changeLook(work, grammar, look, widgetGesture(work));
    }
}

void ask(const char* title, PathText& path, uint32_t grammar, const TerminalLook& look, const std::string& now) {
    const fs::path before = path[0] ? fs::path(path.data()) : fs::path(now.empty() ? dialogues().model.data() : now);
    put(path, before.has_parent_path() ? before.parent_path().string() + "/" : "");
    wantedLook().grammar = grammar;
    wantedLook().terminal = look.terminal;
    sample::ask(title);
}

// The file's name, or what the button offers.
void fileCell(Workspace& work, uint32_t grammar, TerminalLook look, std::string TerminalLook::*file, const char* title,
              const char* offer, const char* tip, PathText& path) {
    const std::string now = look.*file;
    const float cross = now.empty() ? 0 : ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x;
    const float width = ImGui::GetContentRegionAvail().x - cross;
    ImGui::PushID(title);
    std::string text = now.empty() ? offer : fs::path(now).filename().string();
    if (const size_t ending = text.find(".terminal.glb"); ending != std::string::npos) text.resize(ending);
    if (ImGui::Button((shortened(text, width - 2 * ImGui::GetStyle().FramePadding.x) + "###file").c_str(), {width, 0}))
        ask(title, path, grammar, look, now);
    toolTip((now.empty() ? tip : now + "\n" + tip).c_str());
    if (!now.empty()) {
        ImGui::SameLine();
        if (ImGui::Button("\u00d7", {ImGui::GetFrameHeight(), 0})) {
            (look.*file).clear();
            changeLook(work, grammar, look);
        }
        toolTip("As shipped again");
    }
    ImGui::PopID();
}

void takeModel(Workspace& work, const std::string& model) {
    TerminalLook look = lookOf(work, wantedLook().grammar, wantedLook().terminal);
    look.mesh = terminalOf(model);
    if (changeLook(work, wantedLook().grammar, look))
        work.say(std::string(titleOf(look.terminal)) + " are " + fs::path(model).filename().string() + " now");
}

// A model that was baked before is taken at once.
void useModel(Workspace& work, Session& session, const std::string& typed) {
    const std::string model = wholePath(typed);
    if (!isModel(model)) {
        work.error = model + ": is no model (.glb, .gltf, .obj, .ply, .stl, .fbx)";
        return endWait(work, false);
    }
    if (isTerminalBaked(model)) {
        takeModel(work, model);
        return endWait(work, work.error.empty());
    }
    Background::Job job{"Reading " + fs::path(model).filename().string(), [model] { return bakingTerminal(model); },
                        [&work, model](const Work& over) {
                            work.error = over.error();
                            if (over.state() == Work::State::done) takeModel(work, model);
                            endWait(work, over.state() == Work::State::done && work.error.empty());
                        }};
    job.leavesWithDocument = true;
    session.background().ask(std::move(job));
}

void usePicture(Workspace& work, const std::string& typed) {
    TerminalLook look = lookOf(work, wantedLook().grammar, wantedLook().terminal);
    look.picture = wholePath(typed);
    if (changeLook(work, wantedLook().grammar, look))
        work.say(std::string(titleOf(look.terminal)) + " show " + fs::path(look.picture).filename().string() + " now");
    endWait(work, work.error.empty());
}

}  // namespace

void looksPanel(Workspace& work, uint32_t grammar) {
    const EspGrammar id = work.scene().grammars[grammar].id;
    const uint32_t count = espTerminalCount(work.context.get(), id);
    if (count == 0 || !ImGui::TreeNode("Looks")) return;
    for (uint32_t i = 0; i < count; ++i) {
        const std::string terminal = espTerminalName(work.context.get(), id, i);
        const TerminalLook look = lookOf(work, grammar, terminal);
        ImGui::PushID(terminal.c_str());
        ImGui::TextUnformatted(titleOf(terminal));
        colourCell(work, grammar, look);
        if (terminal != "bark")
            fileCell(work, grammar, look, &TerminalLook::mesh, kAskModel, "Model \u2026",
                     "A model in place of the shipped mesh: its lowest point is the stalk, its longest side the length",
                     wantedLook().model);
        fileCell(work, grammar, look, &TerminalLook::picture, kAskPicture, "Picture \u2026",
                 terminal == "bark" || terminal == "pebble"
                     ? "A picture that tiles (.png, .jpg)"
                     : "A picture, its stalk at the lower edge; what is transparent is cut out (.png, .jpg)",
                 wantedLook().picture);
        ImGui::PopID();
    }
    ImGui::TreePop();
}

void lookDialogues(Workspace& work, Session& session) {
    askPath(work, session,
            {kAskModel,
             "A model that plants draw in place of the shipped one (.glb, .obj ...):",
             "Take",
             wantedLook().model,
             {std::begin(kModelEndings), std::end(kModelEndings)}},
            [&](const char* file) { useModel(work, session, file); });
    askPath(work, session,
            {kAskPicture, "A picture (.png, .jpg):", "Take", wantedLook().picture, {".png", ".jpg", ".jpeg"}},
            [&](const char* file) { usePicture(work, file); });
}

}  // namespace sample
