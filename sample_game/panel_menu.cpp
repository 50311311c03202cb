// The bar at the top, the line at the bottom.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "sample_game/additions.hpp"
#include "sample_game/field_brush.hpp"
#include "sample_game/graph_editor.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/theme.hpp"
#include "tools/scene/layers.hpp"

namespace sample {
namespace {

using namespace espalier::document;

// What was opened or saved lately and is still there.
void recentMenu(Workspace& work, Session& session) {
    if (!ImGui::BeginMenu("Recent", !work.layout.recent.empty())) return;
    for (const std::string& file : work.layout.recent) {
        std::error_code ignored;
        const bool there = std::filesystem::exists(file, ignored);
        if (ImGui::MenuItem((espalier::scene::lastPart(file) + "##" + file).c_str(), nullptr, false, there))
            askToLeave(work, session, file);
        toolTip(file.c_str());
    }
    ImGui::EndMenu();
}

void fileMenu(Workspace& work, Session& session) {
    if (ImGui::MenuItem("New", "Ctrl+N")) askToLeave(work, session, emptyScene());
    toolTip("An empty scene: add models to it, or drop them onto the window");
    if (ImGui::MenuItem("Open ...", "Ctrl+O")) askToOpen();
    recentMenu(work, session);
    if (ImGui::MenuItem("Add model ...")) askForModel();
    toolTip("A model comes to what is open, baked first if need be. So does one that is dropped onto the window");
    if (ImGui::MenuItem("Add grammar ...")) askForGrammar();
    toolTip("Plants, roofs or patterns of another kind, for seeds of their own");
    ImGui::Separator();
    if (ImGui::MenuItem("Save", "Ctrl+S")) askToSave(work, session);
    if (ImGui::MenuItem("Save as ...", "Ctrl+Shift+S")) askToSave(work, session, true);
    if (ImGui::MenuItem("Export ...")) askToExport(work);
    toolTip("What grows, as glTF: for engines and Blender");
    ImGui::Separator();
    if (ImGui::MenuItem("Record a run ...", nullptr, false, !session.recording())) askToRecord();
    if (ImGui::MenuItem("End the recording", nullptr, false, session.recording())) session.stopRecording(work);
    if (ImGui::MenuItem("Replay a run ...", nullptr, false, !session.recording())) askToReplay();
    ImGui::Separator();
    if (ImGui::MenuItem("Quit", "Ctrl+Q")) askToLeave(work, session);
}

// What the mouse and keys do now. always: what stays where others give way, which who is new needs most.
struct Hint {
    std::string text, always;
};

// What a drag of the brush does, or one with Ctrl, which makes painting of erasing and the other way round.
std::string strokeOf(const Workspace& work, bool control) {
    const Brush& brush = work.brush;
    const std::string mode = !control ? brush.mode : brush.mode == "erase" ? "paint" : "erase";
    if (mode == "smooth" || espalier::scene::isColour(work.scene(), brush.layer)) return mode + " " + brush.layer;
    const float to =
        mode == "paint" ? brush.value : espalier::scene::fillOf(work.context.get(), work.scene(), brush.layer);
    char text[16];
    std::snprintf(text, sizeof text, "%.2f", double(to));
    std::string name;
    for (const auto& named :
         espalier::scene::labelWords(espalier::scene::labelOf(work.context.get(), work.scene(), brush.layer)).values)
        if (named.value == to) name = " (" + named.name + ")";
    return mode + " " + brush.layer + (mode == "paint" ? ": " : " back to ") + text + name;
}

Hint hintOf(const Workspace& work, bool caught, bool flying) {
    if (!work.editing)
        return {std::string(caught ? "Mouse: look   " : "Click: look around   ") + "W A S D: " +
                    (flying ? "fly   Q E: down, up   G: walk" : "walk   Space: jump   Shift: run   G: fly") +
                    (caught ? "   Esc: free the mouse" : ""),
                "   Tab: the editor"};
    if (work.underWay) return {work.underWay, ""};
    if (work.scene().surfaces.empty() && !work.scene().town && work.scene().graphs.empty())
        return {"Drop a model (.glb, .obj ...) onto the window, or File, Add model", "   F1: all keys"};
    std::string text;
    switch (work.tool) {
        case Tool::paint:
            text = "Drag: " + strokeOf(work, false) + "   Ctrl: " + strokeOf(work, true) +
                   (isColour(work.scene(), work.brush.layer) ? "" : "   X: the opposite value") +
                   "   Shift: smooth   F: size   Shift+F: strength   V: show the layer   "
                   "middle drag: turn   "
                   "wheel: nearer";
            break;
        case Tool::seeds:
            text =
                "Click: plant   drag: with a direction   Ctrl+drag: a row   click a seed: choose   Shift+drag: "
                "several   G: move   R: turn   Shift+D: duplicate   Del: remove";
            break;
        case Tool::path:
            text =
                "Drag: ivy grows along the line   click a line, drag its points: it changes   Del: a point or the line "
                "  "
                "Esc while dragging: nothing";
            break;
        case Tool::houses:
            text =
                "Click a house, or an edge of the chosen one   drag a corner: the roof follows   Ctrl+drag an edge: a "
                "new corner   Del: the edge's corner goes   F: show it";
            break;
        case Tool::branch:
            text =
                "Click a branch   [: its parent   Del: prune it   F: show it   white: steps   blue: put in at seams "
                "and creases   green: over a seam";
            break;
        case Tool::fields:
            text = work.field.kind == kComb ? "Drag: comb the field along the way   [ ]: radius"
                   : work.field.kind == kSmooth
                       ? "Drag: smooth the field   [ ]: radius"
                       : "Click: place an element   drag: with a direction   drag an element: move   "
                         "drag its arrow: turn   Del: remove";
            break;
        case Tool::look:
            text = "Drag: turn around   Shift+drag: sideways   wheel: nearer   right drag: look, with W A S D: fly";
            break;
    }
    return {text, "   Tab: walk   F1: all keys"};
}

// The views that are kept, and a row that keeps one more.
void bookmarkMenu(Workspace& work) {
    if (!ImGui::BeginMenu("Bookmarks")) return;
    const auto& bookmarks = work.scene().bookmarks;
    std::optional<uint32_t> removed;
    uint32_t free = 1;
    for (const espalier::scene::Bookmark& bookmark : bookmarks) {
        const std::string digit = std::to_string(bookmark.digit);
        if (bookmark.digit == free) ++free;
        ImGui::PushID(int(bookmark.digit));
        if (ImGui::MenuItem(("View " + digit).c_str(), ("Shift+" + digit).c_str()))
            work.looked = work.lookFromBookmark(bookmark.digit);
        ImGui::SameLine(0, ImGui::GetFontSize());
        if (ImGui::SmallButton("\u00d7")) removed = bookmark.digit;
        toolTip("Removes the bookmark");
        ImGui::PopID();
    }
    if (removed) work.perform(SetBookmark{*removed, false});
    if (free <= espalier::scene::kMostBookmarks &&
        ImGui::MenuItem("Keep this view", ("Ctrl+" + std::to_string(free)).c_str()))
        work.keepBookmark(free);
    toolTip("Ctrl and a digit keep the view under that digit");
    ImGui::EndMenu();
}

// As much of it as there is room for: the last hints give way, each as a whole, then the first. Empty: there is no
// room.
std::string fitted(const Hint& hint, float room) {
    for (std::string text = hint.text;;) {
        const std::string line =
            text.empty() ? hint.always.substr(std::min<size_t>(3, hint.always.size())) : text + hint.always;
        if (ImGui::CalcTextSize(line.c_str()).x <= room) return line;
        if (text.empty()) return "";
        const size_t last = text.rfind("   ");
        text.resize(last == std::string::npos ? 0 : last);
    }
}

// What is open, at the bar's right end: as much of its name as there is room for beside the menus.
void showName(const Workspace& work, const Session& session) {
    constexpr const char* kSign = "REC";
    const float gap = ImGui::GetFontSize(), sign = session.recording() ? ImGui::CalcTextSize(kSign).x + 2 * gap : 0;
    const char* mark = session.modified(work) ? " *" : "";
    const std::string name = session.name(work);
    const float end = ImGui::GetWindowWidth() - 12 * work.scale - ImGui::CalcTextSize(mark).x;
    const std::string shown = shortened(name, std::max(end - sign - ImGui::GetCursorPosX(), 0.f));
    ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), end - sign - ImGui::CalcTextSize(shown.c_str()).x));
    if (session.recording()) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddCircleFilled({at.x + gap / 2, at.y + ImGui::GetFrameHeight() / 2}, gap * .35f,
                                                    ImColor(kBad));
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + gap);
        ImGui::TextColored(kBad, "%s", kSign);
        ImGui::SameLine(0, gap);
    }
    ImGui::TextDisabled("%s%s", shown.c_str(), mark);
    if (shown != name) toolTip(name.c_str());
}

}  // namespace

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
            ImGui::Separator();
            if (ImGui::MenuItem("New graph")) addGraph(work);
            toolTip("Geometry that nodes make, in the node editor below the view");
            ImGui::EndMenu();
        }
        if (ImGui::BeginMenu("View")) {
            const EspView seen = work.scene().look.view;
            for (size_t i = 0; i < std::size(kViews); ++i)
                if (ImGui::MenuItem(viewTitle(kViews[i]), std::to_string(i + 1).c_str(), seen == kViews[i]))
                    work.perform(SetView{espalier::scene::nameOf(kViews[i]), ""});
            const std::string& layer = work.brush.layer;
            if (!layer.empty() && ImGui::MenuItem(("Layer: " + layer).c_str(), "V", seen == ESP_VIEW_LAYER))
                work.showLayer(seen != ESP_VIEW_LAYER);
            ImGui::Separator();
            const auto camera = [&](const char* label, const char* key, void (Workspace::*moves)()) {
                if (!ImGui::MenuItem(label, key)) return;
                (work.*moves)();
                work.looked = true;
            };
            camera("Show all", "Home", &Workspace::frameAll);
            camera("Show what is chosen", "Numpad .", &Workspace::frameChosen);
            camera("Start view", "Numpad 0", &Workspace::lookFromStart);
            if (ImGui::MenuItem("Flat view", "Numpad 5", work.camera.flat())) {
                work.camera.toggleFlat();
                work.looked = work.redraw = true;
            }
            toolTip("Parallel lines stay parallel, as in a drawing");
            bookmarkMenu(work);
            ImGui::Separator();
            ImGui::MenuItem("Panel", "F2", &work.layout.panel);
            ImGui::MenuItem("Statistics", "F3", &work.layout.figures);
            if (ImGui::MenuItem("Grammar", "F4", work.layout.grammar))
                work.showGrammar(!work.layout.grammar, work.shownGrammar);
            if (ImGui::MenuItem("Atlas", "F5", work.layout.atlas)) work.showAtlas(!work.layout.atlas);
            if (ImGui::MenuItem("Nodes", "F6", work.graphs.nodes)) showNodes(work, !work.graphs.nodes);
            if (ImGui::MenuItem("Reset windows")) {
                work.windowsAnew = 2;
                work.layout.panelWidth = Layout{}.panelWidth;
                work.redraw = true;
            }
            ImGui::MenuItem("Lower resolution while moving", nullptr, &work.layout.smallerWhileMoving);
            toolTip("While the camera moves on a slow device, the picture has fewer pixels, down to half a side");
            ImGui::SetNextItemWidth(ImGui::GetFontSize() * 8);
            ImGui::SliderFloat("Interface scale", &work.layout.sizeOfAll, .5f, 2.5f, "%.2f",
                               ImGuiSliderFlags_AlwaysClamp);
            ImGui::EndMenu();
        }
        if (ImGui::BeginMenu("Help")) {
            ImGui::MenuItem("Keys and mouse", "F1", &work.layout.help);
            ImGui::MenuItem("Manual", nullptr, &work.manual);
            ImGui::MenuItem("About", nullptr, &work.about);
            ImGui::EndMenu();
        }
        showName(work, session);
        ImGui::EndMainMenuBar();
    }
}

