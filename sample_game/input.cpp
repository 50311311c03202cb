// GLFW's callbacks -> one list of events.
#define GLFW_INCLUDE_NONE
#include "sample_game/input.hpp"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>

#include <cstring>

namespace sample {

int keyNamed(int key, const char* name) {
    const bool digit = key >= GLFW_KEY_0 && key <= GLFW_KEY_9;
    if (!name || !name[0] || name[1] || digit) return key;  // beyond ASCII, as where letters are Cyrillic: by its place
    const char c = name[0];
    if (c >= 'a' && c <= 'z') return GLFW_KEY_A + (c - 'a');
    if (c >= 'A' && c <= 'Z') return GLFW_KEY_A + (c - 'A');
    const bool punctuation = std::strchr("',-./;=[\\]`", c);
    return punctuation ? c : key;  // GLFW's codes of these are ASCII's
}

int Input::meaning(int key, int scancode, int action) {
    if (action != GLFW_PRESS && meant_.contains(key)) return meant_[key];
    const bool writes = key > GLFW_KEY_SPACE && key <= GLFW_KEY_GRAVE_ACCENT;
    return meant_[key] = writes ? keyNamed(key, glfwGetKeyName(key, scancode)) : key;
}

Input& Input::of(GLFWwindow* window) {
    return *static_cast<Input*>(glfwGetWindowUserPointer(window));
}

Input::Input(GLFWwindow* window) : gui(window), window_(window) {
    glfwSetWindowUserPointer(window, this);
    findMouse();
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
        Input& in = of(w);
        in.gui.key({in.meaning(key, scancode, action), mods, in.x_, in.y_}, scancode, action);
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned code) { of(w).gui.letter(code); });
    glfwSetWindowFocusCallback(window, ImGui_ImplGlfw_WindowFocusCallback);
    glfwSetCursorEnterCallback(window, ImGui_ImplGlfw_CursorEnterCallback);
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        Input& in = of(w);
        in.x_ = float(x);
        in.y_ = float(y);
        in.gui.pointer({PointerEvent::Kind::move, 0, in.mods(), in.x_, in.y_});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int mods) {
        Input& in = of(w);
        // Where the last move ended: what GLFW could tell now is where the mouse is by now, which may be elsewhere.
        const auto kind = action == GLFW_PRESS ? PointerEvent::Kind::press : PointerEvent::Kind::release;
        in.gui.pointer({kind, button, mods, in.x_, in.y_});
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
        ImGui_ImplGlfw_ScrollCallback(w, x, y);
        of(w).wheel_ += float(y);
    });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
        of(w).dropped_.insert(of(w).dropped_.end(), paths, paths + count);
    });
}

void Input::findMouse() {
    double x = 0, y = 0;
    glfwGetCursorPos(window_, &x, &y);
    x_ = float(x);
    y_ = float(y);
}

// GLFW tells of no move when the cursor comes back to where it was caught.
void Input::catchMouse(bool caught) {
    const bool was = glfwGetInputMode(window_, GLFW_CURSOR) == GLFW_CURSOR_DISABLED;
    glfwSetInputMode(window_, GLFW_CURSOR, caught ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    if (!was || caught) return;
    findMouse();
    gui.pointer({PointerEvent::Kind::move, 0, mods(), x_, y_});
}

bool Input::down(int key) const {
    return glfwGetKey(window_, key) == GLFW_PRESS;
}

int Input::mods() const {
    const auto either = [&](int left, int right, int mod) { return down(left) || down(right) ? mod : 0; };
    return either(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT, GLFW_MOD_SHIFT) |
           either(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL, GLFW_MOD_CONTROL) |
           either(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT, GLFW_MOD_ALT);
}

}  // namespace sample
