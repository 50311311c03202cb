#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sample_game/gui_events.hpp"

struct GLFWwindow;

namespace sample {

// What a key of the keyboard, GLFW_KEY_..., means in a layout that calls it `name`, as glfwGetKeyName does (null: it
// has none): letters and brackets are where the user's layout has them. Digits stay: some layouts write them by Shift.
int keyNamed(int key, const char* name);

// What came in since the last frame. Frames may take long on a software device; asking at a frame's beginning what is
// down, as ImGui does, would lose strokes and clicks in between.
class Input {
  public:
    // Takes over the window's callbacks; ImGui's backend is made without its own.
    explicit Input(GLFWwindow* window);
    Input(const Input&) = delete;

    // How far the wheel has turned since the last call.
    float takeWheel() { return std::exchange(wheel_, 0.f); }
    // Something came that the frames haven't seen yet.
    bool pending() const { return !dropped_.empty() || wheel_ != 0 || gui.waiting(); }
    // Files and folders that were dropped onto the window since the last call.
    std::vector<std::string> takeDropped() { return std::exchange(dropped_, {}); }
    // By where it is on a keyboard of the US: who flies by W A S D looks for a place, not for letters.
    bool down(int key) const;
    int mods() const;
    // Caught, it has no cursor and knows no end of the window; what it does once it is free is done where it is then.
    void catchMouse(bool caught);
    // Keys and the mouse, in order.
    GuiEvents gui;

  private:
    static Input& of(GLFWwindow* window);
    int meaning(int key, int scancode, int action);
    void findMouse();
    GLFWwindow* window_;
    std::map<int, int>
        meant_;  // of keys that were pressed: they go up as the same, whatever layout is chosen meanwhile
    std::vector<std::string> dropped_;
    float wheel_ = 0;
    float x_ = 0, y_ = 0;
};

}  // namespace sample