void showStatus(const Workspace& work, bool caught, bool flying) {
    const bool bad = !work.error.empty();
    const float height = std::ceil(ImGui::GetFrameHeight() + 4 * work.scale);  // windows stand on whole pixels
    ImGui::SetNextWindowPos({0, work.window.y - height});
    ImGui::SetNextWindowSize({work.window.x, height});
    ImGui::SetNextWindowBgAlpha(work.editing ? 1.f : .55f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {12 * work.scale, 4 * work.scale});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                   ImGuiWindowFlags_NoNav;
    if (ImGui::Begin("status", nullptr, flags)) {
        // News is short-lived: hints give way to it.
        const std::string& news = bad ? work.error : work.message;
        const float room = work.window.x - 24 * work.scale;
        const std::string line = shortened(news.substr(0, news.find('\n')), room);
        const float width = line.empty() ? 0 : ImGui::CalcTextSize(line.c_str()).x + 28 * work.scale;
        const std::string hint = fitted(hintOf(work, caught, flying), room - width);
        ImGui::TextUnformatted(hint.c_str());
        if (!line.empty()) {
            if (hint.empty())
                ImGui::SameLine(12 * work.scale);
            else
                ImGui::SameLine(work.window.x - width + 16 * work.scale);
            ImGui::TextColored(bad ? kBad : kGood, "%s", line.c_str());
            if (ImGui::IsItemHovered()) tip(news.c_str());
        }
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
}

// Not in a window, of which ImGui hides a new one for a frame: there may be only one.
void showUnderWay(const Workspace& work, const char* text) {
    noteAt(work,
           {(work.window.x + work.panelUnits() - ImGui::CalcTextSize(text).x) / 2, work.viewSize().y - 90 * work.scale},
           text);
}

// When all is written the disk is waited for, which may take as long again.
void progressBar(const Background& background, float width) {
    const float part = background.progress();
    char text[16];
    std::snprintf(text, sizeof text, "%.0f%%", 100 * part);
    ImGui::ProgressBar(part, {width, 0}, part < .995f ? text : "Finishing ...");
}

void showBackground(const Workspace& work, Background& background) {
    if (!background.slow() || dialogueWaits()) return;
    ImGui::SetNextWindowPos({(work.window.x + work.panelUnits()) / 2, work.viewSize().y - 150 * work.scale},
                            ImGuiCond_Always, {.5f, .5f});
    const int flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                      ImGuiWindowFlags_AlwaysAutoResize | kQuiet;
    if (ImGui::Begin("background", nullptr, flags)) {
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted(background.title().c_str());
        ImGui::SameLine();
        progressBar(background, ImGui::GetFontSize() * 12);
        ImGui::SameLine();
        if (ImGui::Button("Cancel")) background.cancel();
        toolTip("What is on the disk stays as it was");
    }
    ImGui::End();
}

}  // namespace sample
