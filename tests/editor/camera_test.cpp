// The camera in a user's hands: what it turns about, moves with and goes nearer to is what is seen, wherever it was
// before; what begins with one button isn't disturbed by another.
#include <cfloat>

#include "tests/editor/window.hpp"

using namespace espalier::document;
using sample::Tool;

namespace {

constexpr int kRight = GLFW_MOUSE_BUTTON_RIGHT, kMiddle = GLFW_MOUSE_BUTTON_MIDDLE;

struct Visitor : Editor {
    explicit Visitor(const Folder& folder, Tool tool = Tool::look) : Editor(folder, smallScene(folder), tool) {
        faceWall(*this, 3);
    }
    sample::ViewCamera& camera() { return work.camera; }
    glm::vec2 middle() const { return {(1 + work.shift()) / 2 * work.window.x, work.window.y / 2}; }
    void wheel(float steps) {
        ImGui::GetIO().DisplaySize = {work.window.x, work.window.y};
        ImGui::GetIO().MousePos = {mouse.x, mouse.y};
        ImGui::NewFrame();
        controls.take({}, steps);
        ImGui::Render();
    }
    // Looks around by the right button, which tells the camera nothing of how far away things are.
    void look(glm::vec2 by) {
        press(middle(), 0, kRight);
        moveTo(middle() + by, 4);
        release(mouse, 0, kRight);
    }
};

float between(glm::vec3 a, glm::vec3 b) {
    return glm::distance(a, b);
}

}  // namespace

TEST_CASE("a button that is pressed while the camera is dragged begins nothing, and the camera is let go by its own") {
    const Folder folder;
    for (const int button : {kRight, kMiddle}) {
        CAPTURE(button);
        Visitor visitor(folder, Tool::paint);
        const glm::vec2 at = visitor.at({-.95f, 1.1f, .36f});
        visitor.press(at, 0, button);
        visitor.moveTo(at + glm::vec2(12, 0), 2);
        visitor.press(visitor.mouse);
        visitor.moveTo(at, 2);
        CHECK(visitor.controls.turning());
        CHECK(!visitor.controls.painting());
        visitor.release(at, 0, button);
        CHECK(!visitor.controls.turning());
        const glm::vec3 eye = visitor.camera().eye(), ahead = visitor.camera().ahead();
        visitor.moveTo(at + glm::vec2(80, 30), 4);
        CHECK(visitor.camera().eye() == eye);
        CHECK(visitor.camera().ahead() == ahead);
        visitor.release(visitor.mouse);
        CHECK(visitor.all<StrokeBegin>().empty());
        visitor.drag(at, at + glm::vec2(20, 0));
        CHECK(visitor.all<StrokeEnd>().size() == 1);
        // The other way around: the stroke goes on.
        visitor.press(at);
        visitor.press(at, 0, button);
        visitor.moveTo(at + glm::vec2(20, 10), 2);
        CHECK(visitor.controls.painting());
        visitor.release(visitor.mouse);
        visitor.moveTo(at, 2);
        visitor.release(at, 0, button);
        CHECK(visitor.all<StrokeEnd>().size() == 2);
        CHECK(visitor.camera().eye() == eye);
        CHECK(visitor.camera().ahead() == ahead);
    }
}

TEST_CASE("the wheel goes nearer to what is seen, also after it went close to something else") {
    const Folder folder;
    Visitor visitor(folder);
    visitor.mouse = visitor.middle();
    const glm::vec3 start = visitor.camera().eye();
    visitor.wheel(3);
    const glm::vec3 near = visitor.camera().eye();
    visitor.wheel(-3);
    CHECK_MESSAGE(between(visitor.camera().eye(), start) < 1e-4f, "there and back again");
    visitor.wheel(3);
    CHECK(between(visitor.camera().eye(), near) < 1e-4f);
    visitor.wheel(60);  // as near as it gets
    const glm::vec3 wall = visitor.under(visitor.middle());
    CHECK(between(visitor.camera().eye(), wall) < .05f);

    faceWall(visitor, 3);
    visitor.camera().focus(.03f);  // it was close to something
    visitor.look({3, 0});
    const glm::vec3 from = visitor.camera().eye(), ahead = visitor.camera().ahead();
    visitor.mouse = visitor.middle();
    const float away = between(visitor.under(visitor.mouse), from);
    visitor.wheel(1);
    CHECK(between(visitor.camera().eye(), from) == doctest::Approx(.12f * away).epsilon(.01));
    CHECK(visitor.camera().ahead() == ahead);
    // Where nothing is, as far as the scene is large.
    faceWall(visitor, 8);
    visitor.camera().focus(.01f);
    visitor.look({905, -100});
    REQUIRE(!visitor.work.pick(visitor.middle()));
    for (const glm::vec2 mouse : {visitor.middle(), glm::vec2(-FLT_MAX)}) {  // which may be outside the window
        const glm::vec3 before = visitor.camera().eye();
        visitor.mouse = mouse;
        visitor.wheel(1);
        const float moved = between(visitor.camera().eye(), before);
        CHECK(moved > .01f * visitor.work.reach());
        CHECK(moved < visitor.work.reach());
    }
}

