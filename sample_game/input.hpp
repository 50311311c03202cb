#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sample_game/gui_events.hpp"

struct GLFWwindow;

namespace sample {

// What came in since the last frame, in order and with the place where it happened. Frames may take long on a software
// device; asking at a frame's beginning what is down, as ImGui does, would lose strokes and clicks in between.
struct PointerEvent {
    enum class Kind { press, move, release };
    Kind kind = Kind::move;
    int button = 0;  // GLFW_MOUSE_BUTTON_...; of press and release
    int mods = 0;    // GLFW_MOD_... as they were then
    float x = 0, y = 0;
};

class Input {
  public:
    // Takes over the window's callbacks; ImGui's backend is made without its own.
    explicit Input(GLFWwindow* window);
    Input(const Input&) = delete;

    // What came since the last call.
    void take(std::vector<PointerEvent>& pointer, float& wheel);
    // Something came that the frames haven't seen yet.
    bool pending() const { return !pointer_.empty() || !dropped_.empty() || wheel_ != 0 || gui.waiting(); }
    // A file or folder that was dropped onto the window since the last call; empty: none was.
    std::string takeDropped() { return std::exchange(dropped_, {}); }
    bool down(int key) const;
    int mods() const;
    // Keys, and the mouse once more on its way to ImGui.
    GuiEvents gui;

  private:
    static Input& of(GLFWwindow* window);
    GLFWwindow* window_;
    std::vector<PointerEvent> pointer_;
    std::string dropped_;
    float wheel_ = 0;
    float x_ = 0, y_ = 0;
};

}  // namespace sample
