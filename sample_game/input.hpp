#pragma once

#include <string>
#include <utility>

#include "sample_game/gui_events.hpp"

struct GLFWwindow;

namespace sample {

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
    // A file or folder that was dropped onto the window since the last call; empty: none was.
    std::string takeDropped() { return std::exchange(dropped_, {}); }
    bool down(int key) const;
    int mods() const;
    // Keys and the mouse, in order.
    GuiEvents gui;

  private:
    static Input& of(GLFWwindow* window);
    GLFWwindow* window_;
    std::string dropped_;
    float wheel_ = 0;
    float x_ = 0, y_ = 0;
};

}  // namespace sample