TEST_CASE("the wheel goes to what the mouse points at, which stays under it and isn't passed through") {
    const Folder folder;
    Visitor visitor(folder);
    faceWall(visitor, 1.4f);
    const glm::vec2 at = glm::floor(visitor.at({-1.1f, 1.3f, .36f}));  // as ImGui tells it
    const glm::vec3 start = visitor.camera().eye(), ahead = visitor.camera().ahead(), point = visitor.under(at);
    REQUIRE(glm::distance(at, visitor.middle()) > 40);
    visitor.mouse = at;
    visitor.wheel(4);
    CHECK(glm::distance(visitor.at(point), at) < 1);
    CHECK(visitor.camera().ahead() == ahead);
    CHECK(between(visitor.camera().eye(), point) ==
          doctest::Approx(std::pow(.88f, 4) * between(start, point)).epsilon(.01));
    visitor.wheel(-4);
    CHECK_MESSAGE(between(visitor.camera().eye(), start) < 1e-3f, "there and back again");
    visitor.wheel(20);
    CHECK(glm::distance(visitor.at(point), at) < 2);
    visitor.wheel(60);
    CHECK(between(visitor.camera().eye(), point) < .05f);
    CHECK(glm::dot(point - visitor.camera().eye(), ahead) > 0);

    // Where nothing is, along the ray through the mouse, as far with each step.
    faceWall(visitor, 8);
    visitor.mouse = visitor.at({-.5f, 3.8f, .3f});
    REQUIRE(!visitor.work.pick(visitor.mouse));
    const glm::vec3 way = visitor.work.rayThrough(visitor.mouse).direction;
    for (float last = 0; const int step : {1, 2, 3}) {
        CAPTURE(step);
        const glm::vec3 from = visitor.camera().eye();
        visitor.wheel(1);
        const glm::vec3 moved = visitor.camera().eye() - from;
        CHECK(glm::dot(glm::normalize(moved), way) > .999f);
        CHECK(glm::length(moved) > .8f * last);
        last = glm::length(moved);
    }
}

TEST_CASE(
    "the wheel over open sky leads there and back again to the same place, also past what comes near on the way") {
    const Folder folder;
    Visitor visitor(folder);
    faceWall(visitor, 8);
    visitor.mouse = visitor.at({-.5f, 3.8f, .3f});
    REQUIRE(!visitor.work.pick(visitor.mouse));
    const float reach = visitor.work.reach();
    for (const std::vector<float>& steps :
         {std::vector<float>{1, 1, 1, -1, -1, -1}, {3, -3}, {-2, -2, 4}, {2, -5, 3}}) {
        const glm::vec3 start = visitor.camera().eye();
        float away = 0;
        for (const float step : steps) {
            visitor.wheel(step);
            away = std::max(away, between(visitor.camera().eye(), start));
        }
        CHECK(away > .01f * reach);
        CHECK(between(visitor.camera().eye(), start) < 1e-4f * reach);
    }
    // From so far away that the wall counts as none, until it comes near.
    faceWall(visitor, 3 * reach);
    visitor.camera().focus(reach);
    visitor.mouse = glm::floor(visitor.at({-1.1f, 1.3f, .36f}));
    const glm::vec3 start = visitor.camera().eye(), wall = visitor.under(visitor.mouse);
    std::vector<glm::vec3> way{start};
    for (int i = 0; i < 25; ++i) visitor.wheel(1), way.push_back(visitor.camera().eye());
    CHECK(between(way.back(), wall) < .5f * reach);
    CHECK(glm::distance(visitor.at(wall), visitor.mouse) < 2);
    for (way.pop_back(); !way.empty(); way.pop_back()) {
        visitor.wheel(-1);
        CHECK(between(visitor.camera().eye(), way.back()) < 2e-3f * reach);
    }
}

