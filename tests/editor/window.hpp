#pragma once

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <functional>
#include <vector>

#include "sample_game/controls.hpp"
#include "tests/editor/editing.hpp"

// A window's workspace without the window, and the user's settings in a folder of the test's own.
struct Window {
    sample::Workspace work;
    sample::Session session;
    double now = 0;

    Window(const Folder& folder, const std::string& file) {
        ::setenv("XDG_CONFIG_HOME", folder.file("config").c_str(), 1);
        Editing editing(file);
        work.context = std::move(editing.context);
        work.document = std::move(editing.document);
        session.begin(work, file);
    }
    ~Window() { session.givesUp = true, session.end(work), work.document.reset(); }
    void fill(float value) { REQUIRE(work.perform(espalier::document::FillLayer{"mask", value})); }
    bool save(const std::string& folder) {
        bool saved = false;
        session.save(work, folder, [&](bool good) { saved = good; });
        session.background().finish();
        return saved;
    }
    // As much time as files are looked at in, and autosaves are made.
    void wait() {
        for (int i = 0; i < 5; ++i) {
            now += session.autosaveEvery;
            (void)session.step(work, now);
            session.background().finish();
        }
    }
};

// ImGui with nothing to show it on: tools ask it what lies under the mouse, and draw by it.
struct Gui {
    Gui() {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().Fonts->Build();
    }
    ~Gui() { ImGui::DestroyContext(); }
};

// That window with the editor open, and a user's hands on the mouse and the keys. Each thing they do is a frame.
struct Editor : Window {
    Gui gui;
    sample::Controls controls{work, session, nullptr};
    glm::vec2 mouse{0};
    std::function<void()> panels = [] {};          // lays them out
    std::vector<espalier::document::Action> done;  // all that the document was asked for, in order

    Editor(const Folder& folder, const std::string& file, sample::Tool tool) : Window(folder, file) {
        work.editing = true;
        work.brush.layer = work.scene().layers.empty() ? "" : work.scene().layers.front();
        work.start = work.scene().camera;
        work.lookFromStart();
        work.choose(tool);
        work.document->listen([this](const espalier::document::Action& action, uint32_t) { done.push_back(action); });
    }
    ~Editor() { work.document->listen({}); }

    void frame(const std::vector<sample::InputEvent>& events, int mods = 0) {
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = {work.window.x, work.window.y};
        io.MousePos = {mouse.x, mouse.y};
        ImGui::NewFrame();
        controls.take(events, 0);
        panels();
        controls.showTool(mods);
        ImGui::Render();
    }
    void press(glm::vec2 at, int mods = 0, int button = GLFW_MOUSE_BUTTON_LEFT) {
        point(sample::PointerEvent::Kind::press, at, mods, button);
    }
    void move(glm::vec2 at, int mods = 0) { point(sample::PointerEvent::Kind::move, at, mods, 0); }
    void release(glm::vec2 at, int mods = 0, int button = GLFW_MOUSE_BUTTON_LEFT) {
        point(sample::PointerEvent::Kind::release, at, mods, button);
    }
    void click(glm::vec2 at, int mods = 0, int button = GLFW_MOUSE_BUTTON_LEFT) {
        move(at, mods);
        press(at, mods, button);
        release(at, mods, button);
    }
    // Moves on from where the mouse is, in as many events.
    void moveTo(glm::vec2 to, int events, int mods = 0) {
        const glm::vec2 from = mouse;
        for (int i = 1; i <= events; ++i) move(glm::mix(from, to, float(i) / float(events)), mods);
    }
    void drag(glm::vec2 from, glm::vec2 to, int mods = 0, int events = 8) {
        press(from, mods);
        moveTo(to, events, mods);
        release(to, mods);
    }
    void key(int code, int mods = 0) { frame({sample::KeyEvent{code, mods, mouse.x, mouse.y}}, mods); }
    void undo() { key(GLFW_KEY_Z, GLFW_MOD_CONTROL); }

    // Where a point of the scene is in the window.
    glm::vec2 at(glm::vec3 point) const {
        const auto place = work.place(point);
        REQUIRE(place);
        return *place;
    }
    // What is seen there of the surfaces.
    glm::vec3 under(glm::vec2 place) const {
        const auto hit = work.pick(place);
        REQUIRE(hit);
        return sample::vec(hit->position);
    }
    // Those of one kind, of all that was done.
    template <class Kind>
    std::vector<Kind> all() const {
        std::vector<Kind> found;
        for (const auto& action : done)
            if (const auto* one = std::get_if<Kind>(&action)) found.push_back(*one);
        return found;
    }

  private:
    void point(sample::PointerEvent::Kind kind, glm::vec2 place, int mods, int button) {
        mouse = place;
        frame({sample::PointerEvent{kind, button, mods, place.x, place.y}}, mods);
    }
};

// The camera before the wall of the small scene, where that is bare: as far away as is said. At up to 1.5 m nothing is
// between.
inline void faceWall(Editor& editor, float metres) {
    EspCamera camera = editor.work.scene().camera;
    for (int i = 0; i < 3; ++i) camera.eye[i] = camera.target[i] = std::array{-.95f, 1.1f, .3f}[size_t(i)];
    camera.eye[2] += metres;
    editor.work.lookFrom(camera);
}
