#pragma once

#include "sample_game/session.hpp"
#include "sample_game/widgets.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

// Each is laid out between ImGui::NewFrame and Render, shows the workspace and performs what the user does with it.
void showMenu(Workspace& work, Session& session);  // the bar at the top
// What menus and keys have asked for. After everything else: a window or tool tip that appears in the same frame would
// end ImGui 1.86 in an assertion.
void showDialogues(Workspace& work, Session& session);
void showPanel(Workspace& work);          // at the left: the tool, layers, seeds, grammars, light
void showGrammarWindow(Workspace& work);  // the text, with mistakes at their lines
bool grammarFocused();                    // it was clicked at last: letters are meant for it
void leaveGrammar();                      // they aren't any more
void showFigures(const Workspace& work, uint32_t validationMessages, bool validation);
void showLegend(const Workspace& work);                            // of a view that shows amounts
void showStatus(const Workspace& work, bool caught, bool flying);  // at the bottom: what keys and buttons do now
void showWalk(const Workspace& work);                              // of the picked branch, on the model
void showManualAndAbout(Workspace& work);
void showHelp(Workspace& work);                                      // over all: F1
void showUnderWay(const Workspace& work, const char* text);          // what takes longer than a blink
void showBackground(const Workspace& work, Background& background);  // what takes long of it, unless a dialogue does
void progressBar(const Background& background, float width);         // of what is under way

// Ctrl+S and Ctrl+O: at once, or by a dialogue. True: it is being saved; else that is asked first.
bool askToSave(Workspace& work, Session& session, bool elsewhere = false);
void askToOpen(const std::string& refused = {}, const std::string& why = {});  // refused: what couldn't be opened
void beginOpeningIn(const std::string& recent);  // beside what was opened by an earlier session
void askForGrammar();                            // likewise
void askForModel();                              // that comes to what is open
void askToExport(const Workspace& work);
void askToRecord();
void askToReplay();
// The end of the program, or another file to open: at once, or when the user has said what becomes of what isn't saved.
// False: that is asked, which only frames with showDialogues() do.
bool askToLeave(Workspace& work, Session& session, const std::string& next = {});
bool asksToQuit();     // whether that is asked now, with nothing to be opened
bool usesPanels();     // a dialogue or a menu is open, or something is typed
bool closeMenus();     // those that are open, not dialogues; false: there are none
bool dialogueWaits();  // for work that it began
// One opens in the next frame with showDialogues().
bool dialogueAsked();
// In frames without showDialogues(): ImGui can't do with a dialogue that is open and isn't laid out.
void closeDialogues();
// A dialogue has been asked for, or is open, whose text can't be typed into yet, or that is about to close: within some
// frames keys can go on.
bool awaitsText();
void askForLayer(const std::string& layer, bool import);

// The parts of showPanel().
void brushPanel(Workspace& work);
void layersPanel(Workspace& work);
void seedsPanel(Workspace& work);
void grammarsPanel(Workspace& work);
void presetsPanel(Workspace& work, uint32_t grammar);  // a combo that takes the rest of the row
void looksPanel(Workspace& work, uint32_t grammar);    // of its leaves, bark ...: colour, picture, model
void branchPanel(Workspace& work);
void housesPanel(Workspace& work);
void fieldsPanel(Workspace& work);
void lightPanel(Workspace& work);
void plantsPanel(Workspace& work);
void modelsPanel(Workspace& work);  // where each stands
void houseList(Workspace& work);

// A slider, check box (with its label) or colour. True: the value has changed. several: it stands for values that
// differ.
bool editParam(const EspParamInfo& param, float* value, bool several = false);
// Views that need no layer, in the order of their keys 1, 2 ...
constexpr EspView kViews[] = {ESP_VIEW_SHADED, ESP_VIEW_CHARTS, ESP_VIEW_NORMALS,
                              ESP_VIEW_LOD,    ESP_VIEW_DEPTH,  ESP_VIEW_OVERDRAW};
const char* viewTitle(EspView view);

}  // namespace sample
