#pragma once

#include <vector>

#include "sample_game/input.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

// The mouse and keys that move the camera. In the editor as in Blender and Unreal: the middle button turns around
// (Shift moves sideways), the right one looks around and flies with W A S D Q E, the wheel goes nearer, Alt and the
// left button is the middle one. In the game the mouse looks while it is caught, and W A S D walk.
class Navigation {
  public:
    // An event that isn't over a panel; true: it was the camera's.
    bool take(Workspace& work, const PointerEvent& event);
    // A move of the mouse that was somebody else's.
    void follow(glm::vec2 at) { last_ = at; }
    void wheel(Workspace& work, float steps);
    // Once a frame: keys that are down, for `seconds`. True: the camera moved.
    bool step(Workspace& work, const Input& input, float seconds, bool typing);
    void toggleFlying() { flying_ = !flying_; }
    bool flying() const { return flying_; }
    void jump() { jump_ = true; }
    void moved() { moved_ = true; }  // by a key
    bool dragging() const { return drag_ != Drag::none; }
    // The mouse is caught by the game: events are moves of the view whatever they are over.
    bool caught = false;

  private:
    enum class Drag { none, orbit, pan, look };
    Drag drag_ = Drag::none;
    int button_ = 0;
    glm::vec2 last_{0};
    bool known_ = false, flying_ = false, jump_ = false, moved_ = false;
};

}  // namespace sample
