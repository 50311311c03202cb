#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <imgui.h>

#include "sample_game/session.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

using PathText = std::array<char, 4096>;  // that is typed

// Which dialogue is open, and what was typed into each. One thread; one of them at a time.
struct Dialogues {
    const char* open = nullptr;  // asked for: it opens in the next frame
    // Of the open one. confirms: what lies at the path would go, see `why`, and is asked about; acts: what it was told
    // is done in the next frame, when the user has seen that; waits: for work beside the frames; done: it closes;
    // failed: it stays, with `why`.
    enum class Turn { asks, confirms, acts, waits, done, failed } turn = Turn::asks;
    std::string why;
    std::string doubted;   // the path that it confirms
    const char* yes = "";  // and the button that does so
    bool asks = false;     // one that asks for a path was open in the last frame
    int openings = 0;      // each time the whole path is marked, so that it can be typed over
    std::string unsaved;   // why saving has failed while another one was open
    bool leaves = false;   // for what is next, as soon as nothing is under way
    PathText project{}, file{}, model{}, grammar{}, run{}, picture{}, grown{};
    std::string layer;                // of the picture
    std::optional<std::string> next;  // what is opened once this is saved or given up; "": nothing, the program ends
};
Dialogues& dialogues();

// What speaks against a path, as a sentence, and what is asked then; empty: nothing does.
struct Doubt {
    std::string why;
    const char *question = "Replace it?", *yes = "Replace";
};

// One that asks for a path.
struct PathQuestion {
    const char *title, *label, *button;
    PathText& path;
    std::vector<std::string> endings;  // of the files that are listed
    bool projects = false;             // may be answered with; else they are folders like others
    std::function<Doubt(const std::string& path)> doubts = {};
};

void ask(const char* title);
void put(PathText& to, const std::string& text);
void doubt(const std::string& path, const Doubt& found);  // of the one that was asked for: it begins by confirming
bool beginDialogue(const char* title);                    // false: it isn't open
void say(const std::string& text, ImVec4 colour = ImGui::GetStyleColorVec4(ImGuiCol_Text));
// Stays with what went wrong until `act`, which is given the path, or the work that it began, is done.
void askPath(Workspace& work, Session& session, const PathQuestion& question,
             const std::function<void(const char* path)>& act);
// What became of what it was told: with Workspace::error, if it failed.
Dialogues::Turn turnOf(const Workspace& work, bool good);
// The end of what a dialogue waits for. Cancelled, it asks again.
void endWait(const Workspace& work, bool good);

// For another place for what couldn't be saved, and hasn't been since, once no dialogue is open.
void askElsewhere(Workspace& work, const Session& session);

// Each laid out while it is open.
void projectDialogues(Workspace& work, Session& session);  // save, open, leave, recover
void layerDialogues(Workspace& work, Session& session);    // pictures of layers, out and in
void lookDialogues(Workspace& work, Session& session);     // a leaf's model, its picture
void fieldDialogue(Workspace& work, Session& session);     // a field of another program
void exportDialogue(Workspace& work, Session& session);    // what grows, as glTF
void runDialogues(Workspace& work, Session& session);      // record, replay

}  // namespace sample
