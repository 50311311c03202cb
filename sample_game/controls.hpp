#pragma once

#include <vector>

#include "sample_game/brush_tool.hpp"
#include "sample_game/field_tool.hpp"
#include "sample_game/house_tool.hpp"
#include "sample_game/navigation.hpp"
#include "sample_game/path_tool.hpp"
#include "sample_game/seed_tool.hpp"
#include "sample_game/session.hpp"

namespace sample {

// Whose a key or a click is: the panels', the camera's or the chosen tool's. Between ImGui::NewFrame and Render.
class Controls {
  public:
    // `input` may be null: there is no mouse to catch.
    Controls(Workspace& work, Session& session, Input* input) : work_(work), session_(session), input_(input) {}

    void take(const std::vector<InputEvent>& events, float wheel);
    // Keys that are held move the camera. True: it moved.
    bool step(const Input& input, float seconds);
    // What the mouse points at, and the tool's own marks over the picture.
    void showTool(int mods);

    void setEditing(bool editing);
    void askToQuit();                              // see askToLeave
    void finishTools();                            // what they, and the mouse in a panel, are about is done as it is
    void forgetScene() { fields_.forget(work_); }  // another one is open now
    void forgetButtons() { panelButtons_ = 0; }    // what lets go of those that are down won't be told
    bool caught() const { return navigation_.caught; }
    bool flying() const { return navigation_.flying(); }
    bool painting() const { return brush_.painting(); }
    bool turning() const { return navigation_.dragging(); }

  private:
    void takeKey(const KeyEvent& key);
    bool takeBookmarkKey(const KeyEvent& event);
    bool takeHideKey(const KeyEvent& event);
    bool takeViewKey(const KeyEvent& key);  // false: it is none
    void takeToolKey(const KeyEvent& key);
    void takePointer(const PointerEvent& event);
    bool toolBusy() const;
    void noteTools();  // what they are about, for others
    bool panelTakes(const PointerEvent& event);
    bool panelTakes(const KeyEvent& event);
    void catchMouse(bool caught);
    void chooseTool(Tool tool);
    void cancelTools();   // what they are about, as if it hadn't been
    bool takeBackDrag();  // what the mouse is about with the tool; false: nothing
    void hover();

    Workspace& work_;
    Session& session_;
    Input* input_;
    Navigation navigation_;
    BrushTool brush_;
    SeedTool seeds_;
    PathTool path_;
    HouseTool houses_;
    FieldTool fields_;
    uint32_t panelButtons_ = 0;  // bits: those that were pressed over a panel and are down
};

}  // namespace sample
