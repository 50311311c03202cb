#pragma once

#include <vector>

#include "sample_game/input.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

// The mouse and keys that move the camera. In the editor as in Blender and Unreal: the middle button turns around
// (Shift moves sideways), the right one looks around and flies with W A S D Q E, at a speed that the wheel sets
// meanwhile; else the wheel goes nearer. Alt and the left button is the middle one. In the game the mouse looks while
// it is caught, and W A S D walk.
class Navigation {
  public:
    // An event that isn't over a panel; true: it was the camera's. So are all while it is dragged: other buttons begin
    // nothing then.
    bool take(Workspace& work, const PointerEvent& event);
    // A move of the mouse that was somebody else's.
    void follow(glm::vec2 at) { last_ = at; }
    void wheel(Workspace& work, float steps, glm::vec2 mouse);
    // Once a frame: keys that are down, for `seconds`. True: the camera moved.
    bool step(Workspace& work, const Input& input, float seconds, bool typing);
    // By `steps` right, up and ahead, -1 to 1: flies in the editor and where G is on, else walks.
    void go(Workspace& work, glm::vec3 steps, float seconds, bool fast);
    void toggleFlying() { flying_ = !flying_; }
    bool flying() const { return flying_; }
    void jump() { jump_ = true; }
    void moved() { moved_ = true, strayed_ = false, wheeled_.reset(); }  // by a key, about or towards what is aimed at
    void aim(Workspace& work);  // at what is in the middle, before a key turns the view about it or goes nearer
    bool dragging() const { return drag_ != Drag::none; }
    // The mouse is caught by the game: events are moves of the view whatever they are over.
    bool caught = false;

  private:
    enum class Drag { none, orbit, pan, look };
    bool aimAt(Workspace& work, glm::vec2 mouse);  // false: nothing is under it
    void approach(Workspace& work, float steps, glm::vec3 way);
    Drag drag_ = Drag::none;
    bool strayed_ = false;              // what the camera turns about isn't what lies in the middle any more
    std::optional<glm::vec2> wheeled_;  // where the wheel was turned last, if the camera hasn't moved otherwise since
    bool open_ = false;                 // nothing is there
    float stride_ = 0, metAt_ = 0;      // of steps in the open, where it began there; how far what came near was then
    int button_ = 0;
    glm::vec2 last_{0};
    glm::vec3 walked_{0};  // where walking has left the camera
    bool known_ = false, flying_ = false, jump_ = false, moved_ = false;
};

}  // namespace sample