TEST_CASE("Home shows what plants grow on, not the village around it") {
    const Folder folder;
    Editor editor(folder, wallScene(folder, true), Tool::look);  // 4 m wide, the houses 30 m behind it
    const auto [low, high] = editor.work.bounds();
    editor.key(GLFW_KEY_HOME);
    glm::vec2 least(1e6f), most(-1e6f);
    for (int i = 0; i < 8; ++i) {
        const glm::vec2 at = editor.at(glm::mix(low, high, glm::vec3(i & 1, i >> 1 & 1, i >> 2 & 1)));
        CHECK(at.x > editor.work.panelUnits());
        CHECK(glm::clamp(at, glm::vec2(0), editor.work.window) == at);
        least = glm::min(least, at), most = glm::max(most, at);
    }
    const glm::vec2 filled =
        (most - least) / glm::vec2(editor.work.window.x - editor.work.panelUnits(), editor.work.window.y);
    CHECK(std::max(filled.x, filled.y) > .85f);
}

TEST_CASE("numpad 0 leads back to where the scene begins, and so does Home in the game") {
    const Folder folder;
    Visitor visitor(folder);
    const glm::vec3 start = sample::vec(visitor.work.scene().camera.eye);
    const auto away = [&] { return between(visitor.camera().eye(), start); };
    visitor.wheel(8);
    visitor.look({200, 40});
    REQUIRE(away() > .5f);
    visitor.key(GLFW_KEY_HOME);
    CHECK(away() > .1f);
    visitor.key(GLFW_KEY_KP_0);
    CHECK(away() < 1e-4f);
    visitor.wheel(8);
    REQUIRE(away() > .5f);
    visitor.controls.setEditing(false);
    visitor.key(GLFW_KEY_HOME);
    CHECK(away() < 1e-4f);
}

TEST_CASE("numpad 5 shows what is looked at as large as before, parallel lines nearly parallel, and leads back") {
    const Folder folder;
    Visitor visitor(folder);
    const EspCamera before = visitor.work.camera.camera();
    const glm::vec3 target = sample::vec(before.target), side(.3f, 0, 0), front(0, 0, .3f);
    const auto width = [&](glm::vec3 middle) {
        return glm::distance(visitor.at(middle + side), visitor.at(middle - side));
    };
    const float seen = width(target);
    CHECK(width(target + front) > 1.1f * seen);
    visitor.key(GLFW_KEY_KP_5);
    CHECK(visitor.work.camera.flat());
    CHECK(width(target) == doctest::Approx(seen).epsilon(.01));
    CHECK(width(target + front) < 1.02f * seen);
    visitor.key(GLFW_KEY_KP_5);
    CHECK(!visitor.work.camera.flat());
    const EspCamera after = visitor.work.camera.camera();
    CHECK(after.fovY == before.fovY);
    CHECK(glm::distance(sample::vec(after.eye), sample::vec(before.eye)) < 1e-3f);
}

TEST_CASE("who walks where the editor looked from below, or low above the ground, stands on it") {
    const Folder folder;
    std::string scene = readAll(smallScene(folder));
    scene.insert(scene.find('{') + 1, "\"ground\": {\"level\": 0.1},");
    Editor visitor(folder, folder.write("meadow.json", scene), Tool::look);
    visitor.controls.setEditing(false);
    sample::ViewCamera& walker = visitor.work.camera;
    for (const float height : {.3f, -.5f}) {
        CAPTURE(height);
        EspCamera camera = walker.camera();
        const float eye[3] = {0, .1f + height, 6}, target[3] = {0, eye[1], 7};
        std::copy(eye, eye + 3, camera.eye);
        std::copy(target, target + 3, camera.target);
        walker.set(camera, 10);
        sample::Navigation legs;
        for (int i = 0; i < 20; ++i) legs.go(visitor.work, {0, 0, 1}, .05f, false);
        CHECK(walker.eye().y == doctest::Approx(.1f + 1.65f).epsilon(.01));
        CHECK(walker.eye().z > 7);
    }
}

