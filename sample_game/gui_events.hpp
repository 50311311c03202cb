#pragma once

#include <deque>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

struct GLFWwindow;

namespace sample {

// With the place of the mouse when it happened.
struct PointerEvent {
    enum class Kind { press, move, release };
    Kind kind = Kind::move;
    int button = 0;  // GLFW_MOUSE_BUTTON_...; of press and release
    int mods = 0;    // GLFW_MOD_... as they were then
    float x = 0, y = 0;
};
struct KeyEvent {
    int key = 0, mods = 0;  // GLFW_KEY_...: what the layout makes of it, see keyNamed
    float x = 0, y = 0;
    bool repeated = false;  // it is held, and was pressed before
};
using InputEvent = std::variant<PointerEvent, KeyEvent>;

// As of the last frame: whether a press there is the panels' own. ImGui knows only what lies under the mouse at the
// beginning of a frame, which with slow frames isn't where it was pressed.
bool overPanel(float x, float y);
// Neither that nor outside the window: what tools do there is seen.
bool inScene(float x, float y);

// Keys, letters, moves and clicks on their way to ImGui and the tools, in the order in which they came. ImGui sees only
// how things stand once a frame: with frames that take long, a key that went down and up in between would be lost to
// it, and a click would land where the mouse is by now. So it gets no more at a time than it can tell apart, and the
// rest comes with the next frames. What is typed after the key that asks for a dialogue, or after a click on a panel,
// waits until it can be typed there. What changes or keeps that which panels are about waits until they have taken over
// what is typed into them.
class GuiEvents {
  public:
    explicit GuiEvents(GLFWwindow* window) : window_(window) {}
    void key(const KeyEvent& event, int scancode, int action);
    void letter(unsigned code);
    void pointer(const PointerEvent& event);
    // Events up to now were asked for. Those that come next have happened after it: nobody tells when.
    void polled(double seconds) { polled_ = seconds; }

    // Between the backend's NewFrame and ImGui's. `taken` gets what ImGui has been told of, for the tools: no keys that
    // went up, no letters.
    void feed(std::vector<InputEvent>& taken);
    size_t count() const { return events_.size(); }  // that wait
    // Esc was pressed, behind so many events that wait; nobody else is told of that.
    bool takeEscape(size_t behind);
    // Buttons that were pressed behind so many events that wait weren't; those that were down before go up all the
    // same.
    void dropPresses(size_t behind);
    // There is more for the next frame.
    bool waiting() const { return !events_.empty(); }

  private:
    struct Key {
        KeyEvent event;
        int code, scancode, action;  // code: for ImGui, the same when it goes up
    };
    struct Letter {
        unsigned code;
    };
    struct Pointer {
        PointerEvent event;
        bool again;  // a press that may be a double click's second
    };
    using Event = std::variant<Key, Letter, Pointer>;
    // What of this frame's events ImGui has been told so far.
    struct Told {
        bool typing, awaited;                             // something is typed into; a dialogue isn't there yet
        bool moved = false, clicked = false;              // clicked: a panel's button has changed
        bool keyed = false, wrote = false, asks = false;  // asks: for a dialogue
        bool handed = false;                              // a key to the tools
        bool waited = false;                              // the event that is next, for the panels
        bool held = false;                                // keys have been passed over, by what comes behind them
    };
    // False: the event has to wait for the next frame.
    bool tell(const Key& key, Told& told, std::vector<InputEvent>& taken);
    bool tell(const Letter& letter, Told& told, std::vector<InputEvent>& taken);
    bool tell(const Pointer& pointer, Told& told, std::vector<InputEvent>& taken);
    // True: the event that is next waits for a frame in which the panels take over what is typed.
    bool waitsForPanels(const Told& told);

    GLFWwindow* window_;
    std::deque<Event> events_;
    std::optional<std::pair<int, double>> pressed_;  // the last button, and when at the latest
    double polled_ = 0;
    float x_ = 0, y_ = 0;
    bool buttons_[5] = {}, ofPanel_[5] = {}, placed_ = false;
    bool waited_ = false;
};

}  // namespace sample
