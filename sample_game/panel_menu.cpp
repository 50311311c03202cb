// The bar at the top with its dialogues, the line at the bottom, the help.
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "sample_game/folder_list.hpp"
#include "sample_game/panels.hpp"
#include "tools/document/layer_files.hpp"

namespace sample {
namespace {

using namespace espalier::document;

const ImVec4 kBad{1, .55f, .45f, 1}, kGood{.62f, .85f, .5f, 1};

struct Dialogues {
    const char* open = nullptr;
    bool failed = false;  // the open one's last try
    bool asks = false;    // one that asks for a path was open in the last frame
    char project[512] = "", file[512] = "", run[512] = "", picture[512] = "";
    std::string layer;  // of the picture
};

Dialogues& dialogues() {
    static Dialogues state;
    return state;
}

// Windows that appear for the first time would lie over it.
bool beginDialogue(const char* title) {
    if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return false;
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    return true;
}

// What lies in the folder of `path`, to be clicked. True: a file or project was clicked twice.
bool showFolder(char* path, size_t size, const std::vector<std::string>& endings) {
    static struct {
        std::string typed;
        double read = -1;
        std::vector<FolderEntry> entries;
    } shown;
    if (shown.typed != path || ImGui::GetTime() > shown.read + 2)
        shown = {path, ImGui::GetTime(), listFolder(path, endings)};
    bool taken = false;
    if (ImGui::BeginChild("folder", {ImGui::GetFontSize() * 32, ImGui::GetTextLineHeightWithSpacing() * 8}, true))
        for (const FolderEntry& entry : shown.entries) {
            const bool known = entry.kind == FolderEntry::project;
            const std::string text = known ? entry.name + "   project" : entry.name;
            const ImGuiSelectableFlags flags =
                ImGuiSelectableFlags_AllowDoubleClick | ImGuiSelectableFlags_DontClosePopups;
            if (!ImGui::Selectable(text.c_str(), entry.path == path, flags)) continue;
            std::snprintf(path, size, "%s", entry.path.c_str());
            taken = entry.kind != FolderEntry::folder && ImGui::IsMouseDoubleClicked(0);
        }
    ImGui::EndChild();
    return taken;
}

// A dialogue that asks for a path, and stays with what went wrong until `act`, which is given the path, returns true.
template <class Act>
void askPath(Workspace& work, const char* title, const char* label, const char* button, char* path, size_t size,
             const std::vector<std::string>& endings, Act&& act) {
    bool confirmed = false;
    if (!beginDialogue(title)) return;
    dialogues().asks = true;
    ImGui::TextUnformatted(label);
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 32);
    if (!ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();  // it is all that one can type into
    confirmed = ImGui::InputText("##path", path, size, ImGuiInputTextFlags_EnterReturnsTrue);
    confirmed |= showFolder(path, size, endings);
    confirmed |= ImGui::Button(button);
    ImGui::SameLine();
    const bool cancelled = ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (confirmed && path[0]) {
        work.error.clear();
        dialogues().failed = !act(path);
    }
    if (dialogues().failed) {
        ImGui::PushTextWrapPos(ImGui::GetFontSize() * 32);
        ImGui::TextColored(kBad, "%s", work.error.c_str());
        ImGui::PopTextWrapPos();
    }
    if (cancelled || (confirmed && !dialogues().failed)) {
        dialogues().asks = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}
void ask(const char* title) {
    dialogues().open = title;
    dialogues().failed = false;
}

void put(char* to, size_t size, const std::string& text) {
    std::snprintf(to, size, "%s", text.c_str());
}

void fileMenu(Workspace& work, Session& session) {
    Dialogues& d = dialogues();
    if (ImGui::MenuItem("Open ...", "Ctrl+O")) askToOpen();
    if (ImGui::MenuItem("Save", "Ctrl+S")) askToSave(work, session);
    if (ImGui::MenuItem("Save as ...")) {
        put(d.project, sizeof d.project, session.folder());
        ask("Save the project");
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Record a run ...", nullptr, false, !session.recording())) ask("Record a run");
    if (ImGui::MenuItem("End the recording", nullptr, false, session.recording())) session.stopRecording(work);
    ImGui::Separator();
    if (ImGui::MenuItem("Quit", "Ctrl+Q")) session.quit = true;
}

}  // namespace

void askToSave(Workspace& work, Session& session) {
    if (!session.folder().empty())
        session.save(work, session.folder());
    else
        ask("Save the project");
}

void askForLayer(const std::string& layer, bool import) {
    Dialogues& d = dialogues();
    if (d.layer != layer) put(d.picture, sizeof d.picture, layer + ".exr");
    d.layer = layer;
    ask(import ? "Import a layer" : "Export a layer");
}

void closeDialogues() {
    dialogues().open = nullptr;
    dialogues().asks = false;
    if (!ImGui::GetCurrentContext()->OpenPopupStack.empty()) ImGui::ClosePopupToLevel(0, false);
}

bool awaitsText() {
    const Dialogues& d = dialogues();
    return (d.open || d.asks) && !ImGui::GetIO().WantTextInput;
}

bool closeMenus() {
    const auto& open = ImGui::GetCurrentContext()->OpenPopupStack;
    int level = open.Size;
    while (level > 0 && open[level - 1].Window && !(open[level - 1].Window->Flags & ImGuiWindowFlags_Modal)) --level;
    if (level == open.Size) return false;
    ImGui::ClosePopupToLevel(level, true);
    return true;
}

void askToOpen(const std::string& refused) {
    Dialogues& d = dialogues();
    d.open = "Open";
    d.failed = !refused.empty();
    if (d.failed) put(d.file, sizeof d.file, refused);
}

void showDialogues(Workspace& work, Session& session) {
    Dialogues& d = dialogues();
    d.asks = false;
    if (d.open) {
        if (!d.project[0]) put(d.project, sizeof d.project, std::filesystem::path(session.name(work)).stem().string());
        if (!d.file[0]) put(d.file, sizeof d.file, std::filesystem::path(session.file()).parent_path().string() + "/");
        if (!d.run[0]) put(d.run, sizeof d.run, "run.jsonl");
        ImGui::OpenPopup(d.open);
        d.open = nullptr;
    }
    askPath(work, "Save the project", "Folder of the project:", "Save", d.project, sizeof d.project, {},
            [&](const char* folder) {
                session.save(work, folder);
                return work.error.empty();
            });
    // What can't be opened asks again, see askToOpen.
    askPath(work, "Open", "A project's folder, a scene (.json) or a baked surface (.glb):", "Open", d.file,
            sizeof d.file, {".json", ".glb"}, [&](const char* file) {
                session.openNext = file;
                return true;
            });
    askPath(work, "Record a run", "File for what is done from now on:", "Record", d.run, sizeof d.run, {".jsonl"},
            [&](const char* file) {
                return session.startRecording(work, file, uint32_t(work.window.x), uint32_t(work.window.y));
            });
    const bool town = work.townLayer(d.layer);
    const char* asked = town ? "Picture of the town from above, north up (.png, .exr):"
                             : "Picture in the surface's walk UVs, as Export writes it (.png, .exr):";
    askPath(work, "Import a layer", asked, "Import", d.picture, sizeof d.picture, {".png", ".exr"},
            [&](const char* file) {
                if (town) return work.perform(LoadTownLayer{d.layer, file});
                const uint32_t gesture = work.newGesture();
                for (uint32_t i = 0; i < work.scene().surfaces.size(); ++i)
                    if (!work.perform(LoadLayer{d.layer, pictureOf(*work.document, file, i), i}, gesture)) return false;
                work.message = "Read: " + wholePath(file);
                return true;
            });
    askPath(work, "Export a layer", "File of the picture (.png: 16 bits, .exr: floats):", "Export", d.picture,
            sizeof d.picture, {".png", ".exr"}, [&](const char* file) {
                if (!(town ? exportTownLayer : exportLayer)(*work.document, d.layer, file, work.error)) return false;
                work.message = "Written: " + wholePath(file);
                return true;
            });
    if (!session.recovery().empty()) ImGui::OpenPopup("Unsaved work");
    if (beginDialogue("Unsaved work")) {
        ImGui::TextUnformatted("The last session ended without saving. What it had changed was kept.");
        if (session.recovery().empty()) ImGui::CloseCurrentPopup();
        if (ImGui::Button("Open it") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false)) {
            session.openNext = session.recovery();
            session.forgetRecovery(false);
            ImGui::CloseCurrentPopup();
        }
        ImGui::SameLine();
        if (ImGui::Button("Throw it away")) {
            session.forgetRecovery(true);
            ImGui::CloseCurrentPopup();
        }
        ImGui::EndPopup();
    }
}

void showMenu(Workspace& work, Session& session) {
    if (ImGui::BeginMainMenuBar()) {
        if (ImGui::BeginMenu("File")) {
            fileMenu(work, session);
            ImGui::EndMenu();
        }
        if (ImGui::BeginMenu("Edit")) {
            const char *undo = work.document->undoName(), *redo = work.document->redoName();
            const std::string back = undo ? std::string("Undo: ") + undo : "Undo";
            const std::string again = redo ? std::string("Redo: ") + redo : "Redo";
            if (ImGui::MenuItem(back.c_str(), "Ctrl+Z", false, undo)) work.perform(Undo{});
            if (ImGui::MenuItem(again.c_str(), "Ctrl+Shift+Z", false, redo)) work.perform(Redo{});
            ImGui::EndMenu();
        }
        if (ImGui::BeginMenu("View")) {
            ImGui::MenuItem("Panel", "F2", &work.layout.panel);
            ImGui::MenuItem("Figures", "F3", &work.layout.figures);
            ImGui::MenuItem("Grammar", "F4", &work.layout.grammar);
            ImGui::MenuItem("Atlas", "F5", &work.layout.atlas);
            ImGui::MenuItem("Coarser while moving", nullptr, &work.layout.halfWhileMoving);
            toolTip("While the camera moves on a slow device, the picture has half the pixels a side");
            ImGui::SetNextItemWidth(ImGui::GetFontSize() * 8);
            ImGui::SliderFloat("Size of letters", &work.layout.sizeOfAll, .5f, 2.5f, "%.2f",
                               ImGuiSliderFlags_AlwaysClamp);
            ImGui::EndMenu();
        }
        if (ImGui::BeginMenu("Help")) {
            ImGui::MenuItem("Keys and mouse", "F1", &work.layout.help);
            ImGui::EndMenu();
        }
        std::string name = session.name(work);
        if (session.modified(work)) name += " *";
        if (session.recording()) name += "   REC";
        ImGui::SetCursorPosX(ImGui::GetWindowWidth() - ImGui::CalcTextSize(name.c_str()).x - 12 * work.scale);
        ImGui::TextDisabled("%s", name.c_str());
        ImGui::EndMainMenuBar();
    }
}

void showStatus(const Workspace& work, bool caught, bool flying) {
    std::string text;
    if (!work.editing)
        text = std::string(caught ? "Mouse: look   " : "Click: look around   ") +
               "W A S D: " + (flying ? "fly   Q E: down, up   G: walk" : "walk   Space: jump   Shift: run   G: fly") +
               "   Tab: the editor" + (caught ? "   Esc: free the mouse" : "");
    else if (work.underWay)
        text = work.underWay;
    else if (work.tool == Tool::paint)
        text = "Drag: paint " + work.brush.layer + "   Ctrl: erase   Shift: smooth   [ ]: size   " +
               (work.townLayer(work.brush.layer) ? "" : "V: show the layer   ") +
               "right drag: look, with W A S D: fly   middle drag: turn";
    else if (work.tool == Tool::seeds)
        text =
            "Click: plant   drag: plant with a direction   Ctrl+drag: a row   click a seed: choose, drag it: move   "
            "G: move   R: turn   Del: remove   F: show it";
    else if (work.tool == Tool::houses)
        text =
            "Click a house, or an edge of the chosen one   drag a corner: the roof follows   Ctrl+drag an edge: a new "
            "corner   Del: the edge's corner goes";
    else if (work.tool == Tool::branch)
        text =
            "Click a branch: its walk, on the model and over the atlas   Del: prune it   white: steps   blue: put in "
            "at "
            "seams and creases   green: over a seam";
    else
        text =
            "Drag: turn around   Shift+drag: sideways   wheel: nearer   right drag: look, with W A S D: fly   "
            "B: paint   S: seeds   Tab: walk";
    const bool bad = !work.error.empty();
    const float height = ImGui::GetFrameHeight() + 4 * work.scale;
    ImGui::SetNextWindowPos({0, work.window.y - height});
    ImGui::SetNextWindowSize({work.window.x, height});
    ImGui::SetNextWindowBgAlpha(work.editing ? .96f : .55f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {12 * work.scale, 4 * work.scale});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                   ImGuiWindowFlags_NoNav;
    if (ImGui::Begin("status", nullptr, flags)) {
        // News is short-lived: it takes the hint's place where there isn't room for both.
        const std::string& news = bad ? work.error : work.message;
        const std::string line = news.substr(0, news.find('\n'));
        const float width = ImGui::CalcTextSize(line.c_str()).x;
        const bool fits = ImGui::CalcTextSize(text.c_str()).x + width + 52 * work.scale < work.window.x;
        // In a narrow window the last hints give way, each as a whole.
        while (ImGui::CalcTextSize(text.c_str()).x + 24 * work.scale > work.window.x &&
               text.rfind("   ") != std::string::npos)
            text.resize(text.rfind("   "));
        if (line.empty() || fits) ImGui::TextUnformatted(text.c_str());
        if (!line.empty()) {
            if (fits) ImGui::SameLine(work.window.x - width - 12 * work.scale);
            ImGui::TextColored(bad ? kBad : kGood, "%s", line.c_str());
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", news.c_str());
        }
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
}

void showHelp(Workspace& work) {
    if (!work.layout.help) return;
    struct Row {
        const char *keys, *what;
    };
    const Row camera[] = {{"Tab", "between the game and the editor"},
                          {"W A S D, mouse", "walk and look (game); G flies, Space jumps, Shift runs"},
                          {"Middle drag, Alt+drag", "turn around; with Shift sideways"},
                          {"Right drag", "look around; with W A S D Q E fly"},
                          {"Wheel", "nearer, further"},
                          {"Home, F or numpad .", "show everything, what is chosen"},
                          {"Numpad 1 3 7", "from the front, the right, above; Ctrl: the other side"}};
    const Row paint[] = {{"B, then drag", "paint the chosen layer"},
                         {"Ctrl+drag, Shift+drag", "erase, smooth"},
                         {"[ and ]", "smaller, larger brush"},
                         {"F, Shift+F, then move", "radius, strength; click to keep it"},
                         {"V", "show or hide what is painted"}};
    const Row seeds[] = {{"S, then click", "plant; drag gives the direction"},
                         {"Ctrl+drag", "plant a row"},
                         {"Click, Shift+click", "choose seeds; drag moves them, a drag of the arrow turns them"},
                         {"G, R", "move, turn the chosen seeds; a click ends it, Esc takes it back"},
                         {"A, X or Del", "choose all, remove"},
                         {"Shift+R", "other random numbers for all"},
                         {"P, then click", "the walk of a branch; Del prunes it"},
                         {"H, then click", "a house; drag its corners, choose its edges"}};
    const Row all[] = {{"Ctrl+Z, Ctrl+Shift+Z", "undo, redo: of everything"},
                       {"Ctrl+S, Ctrl+O, Ctrl+E", "save, open, export the layer"},
                       {"1 2 3 4 5 6", "shaded, charts, normals, levels of detail, depth, overdraw"},
                       {"F2 F3 F4 F5", "panel, figures, grammar, atlas"},
                       {"F12", "write a screenshot"},
                       {"Esc", "puts the tool away"}};
    ImGui::SetNextWindowPos({work.window.x / 2, work.window.y / 2}, ImGuiCond_Always, {.5f, .5f});
    ImGui::SetNextWindowSize({std::min(680 * work.scale, work.window.x), 0});
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize | kQuiet;
    if (ImGui::Begin("Keys and mouse", &work.layout.help, flags)) {
        ImGui::TextWrapped(
            "A path of ivy up a wall: B, Clear the mask, drag up the wall; then S and a "
            "click at the foot of what you painted.");
        const auto table = [&](const char* title, const Row* rows, size_t count) {
            ImGui::Spacing();
            ImGui::TextColored({.62f, .85f, .5f, 1}, "%s", title);
            if (!ImGui::BeginTable(title, 2)) return;
            ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthFixed, 230 * work.scale);
            ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch);
            for (size_t i = 0; i < count; ++i) {
                ImGui::TableNextRow();
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(rows[i].keys);
                ImGui::TableNextColumn();
                ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
                ImGui::TextWrapped("%s", rows[i].what);
                ImGui::PopStyleColor();
            }
            ImGui::EndTable();
        };
        table("Camera", camera, std::size(camera));
        table("Painting", paint, std::size(paint));
        table("Seeds", seeds, std::size(seeds));
        table("Everything", all, std::size(all));
    }
    ImGui::End();
}

void showGrowing(const Workspace& work) {
    ImGui::SetNextWindowPos({(work.window.x + work.panelUnits()) / 2, work.window.y - 90 * work.scale},
                            ImGuiCond_Always, {.5f, .5f});
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize | kQuiet;
    if (ImGui::Begin("growing", nullptr, flags)) ImGui::TextUnformatted("Growing ...");
    ImGui::End();
}

}  // namespace sample