TEST_CASE(
    "what is pressed upon stays under the mouse when the camera moves sideways, and in the middle when it turns") {
    const Folder folder;
    for (const float stale : {.02f, 40.f}) {
        CAPTURE(stale);
        Visitor visitor(folder);
        visitor.camera().focus(stale);
        visitor.look({2, 1});
        const glm::vec3 eye = visitor.camera().eye(), ahead = visitor.camera().ahead();
        const glm::vec2 at = visitor.at({-.8f, 1.3f, .36f});
        const glm::vec3 held = visitor.under(at);
        visitor.press(at, GLFW_MOD_SHIFT, kMiddle);
        CHECK(visitor.camera().eye() == eye);
        CHECK(visitor.camera().ahead() == ahead);
        visitor.moveTo(at + glm::vec2(90, -40), 6, GLFW_MOD_SHIFT);
        CHECK(glm::distance(visitor.at(held), visitor.mouse) < 1);
        visitor.release(visitor.mouse, GLFW_MOD_SHIFT, kMiddle);

        visitor.camera().focus(stale);
        const glm::vec3 seen = visitor.under(visitor.middle());
        const glm::vec3 before = visitor.camera().eye();
        visitor.press(at, 0, kMiddle);
        CHECK(visitor.camera().eye() == before);
        visitor.moveTo(at + glm::vec2(60, 30), 6);
        visitor.release(visitor.mouse, 0, kMiddle);
        CHECK(glm::distance(visitor.at(seen), visitor.middle()) < 1);
        CHECK(between(visitor.camera().eye(), seen) == doctest::Approx(between(before, seen)).epsilon(.001));
    }
}

TEST_CASE("what was framed is turned about as a whole, until the user looks elsewhere") {
    const Folder folder;
    Visitor visitor(folder);
    visitor.look({300, 80});
    visitor.key(GLFW_KEY_HOME);
    const EspCamera framed = visitor.camera().camera();
    const glm::vec3 centre = sample::vec(framed.target);
    visitor.press(visitor.middle(), 0, kMiddle);
    visitor.moveTo(visitor.middle() + glm::vec2(200, 0), 6);
    visitor.release(visitor.mouse, 0, kMiddle);
    visitor.key(GLFW_KEY_KP_1);
    visitor.key(GLFW_KEY_KP_4);
    CHECK(glm::distance(visitor.at(centre), visitor.middle()) < 1);
}

TEST_CASE("while the right button looks around the wheel sets how fast one flies, and says so") {
    const Folder folder;
    Visitor visitor(folder);
    const float usual = visitor.camera().hurry(0);
    visitor.press(visitor.middle(), 0, kRight);
    const glm::vec3 eye = visitor.camera().eye();
    visitor.wheel(3);
    CHECK(visitor.camera().eye() == eye);
    CHECK(visitor.camera().hurry(0) > 1.5f * usual);
    CHECK_MESSAGE(contains(visitor.work.message, "Flying at"), visitor.work.message);
    visitor.wheel(-500);
    CHECK(visitor.camera().hurry(0) > 0);
    visitor.wheel(500);
    const float most = visitor.camera().hurry(0);
    visitor.camera().fly({0, 0, -1}, .5f, false);
    CHECK(between(visitor.camera().eye(), eye) == doctest::Approx(most / 2));
    visitor.release(visitor.mouse, 0, kRight);
    visitor.wheel(1);
    CHECK(visitor.camera().hurry(0) == most);
}

TEST_CASE("the numpad's . shows what the brush points at") {
    const Folder folder;
    Visitor visitor(folder, Tool::paint);
    visitor.work.brush.radius = .1f;
    const glm::vec2 at = visitor.at({-.8f, 1.4f, .36f});
    visitor.move(at);
    const glm::vec3 point = visitor.under(at);
    visitor.key(GLFW_KEY_KP_DECIMAL);
    CHECK(glm::distance(visitor.at(point), visitor.middle()) < 1);
    CHECK(between(visitor.camera().eye(), point) < .3f * visitor.work.reach());
}
