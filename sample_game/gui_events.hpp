#pragma once

#include <deque>
#include <vector>

struct GLFWwindow;

namespace sample {

struct KeyEvent {
    int key = 0, mods = 0;
};

// As of the last frame: whether a press there is the panels' own. ImGui knows only what lies under the mouse at the
// beginning of a frame, which with slow frames isn't where it was pressed.
bool overPanel(float x, float y);

// Keys, letters and clicks on their way to ImGui, which sees only how things stand once a frame. With frames that take
// long, a key that went down and up in between would be lost to it, and a click would land where the mouse is by now:
// so it gets no more at a time than it can tell apart, and the rest with the next frames. What is typed after the key
// that asks for a dialogue waits until the dialogue can be typed into.
class GuiEvents {
  public:
    void key(GLFWwindow* window, int key, int scancode, int action, int mods);
    void letter(GLFWwindow* window, unsigned code);
    void move(float x, float y);
    void button(int button, bool down);

    // Between the backend's NewFrame and ImGui's. `pressed` gets the keys that ImGui has been told of, for the tools.
    void feed(std::vector<KeyEvent>& pressed);
    // There is more for the next frame.
    bool waiting() const { return !keys_.empty() || !mouse_.empty(); }

  private:
    struct Key {
        GLFWwindow* window;
        bool letter;
        int code, scancode, action, mods;
    };
    struct Mouse {
        int button;  // that changed; -1: it moved
        bool down;
        float x, y;
    };
    bool feedMouse();
    void feedKeys(bool typing, std::vector<KeyEvent>& pressed);
    std::deque<Key> keys_;
    std::deque<Mouse> mouse_;
    float x_ = 0, y_ = 0;
    bool buttons_[5] = {}, ofPanel_[5] = {}, placed_ = false;
};

}  // namespace sample
